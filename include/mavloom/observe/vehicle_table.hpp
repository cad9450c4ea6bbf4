// SPDX-License-Identifier: MIT
// What is known of each component that sends HEARTBEATs: when it was heard, and what it reports of itself.
// One owner thread. Bounded: if the table is full, those that were silent for long leave their place to new ones.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/msg/battery_status.hpp"
#include "mavloom/msg/global_position_int.hpp"
#include "mavloom/msg/gps_raw_int.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/sys_status.hpp"

namespace mavloom::observe {

struct Battery {
    std::optional<double> percent{}, voltage_v{}, current_a{};
};
struct Gps {
    std::uint8_t fix = 0;  // GPS_FIX_TYPE
    std::optional<std::uint8_t> satellites{};
};
struct Position {
    double lat_deg = 0, lon_deg = 0, alt_m = 0, relative_alt_m = 0;  // alt_m: above mean sea level
    std::optional<double> heading_deg{};                             // from 0, below 360
    double ground_speed_m_s = 0;
};
struct RoundTrip {
    Nanoseconds last{}, least{}, sum{};
    std::uint64_t count = 0;

    void add(Nanoseconds time) noexcept;
    [[nodiscard]] Nanoseconds mean() const noexcept {
        return count == 0 ? Nanoseconds{} : sum / static_cast<std::int64_t>(count);
    }
};

struct Vehicle {
    Source source;
    std::uint64_t heartbeats = 0;
    std::uint8_t type = 0, autopilot = 0, status = 0;  // MAV_TYPE, MAV_AUTOPILOT, MAV_STATE
    std::string_view mode{};                           // empty: it has no name
    bool is_armed = false;
    WallTime last_heartbeat{};
    MonoTime heard{};        // its last frame
    LinkId link{};           // and its link
    double hz = 0;           // filled by the Inspector, and so is the next
    bool has_ended = false;  // its link was a recording, which has ended
    std::optional<Battery> battery{};
    std::optional<std::uint8_t> battery_id{};  // of the lowest BATTERY_STATUS, which has more than SYS_STATUS
    std::optional<Gps> gps{};
    std::optional<Position> position{};
    RoundTrip timesync{}, ping{}, command{};  // from a request that was heard to its answer

    [[nodiscard]] bool is_silent(MonoTime now) const noexcept;
};

class VehicleTable {
public:
    static constexpr std::size_t max_senders = 4096;

    // Null if it is not in the table. Cheap.
    [[nodiscard]] Vehicle* find(Source source) noexcept {
        const auto index = index_of_[place_of(source)];
        return index == 0 ? nullptr : &all_[index - 1u];
    }
    // Null if there is no room for another one.
    Vehicle* find_or_add(Source source, MonoTime now);
    [[nodiscard]] const std::deque<Vehicle>& all() const noexcept { return all_; }

    static void take(Vehicle& vehicle, const msg::Heartbeat& heartbeat, ByteView payload) noexcept;
    static void take(Vehicle& vehicle, const msg::SysStatus& status) noexcept;
    static void take(Vehicle& vehicle, const msg::BatteryStatus& status) noexcept;
    static void take(Vehicle& vehicle, const msg::GpsRawInt& gps) noexcept;
    static void take(Vehicle& vehicle, const msg::GlobalPositionInt& position) noexcept;

private:
    [[nodiscard]] static std::size_t place_of(Source source) noexcept {
        return std::size_t{source.system.value} << 8 | source.component.value;
    }
    [[nodiscard]] Vehicle* longest_silent(MonoTime now) noexcept;

    std::deque<Vehicle> all_;
    MonoTime may_search_at_{};
    std::vector<std::uint16_t> index_of_ = std::vector<std::uint16_t>(65'536);  // plus one; 0: none
};

}  // namespace mavloom::observe
