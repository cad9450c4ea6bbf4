// SPDX-License-Identifier: MIT
#include "sim/recorder/flight_recorder.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <span>
#include <utility>

#include "flight/physics/math.hpp"
#include "flight/wire_units.hpp"
#include "mavloom/msg/enums/gps_fix_type.hpp"

namespace mavloom::sim {

namespace {

std::uint32_t milliseconds(FlightTime time) noexcept {
    return static_cast<std::uint32_t>(time / std::chrono::milliseconds{1});
}

std::array<std::int32_t, 3> on_wire(const GeoPoint& point) noexcept {
    return {to_degrees_e7(point.latitude), to_degrees_e7(point.longitude), to_mm(point.altitude)};
}

void fill_gps(const Flight& flight, Sample& sample) {
    const GpsFix& fix = flight.sensors().gps();
    sample.fix_type = fix.fix_type;
    sample.satellites = fix.satellites;
    if (fix.fix_type < msg::GPS_FIX_TYPE_2D_FIX) return;
    sample.gps_position = on_wire(flight.frame().to_geo(fix.position));
    sample.gps_speed = saturated<std::uint16_t>(flight::math::hypot(fix.velocity.x(), fix.velocity.y()) * 100);
    sample.gps_course = to_centidegrees(wrap_2pi(flight::math::atan2(fix.velocity.y(), fix.velocity.x())));
}

void fill_motion(const Flight& flight, Sample& sample) {
    const Estimate& now = flight.estimate();
    const Quaternion& q = now.attitude;
    sample.position = on_wire(flight.position());
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        sample.local[i] = as_float(now.position[axis]);
        sample.velocity[i] = to_cm_s(now.velocity[axis]);
        sample.rates[i] = saturated<std::int16_t>(now.rates[axis] * 1e3);
    }
    const std::array parts{q.w(), q.x(), q.y(), q.z()};
    std::ranges::transform(parts, sample.attitude.begin(),
                           [](double part) { return saturated<std::int16_t>(part * 32767); });
}

void fill_battery(const Battery& battery, Sample& sample) {
    sample.millivolts = saturated<std::uint16_t>(battery.voltage() * 1e3);
    sample.centiamperes = saturated<std::int16_t>(battery.current() * 1e2);
    sample.used_mah = saturated<std::uint16_t>(battery.used_mah());
    sample.remaining = saturated<std::uint16_t>(battery.remaining() * 1e4);
}

}  // namespace

FlightRecorder::FlightRecorder(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters,
                               const Flight& flight, const Radio& radio) noexcept
    : options_(options),
      firmware_(firmware),
      parameters_(parameters),
      flight_(flight),
      radio_(radio),
      format_(LogFormat::of(firmware.is_px4())),
      source_{firmware, options.battery.cells} {}

// A vehicle that moves at random is always armed: its flight has no end.
void FlightRecorder::advance() {
    const Limits& limits = options_.limits;
    if (options_.motion == Motion::random || limits.flight_logs == 0 || limits.log_records == 0) return;
    if (!is_recording_) begin();
    const FlightTime now = flight_.since_boot();
    if (!flight_.armed()) return finish();
    if (const std::uint8_t mode = index_of(flight_.mode()); mode != mode_) {
        mode_ = mode;
        add(now, ModeChange{mode});
    }
    if (now < next_sample_) return;
    next_sample_ += interval_;
    add(now, sample());
}

void FlightRecorder::begin() {
    const FlightTime now = flight_.since_boot();
    LogHead facts = head(now);
    make_room(facts.changed.size());
    records_.reserve(options_.limits.log_records);
    is_recording_ = true;
    is_full_ = false;
    interval_ = sample_interval;
    next_sample_ = now;
    present_ = {.head = std::move(facts), .begin = records_.size(), .end = records_.size()};
    mode_ = index_of(flight_.mode());
    add(now, ModeChange{mode_});
}

void FlightRecorder::make_room(std::size_t changed) {
    const Limits& limits = options_.limits;
    for (const RecordedFlight& flight : flights_) changed += flight.head.changed.size();
    while (!flights_.empty() && (flights_.size() >= limits.flight_logs || records_.size() > limits.log_records / 2 ||
                                 changed > limits.log_parameters)) {
        changed -= flights_.front().head.changed.size();
        drop_oldest();
    }
}

LogHead FlightRecorder::head(FlightTime now) const {
    const GeoPoint& origin = flight_.frame().origin();
    LogHead head{.system = radio_.system(),
                 .began_ms = milliseconds(now),
                 .began = utc_at(now),
                 .origin = {origin.latitude, origin.longitude, origin.altitude},
                 .home_altitude = to_mm(flight_.home_altitude())};
    const Parameters initial(firmware_.parameters());
    for (ParamIndex i = 0; i < parameters_.size(); ++i)
        if (parameters_.bits(i) != initial.bits(i)) head.changed.push_back({i, parameters_.bits(i)});
    return head;
}

// Logs of PX4 are named by the second in which they begin, so no two may begin in the same one. The newest log that the
// vehicle brings along begins at the start.
WallTime FlightRecorder::utc_at(FlightTime since_boot) const noexcept {
    if (options_.utc_at_start == WallTime{}) return {};
    const WallTime began = options_.utc_at_start + booted_ + since_boot;
    if (flights_.empty() && options_.logs == 0) return began;
    const WallTime previous = flights_.empty() ? options_.utc_at_start : flights_.back().head.began;
    return std::max(began, previous + std::chrono::seconds{1});
}

