// SPDX-License-Identifier: MIT
#include "link/signing/signing_ids.hpp"

#include <cassert>
#include <ranges>

namespace mavloom::link::detail {

std::optional<std::uint8_t> SigningIds::choose(const std::string& label, EndpointId fresh,
                                               const OpenEndpoints& endpoints) const {
    const Use* best = nullptr;
    const auto id_of = [&](const Use* use) { return static_cast<std::uint8_t>(use - uses_.data()); };
    for (const Use& use : uses_ | std::views::reverse) {
        if (use.number != 0 && endpoints.find(use.holder) != nullptr) continue;
        if (use.number != 0 && !label.empty() && use.label == label) return id_of(&use);
        if (best == nullptr || use.number < best->number) best = &use;
    }
    if (fresh.value < uses_.size())
        if (const Use* const own = &uses_[uses_.size() - 1 - fresh.value]; own->number == 0) return id_of(own);
    return best == nullptr ? std::nullopt : std::optional(id_of(best));
}

void SigningIds::keep(const std::string& label, std::uint8_t link_id, EndpointId holder) {
    assert(holder != uses_[link_id].holder || uses_[link_id].number == 0);
    uses_[link_id] = {label, holder, ++count_};
}

}  // namespace mavloom::link::detail
