// SPDX-License-Identifier: MIT
#include "flight/flight.hpp"

#include "flight/flight_impl.hpp"

namespace mavloom::flight {

namespace {

constexpr unsigned navigation_period = 5;  // steps; 50 Hz

}  // namespace

Flight::Impl::Impl(const VehicleOptions& options, const Firmware& firmware, const Parameters& values,
                   FlightObserver& observer)
    : parameters(values),
      context{.options = options,
              .firmware = firmware,
              .observer = observer,
              .craft = Craft(options),
              .tuning = firmware.tuning(values),
              .plans = {}},
      navigator(context, inputs),
      detector(context),
      commander(context, inputs, navigator, detector),
      fence(context),
      failsafes(context, inputs, fence, commander) {
    if (options.motion == Motion::random) begin_random_motion();
    shown_ = shown();
}

void Flight::Impl::begin_random_motion() {
    random_pilot.emplace(context.options.seed);
    context.craft.place({0, 0, -RandomPilot::height}, to_radians(context.options.home.heading_deg));
    context.armed = true;
    context.landed = LandedState::in_air;
}

void Flight::Impl::step() {
    if (steps_++ % navigation_period == 0) random_pilot ? steer_at_random() : supervise();
    context.craft.step(navigator.guidance().setpoint(), context.armed);
}

void Flight::Impl::supervise() {
    const Guidance& guidance = navigator.guidance();
    detector.update({guidance.is_climbing(), guidance.is_landing(), navigator.is_home()});
    commander.update();
    failsafes.update();
    if (const auto next = navigator.update())
        (void)(*next == Behaviour::return_home ? return_home(OrderedBy::vehicle)
                                               : commander.enter(*next, OrderedBy::vehicle));
    report_changes();
}

// Such a vehicle is always armed and in the air, and gets a new battery in flight.
void Flight::Impl::steer_at_random() {
    Craft& craft = context.craft;
    context.armed = true;
    context.landed = LandedState::in_air;
    commander.update();
    if (craft.battery().remaining() < 0.2) craft.battery().set_remaining(1);
    navigator.guidance().follow(random_pilot->steer(craft.home_place(), craft.estimate().position));
    report_changes();
}

void Flight::Impl::set_origin(const GeoPoint& origin) {
    navigator.move_origin(context.craft.set_origin(origin));
    fence.rebuild();
}

// The local frame begins where the vehicle boots.
void Flight::Impl::reboot() {
    const GeoPoint here = context.craft.position();
    set_origin({here.latitude, here.longitude, context.craft.ground_altitude()});
    context.craft.reboot();
    inputs = {};
    failsafes.reset();
    detector.reset();
    fence.enable(true);
    commander.reboot();
    navigator.mission().on_plan_changed();
    report_changes();
}

Flight::Impl::Shown Flight::Impl::shown() const noexcept {
    return {&commander.mode(), context.armed, commander.status(), context.landed};
}

void Flight::Impl::report_changes() {
    if (const Shown now = shown(); now != shown_) {
        shown_ = now;
        context.observer.on_state_changed();
    }
}

Flight::Flight(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters,
               FlightObserver& observer)
    : impl_(std::make_unique<Impl>(options, firmware, parameters, observer)) {}
Flight::~Flight() = default;

void Flight::step() { impl_->step(); }
void Flight::set_real_time(MonoTime now) noexcept { impl_->context.real = now.time_since_epoch(); }
void Flight::reboot() { impl_->reboot(); }
void Flight::retune() { impl_->context.tuning = impl_->context.firmware.tuning(impl_->parameters); }

void Flight::on_sticks(const Sticks& sticks) { impl_->inputs.sticks.put(bounded(sticks), impl_->context.input_time()); }
void Flight::on_offboard(const OffboardSetpoint& setpoint) {
    if (const auto given = bounded(setpoint)) impl_->inputs.offboard.put(*given, impl_->context.input_time());
}
void Flight::on_ground_station_heard() { impl_->inputs.ground_station.put({}, impl_->context.input_time()); }
void Flight::on_plan_changed(PlanType type) {
    if (type == PlanType::mission) impl_->navigator.mission().on_plan_changed();
    if (type == PlanType::fence) impl_->fence.rebuild();
}
void Flight::set_calibrating(bool calibrating) {
    impl_->commander.set_calibrating(calibrating);
    impl_->report_changes();
}

FlightTime Flight::since_boot() const noexcept { return impl_->context.now(); }
bool Flight::armed() const noexcept { return impl_->context.armed; }
const ModeInfo& Flight::mode() const noexcept { return impl_->commander.mode(); }
const ModeInfo& Flight::intended_mode() const noexcept { return impl_->commander.intended_mode(); }
SystemStatus Flight::system_status() const noexcept { return impl_->commander.status(); }
LandedState Flight::landed() const noexcept { return impl_->context.landed; }
std::uint32_t Flight::unready() const noexcept { return impl_->commander.unready(); }
bool Flight::has_failsafe() const noexcept { return impl_->commander.has_failsafe(); }
bool Flight::has_sticks() const noexcept {
    return impl_->inputs.sticks.is_fresh(impl_->context.input_time(), impl_->context.tuning.manual_loss);
}
Sticks Flight::sticks() const noexcept { return impl_->inputs.sticks.value().value_or(Sticks{}); }
const Tuning& Flight::tuning() const noexcept { return impl_->context.tuning; }

const Kinematics& Flight::truth() const noexcept { return impl_->context.craft.truth(); }
const Estimate& Flight::estimate() const noexcept { return impl_->context.craft.estimate(); }
const Sensors& Flight::sensors() const noexcept { return impl_->context.craft.sensors(); }
const Airframe& Flight::airframe() const noexcept { return impl_->context.craft.airframe(); }
const Battery& Flight::battery() const noexcept { return impl_->context.craft.battery(); }
const Vector3& Flight::wind() const noexcept { return impl_->context.craft.wind(); }
const Setpoint& Flight::setpoint() const noexcept { return impl_->navigator.guidance().setpoint(); }

const LocalFrame& Flight::frame() const noexcept { return impl_->context.craft.frame(); }
bool Flight::has_origin() const noexcept { return impl_->context.craft.has_origin(); }
const std::optional<GeoPoint>& Flight::home() const noexcept { return impl_->context.craft.home(); }
double Flight::home_yaw() const noexcept { return impl_->context.craft.home_yaw(); }
const GeoPoint& Flight::position() const { return impl_->context.craft.position(); }
double Flight::ground_altitude() const noexcept { return impl_->context.craft.ground_altitude(); }

Plans& Flight::plans() noexcept { return impl_->context.plans; }
const Plans& Flight::plans() const noexcept { return impl_->context.plans; }
MissionProgress Flight::mission() const noexcept { return impl_->navigator.mission().progress(); }
const std::optional<NavigationTarget>& Flight::target() const noexcept { return impl_->navigator.guidance().target(); }
std::optional<OrbitStatus> Flight::orbit_status() const {
    const auto& circle = impl_->navigator.guidance().present_circle();
    if (!circle || mode().behaviour != Behaviour::orbit || !armed()) return std::nullopt;
    return OrbitStatus{frame().to_geo(circle->center), circle->radius};
}
const std::optional<GeoPoint>& Flight::region_of_interest() const noexcept {
    return impl_->navigator.guidance().heading().interest();
}
FlightTime Flight::armed_at() const noexcept { return impl_->context.armed_at; }
FlightTime Flight::took_off_at() const noexcept { return impl_->detector.took_off_at(); }
std::uint32_t Flight::flights() const noexcept { return impl_->commander.flights(); }

}  // namespace mavloom::flight
