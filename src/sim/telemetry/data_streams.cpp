// SPDX-License-Identifier: MIT
#include "sim/telemetry/data_streams.hpp"

#include <algorithm>
#include <array>

#include "mavloom/msg/enums/mav_data_stream.hpp"
#include "mavloom/msg/request_data_stream.hpp"
#include "sim/parts.hpp"

namespace mavloom::sim {

namespace {

constexpr std::array data_stream_ids{msg::RequestDataStream::id};

Nanoseconds group_interval(double rate_hz) noexcept {
    constexpr double fastest_hz = 1000;
    return rate_hz > 0 ? Nanoseconds{static_cast<std::int64_t>(1e9 / std::min(rate_hz, fastest_hz))} : Nanoseconds{0};
}

void set_group(Streams& streams, LinkId link, std::uint8_t id, double rate_hz, FlightTime now) {
    for (const StreamGroup& group : stream_groups()) {
        if (id != msg::MAV_DATA_STREAM_ALL && id != group.id) continue;
        for (const MessageId message : group.messages)
            (void)streams.set_interval(link, message, group_interval(rate_hz), now);
    }
}

struct GroupParameter {
    std::string_view name;
    std::uint8_t group;  // MAV_DATA_STREAM
};
constexpr std::array group_parameters{GroupParameter{"SR0_RAW_SENS", msg::MAV_DATA_STREAM_RAW_SENSORS},
                                      GroupParameter{"SR0_EXT_STAT", msg::MAV_DATA_STREAM_EXTENDED_STATUS},
                                      GroupParameter{"SR0_RC_CHAN", msg::MAV_DATA_STREAM_RC_CHANNELS},
                                      GroupParameter{"SR0_POSITION", msg::MAV_DATA_STREAM_POSITION},
                                      GroupParameter{"SR0_EXTRA1", msg::MAV_DATA_STREAM_EXTRA1},
                                      GroupParameter{"SR0_EXTRA2", msg::MAV_DATA_STREAM_EXTRA2},
                                      GroupParameter{"SR0_EXTRA3", msg::MAV_DATA_STREAM_EXTRA3}};

}  // namespace

std::span<const MessageId> DataStreams::handled() const noexcept { return data_stream_ids; }

void DataStreams::receive(const Client& from, MessageId /*id*/, ByteView payload, Moment now) {
    if (parts_.firmware.is_px4()) return;
    const auto request = msg::RequestDataStream::decode(payload);
    const double rate_hz = request.start_stop == 0 ? 0.0 : request.req_message_rate;
    set_group(parts_.streams, from.link, request.req_stream_id, rate_hz, now.flight);
}

void DataStreams::on_open(Parts& parts, LinkId link, FlightTime now) {
    for (const GroupParameter& row : group_parameters) {
        const auto index = parts.parameters.find(row.name);
        if (!index || parts.parameters.value(*index) == parts.parameters.info(*index).initial) continue;
        set_group(parts.streams, link, row.group, parts.parameters.value(*index), now);
    }
}

void DataStreams::on_parameter(Parts& parts, std::string_view name, double value, FlightTime now) {
    const auto row = std::ranges::find(group_parameters, name, &GroupParameter::name);
    if (row == group_parameters.end()) return;
    for (const LinkId link : parts.radio.links()) set_group(parts.streams, link, row->group, value, now);
}

}  // namespace mavloom::sim