void FlightRecorder::finish() {
    is_recording_ = false;
    const FlightTime now = flight_.since_boot();
    if (milliseconds(now) >= records_.back().time_ms) add(now, sample());
    present_.header_size = static_cast<std::uint32_t>(format_.header(source_, present_.head).size());
    present_.size = present_.header_size;
    present_.end = records_.size();
    for (std::size_t i = present_.begin; i < present_.end; ++i) {
        records_[i].offset = present_.size;
        present_.size += format_.size(records_[i]);
    }
    flights_.push_back(std::move(present_));
}

void FlightRecorder::note(Severity severity, std::string_view text) {
    if (!is_recording_ && flight_.armed()) advance();
    if (!is_recording_) return;
    LoggedText logged{.severity = static_cast<std::uint8_t>(severity)};
    logged.length = static_cast<std::uint8_t>(std::min(text.size(), logged.characters.size()));
    std::memcpy(logged.characters.data(), text.data(), logged.length);
    add(flight_.since_boot(), logged);
}

void FlightRecorder::erase() {
    while (!flights_.empty()) drop_oldest();
}

void FlightRecorder::drop_oldest() {
    const std::size_t gone = flights_.front().end;
    flights_.erase(flights_.begin());
    records_.erase(records_.begin(), records_.begin() + static_cast<std::ptrdiff_t>(gone));
    for (RecordedFlight& flight : flights_) {
        flight.begin -= gone;
        flight.end -= gone;
    }
    if (is_recording_) present_.begin -= gone;
    is_full_ = false;
    ++dropped_;
    if (header_.flight < dropped_) header_ = {};
}

// If nothing can be thinned out, the flight has too many texts and changes of mode. Further records are lost.
void FlightRecorder::add(FlightTime time, const LogContent& content) {
    const auto has_room = [&] { return records_.size() < options_.limits.log_records; };
    if (!has_room() && !is_full_) thin_out();
    if (has_room()) records_.push_back({milliseconds(time), 0, content});
}

// Every other sample of the present flight goes. If there is none to go, the flight is full.
void FlightRecorder::thin_out() {
    bool goes = false;
    const auto from = records_.begin() + static_cast<std::ptrdiff_t>(present_.begin);
    const auto end = std::remove_if(from, records_.end(), [&](const LogRecord& record) {
        if (!std::holds_alternative<Sample>(record.content)) return false;
        return std::exchange(goes, !goes);
    });
    is_full_ = end == records_.end();
    if (is_full_) return;
    records_.erase(end, records_.end());
    interval_ *= 2;
}

Sample FlightRecorder::sample() const {
    Sample sample{.mode = index_of(flight_.mode()),
                  .wanted_mode = index_of(flight_.intended_mode()),
                  .is_armed = flight_.armed(),
                  .is_landed = flight_.landed() == LandedState::on_ground,
                  .has_failsafe = flight_.has_failsafe()};
    fill_motion(flight_, sample);
    fill_gps(flight_, sample);
    fill_battery(flight_.battery(), sample);
    return sample;
}

std::uint8_t FlightRecorder::index_of(const ModeInfo& mode) const noexcept {
    return static_cast<std::uint8_t>(&mode - firmware_.modes().data());
}

std::size_t FlightRecorder::read(std::uint16_t index, std::uint32_t offset, ByteSpan out) const {
    const RecordedFlight& flight = flights_[index];
    if (offset >= flight.size || out.empty()) return 0;
    const std::size_t length = std::min<std::size_t>(out.size(), flight.size - offset);
    std::size_t done = 0;
    if (offset < flight.header_size) {
        done = std::min<std::size_t>(length, flight.header_size - offset);
        read_header(index, offset, out.first(done));
    }
    while (done < length)
        done += read_record(flight, offset + static_cast<std::uint32_t>(done), out.first(length).subspan(done));
    return length;
}

// Clients read a header in many small parts: it stays in memory until its last byte has been read.
void FlightRecorder::read_header(std::uint16_t index, std::uint32_t offset, ByteSpan out) const {
    const std::uint32_t flight = dropped_ + index;
    if (header_.bytes.empty() || header_.flight != flight)
        header_ = {flight, format_.header(source_, flights_[index].head)};
    std::memcpy(out.data(), header_.bytes.data() + offset, out.size());
    if (offset + out.size() == header_.bytes.size()) header_ = {};
}

// A record without bytes has the offset of the next one.
std::size_t FlightRecorder::read_record(const RecordedFlight& flight, std::uint32_t offset, ByteSpan out) const {
    const auto all = std::span(records_).subspan(flight.begin, flight.end - flight.begin);
    const LogRecord& record = *std::prev(std::ranges::upper_bound(all, offset, {}, &LogRecord::offset));
    std::array<std::uint8_t, LogFormat::largest_record> bytes;
    format_.write(source_, flight.head, record, bytes);
    const std::uint32_t inside = offset - record.offset;
    const std::size_t part = std::min<std::size_t>(out.size(), format_.size(record) - inside);
    std::memcpy(out.data(), bytes.data() + inside, part);
    return part;
}

}  // namespace mavloom::sim
