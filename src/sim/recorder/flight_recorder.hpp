// SPDX-License-Identifier: MIT
// Records each flight from arming to disarming, and writes the log of a finished flight when a client reads it. Private
// to module sim; single owner.
//
// A flight is a row of records: samples of the vehicle's state, texts and changes of mode. All flights together have at
// most Limits::log_records of them; they are allocated at the first arming. At each arming, the oldest flights go until
// half of the records are free. If a flight fills what is left, it continues with half as many samples a second; if
// texts and changes of mode alone fill it, the rest of the flight is lost.
#pragma once

#include <optional>
#include <vector>

#include "flight/flight.hpp"
#include "sim/radio/radio.hpp"
#include "sim/recorder/format.hpp"

namespace mavloom::sim {

class FlightRecorder {
public:
    // The arguments must outlive the object.
    FlightRecorder(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters,
                   const Flight& flight, const Radio& radio) noexcept;

    // Call it after each step of the flight. Allocates only when the vehicle is armed or disarmed.
    void step() {
        if (flight_.armed() || is_recording_) advance();
    }
    // A text that the vehicle announces.
    void note(Severity severity, std::string_view text);
    // The vehicle boots at this flight time.
    void reboot(FlightTime now) noexcept { booted_ = now; }
    // Forgets the finished flights.
    void erase();

    // --- Finished flights, the oldest first.
    [[nodiscard]] std::uint16_t count() const noexcept { return static_cast<std::uint16_t>(flights_.size()); }
    // Flights since the object was created that are no longer here. So flight `index` has the number dropped() + index.
    [[nodiscard]] std::uint32_t dropped() const noexcept { return dropped_; }
    [[nodiscard]] WallTime began_at(std::uint16_t index) const noexcept { return flights_[index].head.began; }
    [[nodiscard]] std::uint32_t size(std::uint16_t index) const noexcept { return flights_[index].size; }
    // Returns the number of bytes written to `out`: fewer than requested at the end of the log. Allocates in the header
    // of a log only.
    std::size_t read(std::uint16_t index, std::uint32_t offset, ByteSpan out) const;

    static constexpr Nanoseconds sample_interval = std::chrono::milliseconds{200};

private:
    struct RecordedFlight {
        LogHead head;
        std::size_t begin = 0, end = 0;  // in records_
        std::uint32_t header_size = 0, size = 0;
    };

    // The header of the log that is being read.
    struct ReadHeader {
        std::uint32_t flight = 0;  // its number
        std::vector<std::uint8_t> bytes;
    };

    void advance();
    void begin();
    // Drops the oldest flights, so that a flight with so many changed parameters can begin.
    void make_room(std::size_t changed);
    void finish();
    void drop_oldest();
    void add(FlightTime time, const LogContent& content);
    void thin_out();
    [[nodiscard]] LogHead head(FlightTime now) const;
    void read_header(std::uint16_t index, std::uint32_t offset, ByteSpan out) const;
    std::size_t read_record(const RecordedFlight& flight, std::uint32_t offset, ByteSpan out) const;
    [[nodiscard]] Sample sample() const;
    [[nodiscard]] std::uint8_t index_of(const ModeInfo& mode) const noexcept;
    [[nodiscard]] WallTime utc_at(FlightTime since_boot) const noexcept;

    const VehicleOptions& options_;
    const Firmware& firmware_;
    const Parameters& parameters_;
    const Flight& flight_;
    const Radio& radio_;
    const LogFormat& format_;
    const LogSource source_;
    std::vector<LogRecord> records_;  // of the finished flights and of the present one
    std::vector<RecordedFlight> flights_;
    RecordedFlight present_;
    mutable ReadHeader header_;
    Nanoseconds interval_ = sample_interval;
    FlightTime next_sample_{};
    FlightTime booted_{};
    std::uint32_t dropped_ = 0;
    std::uint8_t mode_ = 0;
    bool is_recording_ = false;
    bool is_full_ = false;  // no record has room, and no sample can go
};

}  // namespace mavloom::sim
