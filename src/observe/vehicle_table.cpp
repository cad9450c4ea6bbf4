// SPDX-License-Identifier: MIT
// Values for "not known": MAVLink's common.xml, in the descriptions of the fields.
#include "mavloom/observe/vehicle_table.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mavloom/message/modes.hpp"
#include "mavloom/observe/latest_table.hpp"

namespace mavloom::observe {

namespace {

constexpr std::uint8_t armed = 128;  // MAV_MODE_FLAG_SAFETY_ARMED

template <class T>
std::optional<double> known(T value, T unknown, double scale) {
    if (value == unknown) return std::nullopt;
    return static_cast<double>(value) * scale;
}

// From 0, below 360: some vehicles send 36000 for north.
std::optional<double> heading_of(std::uint16_t centidegrees) {
    if (centidegrees == UINT16_MAX) return std::nullopt;
    return centidegrees % 36'000 * 1e-2;
}

constexpr std::uint16_t no_u16 = UINT16_MAX;
constexpr std::int16_t no_current = -1;
constexpr std::int8_t no_percent = -1;

// The sum of the cells, in V. Cells that do not exist have UINT16_MAX, and in the extension 0. A pack whose cells are
// not known has its voltage in the first ones.
std::optional<double> voltage_of(const msg::BatteryStatus& status) {
    double sum = 0;
    bool is_known = false;
    for (const auto cell : status.voltages) {
        if (cell == no_u16) break;
        sum += cell * 1e-3;
        is_known = true;
    }
    for (const auto cell : status.voltages_ext) sum += cell == no_u16 ? 0 : cell * 1e-3;
    return is_known ? std::optional(sum) : std::nullopt;
}

}  // namespace

bool Vehicle::is_silent(MonoTime now) const noexcept { return !has_ended && now - heard >= silence; }

void RoundTrip::add(Nanoseconds time) noexcept {
    last = time;
    least = count == 0 ? time : std::min(least, time);
    sum += time;
    ++count;
}

Vehicle* VehicleTable::find_or_add(Source source, MonoTime now) {
    if (auto* const known = find(source)) return known;
    if (all_.size() < max_senders) {
        all_.push_back({.source = source, .heard = now});
        index_of_[place_of(source)] = static_cast<std::uint16_t>(all_.size());
        return &all_.back();
    }
    auto* const place = longest_silent(now);
    if (place == nullptr) return nullptr;
    std::swap(index_of_[place_of(source)], index_of_[place_of(place->source)]);  // one of them is 0
    *place = {.source = source, .heard = now};
    return place;
}

// Searches all, so it does that once a second at most.
Vehicle* VehicleTable::longest_silent(MonoTime now) noexcept {
    if (now < may_search_at_) return nullptr;
    may_search_at_ = now + std::chrono::seconds(1);
    const auto at = std::ranges::min_element(all_, {}, &Vehicle::heard);
    return now - at->heard > LatestTable::forgotten_after ? &*at : nullptr;
}

void VehicleTable::take(Vehicle& vehicle, const msg::Heartbeat& heartbeat, ByteView payload) noexcept {
    ++vehicle.heartbeats;
    vehicle.type = heartbeat.type;
    vehicle.autopilot = heartbeat.autopilot;
    vehicle.status = heartbeat.system_status;
    vehicle.mode = message::heartbeat_mode(payload);
    vehicle.is_armed = (heartbeat.base_mode & armed) != 0;
}

void VehicleTable::take(Vehicle& vehicle, const msg::SysStatus& status) noexcept {
    if (vehicle.battery_id) return;
    vehicle.battery = Battery{.percent = known(status.battery_remaining, no_percent, 1),
                              .voltage_v = known(status.voltage_battery, no_u16, 1e-3),
                              .current_a = known(status.current_battery, no_current, 1e-2)};
}

// Of several batteries, the one with the lowest number.
void VehicleTable::take(Vehicle& vehicle, const msg::BatteryStatus& status) noexcept {
    if (vehicle.battery_id && status.id_ > *vehicle.battery_id) return;
    vehicle.battery_id = status.id_;
    vehicle.battery = Battery{.percent = known(status.battery_remaining, no_percent, 1),
                              .voltage_v = voltage_of(status),
                              .current_a = known(status.current_battery, no_current, 1e-2)};
}

void VehicleTable::take(Vehicle& vehicle, const msg::GpsRawInt& gps) noexcept {
    vehicle.gps = Gps{.fix = gps.fix_type};
    if (gps.satellites_visible != UINT8_MAX) vehicle.gps->satellites = gps.satellites_visible;
}

// 0/0 stands for an unknown position.
void VehicleTable::take(Vehicle& vehicle, const msg::GlobalPositionInt& position) noexcept {
    if (position.lat == 0 && position.lon == 0) {
        vehicle.position.reset();
        return;
    }
    vehicle.position = Position{.lat_deg = position.lat / 1e7,
                                .lon_deg = position.lon / 1e7,
                                .alt_m = position.alt / 1e3,
                                .relative_alt_m = position.relative_alt / 1e3,
                                .heading_deg = heading_of(position.hdg),
                                .ground_speed_m_s = std::hypot(position.vx, position.vy) * 1e-2};
}

}  // namespace mavloom::observe
