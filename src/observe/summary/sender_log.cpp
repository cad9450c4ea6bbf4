// SPDX-License-Identifier: MIT
#include "observe/summary/sender_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "mavloom/observe/summarizer.hpp"

namespace mavloom::observe {

namespace {

constexpr std::uint8_t ardupilot = 3, no_autopilot = 8, px4 = 12;  // MAV_AUTOPILOT
constexpr std::uint64_t encodes_bytewise = 16;                     // MAV_PROTOCOL_CAPABILITY

template <class Period>
void extend_last(std::vector<Period>& periods, const When& now) noexcept {
    if (!periods.empty()) periods.back().duration = now.at - periods.back().begin.at;
}

template <class Period>
bool begin(std::vector<Period>& periods, const Period& period) {
    if (periods.size() == Summarizer::max_entries) return false;
    periods.push_back(period);
    return true;
}

// ArduPilot sends eight digits as text; PX4 a number of up to 16 digits, with zeros for those that it does not have.
std::string git_digits(const std::array<std::uint8_t, 8>& version) {
    if (std::ranges::all_of(version, [](int c) { return std::isxdigit(c) != 0; }))
        return {version.begin(), version.end()};
    auto digits = fmt::format("{:016x}", load_le<std::uint64_t>(version.data()));
    digits.erase(digits.find_last_not_of('0') + 1);
    return digits;
}

// FIRMWARE_VERSION_TYPE. Between two of them lie further ones of the lower kind.
std::string_view release_kind(std::uint8_t type) noexcept {
    constexpr std::uint8_t alpha = 64, beta = 128, candidate = 192, official = 255;
    if (type == official) return "";
    if (type >= candidate) return " rc";
    if (type >= beta) return " beta";
    return type >= alpha ? " alpha" : " dev";
}

void lower_to(std::optional<double>& lowest, const std::optional<double>& value) noexcept {
    if (value) lowest = std::min(lowest.value_or(*value), *value);
}

}  // namespace

std::string Firmware::text() const { return fmt::format("{}.{}.{}{}", major, minor, patch, release_kind(type)); }

bool SenderLog::count_unknown(MessageId id, std::size_t size) {
    auto place = std::ranges::find(unknown_, id, &Unknown::id);
    if (place == unknown_.end()) {
        if (unknown_.size() == max_unknown) return false;
        place = unknown_.insert(place, {.id = id});
    }
    place->tally.add(size);
    return true;
}

bool SenderLog::take(const msg::Heartbeat& message, ByteView payload, const When& when) {
    const bool was_armed = vehicle_.is_armed;
    VehicleTable::take(vehicle_, message, payload);
    const bool has_mode = note_mode(message.custom_mode, when);
    return note_armed(was_armed, when) && has_mode;
}

bool SenderLog::note_mode(std::uint32_t custom_mode, const When& when) {
    extend_last(modes_, when);
    const bool is_same = !modes_.empty() && modes_.back().custom_mode == custom_mode &&
                         modes_.back().name == vehicle_.mode;
    return is_same || begin(modes_, {.begin = when, .name = vehicle_.mode, .custom_mode = custom_mode});
}

bool SenderLog::note_armed(bool was_armed, const When& when) {
    if (was_armed) extend_last(armed_, when);
    return was_armed || !vehicle_.is_armed || begin(armed_, {.begin = when});
}

void SenderLog::take(const msg::AutopilotVersion& message) {
    capabilities_ = message.capabilities;
    const auto byte = [&](int shift) { return static_cast<std::uint8_t>(message.flight_sw_version >> shift); };
    if (message.flight_sw_version == 0) return;
    firmware_ = Firmware{.major = byte(24),
                         .minor = byte(16),
                         .patch = byte(8),
                         .type = byte(0),
                         .git = git_digits(message.flight_custom_version)};
}

void SenderLog::take(const msg::GlobalPositionInt& message, const When& when, bool with_track) {
    VehicleTable::take(vehicle_, message);
    if (!vehicle_.position) return;
    const auto& at = *vehicle_.position;
    const Fix fix{when, at.lat_deg, at.lon_deg, at.alt_m, at.relative_alt_m};
    by_position_.add(fix, at.ground_speed_m_s, is_flown(), with_track);
}

void SenderLog::take(const msg::GpsRawInt& message, const When& when, bool with_track) {
    constexpr std::uint8_t fix_3d = 3;  // GPS_FIX_TYPE
    if (by_position_.journey().first || message.fix_type < fix_3d) return;
    const Fix fix{when, message.lat / 1e7, message.lon / 1e7, message.alt / 1e3};
    const auto speed = message.vel == UINT16_MAX ? std::nullopt : std::optional(message.vel * 1e-2);
    by_gps_.add(fix, speed, is_flown(), with_track);
}

void SenderLog::note_battery() {
    const auto& now = vehicle_.battery;
    if (!now || (!now->percent && !now->voltage_v)) return;
    if (!battery_) battery_ = BatteryUse{.first = *now};
    battery_->last = *now;
    lower_to(battery_->lowest_percent, now->percent);
    lower_to(battery_->lowest_voltage_v, now->voltage_v);
}

bool SenderLog::is_bytewise() const noexcept {
    if (vehicle_.autopilot == px4 || vehicle_.autopilot == ardupilot) return vehicle_.autopilot == px4;
    return (capabilities_ & encodes_bytewise) != 0;
}

std::vector<MessageTotal> SenderLog::totals(const dialect::Dialect& dialect) const {
    std::vector<MessageTotal> all;
    const auto add = [&](MessageId id, std::string_view name, const Tally& tally) {
        if (tally.count != 0) all.push_back({id, name, tally.count, tally.bytes});
    };
    const auto messages = dialect.wire_table().messages();
    for (std::size_t i = 0; i < tallies_.size(); ++i)
        add(messages[i].id, dialect.find(messages[i].id)->name, tallies_[i]);
    for (const auto& unknown : unknown_) add(unknown.id, {}, unknown.tally);
    std::ranges::stable_sort(all, std::greater{}, &MessageTotal::count);
    return all;
}

SenderSummary SenderLog::summary(const dialect::Dialect& dialect) const {
    const auto& journey = by_position_.journey().first ? by_position_.journey() : by_gps_.journey();
    const bool has_autopilot = vehicle_.heartbeats != 0 && vehicle_.autopilot != no_autopilot;
    SenderSummary all{.source = vehicle_.source,
                      .is_vehicle = has_autopilot || journey.first.has_value(),
                      .has_heartbeat = vehicle_.heartbeats != 0,
                      .type = vehicle_.type,
                      .autopilot = vehicle_.autopilot,
                      .messages = totals(dialect),
                      .firmware = firmware_,
                      .modes = modes_,
                      .armed = armed_,
                      .battery = battery_,
                      .journey = journey};
    for (const auto& message : all.messages) {
        all.frames += message.count;
        all.bytes += message.bytes;
    }
    return all;
}

}  // namespace mavloom::observe
