// SPDX-License-Identifier: MIT
// Detects links that send frames but receive none. Typical causes are a wrong port, a wrong baud rate, or a vehicle
// that answers another program. It reports each endpoint once. It watches only endpoints that send first
// (endpoint::sends_first): a peer that connects to the router has been heard already.
//
// Private to module router. One owner thread; time is a parameter.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/link/links.hpp"

namespace mavloom::router {

class SilenceWatch {
public:
    static constexpr Nanoseconds patience = std::chrono::seconds{5};

    // Starts to watch a link that came up. expects_answer must be true for its endpoint.
    void add(LinkId link, link::EndpointId endpoint);
    void remove(LinkId link);

    struct Silent {
        LinkId link;
        link::EndpointId endpoint;
    };
    // Returns null for a link that is gone.
    using CountersOf = std::function<const link::LinkCounters*(LinkId)>;
    // Returns the links to report now. Call it about once a second. Once a frame has arrived on a link, it is no longer
    // watched.
    [[nodiscard]] std::vector<Silent> look(const CountersOf& counters_of, MonoTime now);

private:
    struct Watched {
        LinkId link;
        link::EndpointId endpoint;
        // The first look() that found a frame sent, and none refused since the look before it: the link reports a
        // closed port itself.
        MonoTime since = MonoTime::max();
        std::uint64_t refused = 0;  // at the last look()
    };
    std::vector<Watched> watched_;
    std::vector<link::EndpointId> reported_;
};

// Whether silence on this endpoint is worth a report: it sends first and is not a tap.
[[nodiscard]] bool expects_answer(const endpoint::Endpoint& endpoint) noexcept;

// The report text, for example "px4: nothing heard for 5 s; ...". It suggests what to check, based on the counters of
// the endpoint (`info`) and of its link.
[[nodiscard]] std::string silence_text(const link::EndpointInfo& info, const link::LinkCounters& link);

}  // namespace mavloom::router
