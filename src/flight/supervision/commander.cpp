// SPDX-License-Identifier: MIT
#include "flight/supervision/commander.hpp"

#include <algorithm>
#include <cmath>

namespace mavloom::flight {

namespace {

constexpr double standstill = 0.5;  // m/s

// The sooner a behaviour brings the vehicle down, the higher.
int urgency_of(Behaviour behaviour) noexcept {
    switch (behaviour) {
        case Behaviour::land:
        case Behaviour::descend: return 3;
        case Behaviour::return_home: return 2;
        case Behaviour::hold:
        case Behaviour::brake: return 1;
        default: return 0;
    }
}

}  // namespace

Commander::Commander(FlightContext& context, const Inputs& inputs, Navigator& navigator, LandedDetector& detector)
    : context_(context),
      inputs_(inputs),
      navigator_(navigator),
      detector_(detector),
      mode_(&context.firmware.boot_mode()),
      intended_(mode_) {
    navigator_.enter(mode_->behaviour);
    update();
}

void Commander::reboot() {
    context_.armed = false;
    context_.armed_at = {};
    has_failsafe_ = has_flown_ = is_terminated_ = is_calibrating_ = keeps_home_ = false;
    reboot_for_ = 0;
    mode_ = intended_ = &context_.firmware.boot_mode();
    navigator_.enter(mode_->behaviour);
    update();
}

// --- Readiness

bool Commander::is_booted() const noexcept { return context_.now() >= context_.options.ready_after; }

std::uint32_t Commander::unready() const noexcept {
    const bool has_all_sensors = context_.craft.sensors().failures().has_all_sensors();
    const bool needs_position = context_.tuning.needs_position_to_arm;
    const auto bit = [](bool is_missing, Unready reason) { return is_missing ? std::uint32_t{reason} : 0u; };
    return bit(!is_booted(), unready_booting) |
           bit(needs_position && !context_.craft.sensors().has_position(), unready_position) |
           bit(needs_position && !context_.craft.home(), unready_home) |
           bit(context_.craft.battery().remaining() < context_.tuning.battery_critical, unready_battery) |
           bit(!has_all_sensors, unready_sensors) | bit(is_calibrating_, unready_calibrating) |
           bit(!context_.armed && !can_arm_in(mode_->behaviour), unready_mode) |
           bit(is_terminated_, unready_terminated) | reboot_for_;
}

bool Commander::can_run(Behaviour behaviour) const noexcept {
    if (needs_position(behaviour) && !context_.craft.sensors().has_position()) return false;
    const bool is_px4 = context_.firmware.is_px4();
    switch (behaviour) {
        case Behaviour::mission:
            return context_.plans.mission().size() > (context_.firmware.has_home_in_mission() ? 1 : 0);
        case Behaviour::return_home: return context_.craft.home().has_value();
        case Behaviour::offboard:
            return is_px4 ? inputs_.offboard.is_fresh(context_.input_time(), context_.tuning.offboard_loss)
                          : context_.craft.sensors().has_position();
        case Behaviour::unavailable: return false;
        default:
            return !is_px4 || !needs_sticks(behaviour) ||
                   inputs_.sticks.is_fresh(context_.input_time(), context_.tuning.manual_loss);
    }
}

bool Commander::can_arm_in(Behaviour behaviour) const noexcept {
    const bool flies_auto = !context_.firmware.is_px4() && context_.kind() == Kind::quad &&
                            behaviour == Behaviour::mission;
    return urgency_of(behaviour) < 2 && behaviour != Behaviour::terminated && !flies_auto && can_run(behaviour);
}

SystemStatus Commander::status() const noexcept {
    if (is_terminated_) return SystemStatus::terminated;
    if (is_calibrating_) return SystemStatus::calibrating;
    if (context_.armed) return has_failsafe_ ? SystemStatus::critical : SystemStatus::active;
    return (unready() & ~reboot_for_) == 0 ? SystemStatus::standby : SystemStatus::uninitialised;
}

// --- Arming

Outcome Commander::arm(bool force, OrderedBy /*by*/) {
    if (context_.armed) return Result::accepted;
    const std::uint32_t reasons = unready();
    const Texts& texts = context_.texts();
    const Result refused = context_.firmware.is_px4() ? Result::temporarily_rejected : Result::failed;
    if (is_terminated_) return context_.refuse(refused, texts.not_ready);
    if (reasons != 0 && !force) return context_.refuse(refused, refusal(reasons), mode_->name);
    context_.armed = true;
    context_.armed_at = context_.now();
    has_flown_ = false;
    if (!keeps_home_ && context_.craft.sensors().has_position()) put_home_here();
    navigator_.mission().on_armed();
    context_.say(Severity::info, texts.armed);
    return Result::accepted;
}

// The text of the first reason that has one.
std::string_view Commander::refusal(std::uint32_t reasons) const noexcept {
    const Refusals& texts = context_.texts().refusals;
    const bool calibrates_compass = (reasons & unready_calibrating) != 0 && (reasons & unready_compass_calibrated) != 0;
    const std::pair<bool, std::string_view> candidates[]{
        {calibrates_compass, texts.compass_runs},
        {(reasons & unready_compass_calibrated) != 0, texts.compass_calibrated},
        {(reasons & unready_calibrating) != 0, texts.accelerometer_runs},
        {(reasons & unready_accelerometer_calibrated) != 0, texts.accelerometer_calibrated},
        {(reasons & unready_position) != 0, texts.position},
        {(reasons & unready_booting) != 0, texts.booting},
        {(reasons & unready_home) != 0, texts.home},
        {(reasons & unready_battery) != 0, texts.battery},
        {reasons == unready_mode, mode_refusal()}};
    for (const auto& [applies, text] : candidates)
        if (applies && !text.empty()) return text;
    return context_.texts().not_ready;
}

std::string_view Commander::mode_refusal() const noexcept {
    const Refusals& texts = context_.texts().refusals;
    return mode_->behaviour == Behaviour::mission && !can_run(Behaviour::mission) ? texts.mission : texts.mode;
}

bool Commander::may_disarm() const noexcept {
    return context_.is_on_ground() || (context_.kind() == Kind::rover && context_.craft.speed() < standstill);
}

Outcome Commander::disarm(bool force, OrderedBy /*by*/) {
    if (!context_.armed) return Result::accepted;
    const Result refused = context_.firmware.is_px4() ? Result::temporarily_rejected : Result::failed;
    if (!force && !may_disarm()) return context_.refuse(refused, context_.texts().not_landed);
    end_flight(context_.texts().disarmed);
    return Result::accepted;
}

// PX4 leaves the modes that end on the ground.
void Commander::end_flight(std::string_view text) {
    context_.armed = false;
    context_.armed_at = {};
    ++flights_;
    has_failsafe_ = false;
    context_.say(Severity::info, text);
    const Behaviour behaviour = mode_->behaviour;
    const bool is_over = urgency_of(behaviour) >= 2 || behaviour == Behaviour::takeoff || behaviour == Behaviour::orbit;
    if (context_.firmware.is_px4() && is_over) switch_to(context_.firmware.boot_mode());
    intended_ = mode_;
}

void Commander::on_crash() {
    if (context_.armed) end_flight(context_.texts().disarmed_by_crash);
}

Outcome Commander::terminate() {
    if (!context_.armed) return Result::temporarily_rejected;
    end_flight(context_.texts().disarmed);
    is_terminated_ = true;
    if (const ModeInfo* const mode = context_.firmware.mode_for(Behaviour::terminated)) switch_to(*mode);
    intended_ = mode_;
    return Result::accepted;
}

// --- Home

void Commander::put_home_here() {
    context_.craft.set_home(context_.craft.position(), context_.craft.estimate().euler.yaw);
    context_.observer.on_home_changed();
}

Outcome Commander::set_home(const std::optional<GeoPoint>& point, double yaw) {
    if (!point && !context_.craft.sensors().has_position())
        return context_.refuse(Result::temporarily_rejected, context_.texts().no_position);
    keeps_home_ = true;
    put_home_here();
    if (point) context_.craft.set_home(*point, std::isfinite(yaw) ? wrap_pi(yaw) : context_.craft.home_yaw());
    return Result::accepted;
}

// --- Modes

Outcome Commander::enter(Behaviour behaviour, OrderedBy by) {
    const ModeInfo* const mode = context_.firmware.mode_for(behaviour);
    return mode == nullptr ? Outcome(Result::unsupported) : set_mode(*mode, by);
}

// A disarmed vehicle may be in any mode; an armed one only where it can fly.
Outcome Commander::set_mode(const ModeInfo& mode, OrderedBy by) {
    if ((by != OrderedBy::failsafe && !mode.is_selectable()) || is_terminated_) return refuse_mode(mode);
    if (context_.armed && !can_run(mode.behaviour)) return refuse_mode(mode);
    if (by != OrderedBy::failsafe) {
        intended_ = &mode;
        has_failsafe_ = false;
    }
    switch_to(mode);
    return Result::accepted;
}

Outcome Commander::refuse_mode(const ModeInfo& mode) const {
    const Texts& texts = context_.texts();
    const bool lacks_setpoints = mode.behaviour == Behaviour::offboard && !texts.offboard_without_setpoints.empty();
    const bool is_px4 = context_.firmware.is_px4();
    if (!is_px4 && mode.behaviour == Behaviour::mission) context_.say(Severity::notice, texts.no_mission);
    return context_.refuse(is_px4 ? Result::temporarily_rejected : Result::failed,
                           lacks_setpoints ? texts.offboard_without_setpoints : texts.mode_refused, mode.name,
                           is_px4 ? Severity::critical : Severity::warning);
}

void Commander::switch_to(const ModeInfo& mode) {
    if (mode_ == &mode) return;
    mode_ = &mode;
    navigator_.enter(mode.behaviour);
}

// --- Fail-safes

void Commander::perform(FailsafeAction action) {
    if (!context_.armed || action <= FailsafeAction::warn) return;
    if (action == FailsafeAction::terminate) return void(terminate());
    if (action == FailsafeAction::disarm) return end_flight(context_.texts().disarmed);
    const Behaviour wanted = action == FailsafeAction::land          ? Behaviour::land
                             : action == FailsafeAction::return_home ? Behaviour::return_home
                                                                     : Behaviour::hold;
    has_failsafe_ = true;
    const bool has_position = context_.craft.sensors().has_position();
    if (has_position && urgency_of(mode_->behaviour) >= urgency_of(wanted)) return;
    switch_to(failsafe_mode(wanted));
}

// Without a position the vehicle can only come down.
const ModeInfo& Commander::failsafe_mode(Behaviour wanted) const noexcept {
    const Firmware& firmware = context_.firmware;
    if (context_.craft.sensors().has_position())
        for (const Behaviour behaviour : {wanted, Behaviour::land, Behaviour::hold})
            if (const ModeInfo* const mode = firmware.mode_for(behaviour); mode != nullptr && can_run(behaviour))
                return *mode;
    const ModeInfo* const descend = firmware.mode_for(Behaviour::descend);
    return descend != nullptr ? *descend : *mode_;
}

void Commander::resume() {
    if (!has_failsafe_ || !context_.armed || !can_run(intended_->behaviour)) return;
    has_failsafe_ = false;
    switch_to(*intended_);
}

// --- Time

// The receiver finds its position half-way to the end of the start.
void Commander::update() {
    Craft& craft = context_.craft;
    if (context_.now() >= context_.options.ready_after / 2) craft.acquire_gps();
    if (!craft.home() && is_booted() && craft.sensors().has_position()) put_home_here();
    if (!context_.armed) return;
    has_flown_ |= !context_.is_on_ground();
    disarm_if_standing();
}

// A mission that ends on the ground ends the flight at once. Within a mission, the vehicle may stand for a while.
void Commander::disarm_if_standing() {
    if (!context_.is_on_ground()) return;
    const Tuning& tuning = context_.tuning;
    const Texts& texts = context_.texts();
    const bool flies_mission = mode_->behaviour == Behaviour::mission;
    if (flies_mission && navigator_.mission().is_complete() && has_flown_ && tuning.disarm_after_landing > 0)
        return end_flight(texts.disarmed_by_landing);
    const bool takes_off = navigator_.guidance().is_climbing();
    if (has_flown_ && !takes_off && !flies_mission && tuning.disarm_after_landing > 0 &&
        detector_.seconds_landed() >= tuning.disarm_after_landing)
        return end_flight(texts.disarmed_by_landing);
    const double standing_for = std::min(context_.seconds_since(context_.armed_at), detector_.seconds_landed());
    if ((!has_flown_ || takes_off) && tuning.disarm_without_takeoff > 0 && context_.craft.speed() < standstill &&
        standing_for >= tuning.disarm_without_takeoff)
        end_flight(texts.disarmed_without_takeoff);
}

}  // namespace mavloom::flight
