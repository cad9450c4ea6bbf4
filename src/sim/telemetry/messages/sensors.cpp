// SPDX-License-Identifier: MIT
#include "flight/physics/sensors.hpp"

#include "flight/wire_units.hpp"
#include "mavloom/msg/distance_sensor.hpp"
#include "mavloom/msg/enums/highres_imu_updated_flags.hpp"
#include "mavloom/msg/enums/mav_sensor_orientation.hpp"
#include "mavloom/msg/highres_imu.hpp"
#include "mavloom/msg/raw_imu.hpp"
#include "mavloom/msg/scaled_imu.hpp"
#include "mavloom/msg/scaled_imu2.hpp"
#include "mavloom/msg/scaled_imu3.hpp"
#include "mavloom/msg/scaled_pressure.hpp"
#include "mavloom/msg/vibration.hpp"
#include "sim/telemetry/projections.hpp"

namespace mavloom::sim {

namespace {

constexpr std::uint16_t all_updated = 0x1fff;

// RAW_IMU and the SCALED_IMU messages: mG, mrad/s, mgauss and 0.01 degC.
template <class Message>
Message imu_message(const ImuSample& imu) noexcept {
    const auto milli = [](double value) { return saturated<std::int16_t>(value * 1e3); };
    Message message;
    message.xacc = milli(imu.acceleration.x() / gravity);
    message.yacc = milli(imu.acceleration.y() / gravity);
    message.zacc = milli(imu.acceleration.z() / gravity);
    message.xgyro = milli(imu.rates.x());
    message.ygyro = milli(imu.rates.y());
    message.zgyro = milli(imu.rates.z());
    message.xmag = milli(imu.magnetic.x());
    message.ymag = milli(imu.magnetic.y());
    message.zmag = milli(imu.magnetic.z());
    message.temperature = saturated<std::int16_t>(imu.temperature_c * 100);
    return message;
}

template <class Message>
bool write_scaled(const View& view, ByteSpan payload) {
    auto message = imu_message<Message>(view.flight.sensors().imu());
    message.time_boot_ms = boot_ms(view);
    return put(message, payload);
}

}  // namespace

bool write_highres_imu(const View& view, ByteSpan payload) {
    const ImuSample& imu = view.flight.sensors().imu();
    const bool has_airspeed = view.options.kind == Kind::plane;
    const bool is_off = view.flight.sensors().failures().airspeed == Failure::off;
    const unsigned absent = has_airspeed && !is_off ? 0 : unsigned{msg::HIGHRES_IMU_UPDATED_DIFF_PRESSURE};
    return put(msg::HighresImu{.time_usec = boot_us(view),
                               .xacc = as_float(imu.acceleration.x()),
                               .yacc = as_float(imu.acceleration.y()),
                               .zacc = as_float(imu.acceleration.z()),
                               .xgyro = as_float(imu.rates.x()),
                               .ygyro = as_float(imu.rates.y()),
                               .zgyro = as_float(imu.rates.z()),
                               .xmag = as_float(imu.magnetic.x()),
                               .ymag = as_float(imu.magnetic.y()),
                               .zmag = as_float(imu.magnetic.z()),
                               .abs_pressure = as_float(imu.pressure_hpa),
                               .diff_pressure = as_float(imu.differential_hpa),
                               .pressure_alt = as_float(imu.pressure_altitude),
                               .temperature = as_float(imu.temperature_c),
                               .fields_updated = static_cast<std::uint16_t>(all_updated & ~absent)},
               payload);
}

bool write_raw_imu(const View& view, ByteSpan payload) {
    auto message = imu_message<msg::RawImu>(view.flight.sensors().imu());
    message.time_usec = boot_us(view);
    return put(message, payload);
}

bool write_scaled_imu(const View& view, ByteSpan payload) { return write_scaled<msg::ScaledImu>(view, payload); }
bool write_scaled_imu2(const View& view, ByteSpan payload) { return write_scaled<msg::ScaledImu2>(view, payload); }
bool write_scaled_imu3(const View& view, ByteSpan payload) { return write_scaled<msg::ScaledImu3>(view, payload); }

bool write_scaled_pressure(const View& view, ByteSpan payload) {
    const ImuSample& imu = view.flight.sensors().imu();
    return put(msg::ScaledPressure{.time_boot_ms = boot_ms(view),
                                   .press_abs = as_float(imu.pressure_hpa),
                                   .press_diff = as_float(imu.differential_hpa),
                                   .temperature = saturated<std::int16_t>(imu.temperature_c * 100)},
               payload);
}

// A laser that looks down, with a range of 100 m. As in PX4, the signal is invalid (1) on the ground and out of range,
// and unknown (0) in between.
bool write_distance_sensor(const View& view, ByteSpan payload) {
    constexpr double range = 100, lowest = 0.05;
    const Failure failure = view.flight.sensors().failures().rangefinder;
    if (failure == Failure::off) return false;
    const double height = failure == Failure::stuck ? view.flight.last_range() : height_of(view);
    const bool is_valid = height > lowest && height <= range;
    return put(msg::DistanceSensor{.time_boot_ms = boot_ms(view),
                                   .max_distance = 100 * static_cast<std::uint16_t>(range),
                                   .current_distance = saturated<std::uint16_t>(100 * std::min(height, range)),
                                   .orientation = msg::MAV_SENSOR_ROTATION_PITCH_270,
                                   .signal_quality = static_cast<std::uint8_t>(is_valid ? 0 : 1)},
               payload);
}

bool write_vibration(const View& view, ByteSpan payload) {
    const double level = view.flight.sensors().vibration();
    return put(msg::Vibration{.time_usec = boot_us(view),
                              .vibration_x = as_float(0.8 * level),
                              .vibration_y = as_float(0.9 * level),
                              .vibration_z = as_float(level)},
               payload);
}

}  // namespace mavloom::sim
