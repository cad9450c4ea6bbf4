// SPDX-License-Identifier: MIT
// Notices links that send and hear nothing: a wrong port, a wrong baud rate, a vehicle that talks to somebody else. Each endpoint is reported
// once, and only where it calls somebody: a peer that calls us has been heard already.
//
// Private to module router; one owner thread; time is a parameter.
#pragma once

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

    // A link came up of an endpoint that calls somebody and expects an answer.
    void add(LinkId link, link::EndpointId endpoint);
    void remove(LinkId link);

    struct Silent {
        LinkId link;
        link::EndpointId endpoint;
    };
    // Null for a link that is gone.
    using CountersOf = std::function<const link::LinkCounters*(LinkId)>;
    // About once a second: what to report now. A link that was heard is watched no longer.
    [[nodiscard]] std::vector<Silent> look(const CountersOf& counters_of, MonoTime now);

private:
    struct Watched {
        LinkId link;
        link::EndpointId endpoint;
        MonoTime since = MonoTime::max();  // the first look at which it had sent something
    };
    std::vector<Watched> watched_;
    std::vector<link::EndpointId> reported_;
};

// Whether silence on this endpoint is worth a word: it calls somebody, and is no tap.
[[nodiscard]] bool expects_answer(const endpoint::Endpoint& endpoint) noexcept;

// "px4: nothing heard for 5 s; ..." with what to look at, by what did come: `link` of its link, `info` of the endpoint.
[[nodiscard]] std::string silence_text(const link::EndpointInfo& info, const link::LinkCounters& link);

}  // namespace mavloom::router
