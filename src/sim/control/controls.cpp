// SPDX-License-Identifier: MIT
#include "sim/control/controls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mavloom/msg/follow_target.hpp"
#include "mavloom/msg/manual_control.hpp"
#include "mavloom/msg/rc_channels_override.hpp"
#include "mavloom/msg/set_actuator_control_target.hpp"
#include "mavloom/msg/set_attitude_target.hpp"
#include "mavloom/msg/set_gps_global_origin.hpp"
#include "mavloom/msg/set_home_position.hpp"
#include "mavloom/msg/set_position_target_global_int.hpp"
#include "mavloom/msg/set_position_target_local_ned.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

constexpr std::array control_messages{msg::ManualControl::id,
                                      RcChannelsOverride::id,
                                      SetPositionTargetLocalNed::id,
                                      SetPositionTargetGlobalInt::id,
                                      SetAttitudeTarget::id,
                                      SetActuatorControlTarget::id,
                                      FollowTarget::id,
                                      SetGpsGlobalOrigin::id,
                                      SetHomePosition::id};

// INT16_MAX marks an axis that the client does not have.
double axis(std::int16_t value) noexcept {
    return value == std::numeric_limits<std::int16_t>::max() ? nan : value / 1000.0;
}

}  // namespace

Controls::Controls(const Firmware& firmware, const Parameters& parameters, Flight& flight, const Radio& radio,
                   FlightObserver& observer, SetOrigin set_origin) noexcept
    : firmware_(firmware),
      parameters_(parameters),
      flight_(flight),
      radio_(radio),
      set_origin_(std::move(set_origin)),
      px4_(flight, observer),
      ardupilot_(firmware.kind(), flight, observer) {}

std::span<const MessageId> Controls::handled() const noexcept { return control_messages; }

void Controls::receive(const Client& from, MessageId id, ByteView payload, Moment now) {
    if (id == msg::ManualControl::id) return on_manual_control(from, payload);
    if (id == RcChannelsOverride::id) return on_channels(from, payload);
    if (id == FollowTarget::id) return on_follow_target(payload);
    if (id == SetGpsGlobalOrigin::id) return on_origin(payload);
    if (id == SetHomePosition::id) return on_home(payload);
    on_setpoint(id, payload, now);
}

// Only PX4 takes set-points of actuators.
void Controls::on_setpoint(MessageId id, ByteView payload, Moment now) {
    const bool is_px4 = firmware_.is_px4();
    if (id == SetPositionTargetLocalNed::id)
        return is_px4 ? px4_.on_local_target(payload, now) : ardupilot_.on_local_target(payload);
    if (id == SetPositionTargetGlobalInt::id)
        return is_px4 ? px4_.on_global_target(payload, now) : ardupilot_.on_global_target(payload);
    if (id == SetAttitudeTarget::id)
        return is_px4 ? px4_.on_attitude_target(payload, now) : ardupilot_.on_attitude_target(payload);
    if (is_px4) px4_.on_actuator_target(payload, now);
}

// --- Sticks

bool Controls::may_steer(const Client& from) const noexcept {
    if (firmware_.is_px4()) {
        const double source = parameters_.get("COM_RC_IN_MODE", 1);
        constexpr double radio_only = 0, off = 4;
        return source != radio_only && source != off;
    }
    return parameters_.get("SYSID_ENFORCE") == 0 || parameters_.get("SYSID_MYGCS") == from.id.system.value;
}

void Controls::on_manual_control(const Client& from, ByteView payload) {
    const auto m = msg::ManualControl::decode(payload);
    if ((m.target != 0 && m.target != radio_.system().value) || !may_steer(from)) return;
    const Sticks sticks{.pitch = axis(m.x), .roll = axis(m.y), .yaw = axis(m.r), .throttle = axis(m.z)};
    const bool has_no_axis = std::isnan(sticks.pitch) && std::isnan(sticks.roll) && std::isnan(sticks.yaw) &&
                             std::isnan(sticks.throttle);
    if (!has_no_axis) flight_.on_sticks(sticks);
}

// UINT16_MAX keeps a channel. 0 gives it back to the remote control; for channels 9 and more, 0 keeps it, too, and
// UINT16_MAX - 1 gives it back. The simulated remote control stands in its middle.
void Controls::on_channels(const Client& from, ByteView payload) {
    if (firmware_.is_px4() || !may_steer(from)) return;
    const auto m = RcChannelsOverride::decode(payload);
    const std::array given{m.chan1_raw,  m.chan2_raw,  m.chan3_raw,  m.chan4_raw,  m.chan5_raw,  m.chan6_raw,
                           m.chan7_raw,  m.chan8_raw,  m.chan9_raw,  m.chan10_raw, m.chan11_raw, m.chan12_raw,
                           m.chan13_raw, m.chan14_raw, m.chan15_raw, m.chan16_raw, m.chan17_raw, m.chan18_raw};
    constexpr std::uint16_t keep = 0xffff, give_back = 0xfffe;
    constexpr std::size_t first_extended = 8;
    for (std::size_t i = 0; i < channel_count; ++i) {
        const bool is_extended = i >= first_extended;
        if (given[i] == keep || (is_extended && given[i] == 0)) continue;
        channels_[i] = is_extended && given[i] == give_back ? std::uint16_t{0} : given[i];
    }
    flight_.on_sticks(sticks_of_channels());
}

// -1 to 1; nan: the channel is not overridden. The parameter `map` holds the channel's number.
double Controls::channel(std::string_view map) const noexcept {
    const double number = parameters_.get(map, 1);
    const std::uint16_t pulse = channels_[static_cast<std::size_t>(std::clamp(number, 1.0, double{channel_count})) - 1];
    return pulse == 0 ? nan : (pulse - 1500.0) / 500;
}

// A long pulse on the pitch channel lifts the nose, so that the stick is back.
Sticks Controls::sticks_of_channels() const noexcept {
    return {.pitch = -channel("RCMAP_PITCH"),
            .roll = channel("RCMAP_ROLL"),
            .yaw = channel("RCMAP_YAW"),
            .throttle = (channel("RCMAP_THROTTLE") + 1) / 2};
}

// --- The rest

void Controls::on_follow_target(ByteView payload) {
    const auto m = FollowTarget::decode(payload);
    flight_.on_target({from_degrees_e7(m.lat), from_degrees_e7(m.lon), double{m.alt}},
                      {double{m.vel[0]}, double{m.vel[1]}, double{m.vel[2]}});
}

void Controls::on_origin(ByteView payload) {
    const auto m = SetGpsGlobalOrigin::decode(payload);
    set_origin_({from_degrees_e7(m.latitude), from_degrees_e7(m.longitude), m.altitude * 1e-3});
}

void Controls::on_home(ByteView payload) {
    const auto m = SetHomePosition::decode(payload);
    const GeoPoint home{from_degrees_e7(m.latitude), from_degrees_e7(m.longitude), m.altitude * 1e-3};
    if (!firmware_.is_px4()) (void)flight_.set_home(home, nan);
}

}  // namespace mavloom::sim
