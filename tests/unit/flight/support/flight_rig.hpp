// SPDX-License-Identifier: MIT
// A Flight on a test bench, without MAVLink: the test gives orders, steps it and reads what it announced.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "flight/firmware/firmware.hpp"
#include "flight/flight.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/enums/mav_frame.hpp"

namespace mavloom::flight::test {

// Can be armed at once.
inline constexpr VehicleOptions ready{.ready_after = Nanoseconds{0}};

class FlightRig : public FlightObserver {
public:
    explicit FlightRig(const VehicleOptions& given = {})
        : options(given),
          firmware(Firmware::of(options.autopilot, options.kind)),
          parameters(firmware.parameters()),
          flight(options, firmware, parameters, *this) {}

    void step() {
        flight.step();
        if (landed.empty() || landed.back() != flight.landed()) landed.push_back(flight.landed());
        if (modes.empty() || modes.back() != flight.mode().name) modes.emplace_back(flight.mode().name);
    }
    void run(double seconds, const std::function<void()>& look = {}) {
        for (long i = std::lround(seconds / step_s); i > 0; --i) {
            step();
            if (look) look();
        }
    }
    // False: the condition did not hold within `limit` seconds.
    [[nodiscard]] bool run_until(const std::function<bool()>& condition, double limit) {
        for (double t = 0; t < limit && !condition(); t += step_s) step();
        return condition();
    }
    void set(std::string_view name, double value) {
        ASSERT_TRUE(parameters.find(name)) << name;
        parameters.put(name, value);
        flight.retune();
    }
    [[nodiscard]] Outcome set_mode(std::string_view name) {
        return flight.set_mode(*firmware.find_mode(name), OrderedBy::client);
    }
    [[nodiscard]] Outcome arm() { return flight.arm(false, OrderedBy::client); }
    [[nodiscard]] Outcome disarm() { return flight.disarm(false, OrderedBy::client); }

    // Waits for the start-up, arms, and hovers at a height. ArduPilot's copter does so in Guided.
    void take_off(double height) {
        ASSERT_TRUE(run_until([&] { return (flight.unready() & ~unsigned{unready_mode}) == 0; }, 5));
        if (!firmware.is_px4() && options.kind == Kind::quad) {
            ASSERT_TRUE(set_mode("GUIDED").is_accepted());
        }
        ASSERT_TRUE(arm().is_accepted());
        ASSERT_TRUE(flight.take_off({.altitude = flight.ground_altitude() + height}).is_accepted());
        ASSERT_TRUE(run_until([&] { return flight.landed() == LandedState::in_air; }, 90));
        run(6);
    }
    [[nodiscard]] const Vector3& place() const { return flight.estimate().position; }
    [[nodiscard]] double height() const { return -place().z(); }
    [[nodiscard]] double ground_speed() const { return flight.estimate().velocity.head<2>().norm(); }
    [[nodiscard]] double seconds() const { return std::chrono::duration<double>(flight.since_boot()).count(); }
    [[nodiscard]] std::string_view mode() const { return flight.mode().name; }
    [[nodiscard]] bool was_said(std::string_view text) const { return std::ranges::find(texts, text) != texts.end(); }
    // Metres north and east of the home of the options.
    [[nodiscard]] GeoPoint point(double north, double east, double height) const {
        return flight.frame().to_geo({north, east, -height});
    }

    // A mission item with a place above home.
    [[nodiscard]] PlanItem item(std::uint16_t command, double north, double east, double height,
                                std::array<float, 4> params = {}) const {
        const GeoPoint at = point(north, east, height);
        return {.command = command,
                .frame = msg::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT,
                .params = params,
                .x = to_degrees_e7(at.latitude),
                .y = to_degrees_e7(at.longitude),
                .z = static_cast<float>(height)};
    }
    [[nodiscard]] static PlanItem action(std::uint16_t command, std::array<float, 4> params = {}) {
        return {.command = command, .frame = msg::MAV_FRAME_MISSION, .params = params};
    }
    void upload(PlanType type, std::vector<PlanItem> items) {
        flight.plans().of(type).replace(std::move(items));
        flight.on_plan_changed(type);
    }

    void on_text(Severity /*severity*/, std::string_view text) override { texts.emplace_back(text); }
    void on_state_changed() override { ++state_changes; }
    void on_home_changed() override { ++home_changes; }
    void on_mission_progress() override { ++progress_changes; }
    void on_item_reached(std::uint16_t seq) override { reached.push_back(seq); }
    void on_payload_item(const PlanItem& item) override { payload.push_back(item.command); }

    VehicleOptions options;
    const Firmware& firmware;
    Parameters parameters;
    std::vector<std::string> texts, modes;  // in their order; modes and landed states without repeats
    std::vector<LandedState> landed;
    std::vector<std::uint16_t> reached, payload;
    int state_changes = 0, home_changes = 0, progress_changes = 0;
    Flight flight;
};

}  // namespace mavloom::flight::test
