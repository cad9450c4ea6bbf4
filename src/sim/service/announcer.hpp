// SPDX-License-Identifier: MIT
// Texts for people: STATUSTEXT, in chunks if a text is long. Private to module sim; single owner.
//
// A client that connects late gets the last few texts. When the first heartbeat of a ground station arrives on a link,
// the announcer repeats on that link what it sent within the last 5 s. Source: MAVLink common.xml, STATUSTEXT.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "flight/flight.hpp"
#include "mavloom/sim/flight.hpp"
#include "sim/radio/radio.hpp"

namespace mavloom::sim {

class Announcer {
public:
    explicit Announcer(Radio& radio) noexcept : radio_(radio) {}

    // Sends a text to all links, in chunks if it is longer than 50 bytes.
    void say(Severity severity, std::string_view text, FlightTime now);
    // A ground station was heard on this link for the first time.
    void greet(LinkId link, FlightTime now);
    void forget(LinkId link);
    // True if a ground station was heard on a link that is open.
    [[nodiscard]] bool has_audience() const noexcept { return !greeted_.empty(); }

private:
    struct Past {
        Severity severity;
        std::string text;
        FlightTime at;
        std::uint16_t id;
    };
    void send(LinkId link, const Past& past);

    Radio& radio_;
    std::vector<Past> past_;  // newest last, at most `kept`
    std::vector<LinkId> greeted_;
    std::uint16_t last_id_ = 0;
    static constexpr std::size_t kept = 8;
    static constexpr Nanoseconds repeated_for = std::chrono::seconds{5};
};

}  // namespace mavloom::sim
