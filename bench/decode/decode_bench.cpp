// SPDX-License-Identifier: MIT
// The C++ half of bench/decode.py: parses the frames of a recording and decodes each into its generated struct. Fails
// if the recording contains a message without a struct below, because a figure for part of the traffic would be
// meaningless. usage: decode_bench FILE.tlog [TURNS]; prints one JSON object with the median messages a second.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/msg/altitude.hpp"
#include "mavloom/msg/attitude.hpp"
#include "mavloom/msg/attitude_quaternion.hpp"
#include "mavloom/msg/attitude_target.hpp"
#include "mavloom/msg/battery_status.hpp"
#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/command_int.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/current_event_sequence.hpp"
#include "mavloom/msg/current_mode.hpp"
#include "mavloom/msg/distance_sensor.hpp"
#include "mavloom/msg/esc_info.hpp"
#include "mavloom/msg/esc_status.hpp"
#include "mavloom/msg/estimator_sensor_fusion_status.hpp"
#include "mavloom/msg/estimator_status.hpp"
#include "mavloom/msg/event.hpp"
#include "mavloom/msg/extended_sys_state.hpp"
#include "mavloom/msg/global_position_int.hpp"
#include "mavloom/msg/gnss_integrity.hpp"
#include "mavloom/msg/gps_raw_int.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/home_position.hpp"
#include "mavloom/msg/link_node_status.hpp"
#include "mavloom/msg/local_position_ned.hpp"
#include "mavloom/msg/mission_current.hpp"
#include "mavloom/msg/open_drone_id_location.hpp"
#include "mavloom/msg/open_drone_id_system.hpp"
#include "mavloom/msg/ping.hpp"
#include "mavloom/msg/position_target_global_int.hpp"
#include "mavloom/msg/position_target_local_ned.hpp"
#include "mavloom/msg/scaled_pressure.hpp"
#include "mavloom/msg/servo_output_raw.hpp"
#include "mavloom/msg/statustext.hpp"
#include "mavloom/msg/sys_status.hpp"
#include "mavloom/msg/time_estimate_to_target.hpp"
#include "mavloom/msg/vfr_hud.hpp"
#include "mavloom/msg/vibration.hpp"
#include "mavloom/wire/stream_parser.hpp"

namespace {

using namespace mavloom;

// Decodes, and makes the optimiser treat the whole struct as used.
template <class Struct>
void decode_one(ByteView payload) {
    const auto decoded = Struct::decode(payload);
    asm volatile("" : : "g"(&decoded) : "memory");
}

class Structs {
public:
    using Decode = void (*)(ByteView);

    template <class... Struct>
    static Structs of() {
        Structs all;
        (all.add(Struct::id.value, decode_one<Struct>), ...);
        return all;
    }
    [[nodiscard]] Decode find(MessageId id) const { return id.value < decode_.size() ? decode_[id.value] : nullptr; }

private:
    void add(std::uint32_t id, Decode decode) {
        if (id >= decode_.size()) decode_.resize(id + 1);
        decode_[id] = decode;
    }
    std::vector<Decode> decode_;
};

const auto structs = Structs::of<
    msg::Altitude, msg::Attitude, msg::AttitudeQuaternion, msg::AttitudeTarget, msg::BatteryStatus, msg::CommandAck,
    msg::CommandInt, msg::CommandLong, msg::CurrentEventSequence, msg::CurrentMode, msg::DistanceSensor, msg::EscInfo,
    msg::EscStatus, msg::EstimatorSensorFusionStatus, msg::EstimatorStatus, msg::Event, msg::ExtendedSysState,
    msg::GlobalPositionInt, msg::GnssIntegrity, msg::GpsRawInt, msg::Heartbeat, msg::HomePosition, msg::LinkNodeStatus,
    msg::LocalPositionNed, msg::MissionCurrent, msg::OpenDroneIdLocation, msg::OpenDroneIdSystem, msg::Ping,
    msg::PositionTargetGlobalInt, msg::PositionTargetLocalNed, msg::ScaledPressure, msg::ServoOutputRaw,
    msg::Statustext, msg::SysStatus, msg::TimeEstimateToTarget, msg::VfrHud, msg::Vibration>();

// Returns the frames of a tlog without their times.
std::vector<std::uint8_t> frames_of(const char* path, const wire::MessageTable& table) {
    std::ifstream in(path, std::ios::binary);
    const std::vector<std::uint8_t> file{std::istreambuf_iterator<char>(in), {}};
    std::vector<std::uint8_t> frames;
    wire::StreamParser parser(table);
    parser.feed(file, MonoTime{}, [&](const wire::ParseEvent& event) {
        if (event.kind != wire::ParseEvent::Kind::frame) return;
        frames.insert(frames.end(), event.frame.bytes().begin(), event.frame.bytes().end());
    });
    return frames;
}

struct Decoded {
    std::size_t messages = 0, without_struct = 0;
};

Decoded decode_all(ByteView frames, const wire::MessageTable& table) {
    constexpr std::size_t chunk = 4096;
    Decoded decoded;
    wire::StreamParser parser(table);
    const auto sink = [&](const wire::ParseEvent& event) {
        if (event.kind != wire::ParseEvent::Kind::frame) return;
        ++decoded.messages;
        if (const auto decode = structs.find(event.frame.id())) {
            decode(event.frame.payload());
        } else {
            ++decoded.without_struct;
        }
    };
    for (std::size_t at = 0; at < frames.size(); at += chunk)
        parser.feed(frames.subspan(at, std::min(chunk, frames.size() - at)), MonoTime{}, sink);
    parser.finish(sink);
    return decoded;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: decode_bench FILE.tlog [TURNS]\n");
        return 2;
    }
    const auto& table = dialect::default_dialect().wire_table();
    const auto frames = frames_of(argv[1], table);
    const auto decoded = decode_all(frames, table);
    if (decoded.messages == 0 || decoded.without_struct != 0) {
        fmt::print(stderr, "decode_bench: {} of {} messages have no struct here\n", decoded.without_struct,
                   decoded.messages);
        return 4;
    }
    std::vector<double> rates;
    for (int turn = 0; turn < std::max(1, argc > 2 ? std::atoi(argv[2]) : 21); ++turn) {
        const auto begin = std::chrono::steady_clock::now();
        decode_all(frames, table);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        rates.push_back(static_cast<double>(decoded.messages) / took.count());
    }
    std::ranges::nth_element(rates, rates.begin() + static_cast<std::ptrdiff_t>(rates.size() / 2));
    fmt::print(
        "{{\"bench\":\"decode structs\",\"per_second\":{:.0f},\"unit\":\"messages\",\"frames\":{},\"turns\":{}}}\n",
        rates[rates.size() / 2], decoded.messages, rates.size());
}
