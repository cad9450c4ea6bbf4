// SPDX-License-Identifier: MIT
// Messages by which clients steer the vehicle directly: sticks, set-points, a target to follow, home and origin.
// Private to module sim; single owner. Source: MAVLink common.xml.
#pragma once

#include <array>
#include <functional>
#include <string_view>

#include "flight/firmware/firmware.hpp"
#include "flight/flight.hpp"
#include "flight/orders.hpp"
#include "sim/control/ardupilot_setpoints.hpp"
#include "sim/control/px4_setpoints.hpp"
#include "sim/radio/radio.hpp"
#include "sim/service/service.hpp"

namespace mavloom::sim {

class Controls final : public Service {
public:
    // Moves the origin of the local frame, and reports it.
    using SetOrigin = std::function<void(const GeoPoint& origin)>;
    Controls(const Firmware& firmware, const Parameters& parameters, Flight& flight, const Radio& radio,
             FlightObserver& observer, SetOrigin set_origin) noexcept;

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;
    void reboot() override { channels_ = {}; }

private:
    void on_manual_control(const Client& from, ByteView payload);
    void on_channels(const Client& from, ByteView payload);
    void on_setpoint(MessageId id, ByteView payload, Moment now);
    void on_follow_target(ByteView payload);
    void on_origin(ByteView payload);
    void on_home(ByteView payload);

    // Whether this client may steer. An ArduPilot parameter can limit steering to one ground station; a PX4 parameter
    // can turn it off.
    [[nodiscard]] bool may_steer(const Client& from) const noexcept;
    [[nodiscard]] Sticks sticks_of_channels() const noexcept;
    [[nodiscard]] double channel(std::string_view map) const noexcept;

    const Firmware& firmware_;
    const Parameters& parameters_;
    Flight& flight_;
    const Radio& radio_;
    SetOrigin set_origin_;
    Px4Setpoints px4_;
    ArdupilotSetpoints ardupilot_;
    static constexpr std::size_t channel_count = 18;
    std::array<std::uint16_t, channel_count> channels_{};  // us, as overridden; 0: not overridden
};

}  // namespace mavloom::sim
