// SPDX-License-Identifier: MIT
// Writes what a vehicle's sensors measured in a step as the HIL messages that PX4 reads. Private to hil; single owner;
// nothing allocates.
//
// PX4 takes a group of fields of HIL_SENSOR only if `fields_updated` has all bits of the group. It believes that a
// sensor is stale when a hundred samples are equal. So without noise, the last digit of the magnetometer and of the
// barometer goes up and down.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "hil/sensed_vehicle.hpp"
#include "mavloom/flight/moment.hpp"
#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::hil {

// The times of a regular message.
class Beat {
public:
    // 0: never.
    void set(Nanoseconds interval, flight::FlightTime from) noexcept {
        interval_ = interval;
        due_ = from;
    }
    [[nodiscard]] bool is_due(flight::FlightTime now) noexcept {
        if (interval_ <= Nanoseconds{} || now < due_) return false;
        due_ = std::max(due_ + interval_, now - interval_);
        return true;
    }

private:
    Nanoseconds interval_{};
    flight::FlightTime due_{};
};

class SensorMessages {
public:
    SensorMessages(const SensorRates& rates, WallTime utc_at_start);

    // HIL_STATE_QUATERNION is sent this often; 0: never.
    void send_truth_each(Nanoseconds interval, flight::FlightTime now) noexcept { truth_.set(interval, now); }
    // For flight controllers, which listen on USB only after they heard one.
    void send_heartbeats() noexcept { heartbeat_.set(std::chrono::seconds{1}, {}); }
    void set_source(Source source) noexcept { source_ = source; }
    [[nodiscard]] Source source() const noexcept { return source_; }
    // A fix that waits for its delay is forgotten.
    void forget_fixes() noexcept { waiting_ = 0; }

    // The frames of the step that ended at `now`, valid until the next call. HIL_SENSOR of the first IMU comes first.
    [[nodiscard]] std::span<const wire::FrameView> write(const SensedVehicle& vehicle, flight::FlightTime now);

private:
    struct Fix {
        flight::FlightTime measured{};
        flight::GpsFix gps;
    };
    static constexpr std::size_t max_frames = 8, max_waiting = 32;

    template <class Message>
    void add(const Message& message);
    void add_sensors(const SensedVehicle& vehicle, flight::FlightTime now);
    void add_further_imus(const SensedVehicle& vehicle, flight::FlightTime now);
    void add_fix(const SensedVehicle& vehicle, const Fix& fix);
    void add_fixes(const SensedVehicle& vehicle, flight::FlightTime now);
    void add_truth(const SensedVehicle& vehicle, flight::FlightTime now);
    void add_distance(const SensedVehicle& vehicle, flight::FlightTime now);
    void add_heartbeat();

    const WallTime utc_at_start_;
    const Nanoseconds gps_delay_;
    Source source_{};
    std::uint8_t sequence_ = 0;
    Beat truth_, distance_, heartbeat_;
    unsigned magnetic_samples_ = 0, pressure_samples_ = 0;
    double distance_m_ = 0;                 // as last measured
    std::array<Fix, max_waiting> fixes_{};  // those that wait, the oldest first
    std::size_t waiting_ = 0;
    std::array<wire::FrameBuffer, max_frames> buffers_{};
    std::array<wire::FrameView, max_frames> frames_{};
    std::size_t used_ = 0;
};

}  // namespace mavloom::hil
