// SPDX-License-Identifier: MIT
#include "flight/plant/multicopter.hpp"

#include <algorithm>
#include <cmath>

#include "flight/physics/math.hpp"

namespace mavloom::flight {

namespace {

// Legs, per mass: a spring with damping that carries the weight at height 0, and friction.
constexpr double leg_stiffness = 40 * 40;               // 1/s^2
constexpr double leg_damping = 2 * 0.7 * 40;            // 1/s
constexpr double leg_travel = gravity / leg_stiffness;  // m
constexpr double hardest_impact = 1.5;                  // m/s; a faster fall ends at once
constexpr double friction = 20, levelling = 10;         // 1/s
constexpr double firm = 0.3 * gravity;                  // push of the legs that keeps the vehicle from sliding
constexpr double slack = 0.1;                           // of the weight: with less thrust, the vehicle may rest

// How far a first-order lag follows its input within `dt`.
double share_of(double dt, double time_constant) noexcept {
    return time_constant > 0 ? -math::expm1(-dt / time_constant) : 1;
}

}  // namespace

Multicopter::Multicopter(const CopterBody& body)
    : body_(body), inertia_(body.inertia_kg_m2[0], body.inertia_kg_m2[1], body.inertia_kg_m2[2]) {
    channels_.used = static_cast<std::uint8_t>(body_.rotor_count);
    std::fill_n(channels_.is_motor.begin(), channels_.used, true);
}

void Multicopter::place(const Vector3& position, double heading) {
    rest_at(position, heading);
    speeds_ = thrusts_ = {};
    total_ = 0;
}

void Multicopter::step(const Outputs& outputs, const Surroundings& around, double dt) {
    air_velocity_ = motion_.velocity - around.wind;
    spin(outputs, dt);
    const Vector3 free = acceleration(around), rates = turned(moment(around.supply), dt) + around.turn * dt;
    const double depth = motion_.position.z() - around.ground;
    const double push = depth < -leg_travel
                            ? 0
                            : std::max(0.0, leg_stiffness * (depth + leg_travel) + leg_damping * motion_.velocity.z());
    touches_ground_ = push > 0;
    if (touches_ground_) {
        const bool may_rest = total_ < slack * body_.mass_kg * gravity && !around.lift();
        integrate_step(legs(push, depth, free, may_rest, dt), push < firm ? rates : rates_after(), dt);
    } else {
        integrate_step(free, rates, dt);
    }
    report(around.supply);
}

void Multicopter::spin(const Outputs& outputs, double dt) {
    if (dt != dt_) {
        dt_ = dt;
        up_share_ = share_of(dt, body_.spin_up_s);
        down_share_ = share_of(dt, body_.spin_down_s);
    }
    total_ = 0;
    for (std::size_t i = 0; i < body_.rotor_count; ++i) {
        const double wanted = speed_for(motor_output(outputs[i]));
        speeds_[i] += (wanted - speeds_[i]) * (wanted > speeds_[i] ? up_share_ : down_share_);
        thrusts_[i] = thrust_at(speeds_[i]);
        total_ += thrusts_[i];
    }
}

// At output 0 the motor stands still.
double Multicopter::speed_for(double output) const noexcept {
    return output > 0 ? body_.idle + (1 - body_.idle) * output : 0;
}

double Multicopter::thrust_at(double speed) const noexcept {
    return body_.thrust_n * speed * (1 - body_.curve + body_.curve * speed);
}

Vector3 Multicopter::acceleration(const Surroundings& around) const {
    const Vector3 lift = motion_.attitude * Vector3(0, 0, -total_ * around.supply);
    Vector3 force = lift - air_drag(around.air_density / sea_level_density);
    if (body_.rotor_drag > 0) force -= rotor_drag();
    return force / body_.mass_kg + Vector3(0, 0, gravity) + around.push;
}

Vector3 Multicopter::air_drag(double relative_density) const {
    double drag = body_.drag;
    if (body_.square_drag > 0) drag += body_.square_drag * air_velocity_.norm();
    return air_velocity_ * (drag * relative_density);
}

// Each rotor brakes the air that crosses it in its plane.
Vector3 Multicopter::rotor_drag() const {
    double speeds = 0;
    for (const double speed : speeds_) speeds += speed;
    Vector3 across = motion_.attitude.conjugate() * air_velocity_;
    across.z() = 0;
    return motion_.attitude * across * (body_.rotor_drag * speeds);
}

// Thrust acts upwards, along -z. So a rotor at the right turns the body to the left, and one in front lifts the nose.
// A body turns against its rotors.
Vector3 Multicopter::moment(double supply) const {
    double roll = 0, pitch = 0, yaw = 0;
    for (std::size_t i = 0; i < body_.rotor_count; ++i) {
        const Rotor& rotor = body_.rotors[i];
        roll -= rotor.right_m * thrusts_[i];
        pitch += rotor.forward_m * thrusts_[i];
        yaw += rotor.turn * thrusts_[i];
    }
    return Vector3(roll, pitch, yaw * body_.moment_ratio_m) * supply - motion_.rates * body_.turn_drag;
}

// The rates after this moment has acted for `dt`: Euler's equation.
Vector3 Multicopter::turned(const Vector3& moment, double dt) const {
    const Vector3 gyroscopic = motion_.rates.cross(inertia_.cwiseProduct(motion_.rates));
    return motion_.rates + (moment - gyroscopic).cwiseQuotient(inertia_) * dt;
}

Vector3 Multicopter::legs(double push, double depth, const Vector3& acceleration, bool may_rest, double dt) const {
    Vector3 result = acceleration;
    result.z() -= push;
    if (motion_.velocity.z() > hardest_impact) result.z() = (hardest_impact - motion_.velocity.z()) / dt;
    if (push >= firm) result.head<2>() = -friction * motion_.velocity.head<2>();
    // Close to rest, the last motion ends exactly, so that a parked vehicle reports no velocity.
    const bool is_close = std::abs(depth) < 2e-4 && motion_.velocity.squaredNorm() < 4e-4;
    if (is_close && may_rest) {
        const double rise = std::abs(depth) < 1e-7 ? 0 : -20 * depth;
        result = (Vector3(0, 0, rise) - motion_.velocity) / dt;
    }
    return result;
}

// The vehicle stands up on its legs and does not turn.
Vector3 Multicopter::rates_after() const {
    const Vector3 down = motion_.attitude.conjugate() * Vector3::UnitZ();
    const Vector3 tilt(down.y(), -down.x(), 0);
    if (tilt.squaredNorm() < 1e-20) return Vector3::Zero();
    return -levelling * tilt;
}

// The power of a rotor grows with the thrust to 3/2, as by momentum theory.
void Multicopter::report(double supply) {
    const double hover_share = total_ * supply / (body_.mass_kg * gravity);
    thrust_ = total_ / (body_.thrust_n * static_cast<double>(body_.rotor_count));
    load_ = hover_share * std::sqrt(std::max(hover_share, 0.0));
}

}  // namespace mavloom::flight
