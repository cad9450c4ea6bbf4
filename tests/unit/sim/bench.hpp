// SPDX-License-Identifier: MIT
// A vehicle that is ready to fly, and a client that commands it.
#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/command_int.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/statustext.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim::test {

inline constexpr float nan_f = std::numeric_limits<float>::quiet_NaN();
inline constexpr float inf_f = std::numeric_limits<float>::infinity();
inline constexpr double home_latitude = 47.397742, home_longitude = 8.545594;
inline constexpr float home_altitude = 489.4f;

// MAV_RESULT, or no answer.
enum Answer : int { accepted, temporarily_rejected, denied, unsupported, failed, in_progress, cancelled, none = -1 };

class Bench {
public:
    explicit Bench(Autopilot autopilot = Autopilot::px4, Kind kind = Kind::quad)
        : rig(VehicleOptions{.kind = kind, .autopilot = autopilot, .has_noise = false, .ready_after = Nanoseconds{0}}) {
        rig.run(0.5);
    }

    // COMMAND_LONG with up to seven parameters; the rest is 0.
    int command(int id, std::initializer_list<float> given, const Peer& peer = {}) {
        std::array<float, 7> p{};
        std::ranges::copy(given, p.begin());
        rig.forget();
        rig.send(msg::CommandLong{.target_system = 1,
                                  .target_component = 1,
                                  .command = static_cast<std::uint16_t>(id),
                                  .param1 = p[0],
                                  .param2 = p[1],
                                  .param3 = p[2],
                                  .param4 = p[3],
                                  .param5 = p[4],
                                  .param6 = p[5],
                                  .param7 = p[6]},
                 peer);
        return answer(id);
    }
    // COMMAND_INT with four parameters.
    int command_int(int id, int frame, std::array<float, 4> p, std::int32_t x, std::int32_t y, float z) {
        rig.forget();
        rig.send(msg::CommandInt{.target_system = 1,
                                 .target_component = 1,
                                 .frame = static_cast<std::uint8_t>(frame),
                                 .command = static_cast<std::uint16_t>(id),
                                 .param1 = p[0],
                                 .param2 = p[1],
                                 .param3 = p[2],
                                 .param4 = p[3],
                                 .x = x,
                                 .y = y,
                                 .z = z});
        return answer(id);
    }
    int answer(int id) const {
        const auto acknowledged = rig.last<msg::CommandAck>();
        return acknowledged && acknowledged->command == id ? int{acknowledged->result} : int{none};
    }
    std::string text() const {
        const auto message = rig.last<msg::Statustext>();
        return message ? std::string(message->text.data(), strnlen(message->text.data(), message->text.size())) : "";
    }
    VehicleStatus state() const { return rig.vehicle.status(); }

    int arm() { return command(400, {1}); }
    // Arms, climbs to 10 m above home and waits there. False: it does not.
    [[nodiscard]] bool fly() {
        if (state().autopilot == Autopilot::ardupilot && command(176, {1, 4}) != accepted) return false;
        if (state().autopilot == Autopilot::ardupilot && arm() != accepted) return false;
        const float altitude = state().autopilot == Autopilot::px4 ? home_altitude + 10 : 10;
        if (command(22, {-1, 0, 0, nan_f, nan_f, nan_f, altitude}) != accepted || arm() != accepted) return false;
        return rig.run_until([&] { return std::abs(state().relative_altitude_m - 10) < 0.3; }, 30) &&
               rig.run_until([&] { return state().landed == LandedState::in_air; }, 5);
    }
    double north() const { return (state().latitude_deg - home_latitude) * 111'180; }
    double east() const { return (state().longitude_deg - home_longitude) * 75'460; }

    Rig rig;
};

}  // namespace mavloom::sim::test
