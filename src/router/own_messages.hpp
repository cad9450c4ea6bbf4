// SPDX-License-Identifier: MIT
// What a router sends under its own system and component: a HEARTBEAT on the links that want one, and requests for an ArduPilot's streams.
// Each link has its own sequence numbers. Nothing is sent while the router has no id. docs/guide/route.md, "The router's own heartbeat".
//
// Private to module router; one owner thread; time is a parameter. Allocates when a link or an ArduPilot is new.
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

// Whether links of this endpoint get the router's heartbeat: as `heartbeat=` says, else those that call somebody. A client or peer that came by
// itself would take the heartbeat for a vehicle's.
[[nodiscard]] bool wants_heartbeat(const endpoint::Endpoint& endpoint) noexcept;

class OwnMessages {
public:
    // How the owner sends: false where the link did not take the frame. `answered`: whether anything was heard on the link.
    struct Ways {
        std::function<bool(LinkId, const wire::FrameView&)> send;
        std::function<bool(LinkId)> answered;
    };

    static constexpr Nanoseconds interval_until_answered = std::chrono::milliseconds{100};
    static constexpr Nanoseconds interval = std::chrono::seconds{1};

    // `table` must outlive the object and define HEARTBEAT and REQUEST_DATA_STREAM.
    OwnMessages(const wire::MessageTable& table, const config::RouterConfig& config, Ways ways);

    // Other values; the links stay, and begin with the next heartbeat.
    void configure(const config::RouterConfig& config);

    // A link came up. `beats`: it gets heartbeats.
    void add(LinkId link, bool beats, MonoTime now);
    void remove(LinkId link);

    // When the next heartbeat is due; the end of time where there is none.
    [[nodiscard]] MonoTime next_due() const noexcept;
    void send_due(MonoTime now);

    // A HEARTBEAT was heard: asks an ArduPilot for its streams where the configuration says so.
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
    std::uint16_t streams_hz_ = 0;  // 0: no requests
    Ways ways_;
    std::vector<Link> links_;
    StreamRequests requests_;
    Counter heartbeats_sent_;
};

}  // namespace mavloom::router
