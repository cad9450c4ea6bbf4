// SPDX-License-Identifier: MIT
// Sends the router's own messages, with its own system and component id. These are a HEARTBEAT, on the links that get
// one, and requests for ArduPilot's data streams. Each link has its own sequence numbers. A router without an id sends
// nothing. See docs/guide/route.md, "The router's own heartbeat".
//
// Private to module router. One owner thread; time is a parameter. Allocates for a new link or a new ArduPilot.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/counter.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/config/config.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/message_table.hpp"
#include "router/stream_requests.hpp"

namespace mavloom::router {

// Whether links of this endpoint get the router's heartbeat. If `heartbeat=` is set, it decides. By default, an
// endpoint gets the heartbeat if it sends first (endpoint::sends_first) and is not a tap. Other endpoints do not,
// because a client or peer that connects to the router could mistake the heartbeat for that of a vehicle.
[[nodiscard]] bool wants_heartbeat(const endpoint::Endpoint& endpoint) noexcept;

class OwnMessages {
public:
    // Callbacks to the owner of this object. `send` returns false if the link did not take the frame. `answered`
    // returns whether any frame has arrived on the link.
    struct Callbacks {
        std::function<bool(LinkId, const wire::FrameView&)> send;
        std::function<bool(LinkId)> answered;
    };

    static constexpr Nanoseconds interval_until_answered = std::chrono::milliseconds{100};
    static constexpr Nanoseconds interval = std::chrono::seconds{1};

    // `table` must outlive the object and define HEARTBEAT and REQUEST_DATA_STREAM.
    OwnMessages(const wire::MessageTable& table, const config::RouterConfig& config, Callbacks callbacks);

    // Applies a new configuration. Links stay, and each ArduPilot is asked again. If the router's id changed, the next
    // heartbeat of each link is due at once and its sequence numbers restart.
    void configure(const config::RouterConfig& config);

    // Adds a link that came up. `beats`: whether the router sends heartbeats to it.
    void add(LinkId link, bool beats, MonoTime now);
    void remove(LinkId link);

    // Returns when the next heartbeat is due, or MonoTime::max() if none is.
    [[nodiscard]] MonoTime next_due() const noexcept;
    void send_due(MonoTime now);

    // Handles a received HEARTBEAT: requests the data streams if the sender is an ArduPilot and the configuration asks
    // for that.
    void on_heartbeat(LinkId link, const wire::FrameView& frame, MonoTime now);

    [[nodiscard]] std::uint64_t heartbeats_sent() const noexcept { return heartbeats_sent_.value(); }

private:
    struct Link {
        LinkId id;
        bool beats = false;
        MonoTime due{};
        std::uint8_t sequence = 0;
    };
    bool send(Link& link, MessageId id, ByteView payload);

    const wire::MessageTable& table_;
    std::optional<Source> own_;
    std::uint16_t streams_hz_ = 0;  // 0 if there are no requests
    Callbacks callbacks_;
    std::vector<Link> links_;
    StreamRequests requests_;
    Counter heartbeats_sent_;
};

}  // namespace mavloom::router
