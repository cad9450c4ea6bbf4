// SPDX-License-Identifier: MIT
// A hop: one program on the way of the frames, such as a router, with what it counted. Plain data, for reports.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace mavloom::observe {

struct NamedCount {
    std::string name;  // of a loss, as in the program's own reports: "tx_dropped"
    std::uint64_t count = 0;
    std::string help{};  // one sentence for people
};

// Rates that are not given are reckoned from the counts of earlier reports.
struct HopLink {
    std::string name;
    std::string sends_to{};  // a URL; empty: it is the name, or there is none
    bool is_up = true;
    bool has_ended = false;  // a recording was read to its end, so it is not up
    bool is_sum = false;     // of several links; a link's counts move here when it ends, so growth is no news
    std::uint64_t frames_in = 0, frames_out = 0, bytes_in = 0, bytes_out = 0;
    std::optional<double> hz_in{}, hz_out{};
    std::vector<NamedCount> losses{};
    std::uint64_t refused = 0;  // frames for a port that nobody listens at
    // Bytes that wait to be sent, and how many may wait. 0: the program has no such queue, or does not report it.
    std::uint64_t queued_bytes = 0, queue_limit_bytes = 0;

    [[nodiscard]] const std::string& destination() const noexcept { return sends_to.empty() ? name : sends_to; }
};

struct Hop {
    // A station is an end of the way: a program of others, which counts nothing for us.
    enum class Kind : std::uint8_t { source, router, sim, listener, relay, web, station };

    std::string name;  // for people, unique among the hops
    Kind kind = Kind::source;
    bool is_up = true;
    std::uint64_t frames_in = 0, frames_out = 0;
    std::optional<double> hz_in{}, hz_out{};
    std::vector<NamedCount> losses{};
    std::vector<HopLink> links{};
    std::string hint{};  // for people: what to do to see more; usually empty
};

}  // namespace mavloom::observe
