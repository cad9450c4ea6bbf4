// SPDX-License-Identifier: MIT
#include "flight/wire_units.hpp"
#include "mavloom/msg/actuator_control_target.hpp"
#include "mavloom/msg/actuator_output_status.hpp"
#include "mavloom/msg/esc_info.hpp"
#include "mavloom/msg/esc_status.hpp"
#include "mavloom/msg/rc_channels.hpp"
#include "mavloom/msg/servo_output_raw.hpp"
#include "sim/payload/servo_outputs.hpp"
#include "sim/telemetry/projections.hpp"

namespace mavloom::sim {

namespace {

constexpr std::size_t servo_channels = 16;
constexpr std::size_t escs_in_message = 4;

// Pulse widths in us. A motor at rest gets 900 from PX4 and 1000 from ArduPilot. Channels without a motor or servo are
// 900 and 0.
std::array<std::uint16_t, servo_channels> pulse_widths(const View& view) noexcept {
    const Channels& channels = view.flight.plant().channels();
    const bool is_px4 = view.firmware.is_px4();
    std::array<std::uint16_t, servo_channels> widths;
    widths.fill(is_px4 ? 900 : 0);
    for (std::size_t i = 0; i < channels.used; ++i) {
        const double output = view.flight.outputs()[i];
        if (!channels.is_motor[i]) {
            widths[i] = saturated<std::uint16_t>(1500 + 500 * output);
        } else if (view.flight.armed()) {
            widths[i] = saturated<std::uint16_t>(1000 + 1000 * output);
        } else {
            widths[i] = is_px4 ? 900 : 1000;
        }
    }
    if (view.servos != nullptr)
        for (std::size_t i = channels.used; i < servo_channels; ++i)
            if (const std::uint16_t set = view.servos->pulses()[i]; set != 0) widths[i] = set;
    return widths;
}

template <class Message>
void fill_servos(Message& m, const std::array<std::uint16_t, servo_channels>& widths) noexcept {
    std::size_t i = 0;
    for (std::uint16_t* const field :
         {&m.servo1_raw, &m.servo2_raw, &m.servo3_raw, &m.servo4_raw, &m.servo5_raw, &m.servo6_raw, &m.servo7_raw,
          &m.servo8_raw, &m.servo9_raw, &m.servo10_raw, &m.servo11_raw, &m.servo12_raw, &m.servo13_raw, &m.servo14_raw,
          &m.servo15_raw, &m.servo16_raw})
        *field = widths[i++];
}

// The outputs of the motors that a message of four ESCs has room for.
struct Motors {
    std::array<double, escs_in_message> outputs{};
    std::uint8_t count = 0;
};
Motors motors_of(const View& view) noexcept {
    const Channels& channels = view.flight.plant().channels();
    Motors motors;
    for (std::size_t i = 0; i < channels.used && motors.count < escs_in_message; ++i)
        if (channels.is_motor[i]) motors.outputs[motors.count++] = view.flight.outputs()[i];
    return motors;
}

// Roll, pitch, yaw (-1 to 1) and thrust (0 to 1) behind the outputs of a quadrotor in X form: front right, rear left,
// front left, rear right. The first two motors turn counter-clockwise.
std::array<double, 4> quad_controls(const Outputs& o) noexcept {
    return {(o[1] + o[2] - o[0] - o[3]) / 4, (o[0] + o[2] - o[1] - o[3]) / 4, (o[0] + o[1] - o[2] - o[3]) / 4,
            (o[0] + o[1] + o[2] + o[3]) / 4};
}

// A plane has ailerons, elevator, throttle and rudder, a rover throttle and steering.
std::array<double, 4> controls_of(Kind kind, const Outputs& o) noexcept {
    switch (kind) {
        case Kind::quad: return quad_controls(o);
        case Kind::plane: return {o[0], o[1], o[3], o[2]};
        case Kind::rover: return {0, 0, o[1], o[0]};
    }
    return {};
}

// An ESC that fails sends nothing, or, as with PX4, a tenth of voltage and current and ten times the speed.
void fail_escs(const Failures& failures, std::size_t count, msg::EscStatus& message) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
        if ((failures.wrong_escs >> i & 1) != 0) {
            message.rpm[i] *= 10;
            message.voltage[i] /= 10;
            message.current[i] /= 10;
        }
        if ((failures.silent_escs >> i & 1) != 0) message.rpm[i] = 0, message.voltage[i] = message.current[i] = 0;
    }
}

