// SPDX-License-Identifier: MIT
#include "sim/telemetry/data_streams.hpp"

#include <array>

#include "mavloom/msg/enums/mav_data_stream.hpp"
#include "mavloom/msg/request_data_stream.hpp"

namespace mavloom::sim {

namespace {

constexpr std::array data_stream_ids{msg::RequestDataStream::id};

Nanoseconds group_interval(const msg::RequestDataStream& request) noexcept {
    if (request.start_stop == 0 || request.req_message_rate == 0) return Nanoseconds{0};
    return Nanoseconds{1'000'000'000 / request.req_message_rate};
}

}  // namespace

std::span<const MessageId> DataStreams::handled() const noexcept { return data_stream_ids; }

void DataStreams::receive(const Client& from, MessageId /*id*/, ByteView payload, Moment now) {
    if (firmware_.is_px4()) return;
    const auto request = msg::RequestDataStream::decode(payload);
    for (const StreamGroup& group : stream_groups()) {
        if (request.req_stream_id != msg::MAV_DATA_STREAM_ALL && request.req_stream_id != group.id) continue;
        for (const MessageId message : group.messages)
            (void)streams_.set_interval(from.link, message, group_interval(request), now.flight);
    }
}

}  // namespace mavloom::sim
