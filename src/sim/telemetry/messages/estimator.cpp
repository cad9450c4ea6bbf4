// SPDX-License-Identifier: MIT
#include "flight/physics/math.hpp"
#include "flight/wire_units.hpp"
#include "mavloom/msg/ekf_status_report.hpp"
#include "mavloom/msg/enums/estimator_sensor_fusion_source.hpp"
#include "mavloom/msg/enums/estimator_status_flags.hpp"
#include "mavloom/msg/estimator_sensor_fusion_status.hpp"
#include "mavloom/msg/estimator_status.hpp"
#include "mavloom/msg/wind_cov.hpp"
#include "sim/telemetry/projections.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

// ESTIMATOR_STATUS_FLAGS; EKF_STATUS_FLAGS has the same bits.
constexpr unsigned constant_position = ESTIMATOR_CONST_POS_MODE;
constexpr unsigned absolute_position = ESTIMATOR_POS_HORIZ_ABS | ESTIMATOR_PRED_POS_HORIZ_ABS;
constexpr unsigned without_position = ESTIMATOR_ATTITUDE | ESTIMATOR_VELOCITY_HORIZ | ESTIMATOR_VELOCITY_VERT |
                                      ESTIMATOR_POS_HORIZ_REL | ESTIMATOR_POS_VERT_ABS | ESTIMATOR_PRED_POS_HORIZ_REL;

// PX4 also reports a constant position while the vehicle rests on the ground.
unsigned estimator_flags(const View& view) noexcept {
    const bool is_grounded = view.flight.landed() == LandedState::on_ground;
    const bool has_position = view.flight.sensors().has_position();
    unsigned flags = without_position | (has_position ? absolute_position : constant_position);
    if (view.firmware.is_px4()) flags |= ESTIMATOR_POS_VERT_AGL | (is_grounded ? constant_position : 0);
    return flags;
}

// How far measurement and estimate differ, in relation to what the estimator accepts: squared, as PX4 has it.
struct TestRatios {
    float velocity, position, altitude;
};
TestRatios test_ratios(const View& view) noexcept {
    constexpr double gate = 5;  // standard deviations
    const GpsFix& fix = view.flight.sensors().gps();
    const Estimate& estimate = view.flight.estimate();
    const auto ratio = [](double difference, double deviation) {
        const double normalised = deviation > 0 ? difference / (gate * deviation) : 0;
        return as_float(std::clamp(normalised * normalised, 0.001, 0.5));
    };
    const Vector3 apart = fix.position - estimate.position;
    return {ratio((fix.velocity - estimate.velocity).norm(), fix.speed_m_s),
            ratio(flight::math::hypot(apart.x(), apart.y()), fix.horizontal_m), ratio(apart.z(), fix.vertical_m)};
}

constexpr float magnetometer_ratio = 0.07f, terrain_ratio = 0.003f;

}  // namespace

bool write_estimator_status(const View& view, ByteSpan payload) {
    const TestRatios ratios = test_ratios(view);
    const bool is_grounded = view.flight.landed() == LandedState::on_ground;
    return put(EstimatorStatus{.time_usec = boot_us(view),
                               .flags = static_cast<std::uint16_t>(estimator_flags(view)),
                               .vel_ratio = ratios.velocity,
                               .pos_horiz_ratio = ratios.position,
                               .pos_vert_ratio = ratios.altitude,
                               .mag_ratio = magnetometer_ratio,
                               .hagl_ratio = terrain_ratio,
                               .tas_ratio = float_nan,
                               .pos_horiz_accuracy = as_float(view.flight.sensors().position_accuracy()),
                               .pos_vert_accuracy = is_grounded ? 0.05f : 0.27f},
               payload);
}

// The range finder corrects the height only near the ground, as in PX4.
bool write_estimator_sensor_fusion_status(const View& view, ByteSpan payload) {
    constexpr double range_height = 5;  // m
    const Sensors& sensors = view.flight.sensors();
    EstimatorSensorFusionStatus message;
    const auto fuse = [&](std::size_t source, bool is_active) {
        message.intended[source] = 1;
        message.active[source] = is_active ? 1 : 0;
    };
    fuse(ESTIMATOR_SENSOR_FUSION_SOURCE_GPS, sensors.has_position());
    fuse(ESTIMATOR_SENSOR_FUSION_SOURCE_OF, false);
    fuse(ESTIMATOR_SENSOR_FUSION_SOURCE_BARO, !is_frozen(sensors.failures().barometer));
    fuse(ESTIMATOR_SENSOR_FUSION_SOURCE_RNG,
         sensors.failures().rangefinder == Failure::none && height_of(view) < range_height);
    fuse(ESTIMATOR_SENSOR_FUSION_SOURCE_MAG, !is_frozen(sensors.failures().magnetometer));
    message.test_ratio.fill(float_nan);
    return put(message, payload);
}

bool write_ekf_status_report(const View& view, ByteSpan payload) {
    const TestRatios ratios = test_ratios(view);
    return put(EkfStatusReport{.flags = static_cast<std::uint16_t>(estimator_flags(view)),
                               .velocity_variance = ratios.velocity,
                               .pos_horiz_variance = ratios.position,
                               .pos_vert_variance = ratios.altitude,
                               .compass_variance = magnetometer_ratio},
               payload);
}

// The wind's velocity; it points to where the air moves.
bool write_wind_cov(const View& view, ByteSpan payload) {
    const Vector3& wind = view.flight.wind();
    return put(WindCov{.time_usec = boot_us(view),
                       .wind_x = as_float(wind.x()),
                       .wind_y = as_float(wind.y()),
                       .wind_z = as_float(wind.z()),
                       .var_horiz = 0.25f,
                       .wind_alt = as_float(view.flight.position().altitude),
                       .horiz_accuracy = 0.5f},
               payload);
}

}  // namespace mavloom::sim
