// SPDX-License-Identifier: MIT
// The axes of a stabilised gimbal. Private to module sim; single owner; nothing allocates.
//
// Roll and pitch keep their angles to the horizon. Yaw either follows the vehicle or holds its direction (lock). Axes
// move at a limited rate. Angles are in radians.
#pragma once

#include "flight/physics/rotation.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::sim {

// An order of a client; `nan`: unchanged. A rate moves the axis until the next order.
struct GimbalAim {
    double pitch, yaw;
    double pitch_rate, yaw_rate;  // rad/s
    bool locks_yaw = false;       // hold the direction instead of following the vehicle
    bool is_yaw_from_north = false;
};

class GimbalMotion {
public:
    static constexpr double pitch_lowest = to_radians(-90), pitch_highest = to_radians(30);
    static constexpr double fastest = to_radians(90);  // rad/s, each axis

    // `heading` is that of the vehicle.
    void aim(const GimbalAim& aim, double heading) noexcept;
    // Straight ahead, level.
    void center(double heading) noexcept;
    void step(double dt) noexcept;

    [[nodiscard]] bool is_locked() const noexcept { return locked_; }
    [[nodiscard]] double pitch() const noexcept { return pitch_.angle; }
    [[nodiscard]] double pitch_rate() const noexcept { return pitch_.rate; }
    // From north if locked, else from the vehicle's nose.
    [[nodiscard]] double yaw() const noexcept { return yaw_.angle; }
    [[nodiscard]] double yaw_rate() const noexcept { return yaw_.rate; }
    [[nodiscard]] double yaw_in_vehicle(double heading) const noexcept;
    [[nodiscard]] double yaw_from_north(double heading) const noexcept;

private:
    struct Axis {
        double angle = 0, rate = 0;
        double target = 0, wanted_rate = 0;
        void order(double to, double at_rate) noexcept;
        void step(double dt, double lowest, double highest) noexcept;
    };
    void lock(bool locked, double heading) noexcept;

    Axis pitch_, yaw_;
    bool locked_ = false;
};

}  // namespace mavloom::sim
