// SPDX-License-Identifier: MIT
// Detects endpoints on which nothing is heard, and suggests what to check. Typical causes are a wrong port, a wrong
// baud rate, or a vehicle that answers another program.
//
// The owner adds the endpoints that it expects to hear, and passes on when their links come up and go down. An endpoint
// that has been heard is no longer watched. One owner thread; time is a parameter.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/link/links.hpp"

namespace mavloom::link {

class SilenceWatch {
public:
    static constexpr Nanoseconds patience = std::chrono::seconds{5};

    // Ignores recordings and rings.
    void add(EndpointId endpoint, const endpoint::Endpoint& opened, MonoTime now);
    void remove(EndpointId endpoint);
    void on_link_up(LinkId link, EndpointId endpoint, MonoTime now);
    // `counters` are those of the link; null if they are gone. An endpoint is heard, too, if its link came and went
    // between two polls.
    void on_link_down(LinkId link, const LinkCounters* counters);

    struct Silent {
        EndpointId endpoint;
        LinkId link;  // the newest one; 0: none is up
    };
    // Returns null for a link that is gone.
    using CountersOf = std::function<const LinkCounters*(LinkId)>;
    // Returns what to report now: each endpoint once that was silent for 5 s. An endpoint to which nothing was sent is
    // reported a second time if it then sends frames for 5 s and still hears nothing. Call it about once a second.
    [[nodiscard]] std::vector<Silent> poll(const CountersOf& counters_of, MonoTime now);

private:
    struct Watched {
        EndpointId endpoint;
        bool waits_for_peers = false;      // it opens a port; other endpoints have a link as soon as they are connected
        bool calls = false;                // the far side may answer only what it hears
        std::vector<LinkId> links{};       // those that are up, the newest one last
        MonoTime since = MonoTime::max();  // the start of the silence
        MonoTime sent_since = MonoTime::max();  // the first poll that found a frame sent, and none newly refused
        std::uint64_t refused = 0;              // at the last poll
        bool is_reported = false;
    };
    // Whether to report the endpoint now. `link` is the newest one; null if none is up.
    [[nodiscard]] static bool is_due(Watched& watched, const LinkCounters* link, MonoTime now);

    std::vector<Watched> watched_;
};

// Returns what arrived instead of frames, or what to check if nothing did, based on the counters of the endpoint
// (`info`) and of its link. `link` is null if no link is up.
[[nodiscard]] std::string silence_reason(const EndpointInfo& info, const LinkCounters* link);
// The report text, for example "px4: nothing heard for 5 s; ...", with the reason.
[[nodiscard]] std::string silence_text(const EndpointInfo& info, const LinkCounters* link);
// Polls, and returns the texts.
[[nodiscard]] std::vector<std::string> poll_silence(SilenceWatch& watch, const Links& links, MonoTime now);

}  // namespace mavloom::link
