// SPDX-License-Identifier: MIT
#include "flight/flight.hpp"

namespace mavloom::flight {

namespace {

constexpr unsigned navigation_period = 5;  // steps; 50 Hz

}  // namespace

Flight::Flight(const VehicleOptions& options, const Firmware& firmware, const Parameters& values,
               FlightObserver& observer)
    : parameters_(values),
      context_{.options = options,
               .firmware = firmware,
               .observer = observer,
               .craft = Craft(options),
               .tuning = firmware.tuning(values),
               .plans = {}},
      navigator_(context_, inputs_),
      detector_(context_),
      commander_(context_, inputs_, navigator_, detector_),
      fence_(context_),
      failsafes_(context_, inputs_, fence_, commander_) {
    if (options.motion == Motion::random) begin_random_motion();
    shown_ = shown();
}

void Flight::begin_random_motion() {
    random_pilot_.emplace(context_.options.seed);
    Craft& craft = context_.craft;
    const Vector3 above{craft.home_place().x(), craft.home_place().y(), craft.ground_z() - RandomPilot::height};
    craft.place(above, to_radians(context_.options.home.heading_deg));
    context_.armed = true;
    context_.landed = LandedState::in_air;
}

void Flight::step() {
    if (steps_++ % navigation_period == 0) random_pilot_ ? steer_at_random() : supervise();
    context_.craft.step(navigator_.guidance().setpoint(), context_.armed);
    if (context_.craft.not_finite() != not_finite_) on_put_back();
}

// The pilot starts afresh. Only the first time is reported. A vehicle that moves at random is never on the ground.
void Flight::on_put_back() {
    if (std::exchange(not_finite_, context_.craft.not_finite()) == 0)
        context_.say(Severity::critical, "Motion became infinite: back at home, check body and wind");
    if (random_pilot_) return begin_random_motion();
    (void)commander_.disarm(true, OrderedBy::vehicle);
    detector_.reset();
    report_changes();
}

unsigned Flight::steps_to_change() const noexcept {
    return (navigation_period - steps_ % navigation_period) % navigation_period + 1;
}

void Flight::supervise() {
    const Guidance& guidance = navigator_.guidance();
    detector_.update({guidance.is_climbing(), guidance.is_landing(), navigator_.is_home()});
    if (crash_detector_.update(context_.craft.plant())) commander_.on_crash();
    commander_.update();
    failsafes_.update();
    if (const auto next = navigator_.update())
        (void)(*next == Behaviour::return_home ? begin_return(OrderedBy::vehicle)
                                               : commander_.enter(*next, OrderedBy::vehicle));
    report_changes();
}

// Such a vehicle is always armed and in the air, and gets a new battery in flight.
void Flight::steer_at_random() {
    Craft& craft = context_.craft;
    context_.armed = true;
    context_.landed = LandedState::in_air;
    commander_.update();
    if (craft.battery().remaining() < 0.2) craft.battery().set_remaining(1);
    navigator_.guidance().follow(random_pilot_->steer(craft.home_place(), craft.estimate().position));
    report_changes();
}

void Flight::move_origin(const GeoPoint& origin) {
    navigator_.move_origin(context_.craft.set_origin(origin));
    fence_.rebuild();
}

// The local frame begins where the vehicle boots.
void Flight::reboot() {
    const GeoPoint here = context_.craft.position();
    move_origin({here.latitude, here.longitude, context_.craft.ground_altitude()});
    injected_ = {};
    apply_failures();
    context_.craft.reboot();
    inputs_ = {};
    failsafes_.reset();
    detector_.reset();
    fence_.enable(true);
    commander_.reboot();
    navigator_.mission().on_plan_changed();
    report_changes();
}

Flight::Shown Flight::shown() const noexcept {
    return {&commander_.mode(), context_.armed, commander_.status(), context_.landed};
}

void Flight::report_changes() {
    if (const Shown now = shown(); now != shown_) {
        shown_ = now;
        context_.observer.on_state_changed();
    }
}

void Flight::set_real_time(MonoTime now) noexcept { context_.real = now.time_since_epoch(); }
void Flight::retune() { context_.tuning = context_.firmware.tuning(parameters_); }

void Flight::on_sticks(const Sticks& sticks) { inputs_.sticks.put(bounded(sticks), context_.input_time()); }
void Flight::on_offboard(const OffboardSetpoint& setpoint) {
    if (const auto given = bounded(setpoint)) inputs_.offboard.put(*given, context_.input_time());
}
void Flight::on_ground_station_heard() { inputs_.ground_station.put({}, context_.input_time()); }
void Flight::on_plan_changed(PlanType type) {
    if (type == PlanType::mission) navigator_.mission().on_plan_changed();
    if (type == PlanType::fence) fence_.rebuild();
}
void Flight::set_calibrating(bool calibrating) {
    commander_.set_calibrating(calibrating);
    report_changes();
}

void Flight::require_reboot(Unready reason) {
    commander_.require_reboot(reason);
    report_changes();
}

bool Flight::has_sticks() const noexcept {
    return inputs_.sticks.is_fresh(context_.input_time(), context_.tuning.manual_loss);
}

std::optional<OrbitStatus> Flight::orbit_status() const {
    const auto& circle = navigator_.guidance().present_circle();
    if (!circle || mode().behaviour != Behaviour::orbit || !armed()) return std::nullopt;
    return OrbitStatus{frame().to_geo(circle->center), circle->radius};
}
const std::optional<GeoPoint>& Flight::region_of_interest() const noexcept {
    return navigator_.guidance().heading().interest();
}

}  // namespace mavloom::flight
