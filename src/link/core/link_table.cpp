// SPDX-License-Identifier: MIT
#include <cassert>

#include "link/core/link_table.hpp"

#include <fmt/format.h>

namespace mavloom::link::detail {

void LinkTable::add(Link& link) {
    assert(link.id == LinkId{} && "a link is added once");
    const std::string wanted = link.name;
    for (int n = 2; name_taken(link.name); ++n) link.name = fmt::format("{} ({})", wanted, n);
    if ((size_ + 1) * 2 > slots_.size()) grow();
    do {
        ++last_;
    } while (slots_[last_ & (slots_.size() - 1)] != nullptr);
    slots_[last_ & (slots_.size() - 1)] = &link;
    ++size_;
    link.id = LinkId{last_};
    assert(find(link.id) == &link);
}

void LinkTable::grow() {
    std::vector<Link*> larger(slots_.size() * 2);
    each([&](Link& link) { larger[link.id.value & (larger.size() - 1)] = &link; });
    slots_ = std::move(larger);
}

void LinkTable::remove(LinkId id) noexcept {
    if (find(id) == nullptr) return;
    slots_[id.value & (slots_.size() - 1)] = nullptr;
    --size_;
}

bool LinkTable::any_queued(MonoTime now) const noexcept {
    return std::ranges::any_of(slots_, [&](const Link* link) {
        return link != nullptr && link->up && !link->is_missing(now) && link->queued_bytes() != 0;
    });
}

bool LinkTable::name_taken(const std::string& name) const noexcept {
    return std::ranges::any_of(slots_, [&](const Link* link) { return link != nullptr && link->name == name; });
}

}  // namespace mavloom::link::detail
