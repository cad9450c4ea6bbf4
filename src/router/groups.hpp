// SPDX-License-Identifier: MIT
// The groups of redundant links: their ids, and one mode for each. Private to module router; single owner thread.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/route/engine.hpp"

namespace mavloom::router {

class Groups {
public:
    using Modes = std::map<std::string, endpoint::GroupMode>;

    // The modes that these endpoints set by `group_mode=`, by group name. Fails if a group has two modes.
    [[nodiscard]] static SetupResult<Modes> modes_of(std::span<const endpoint::Endpoint> endpoints);

    void set_modes(Modes modes) { modes_ = std::move(modes); }
    // The mode of an endpoint's group: its own `group_mode=`, or else the mode that its group has.
    [[nodiscard]] endpoint::GroupMode mode_of(const endpoint::EndpointOptions& options) const;
    // Returns the id of a group. A name keeps its id for as long as the object exists. An empty name means no group.
    [[nodiscard]] route::GroupId id_of(const std::string& name);
    void note_mode(const endpoint::EndpointOptions& options);
    // Call it when the group has no members any more.
    void forget_mode(const std::string& name) { modes_.erase(name); }

private:
    std::vector<std::string> names_;  // by GroupId - 1
    Modes modes_;
};

// Returns the error for an endpoint whose group already has another mode.
[[nodiscard]] tl::unexpected<SetupError> other_mode(const endpoint::Endpoint& endpoint, endpoint::GroupMode mode);

}  // namespace mavloom::router
