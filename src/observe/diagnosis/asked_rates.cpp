// SPDX-License-Identifier: MIT
#include "mavloom/observe/asked_rates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/command_int.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/message_interval.hpp"
#include "mavloom/msg/request_data_stream.hpp"

namespace mavloom::observe {

namespace {

constexpr auto set_message_interval = std::uint16_t{msg::MAV_CMD_SET_MESSAGE_INTERVAL};

// A message of each stream group that every ArduPilot vehicle sends (MAV_DATA_STREAM; ArduPilot's
// GCS_MAVLINK::data_stream_ids). PX4 ignores the request.
struct StreamRow {
    std::uint8_t stream;
    MessageId id;
};
constexpr std::array stream_rows{StreamRow{0, MessageId{30}}, StreamRow{1, MessageId{27}}, StreamRow{2, MessageId{1}},
                                 StreamRow{3, MessageId{65}}, StreamRow{6, MessageId{33}}, StreamRow{10, MessageId{30}},
                                 StreamRow{11, MessageId{74}}};

bool is_for(const AskedRate& asked, Source source) {
    return asked.target.system == source.system &&
           (asked.target.component.value == 0 || asked.target.component == source.component);
}

}  // namespace

std::uint64_t AskedRate::count() const {
    std::uint64_t most = 0;
    for (const auto& [link, count] : heard) most = std::max(most, count);
    return most;
}

void AskedRates::take(const Heard& heard) {
    const auto id = heard.frame.id();
    if (id == msg::CommandLong::id) {
        const auto command = msg::CommandLong::decode(heard.frame.payload());
        if (command.command == set_message_interval)
            note_command(heard, {SystemId{command.target_system}, ComponentId{command.target_component}},
                         command.param1, command.param2);
    } else if (id == msg::CommandInt::id) {
        const auto command = msg::CommandInt::decode(heard.frame.payload());
        if (command.command == set_message_interval)
            note_command(heard, {SystemId{command.target_system}, ComponentId{command.target_component}},
                         command.param1, command.param2);
    } else if (id == msg::CommandAck::id) {
        note_answer(heard);
    } else if (id == msg::RequestDataStream::id) {
        note_stream(heard);
    } else if (id == msg::MessageInterval::id) {
        note_report(heard);
    }
    if (!watched_.empty()) count(heard);
}

// An interval of 0 asks for the vehicle's usual rate, -1 for none.
void AskedRates::note_command(const Heard& heard, Source target, float id, float interval_us) {
    if (!(id >= 0) || id > 0xffffff || !std::isfinite(interval_us)) return;
    const MessageId message{static_cast<std::uint32_t>(id)};
    if (interval_us == 0) return forget(target.system, message);
    ask({.asker = heard.frame.source(),
         .target = target,
         .id = message,
         .hz = interval_us < 0 ? 0 : 1e6 / double{interval_us},
         .time = heard.time});
}

void AskedRates::note_stream(const Heard& heard) {
    const auto request = msg::RequestDataStream::decode(heard.frame.payload());
    const auto row = std::ranges::find(stream_rows, request.req_stream_id, &StreamRow::stream);
    if (row == stream_rows.end()) return;
    ask({.how = AskedRate::How::request_data_stream,
         .asker = heard.frame.source(),
         .target = {SystemId{request.target_system}, ComponentId{request.target_component}},
         .id = row->id,
         .hz = request.start_stop == 0 ? 0.0 : request.req_message_rate,
         .time = heard.time});
}

// A vehicle answers an interval of 0 for a message that it does not have, and -1 for one that it does not send.
void AskedRates::note_report(const Heard& heard) {
    const auto report = msg::MessageInterval::decode(heard.frame.payload());
    if (report.interval_us <= 0) return;
    ask({.how = AskedRate::How::reported,
         .asker = heard.frame.source(),
         .target = heard.frame.source(),
         .id = MessageId{report.message_id},
         .hz = 1e6 / report.interval_us,
         .time = heard.time});
}

// The answer belongs to the newest request without one.
void AskedRates::note_answer(const Heard& heard) {
    const auto answer = msg::CommandAck::decode(heard.frame.payload());
    if (answer.command != set_message_interval) return;
    const auto open = std::find_if(all_.rbegin(), all_.rend(), [&](const AskedRate& asked) {
        return asked.how == AskedRate::How::set_message_interval && !asked.result && is_for(asked, heard.frame.source());
    });
    if (open != all_.rend()) open->result = answer.result;
}

// A request that is repeated continues.
void AskedRates::ask(AskedRate asked) {
    if (asked.target.system.value == 0) return;  // each vehicle has its own rates
    const auto known = std::ranges::find_if(all_, [&](const AskedRate& one) {
        return one.how == asked.how && one.asker == asked.asker && one.target == asked.target && one.id == asked.id;
    });
    if (known != all_.end() && known->hz == asked.hz) return;
    if (known != all_.end()) {
        std::rotate(known, known + 1, all_.end());
        all_.back() = std::move(asked);
        return;
    }
    if (all_.size() == max_asked) forget(all_.front().target.system, all_.front().id);
    watched_.insert(key_of(asked.target.system, asked.id));
    all_.push_back(std::move(asked));
}

void AskedRates::forget(SystemId target, MessageId id) {
    std::erase_if(all_, [&](const AskedRate& one) { return one.target.system == target && one.id == id; });
    watched_.erase(key_of(target, id));
}

void AskedRates::count(const Heard& heard) {
    const auto source = heard.frame.source();
    if (!watched_.contains(key_of(source.system, heard.frame.id()))) return;
    for (auto& asked : all_)
        if (asked.id == heard.frame.id() && is_for(asked, source) &&
            (asked.heard.size() < max_links || asked.heard.contains(heard.link)))
            ++asked.heard[heard.link];
}

}  // namespace mavloom::observe
