// SPDX-License-Identifier: MIT
#include "link/core/link_table.hpp"

#include <fmt/format.h>

namespace mavloom::link::detail {

void LinkTable::add(Link& link) {
    const std::string wanted = link.name;
    for (int n = 2; name_taken(link.name); ++n) link.name = fmt::format("{} ({})", wanted, n);
    if ((size_ + 1) * 2 > places_.size()) grow();
    do {
        ++last_;
    } while (places_[last_ & (places_.size() - 1)] != nullptr);
    places_[last_ & (places_.size() - 1)] = &link;
    ++size_;
    link.id = LinkId{last_};
}

void LinkTable::grow() {
    std::vector<Link*> larger(places_.size() * 2);
    each([&](Link& link) { larger[link.id.value & (larger.size() - 1)] = &link; });
    places_ = std::move(larger);
}

void LinkTable::remove(LinkId id) noexcept {
    if (find(id) == nullptr) return;
    places_[id.value & (places_.size() - 1)] = nullptr;
    --size_;
}

bool LinkTable::any_queued() const noexcept {
    return std::ranges::any_of(places_,
                               [](const Link* link) { return link != nullptr && link->up && !link->queue.empty(); });
}

bool LinkTable::name_taken(const std::string& name) const noexcept {
    return std::ranges::any_of(places_, [&](const Link* link) { return link != nullptr && link->name == name; });
}

}  // namespace mavloom::link::detail
