// SPDX-License-Identifier: MIT
// A vehicle with an autopilot of the test.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "mavloom/hil/pair.hpp"
#include "mavloom/msg/distance_sensor.hpp"
#include "mavloom/msg/hil_actuator_controls.hpp"
#include "mavloom/msg/hil_gps.hpp"
#include "mavloom/msg/hil_sensor.hpp"
#include "mavloom/msg/hil_state_quaternion.hpp"
#include "mavloom/wire/struct_frame.hpp"

namespace mavloom::hil::test {

inline constexpr Source px4{SystemId{7}, ComponentId{1}};
// PX4 ignores a group of fields without all of its bits.
inline constexpr std::uint32_t inertial = 0x3f, magnetic = 0x1c0, pressure = 0x1a00;

// The messages of one step.
struct Step {
    std::vector<std::uint32_t> ids;
    std::vector<Source> sources;
    std::vector<std::uint8_t> sequence;
    msg::HilSensor sensor{};
    std::vector<msg::HilSensor> further{};  // of other IMUs
    std::optional<msg::HilGps> gps{};
    std::optional<msg::HilStateQuaternion> truth{};
    std::optional<msg::DistanceSensor> distance{};

    void note(const msg::HilSensor& imu) {
        if (imu.id_ == 0) sensor = imu;
        else further.push_back(imu);
    }
};

class PairRig : public ::testing::Test {
protected:
    explicit PairRig() {
        options.speed = any_speed;
        options.utc_at_start = WallTime{std::chrono::seconds{1'790'000'000}};
    }
    void begin() {
        pair.emplace(options);
        pair->begin(now);
    }
    template <class Message>
    Heard send(const Message& message) {
        wire::FrameBuffer buffer;
        return pair->receive(wire::write_frame(buffer, {.source = px4}, message), now);
    }
    Step step() {
        now = std::max(now, pair->due());
        Step step;
        for (const auto& frame : pair->step(now)) {
            step.ids.push_back(frame.id().value);
            step.sources.push_back(frame.source());
            step.sequence.push_back(frame.sequence());
            if (frame.id() == msg::HilSensor::id) step.note(msg::HilSensor::decode(frame.payload()));
            if (frame.id() == msg::HilGps::id) step.gps = msg::HilGps::decode(frame.payload());
            if (frame.id() == msg::HilStateQuaternion::id)
                step.truth = msg::HilStateQuaternion::decode(frame.payload());
            if (frame.id() == msg::DistanceSensor::id) step.distance = msg::DistanceSensor::decode(frame.payload());
        }
        return step;
    }
    Heard answer(const Step& step, std::array<float, 16> controls = {}) {
        return send(msg::HilActuatorControls{
            .time_usec = step.sensor.time_usec, .controls = controls, .mode = 129, .flags = 1});
    }
    // Steps that are all answered with the same controls.
    std::vector<Step> fly(int steps, std::array<float, 16> controls = {}) {
        std::vector<Step> all;
        all.reserve(static_cast<std::size_t>(steps));
        for (int i = 0; i < steps; ++i) {
            all.push_back(step());
            answer(all.back(), controls);
        }
        return all;
    }
    static std::array<float, 16> four(float value) { return {value, value, value, value}; }

    PairOptions options;
    MonoTime now{std::chrono::hours{1}};
    std::optional<Pair> pair;
};

}  // namespace mavloom::hil::test
