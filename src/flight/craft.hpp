// SPDX-License-Identifier: MIT
// A vehicle without its decisions: plant, pilot, battery, sensors, the wind around it, and its place on earth. Private
// to flight; single owner; `step` allocates nothing.
#pragma once

#include <memory>
#include <optional>

#include "flight/physics/battery.hpp"
#include "flight/physics/geodesy.hpp"
#include "flight/physics/sensors.hpp"
#include "flight/physics/wind.hpp"
#include "flight/pilot/pilot.hpp"
#include "mavloom/flight/moment.hpp"
#include "mavloom/flight/options.hpp"

namespace mavloom::flight {

class Craft {
public:
    explicit Craft(const VehicleOptions& options);

    // Advance by one step of 4 ms: under the craft's own pilot, or with the outputs of a foreign autopilot.
    void step(const Setpoint& setpoint, bool armed);
    void step(const Outputs& outputs, bool armed);
    // Puts the vehicle at rest at a place of the local frame, which may be in the air.
    void place(const Vector3& position, double heading);
    // How often the motion was no longer finite, so that the vehicle was put back at its home, at rest.
    [[nodiscard]] unsigned not_finite() const noexcept { return not_finite_; }
    // Boots the vehicle again where it stands.
    void reboot();

    [[nodiscard]] Kind kind() const noexcept { return kind_; }
    [[nodiscard]] FlightTime since_boot() const noexcept { return time_; }
    [[nodiscard]] const Plant& plant() const noexcept { return *plant_; }
    [[nodiscard]] const Kinematics& truth() const noexcept { return plant_->motion(); }
    // The outputs of the last step.
    [[nodiscard]] const Outputs& outputs() const noexcept { return outputs_; }
    // Of the craft's own pilot.
    [[nodiscard]] InnerTargets targets() const;
    [[nodiscard]] const Estimate& estimate() const noexcept { return sensors_.estimate(); }
    [[nodiscard]] const Vector3& wind() const noexcept { return wind_.velocity(); }
    [[nodiscard]] const Sensors& sensors() const noexcept { return sensors_; }
    [[nodiscard]] Sensors& sensors() noexcept { return sensors_; }
    [[nodiscard]] const Battery& battery() const noexcept { return battery_; }
    [[nodiscard]] Battery& battery() noexcept { return battery_; }

    void set_failures(const Failures& failures);
    // The last range before the range finder failed, m.
    [[nodiscard]] double last_range() const noexcept { return last_range_; }
    void set_deceptions(const Deceptions& deceptions) { sensors_.set_deceptions(deceptions); }

    [[nodiscard]] const LocalFrame& frame() const noexcept { return frame_; }
    // True once a client has set the origin, or once a position was known.
    [[nodiscard]] bool has_origin() const noexcept { return has_origin_; }
    // Returns the offset that every owner of local positions must add to them.
    Vector3 set_origin(const GeoPoint& origin);
    void acquire_gps() noexcept;
    // The estimated position. It is computed at the first call after each step.
    [[nodiscard]] const GeoPoint& position() const;
    [[nodiscard]] double ground_altitude() const noexcept { return ground_altitude_; }  // m above mean sea level
    [[nodiscard]] double ground_z() const noexcept { return frame_.origin().altitude - ground_altitude_; }
    // Estimated height above the ground, m.
    [[nodiscard]] double height() const noexcept { return ground_z() - estimate().position.z(); }
    [[nodiscard]] double speed() const noexcept;  // horizontal, m/s

    [[nodiscard]] const std::optional<GeoPoint>& home() const noexcept { return home_; }
    // The place of home in the local frame; without a home, the place where the vehicle started.
    [[nodiscard]] const Vector3& home_place() const noexcept { return home_place_; }
    [[nodiscard]] double home_yaw() const noexcept { return home_yaw_; }
    void set_home(const GeoPoint& point, double yaw);

private:
    [[nodiscard]] Surroundings surroundings() const;
    void move(const Outputs& outputs, bool armed);
    void put_back();
    void sense();

    const Kind kind_;
    const double ground_altitude_;
    std::unique_ptr<Plant> plant_;
    std::unique_ptr<Pilot> pilot_;
    Outputs outputs_{};
    Battery battery_;
    Sensors sensors_;
    WindField wind_;
    LocalFrame frame_;
    std::optional<GeoPoint> home_;
    Vector3 home_place_ = Vector3::Zero();
    double home_yaw_ = 0, air_density_, last_range_ = 0;
    FlightTime time_{};
    unsigned not_finite_ = 0;
    bool has_origin_ = false;
    mutable GeoPoint position_;
    mutable bool position_is_old_ = true;
};

}  // namespace mavloom::flight
