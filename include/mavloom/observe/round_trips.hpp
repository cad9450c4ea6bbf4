// SPDX-License-Identifier: MIT
// Times from requests to their answers, both as heard here: TIMESYNC, PING, and COMMAND_LONG or COMMAND_INT with
// COMMAND_ACK. They include the way from here to the vehicle and back, and the time that the vehicle takes.
//
// One owner thread. Bounded in the requests that wait for an answer. Sources: MAVLink guide, "Time Synchronization
// Protocol", "Ping Protocol" and "Command Protocol".
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/ping.hpp"
#include "mavloom/msg/timesync.hpp"

namespace mavloom::observe {

class RoundTrips {
public:
    static constexpr std::size_t max_open = 1024;  // after that, the oldest request is forgotten
    static constexpr Nanoseconds max_age = std::chrono::seconds{10};

    // A message that `source` sent. An answer returns the time since its request.
    std::optional<Nanoseconds> take(Source source, const msg::Timesync& message, WallTime time) noexcept;
    std::optional<Nanoseconds> take(Source source, const msg::Ping& message, WallTime time) noexcept;
    std::optional<Nanoseconds> take(Source source, const msg::CommandAck& message, WallTime time) noexcept;
    // Of a COMMAND_LONG or COMMAND_INT. A command that is sent again begins again.
    void command(Source source, SystemId target, std::uint16_t number, WallTime time) noexcept;

private:
    enum class What : std::uint8_t { none, timesync, ping, command };
    struct Open {
        What what = What::none;
        Source from{};
        SystemId to{};  // 0: anybody
        std::uint64_t id = 0, more = 0;
        WallTime time{};
    };

    void ask(const Open& request) noexcept;
    // Ends the newest request that `matches`.
    template <class Matches>
    std::optional<Nanoseconds> answer(What what, std::uint64_t id, WallTime time, Matches&& matches) noexcept;

    std::array<Open, max_open> open_{};
    std::size_t next_ = 0;
};

}  // namespace mavloom::observe
