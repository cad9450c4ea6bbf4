// SPDX-License-Identifier: MIT
// What a recording holds, as a Summarizer finds it. Plain data. Names of modes and messages are views: those of modes
// are constants, those of messages belong to the dialect.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/observe/vehicle_table.hpp"
#include "mavloom/wire/sequence.hpp"

namespace mavloom::observe {

struct When {
    WallTime time{};   // as recorded
    Nanoseconds at{};  // since the first frame, without jumps of the clock
};

struct ClockJump {
    When when{};  // of the first frame after it
    Nanoseconds step{};
};

struct ModePeriod {
    When begin{};
    Nanoseconds duration{};   // until the next mode, or the last HEARTBEAT
    std::string_view name{};  // empty: it has no name
    std::uint32_t custom_mode = 0;
};

struct ArmedPeriod {
    When begin{};
    Nanoseconds duration{};  // until the HEARTBEAT that is disarmed, or the last one
};

struct Fix {
    When when{};
    double lat_deg = 0, lon_deg = 0, alt_m = 0;  // alt_m: above mean sea level
    std::optional<double> relative_alt_m{};      // above home
};

struct TrackPoint {
    WallTime time{};
    std::int32_t lat_deg_e7 = 0, lon_deg_e7 = 0, alt_mm = 0;
    bool begins = false;  // a piece of the track: there was no position for a while, or it jumped
};

// By GLOBAL_POSITION_INT; of a vehicle that sends none, by GPS_RAW_INT.
struct Journey {
    std::optional<Fix> first{}, last{};
    std::optional<double> highest_alt_m{}, highest_relative_alt_m{}, highest_speed_m_s{};  // speed: over ground
    double distance_m = 0;  // over ground while armed, in steps of at least 1 m
    std::vector<TrackPoint> track{};
};

struct BatteryUse {
    Battery first{}, last{};
    std::optional<double> lowest_percent{}, lowest_voltage_v{};
};

struct Firmware {
    std::uint8_t major = 0, minor = 0, patch = 0;
    std::uint8_t type = 0;  // FIRMWARE_VERSION_TYPE
    std::string git{};      // the first digits of the commit; empty: not known

    // "1.16.0", "1.17.0 beta"
    [[nodiscard]] std::string text() const;
};

struct MessageTotal {
    MessageId id{};
    std::string_view name{};  // empty: it has no definition
    std::uint64_t count = 0, bytes = 0;
};

struct SenderSummary {
    Source source{};
    bool is_vehicle = false;  // an autopilot, or something that reports its position
    bool has_heartbeat = false;
    std::uint8_t type = 0, autopilot = 0;  // MAV_TYPE, MAV_AUTOPILOT
    std::uint64_t frames = 0, bytes = 0;
    wire::SequenceStats losses{};
    std::vector<MessageTotal> messages{};  // the most frequent first

    std::optional<Firmware> firmware{};
    std::vector<ModePeriod> modes{};
    std::vector<ArmedPeriod> armed{};
    std::optional<BatteryUse> battery{};
    Journey journey{};
};

// Equal texts of one sender are one.
struct TextSummary {
    Source source{};
    std::uint8_t severity = 0;  // MAV_SEVERITY
    std::string text{};
    When first{}, last{};
    std::uint64_t count = 0;
};

struct ParameterChange {
    When when{};
    Source source{};
    std::string name{};
    double before = 0, after = 0;
};

struct Summary {
    std::optional<WallTime> begin{}, end{};  // of the first and the last frame; empty: there is no frame
    Nanoseconds duration{};                  // without jumps of the clock
    std::uint64_t frames = 0, bytes = 0;
    std::vector<ClockJump> clock_jumps{};
    std::vector<SenderSummary> senders{};  // in the order in which they were first heard
    std::vector<TextSummary> texts{};      // of severity WARNING and above, in the order of time
    std::vector<ParameterChange> parameters{};
    // Frames of senders and entries of lists that found no room.
    std::uint64_t unlisted_frames = 0, unlisted_entries = 0;

    // Over the whole recording; 0 if it has no duration.
    [[nodiscard]] double rate_hz(const MessageTotal& message) const noexcept {
        const auto seconds = std::chrono::duration<double>(duration).count();
        return seconds == 0 ? 0 : static_cast<double>(message.count) / seconds;
    }
};

}  // namespace mavloom::observe
