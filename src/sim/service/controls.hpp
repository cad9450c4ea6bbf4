// SPDX-License-Identifier: MIT
// Messages by which clients steer the vehicle directly: sticks, set-points, a target to follow, home and origin.
// Private to module sim; single owner. Source: MAVLink common.xml; PX4 guide, "Offboard Mode"; ArduPilot's developer
// guide, "Copter Commands in Guided Mode".
//
// A field counts as not given if the message's mask excludes it, or if it is NaN. A message without a given field, or
// with an infinite one, has no effect. The vehicle reports that by a text, at most once a second.
#pragma once

#include <array>
#include <string_view>

#include "flight/orders.hpp"
#include "sim/service/service.hpp"

namespace mavloom::sim {

using flight::Result;  // and not mavloom::Result

struct Parts;

class Controls final : public Service {
public:
    explicit Controls(Parts& parts) noexcept;

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;
    void reboot() override { channels_ = {}; }

private:
    void on_manual_control(const Client& from, ByteView payload);
    void on_channels(const Client& from, ByteView payload);
    void on_local_target(ByteView payload, Moment now);
    void on_global_target(ByteView payload, Moment now);
    void on_attitude_target(ByteView payload, Moment now);
    void on_actuator_target(ByteView payload, Moment now);
    void on_follow_target(ByteView payload);
    void on_origin(ByteView payload);
    void on_home(ByteView payload);

    // Whether this client may steer. An ArduPilot parameter can limit steering to one ground station; a PX4 parameter
    // can turn it off.
    [[nodiscard]] bool may_steer(const Client& from) const noexcept;
    [[nodiscard]] Sticks sticks_of_channels() const noexcept;
    [[nodiscard]] double channel(std::string_view map) const noexcept;
    [[nodiscard]] bool needs_all_axes() const noexcept;
    void complete(OffboardSetpoint& setpoint) const noexcept;
    void steer(OffboardSetpoint setpoint, std::string_view message, Moment now);
    void reject(std::string_view message, Moment now);

    Parts& parts_;
    static constexpr std::size_t channel_count = 18;
    std::array<std::uint16_t, channel_count> channels_{};  // us, as overridden; 0: not overridden
    FlightTime rejected_;                                  // when the last text about a rejected message was sent
};

}  // namespace mavloom::sim
