// SPDX-License-Identifier: MIT
#include "sim/flight/flight.hpp"

#include "sim/firmware/firmware.hpp"

namespace mavloom::sim {

class Flight::Impl {
public:
    Impl(const VehicleOptions& options, const Firmware& f, const Parameters& p, FlightObserver& o)
        : firmware(f), parameters(p), observer(o), mode(&f.boot_mode()), airframe(make_airframe(options.kind)),
          battery(options.battery), sensors(options.has_noise, options.seed),
          frame({options.home.latitude_deg, options.home.longitude_deg, options.home.altitude_m}) {
        airframe->place(Vector3::Zero(), to_radians(options.home.heading_deg));
        home = position = frame.origin();
        tuning = f.tuning(p);
    }
    const Firmware& firmware;
    const Parameters& parameters;
    FlightObserver& observer;
    const ModeInfo* mode;
    std::unique_ptr<Airframe> airframe;
    Battery battery;
    Sensors sensors;
    LocalFrame frame;
    GeoPoint position;
    std::optional<GeoPoint> home, interest;
    Tuning tuning;
    Plans plans;
    Setpoint setpoint;
    Vector3 wind = Vector3::Zero();
    std::optional<NavigationTarget> target;
    FlightTime time{};
    bool armed = false;
};

Flight::Flight(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters,
               FlightObserver& observer)
    : impl_(std::make_unique<Impl>(options, firmware, parameters, observer)) {}
Flight::~Flight() = default;

void Flight::step() {
    impl_->time += step_time;
    impl_->airframe->step(impl_->setpoint, impl_->armed, {});
    impl_->sensors.step(impl_->airframe->motion(), {}, true, 0, 1.2);
}
void Flight::reboot() { impl_->time = {}; }
void Flight::retune() { impl_->tuning = impl_->firmware.tuning(impl_->parameters); }
Outcome Flight::arm(bool /*force*/, OrderedBy /*by*/) { impl_->armed = true; impl_->observer.on_state_changed(); return Result::accepted; }
Outcome Flight::disarm(bool /*force*/, OrderedBy /*by*/) { impl_->armed = false; impl_->observer.on_state_changed(); return Result::accepted; }
Outcome Flight::set_mode(const ModeInfo& mode, OrderedBy /*by*/) { impl_->mode = &mode; impl_->observer.on_state_changed(); return Result::accepted; }
Outcome Flight::take_off(const TakeoffOrder& /*order*/) { return Result::unsupported; }
Outcome Flight::land(const LandOrder& /*order*/) { return Result::unsupported; }
Outcome Flight::return_home() { return Result::unsupported; }
Outcome Flight::reposition(const RepositionOrder& /*order*/) { return Result::unsupported; }
Outcome Flight::orbit(const OrbitOrder& /*order*/) { return Result::unsupported; }
Outcome Flight::pause() { return Result::unsupported; }
Outcome Flight::resume() { return Result::unsupported; }
Outcome Flight::change_altitude(double /*altitude*/) { return Result::unsupported; }
Outcome Flight::change_speed(SpeedKind /*kind*/, double /*speed*/) { return Result::unsupported; }
Outcome Flight::turn_to(double /*yaw*/, double /*yaw_rate*/, bool /*relative*/) { return Result::unsupported; }
Outcome Flight::look_at(const std::optional<GeoPoint>& point) { impl_->interest = point; return Result::accepted; }
Outcome Flight::start_mission(std::optional<std::uint16_t> /*first*/) { return Result::unsupported; }
Outcome Flight::set_current_item(std::optional<std::uint16_t> /*seq*/, bool /*resets*/) { return Result::unsupported; }
Outcome Flight::set_home(const std::optional<GeoPoint>& /*point*/, double /*yaw*/) { return Result::unsupported; }
Outcome Flight::set_origin(const GeoPoint& /*origin*/) { return Result::unsupported; }
Outcome Flight::terminate() { return Result::unsupported; }
Outcome Flight::enable_fence(bool /*enabled*/) { return Result::unsupported; }
Outcome Flight::inject_failures(const SensorFailures& /*failures*/) { return Result::unsupported; }
Outcome Flight::set_battery(double /*share*/) { return Result::unsupported; }
void Flight::on_sticks(const Sticks& /*sticks*/) {  }
void Flight::on_offboard(const OffboardSetpoint& /*setpoint*/) {  }
void Flight::on_ground_station_heard() {  }
void Flight::on_plan_changed(PlanType /*type*/) {  }
void Flight::set_calibrating(bool /*calibrating*/) {  }
FlightTime Flight::since_boot() const noexcept { return impl_->time; }
bool Flight::armed() const noexcept { return impl_->armed; }
const ModeInfo& Flight::mode() const noexcept { return *impl_->mode; }
const ModeInfo& Flight::intended_mode() const noexcept { return *impl_->mode; }
SystemStatus Flight::system_status() const noexcept { return impl_->armed ? SystemStatus::active : SystemStatus::standby; }
LandedState Flight::landed() const noexcept { return LandedState::on_ground; }
std::uint32_t Flight::unready() const noexcept { return 0; }
bool Flight::has_failsafe() const noexcept { return false; }
bool Flight::has_sticks() const noexcept { return false; }
Sticks Flight::sticks() const noexcept { return {}; }
const Tuning& Flight::tuning() const noexcept { return impl_->tuning; }
const Kinematics& Flight::truth() const noexcept { return impl_->airframe->motion(); }
const Estimate& Flight::estimate() const noexcept { return impl_->sensors.estimate(); }
const Sensors& Flight::sensors() const noexcept { return impl_->sensors; }
const Airframe& Flight::airframe() const noexcept { return *impl_->airframe; }
const Battery& Flight::battery() const noexcept { return impl_->battery; }
const Vector3& Flight::wind() const noexcept { return impl_->wind; }
const Setpoint& Flight::setpoint() const noexcept { return impl_->setpoint; }
const LocalFrame& Flight::frame() const noexcept { return impl_->frame; }
bool Flight::has_origin() const noexcept { return true; }
const std::optional<GeoPoint>& Flight::home() const noexcept { return impl_->home; }
double Flight::home_yaw() const noexcept { return 0; }
const GeoPoint& Flight::position() const { return impl_->position; }
double Flight::ground_altitude() const noexcept { return impl_->frame.origin().altitude; }
Plans& Flight::plans() noexcept { return impl_->plans; }
const Plans& Flight::plans() const noexcept { return impl_->plans; }
MissionProgress Flight::mission() const noexcept { return {}; }
const std::optional<NavigationTarget>& Flight::target() const noexcept { return impl_->target; }
std::optional<OrbitStatus> Flight::orbit_status() const { return std::nullopt; }
const std::optional<GeoPoint>& Flight::region_of_interest() const noexcept { return impl_->interest; }
FlightTime Flight::armed_at() const noexcept { return {}; }
FlightTime Flight::took_off_at() const noexcept { return {}; }
std::uint32_t Flight::flights() const noexcept { return 0; }

}  // namespace mavloom::sim
