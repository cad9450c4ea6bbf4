// SPDX-License-Identifier: MIT
#include "router/groups.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace mavloom::router {

tl::unexpected<SetupError> other_mode(const endpoint::Endpoint& endpoint, endpoint::GroupMode mode) {
    return setup_error(SetupCode::usage,
                       fmt::format("{}: group '{}' already has group_mode={}; a group has one mode", endpoint.label(),
                                   endpoint.options.group, endpoint::group_mode_name(mode)));
}

SetupResult<Groups::Modes> Groups::modes_of(std::span<const endpoint::Endpoint> endpoints) {
    Modes modes;
    for (const auto& endpoint : endpoints) {
        const auto& o = endpoint.options;
        if (o.group.empty() || !o.has_group_mode) continue;
        const auto [known, is_new] = modes.try_emplace(o.group, o.group_mode);
        if (!is_new && known->second != o.group_mode) return other_mode(endpoint, known->second);
    }
    return modes;
}

endpoint::GroupMode Groups::mode_of(const endpoint::EndpointOptions& options) const {
    const auto group = modes_.find(options.group);
    return options.has_group_mode || group == modes_.end() ? options.group_mode : group->second;
}

route::GroupId Groups::id_of(const std::string& name) {
    if (name.empty()) return {};
    auto at = std::ranges::find(names_, name);
    if (at == names_.end()) at = names_.insert(names_.end(), name);
    return route::GroupId{static_cast<std::uint32_t>(at - names_.begin()) + 1};
}

void Groups::note_mode(const endpoint::EndpointOptions& options) {
    if (options.has_group_mode) modes_[options.group] = options.group_mode;
}

}  // namespace mavloom::router
