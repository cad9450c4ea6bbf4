// SPDX-License-Identifier: MIT
// The links that exist, by id and with unique names. Private to module link; single owner thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "link/link.hpp"

namespace mavloom::link::detail {

// Looks up links by id with one load. Ids increase and are never reused. `add` skips an id whose slot is still taken.
class LinkTable {
public:
    LinkTable() : slots_(64) {}
    // Assigns the link's id. If another link has the same name, appends " (2)" or a higher number.
    void add(Link& link);
    // Numbers the next links from `last` + 1.
    void count_from(LinkId last) noexcept { last_ = std::max(last_, last.value); }
    // An id for something that is no link of this table.
    [[nodiscard]] LinkId take_id() noexcept { return LinkId{++last_}; }
    void remove(LinkId id) noexcept;
    [[nodiscard]] Link* find(LinkId id) const noexcept {
        Link* link = slots_[id.value & (slots_.size() - 1)];
        return link != nullptr && link->id == id ? link : nullptr;
    }
    // True while a link that is up has frames queued.
    [[nodiscard]] bool any_queued(MonoTime now) const noexcept;
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    template <class F>
    void each(F&& f) const {
        for (Link* link : slots_)
            if (link != nullptr) f(*link);
    }

private:
    [[nodiscard]] bool name_taken(const std::string& name) const noexcept;
    void grow();

    std::vector<Link*> slots_;  // size: a power of two; at most half used
    std::size_t size_ = 0;
    std::uint32_t last_ = 0;
};

}  // namespace mavloom::link::detail
