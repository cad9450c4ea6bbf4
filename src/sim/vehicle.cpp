// SPDX-License-Identifier: MIT
#include "mavloom/sim/vehicle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sim/parts.hpp"
#include "sim/service/guard.hpp"

namespace mavloom::sim {

namespace {

// While something may change by itself, the vehicle looks at least this often.
constexpr Nanoseconds longest_pause = std::chrono::milliseconds{100};
// At rest and without links, it still steps this often, so that the steps do not pile up for its next client.
constexpr Nanoseconds longest_rest = std::chrono::seconds{1};

SetupResult<void> of_outcome(const Outcome& outcome) {
    if (outcome.is_accepted()) return {};
    return setup_error(SetupCode::usage, outcome.text.empty() ? "the vehicle refused" : outcome.text);
}

// True if the message's target fields address this vehicle. A message without them addresses everybody.
bool is_for(SystemId system, const wire::FrameView& frame, const wire::MessageInfo& info) noexcept {
    const ByteView payload = frame.payload();
    const auto at = [&](std::uint8_t offset) { return offset < payload.size() ? payload[offset] : std::uint8_t{0}; };
    if (info.target_system_offset == wire::MessageInfo::no_target) return true;
    const std::uint8_t target = at(info.target_system_offset);
    if (target != 0 && target != system.value) return false;
    if (info.target_component_offset == wire::MessageInfo::no_target) return true;
    const std::uint8_t component = at(info.target_component_offset);
    constexpr std::uint8_t mission_planner = 190;  // MAV_COMP_ID_MISSIONPLANNER: old clients send missions to it
    return component == 0 || component == autopilot_component.value || component == mission_planner;
}

std::vector<std::string> faults_of(const Flight& flight, const FailureTable& injected) {
    std::vector<std::string> all = injected.texts();
    for (const Fault& fault : flight.faults()) all.push_back(text_of(fault));
    return all;
}

}  // namespace

std::vector<StreamInfo> stream_infos() {
    std::vector<StreamInfo> infos;
    for (const Projection& projection : projections())
        if (infos.empty() || infos.back().message != projection.info.id)
            infos.push_back({projection.info.id, projection.name});
    return infos;
}

Vehicle::Vehicle(const VehicleOptions& options, Sink& sink, Moment now)
    : parts_(std::make_unique<Parts>(options, sink, now)) {}

Vehicle::~Vehicle() = default;

void Vehicle::open(LinkId link, const LinkOptions& options, Moment now) {
    advance(now);
    parts_->radio.open(link);
    parts_->streams.open(link, options, parts_->view(), now.flight);
}

void Vehicle::close(LinkId link) {
    for (Service* const service : parts_->services) service->forget(link);
    parts_->announcer.forget(link);
    parts_->streams.close(link);
    parts_->radio.close(link);
}

void Vehicle::receive(LinkId link, const wire::FrameView& frame, const wire::MessageInfo* info, Moment now) {
    Parts& parts = *parts_;
    parts.radio.note_received(link, frame.size());
    if (info == nullptr || parts.radio.is_off() || parts.is_silent(now.flight) ||
        !is_for(parts.radio.system(), frame, *info))
        return;
    Service* const service = parts.service_for(info->id);
    if (service == nullptr || !parts.guard->admits(frame, parts.signing_time(now))) return;
    advance(now);
    service->receive({link, frame.source()}, info->id, frame.payload(), now);
    parts.report_changes();
}

FlightTime Vehicle::next_due() const noexcept {
    const Parts& parts = *parts_;
    if (parts.silent_until() != FlightTime::min()) return parts.silent_until();
    FlightTime due = std::min(parts.streams.next_due(), parts.next_pump());
    if (parts.options.wakes_for_changes)
        return std::min(due, parts.stepped + parts.flight.steps_to_change() * step_time);
    return std::min(due, parts.stepped + (parts.may_change_by_itself() ? longest_pause : longest_rest));
}

void Vehicle::advance(Moment now) {
    Parts& parts = *parts_;
    if (parts.is_silent(now.flight)) return parts.step_to(now);
    parts.streams.skip_missed(now.flight);
    FlightTime reported = FlightTime::min();
    for (;;) {
        const FlightTime at = std::min(parts.streams.next_due(), parts.next_pump());
        if (at > now.flight) break;
        reported = at;
        parts.step_to({.flight = at, .real = now.real});
        parts.report_changes();
        if (parts.next_pump() <= at) parts.pump({.flight = at, .real = now.real});
        parts.streams.run(parts.view(), at, now.flight);
    }
    if (reported == now.flight) return;
    parts.step_to(now);
    parts.report_changes();
}

SetupResult<void> Vehicle::arm(bool force) {
    return of_outcome(parts_->flight.arm(force, OrderedBy::operator_console));
}

SetupResult<void> Vehicle::disarm(bool force) {
    return of_outcome(parts_->flight.disarm(force, OrderedBy::operator_console));
}

SetupResult<void> Vehicle::go_to(double latitude, double longitude, std::optional<double> altitude_m) {
    RepositionOrder order{.latitude = latitude, .longitude = longitude};
    if (altitude_m) order.altitude = parts_->flight.home_altitude() + *altitude_m;
    return of_outcome(parts_->flight.reposition(order));
}

SetupResult<void> Vehicle::take_off(double altitude_m) {
    const double base = parts_->flight.home_altitude();
    const auto climb = [&] { return of_outcome(parts_->flight.take_off({.altitude = base + altitude_m})); };
    const auto arm_first = [&] { return parts_->flight.armed() ? SetupResult<void>{} : arm(false); };
    // PX4 changes to its take-off mode and climbs when it is armed. ArduPilot's copter takes off in Guided, armed.
    if (parts_->firmware.is_px4() || parts_->options.kind != Kind::quad) {
        if (auto taken = climb(); !taken) return taken;
        return arm_first();
    }
    const ModeInfo* const guided = parts_->firmware.mode_for(Behaviour::offboard);
    auto done = of_outcome(parts_->flight.set_mode(*guided, OrderedBy::operator_console));
    if (done) done = arm_first();
    return done ? climb() : done;
}

SetupResult<void> Vehicle::set_mode(std::string_view name) {
    const ModeInfo* const mode = parts_->firmware.find_mode(name);
    if (mode == nullptr) return setup_error(SetupCode::usage, "no mode \"" + std::string(name) + "\"");
    return of_outcome(parts_->flight.set_mode(*mode, OrderedBy::operator_console));
}

SetupResult<void> Vehicle::set_parameter(std::string_view name, double value) {
    const auto index = parts_->parameters.find(name);
    if (!index) return setup_error(SetupCode::usage, "no parameter \"" + std::string(name) + "\"");
    const auto [lowest, highest] = range_of(parts_->parameters.info(*index).type);
    if (!(value >= lowest && value <= highest))
        return setup_error(SetupCode::usage, "the parameter cannot hold this value");
    if (parts_->parameters.info(*index).type != ParamType::real32 && value != std::floor(value))
        return setup_error(SetupCode::usage, "the parameter takes whole numbers");
    parts_->put_parameter(name, value);
    return {};
}

SetupResult<void> Vehicle::fail(const Fault& fault) {
    auto done = of_outcome(parts_->set_fault(fault));
    parts_->report_changes();
    return done;
}

SystemId Vehicle::system() const noexcept { return parts_->radio.system(); }

void Vehicle::ask_for_system(std::function<bool(SystemId)> is_free) { parts_->is_free_system = std::move(is_free); }

VehicleStatus Vehicle::status() const {
    const Flight& flight = parts_->flight;
    const Estimate& estimate = flight.estimate();
    const GeoPoint& position = flight.position();
    return {.system = parts_->radio.system(),
            .kind = parts_->options.kind,
            .autopilot = parts_->options.autopilot,
            .armed = flight.armed(),
            .ready = flight.unready() == 0,
            .mode = flight.mode().name,
            .custom_mode = flight.mode().custom_mode,
            .landed = flight.landed(),
            .latitude_deg = position.latitude,
            .longitude_deg = position.longitude,
            .altitude_m = position.altitude,
            .relative_altitude_m = flight.home() ? position.altitude - flight.home()->altitude : 0,
            .north_m_s = estimate.velocity.x(),
            .east_m_s = estimate.velocity.y(),
            .down_m_s = estimate.velocity.z(),
            .roll_deg = to_degrees(estimate.euler.roll),
            .pitch_deg = to_degrees(estimate.euler.pitch),
            .heading_deg = to_degrees(estimate.heading),
            .battery_percent = 100 * flight.battery().remaining(),
            .battery_volts = flight.battery().voltage(),
            .mission_items = flight.plans().mission().size(),
            .mission_current = flight.mission().current,
            .since_boot = flight.since_boot(),
            .not_finite = flight.not_finite(),
            .faults = faults_of(flight, parts_->failures)};
}

bool Vehicle::has_mode(std::string_view name) const {
    const ModeInfo* const mode = parts_->firmware.find_mode(name);
    return mode != nullptr && mode->behaviour != Behaviour::unavailable;
}

std::vector<std::string_view> Vehicle::mode_names() const {
    std::vector<std::string_view> names;
    for (const ModeInfo& mode : parts_->firmware.modes())
        if (mode.behaviour != Behaviour::unavailable) names.push_back(mode.name);
    return names;
}

std::vector<std::string_view> Vehicle::parameter_names() const {
    std::vector<std::string_view> names;
    for (ParamIndex i = 0; i < parts_->parameters.size(); ++i) names.push_back(parts_->parameters.info(i).name);
    return names;
}

std::string_view Vehicle::system_parameter() const noexcept { return parts_->firmware.system_parameter(); }

std::optional<double> Vehicle::parameter(std::string_view name) const {
    const auto index = parts_->parameters.find(name);
    return index ? std::optional(parts_->parameters.shortest_value(*index)) : std::nullopt;
}

std::vector<StreamReport> Vehicle::stream_reports(LinkId link) const { return parts_->streams.reports(link); }

}  // namespace mavloom::sim
