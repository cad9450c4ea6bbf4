// SPDX-License-Identifier: MIT
// The vehicles of a simulator: passes received frames to their targets, and advances each vehicle when it is due.
// Private to module simserve; single owner thread. Opens nothing and reads no clock.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mavloom/base/ids.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/sim/vehicle.hpp"
#include "simserve/schedule.hpp"

namespace mavloom::simserve {

// The rates and the limit of the telemetry that all vehicles send on one link.
struct LinkRates {
    std::optional<sim::Profile> profile;  // empty: the usual profile of each vehicle's autopilot
    std::uint32_t max_bytes_s = 0;        // of telemetry, in a second of the flight; 0: no limit
    std::uint32_t line_bytes_s = 0;       // what a serial line carries; 0: another link
    std::vector<sim::MessageRate> rates{};
};

class Fleet {
public:
    // `sink` must outlive the object.
    explicit Fleet(sim::Sink& sink) noexcept : sink_(sink) {}
    Fleet(const Fleet&) = delete;
    Fleet& operator=(const Fleet&) = delete;

    // Adds a vehicle before any link is opened. Refuses a system id that another vehicle has (`usage`).
    [[nodiscard]] SetupResult<void> add(const sim::VehicleOptions& options, sim::Moment now);

    // All vehicles stream on the link from now on.
    void open(LinkId link, const LinkRates& rates, sim::Moment now);
    void close(LinkId link);

    // Passes a frame from an open link to the vehicle that it targets, or to all vehicles.
    void receive(LinkId link, const wire::FrameView& frame, const wire::MessageInfo* info, sim::Moment now);

    // The flight time at which `advance` has something to do.
    [[nodiscard]] sim::FlightTime next_due() const noexcept { return schedule_.due(); }
    // Advances all vehicles that are due.
    void advance(sim::Moment now);

    [[nodiscard]] std::size_t size() const noexcept { return vehicles_.size(); }
    // Null if no vehicle has this id.
    [[nodiscard]] sim::Vehicle* find(SystemId system) const noexcept;
    // Calls `use(vehicle)` for each vehicle, in the order in which they were added. Call `reschedule` if `use` changes
    // the vehicle.
    template <class Use>
    void each(Use&& use) const {
        for (const Member& member : vehicles_) use(*member.vehicle);
    }
    // Call it after other code has changed a vehicle.
    void reschedule(const sim::Vehicle& vehicle, sim::Moment now) noexcept;

private:
    struct Member {
        std::unique_ptr<sim::Vehicle> vehicle;
        sim::Autopilot autopilot;
        SystemId system;  // its id in `by_system_`; a reboot may change the vehicle's own id
    };
    using Index = Schedule::Index;
    static constexpr std::uint16_t nobody = 0xFFFF;

    void note_system(Index index) noexcept;
    void note_due(Index index, sim::Moment now) noexcept;

    sim::Sink& sink_;
    std::vector<Member> vehicles_;
    std::array<std::uint16_t, 256> by_system_ = [] {
        std::array<std::uint16_t, 256> none{};
        none.fill(nobody);
        return none;
    }();
    Schedule schedule_;
};

}  // namespace mavloom::simserve
