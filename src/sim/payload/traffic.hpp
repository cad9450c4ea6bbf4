// SPDX-License-Identifier: MIT
// Other aircraft around home, as an ADS-B receiver hears them: ADSB_VEHICLE. Private to module sim; single owner.
//
// Each aircraft flies a racetrack, or a circle, at its own height and speed, and transmits once a second. Its position
// depends only on the flight time and the vehicle's seed. Source: MAVLink common.xml, ADSB_VEHICLE.
#pragma once

#include <vector>

#include "flight/physics/geodesy.hpp"
#include "flight/physics/random.hpp"
#include "mavloom/sim/vehicle.hpp"
#include "sim/radio/radio.hpp"
#include "sim/service/service.hpp"
#include "sim/telemetry/streams.hpp"

namespace mavloom::sim {

struct Aircraft {
    std::uint32_t icao = 0;
    std::array<char, 9> callsign{};
    std::uint16_t squawk = 0;
    std::uint8_t emitter = 0;            // ADSB_EMITTER_TYPE
    Vector3 center = Vector3::Zero();    // of the racetrack, from home
    double direction = 0;                // rad, of the straights
    double straight = 0, radius = 1000;  // m
    double speed = 60;                   // m/s
    double start = 0;                    // m along the track at time 0
    double swing = 0, swing_time = 300;  // m and s: the height varies a little

    struct Motion {
        Vector3 position, velocity;  // from home
    };
    [[nodiscard]] Motion at(double seconds) const;
};

[[nodiscard]] Aircraft make_aircraft(Random& random);

class Traffic final : public Service {
public:
    // The first aircraft transmits soon after `now`.
    Traffic(const VehicleOptions& options, Radio& radio, const Streams& streams, FlightTime now);

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override { return {}; }
    void receive(const Client&, MessageId, ByteView, Moment) override {}
    [[nodiscard]] FlightTime wakes_at() const noexcept override { return next_; }
    void pump(Moment now) override;

private:
    static constexpr std::size_t max_aircraft = 64;
    static constexpr Nanoseconds period = std::chrono::seconds{1};

    void transmit(const Aircraft& aircraft, std::uint64_t round, FlightTime now);

    const VehicleOptions& options_;
    Radio& radio_;
    const Streams& streams_;
    std::vector<Aircraft> aircraft_;
    std::uint64_t turns_ = 0;  // transmissions so far; the aircraft take turns
    FlightTime next_ = FlightTime::max();
    MonoTime last_pump_{};
    std::size_t caught_up_ = 0;  // pumps at the same real time, which happen after a stall
};

}  // namespace mavloom::sim
