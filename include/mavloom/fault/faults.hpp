// SPDX-License-Identifier: MIT
// Gives links the faults that a user asks for: loss, copies, damage, delay, reordering, a narrow line, black-outs
// (docs/guide/faults.md). Each link gets stages (mavloom/link/stage.hpp) for each of its directions.
//
// The same seed and the same pieces at the same times meet the same faults. Every fault of every direction of every
// link draws from a random stream of its own. The stream depends on the seed, on the name of the endpoint, and on how
// many links the endpoint had before this one, those that are gone included.
//
// Call these functions on the thread that owns the Links object, outside callbacks. The stages count each fault in
// link::LinkCounters. A link without faults costs nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "mavloom/base/result.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/link/links.hpp"

namespace mavloom::fault {

// Links::add, and the faults that the endpoint's options ask for. If there are any, on_notice reports them.
[[nodiscard]] SetupResult<link::EndpointId> add(link::Links& links, const endpoint::Endpoint& endpoint,
                                                const dialect::Dialect* dialect = nullptr);

// The faults of both directions.
struct Plan {
    endpoint::Faults in, out;
    std::uint64_t seed = 1;

    [[nodiscard]] bool any() const noexcept { return in.any() || out.any(); }
    // "in loss:0.1, seed 1"; "in and out sik, seed 7"; "off".
    [[nodiscard]] std::string text() const;
};
[[nodiscard]] Plan plan_of(const endpoint::EndpointOptions& options);

// A request of `mavloom ctl NAME fault`: the specifications of one or both directions, and the seed. A missing one
// stays as it is.
struct Change {
    std::optional<std::string> in{}, out{}, seed{};
};
// Replaces the faults of an endpoint's links, present and future ones, or of one link, by its name. All links of an
// endpoint then have the same faults, whatever one of them had. Returns what it has now. Errors are `usage`: a wrong
// specification, none for either direction, no such link, or a ring.
[[nodiscard]] SetupResult<std::string> change(link::Links& links, std::string_view name, const Change& change);

// From now on, links that get faults write a line to this file for each fault that happens (docs/guide/faults.md). It
// applies to all Links of the process: call it once, before endpoints are opened. A log that exists continues; any
// other file is an error (`in_use`) and stays as it is. Lines that the disk refuses are lost. An empty path: no log.
[[nodiscard]] SetupResult<void> log_to(const std::string& path);

// The stages for a link of the endpoint `label`.
[[nodiscard]] link::Stages stages_of(const Plan& plan, std::string_view label, const link::StageSite& site);

}  // namespace mavloom::fault
