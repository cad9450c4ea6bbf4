// SPDX-License-Identifier: MIT
// A vehicle that another program flies: plant, sensors, the wind around it, and its place on earth. Private to hil;
// single owner; nothing allocates after construction.
#pragma once

#include <memory>

#include "flight/faults.hpp"
#include "flight/physics/sensors.hpp"
#include "flight/physics/wind.hpp"
#include "hil/further_imus.hpp"
#include "mavloom/flight/options.hpp"
#include "mavloom/hil/sensor_rates.hpp"

namespace mavloom::hil {

using flight::Vector3;

class SensedVehicle {
public:
    SensedVehicle(const flight::VehicleOptions& options, const SensorRates& rates);

    // Advances by one step with these outputs. Returns false if the motion was no longer finite, so that the vehicle
    // is back at its start.
    [[nodiscard]] bool step(const flight::Outputs& outputs);
    // Puts it at rest where it started.
    void place_at_start();
    // Within `push_time`, the velocity (m/s, local frame) and the rates (rad/s, body frame) change by so much, unless
    // wheels hold the vehicle.
    static constexpr double push_time = 0.5;  // s
    void push(const Vector3& velocity, const Vector3& rates);
    void set_wind(const flight::Wind& wind);
    void set_mass(double kg) { plant_->set_mass(kg); }
    // A fault on purpose. It stays until it is ended, also when the vehicle is put at its start.
    void fail(const flight::Fault& fault);

    [[nodiscard]] std::span<const flight::Fault> faults() const noexcept { return faults_.list(); }
    [[nodiscard]] const flight::Kinematics& truth() const noexcept { return plant_->motion(); }
    [[nodiscard]] const flight::Sensors& sensors() const noexcept { return sensors_; }
    [[nodiscard]] const FurtherImus& further_imus() const noexcept { return further_imus_; }
    [[nodiscard]] flight::Kind kind() const noexcept { return options_.kind; }
    [[nodiscard]] const flight::Channels& channels() const noexcept { return plant_->channels(); }
    [[nodiscard]] bool touches_ground() const noexcept { return plant_->touches_ground(); }
    [[nodiscard]] flight::GeoPoint geo(const Vector3& local) const { return frame_.to_geo(local); }
    // Velocity relative to the air, m/s in the body frame.
    [[nodiscard]] Vector3 air_velocity() const { return truth().attitude.conjugate() * plant_->air_velocity(); }
    [[nodiscard]] double air_density() const noexcept { return around_.air_density; }  // kg/m^3

private:
    void sense();

    const flight::VehicleOptions options_;
    const double step_s_;
    std::unique_ptr<flight::Plant> plant_;
    flight::Sensors sensors_;
    FurtherImus further_imus_;
    flight::Faults faults_;
    flight::WindField wind_;
    flight::LocalFrame frame_;
    flight::Surroundings around_;
    unsigned push_left_ = 0;  // steps
};

}  // namespace mavloom::hil