// Pulse widths in us of a stick from -1 to 1.
std::uint16_t stick(double value) noexcept {
    return saturated<std::uint16_t>(1500 + 500 * std::clamp(value, -1.0, 1.0));
}

}  // namespace

bool write_servo_output_raw(const View& view, ByteSpan payload) {
    msg::ServoOutputRaw message{.time_usec = static_cast<std::uint32_t>(boot_us(view))};
    fill_servos(message, pulse_widths(view));
    return put(message, payload);
}

bool write_actuator_control_target(const View& view, ByteSpan payload) {
    msg::ActuatorControlTarget message{.time_usec = boot_us(view)};
    const auto controls = controls_of(view.options.kind, view.flight.outputs());
    if (view.flight.armed()) std::ranges::transform(controls, message.controls.begin(), as_float);
    return put(message, payload);
}

bool write_actuator_output_status(const View& view, ByteSpan payload) {
    const std::size_t used = view.flight.plant().channels().used;
    msg::ActuatorOutputStatus message{.time_usec = boot_us(view), .active = (1u << used) - 1};
    for (std::size_t i = 0; i < used; ++i) message.actuator[i] = as_float(view.flight.outputs()[i]);
    return put(message, payload);
}

bool write_esc_info(const View& view, ByteSpan payload) {
    constexpr std::int16_t temperature = 5000;  // 50 degC, the constant of PX4's simulator
    const std::uint8_t count = motors_of(view).count;
    if (count == 0) return false;
    const unsigned heard = ((1u << count) - 1) & ~unsigned{view.flight.sensors().failures().silent_escs};
    msg::EscInfo message{.time_usec = boot_us(view), .count = count, .info = static_cast<std::uint8_t>(heard)};
    for (std::size_t i = 0; i < count; ++i)
        if ((heard >> i & 1) != 0) message.temperature[i] = temperature;
    return put(message, payload);
}

// Thrust grows with the square of the speed; at full output a motor turns 10000 times a minute, as in PX4's simulator.
bool write_esc_status(const View& view, ByteSpan payload) {
    constexpr double full_speed = 10'000;
    const Motors motors = motors_of(view);
    if (motors.count == 0) return false;
    msg::EscStatus message{.time_usec = boot_us(view)};
    const bool turns = view.flight.armed();
    for (std::size_t i = 0; turns && i < motors.count; ++i) {
        message.rpm[i] = saturated<std::int32_t>(full_speed * std::sqrt(std::max(motors.outputs[i], 0.0)));
        message.voltage[i] = as_float(view.flight.battery().voltage());
        message.current[i] = as_float(view.flight.battery().current() / motors.count);
    }
    fail_escs(view.flight.sensors().failures(), motors.count, message);
    return put(message, payload);
}

// Channels in the order roll, pitch, throttle, yaw. Stick forward gives a short pulse of the pitch channel, as remote
// controls do. Four switches follow.
bool write_rc_channels(const View& view, ByteSpan payload) {
    constexpr std::uint16_t low = 1000, high = 1800, unused = 0xffff;
    const bool has_sticks = view.flight.has_sticks();
    const Sticks sticks = view.flight.sticks();
    return put(msg::RcChannels{.time_boot_ms = boot_ms(view),
                               .chancount = 8,
                               .chan1_raw = has_sticks ? stick(sticks.roll) : stick(0),
                               .chan2_raw = has_sticks ? stick(-sticks.pitch) : stick(0),
                               .chan3_raw = has_sticks ? stick(2 * sticks.throttle - 1) : low,
                               .chan4_raw = has_sticks ? stick(sticks.yaw) : stick(0),
                               .chan5_raw = high,
                               .chan6_raw = low,
                               .chan7_raw = low,
                               .chan8_raw = high,
                               .chan9_raw = unused,
                               .chan10_raw = unused,
                               .chan11_raw = unused,
                               .chan12_raw = unused,
                               .chan13_raw = unused,
                               .chan14_raw = unused,
                               .chan15_raw = unused,
                               .chan16_raw = unused,
                               .chan17_raw = unused,
                               .chan18_raw = unused,
                               .rssi = 254},
               payload);
}

}  // namespace mavloom::sim
