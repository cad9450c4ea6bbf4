// SPDX-License-Identifier: MIT
// A plant with its pilot, without a flight around them.
#pragma once

#include "flight/pilot/pilot.hpp"

namespace mavloom::flight::test {

class Piloted {
public:
    explicit Piloted(Kind kind, const Body& body = {})
        : plant_(make_plant(kind, body)), pilot_(make_pilot(kind, body)) {}

    void step(const Setpoint& setpoint, bool armed, const Surroundings& around) {
        outputs_ = pilot_->step(setpoint, armed, *plant_, around);
        plant_->step(outputs_, around, step_s);
    }
    void place(const Vector3& position, double heading) {
        plant_->place(position, heading);
        pilot_->start(motion());
    }
    void move_origin(const Vector3& by) {
        plant_->move_origin(by);
        pilot_->move_origin(by);
    }

    [[nodiscard]] const Kinematics& motion() const { return plant_->motion(); }
    [[nodiscard]] const InnerTargets& targets() const { return pilot_->targets(); }
    [[nodiscard]] const Outputs& outputs() const { return outputs_; }
    [[nodiscard]] const Channels& channels() const { return plant_->channels(); }
    [[nodiscard]] bool touches_ground() const { return plant_->touches_ground(); }
    [[nodiscard]] double thrust() const { return plant_->thrust(); }
    [[nodiscard]] double load() const { return plant_->load(); }
    [[nodiscard]] const Vector3& air_velocity() const { return plant_->air_velocity(); }

private:
    std::unique_ptr<Plant> plant_;
    std::unique_ptr<Pilot> pilot_;
    Outputs outputs_{};
};

}  // namespace mavloom::flight::test
