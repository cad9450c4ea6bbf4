// SPDX-License-Identifier: MIT
#include "router/own_messages.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/request_data_stream.hpp"
#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::router {

namespace {

constexpr std::uint8_t ardupilot = 3;                   // MAV_AUTOPILOT_ARDUPILOTMEGA
constexpr msg::Heartbeat own_heartbeat{.type = 18,      // MAV_TYPE_ONBOARD_CONTROLLER
                                       .autopilot = 8,  // MAV_AUTOPILOT_INVALID
                                       .base_mode = 0,
                                       .custom_mode = 0,
                                       .system_status = 4,  // MAV_STATE_ACTIVE
                                       .mavlink_version = 3};

std::optional<Source> own_source(const config::RouterConfig& config) {
    if (!config.heartbeat) return std::nullopt;
    return Source{SystemId{config.heartbeat->first}, ComponentId{config.heartbeat->second}};
}

}  // namespace

bool wants_heartbeat(const endpoint::Endpoint& endpoint) noexcept {
    return endpoint.options.heartbeat.value_or(endpoint::sends_first(endpoint.scheme) && !endpoint.options.tap);
}

OwnMessages::OwnMessages(const wire::MessageTable& table, const config::RouterConfig& config, Callbacks callbacks)
    : table_(table), own_(own_source(config)), streams_hz_(config.request_streams_hz), callbacks_(std::move(callbacks)) {}

void OwnMessages::configure(const config::RouterConfig& config) {
    const auto own = own_source(config);
    if (std::exchange(own_, own) != own)
        for (Link& link : links_) link = {link.id, link.beats};
    streams_hz_ = config.request_streams_hz;
    requests_.clear();
}

void OwnMessages::add(LinkId link, bool beats, MonoTime now) { links_.push_back({link, beats, now}); }

void OwnMessages::remove(LinkId link) {
    std::erase_if(links_, [&](const Link& l) { return l.id == link; });
    requests_.forget(link);
}

MonoTime OwnMessages::next_due() const noexcept {
    MonoTime due = MonoTime::max();
    if (own_)
        for (const Link& link : links_)
            if (link.beats) due = std::min(due, link.due);
    return due;
}

void OwnMessages::send_due(MonoTime now) {
    if (!own_) return;
    std::array<std::uint8_t, msg::Heartbeat::max_length> payload;
    (void)own_heartbeat.encode(payload);
    for (Link& link : links_) {
        if (!link.beats || now < link.due) continue;
        if (send(link, msg::Heartbeat::id, payload)) heartbeats_sent_.add();
        const Nanoseconds pause = callbacks_.answered(link.id) ? interval : interval_until_answered;
        link.due = link.due + pause > now ? link.due + pause : now + pause;  // does not catch up on missed heartbeats
    }
}

bool OwnMessages::send(Link& link, MessageId id, ByteView payload) {
    wire::FrameBuffer buffer;
    const auto frame = wire::write_frame(buffer, {.sequence = link.sequence++, .source = *own_}, *table_.find(id),
                                         payload);
    return callbacks_.send(link.id, frame);
}

void OwnMessages::on_heartbeat(LinkId link, const wire::FrameView& frame, MonoTime now) {
    if (!own_ || streams_hz_ == 0 || msg::Heartbeat::decode(frame.payload()).autopilot != ardupilot) return;
    const auto to = std::ranges::find(links_, link, &Link::id);
    const Source source = frame.source();
    if (to == links_.end() || !requests_.heard(link, source, now)) return;
    const msg::RequestDataStream request{.target_system = source.system.value,
                                         .target_component = source.component.value,
                                         .req_stream_id = 0,  // MAV_DATA_STREAM_ALL
                                         .req_message_rate = streams_hz_,
                                         .start_stop = 1};
    std::array<std::uint8_t, msg::RequestDataStream::max_length> payload;
    (void)request.encode(payload);
    (void)send(*to, msg::RequestDataStream::id, payload);
}

}  // namespace mavloom::router
