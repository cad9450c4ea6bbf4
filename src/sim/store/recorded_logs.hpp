// SPDX-License-Identifier: MIT
// The logs that a vehicle has recorded, for download. Private to module sim; single owner.
//
// A vehicle brings logs along, so that clients have something to download at once. Their content is computed from
// system id and number, and takes no memory: a header that readers of the format accept, then records of a fixed length
// with an attitude. Each flight adds a log (recorder/flight_recorder.hpp). PX4 writes ULog, ArduPilot DataFlash.
// Sources: PX4 guide, "ULog File Format"; ArduPilot's developer documentation, "Log Message Types".
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/sim/flight.hpp"
#include "sim/recorder/flight_recorder.hpp"

namespace mavloom::sim {

// The bytes of a log that the vehicle brings along. The same arguments give the same bytes.
class LogImage {
public:
    LogImage(bool is_px4, SystemId system, std::uint16_t number) noexcept;
    // A log that is still being written: it never ends, with one record every `record_interval`.
    [[nodiscard]] static LogImage endless(bool is_px4, SystemId system) noexcept;
    static constexpr Nanoseconds record_interval = std::chrono::milliseconds{20};

    [[nodiscard]] std::uint32_t size() const noexcept { return size_; }
    // Returns the number of bytes written to `out`: fewer than requested at the end of the log.
    std::size_t read(std::uint32_t offset, ByteSpan out) const noexcept;
    // The size of the header. The first record begins there.
    [[nodiscard]] std::uint32_t header_size() const noexcept { return static_cast<std::uint32_t>(header_.size()); }
    [[nodiscard]] std::uint32_t record_size() const noexcept;

private:
    void write_record(std::uint32_t index, ByteSpan record) const noexcept;

    const LogFormat* format_;
    SystemId system_;
    std::uint16_t number_;
    ByteView header_;
    std::uint32_t size_;
};

// The list of all logs, the oldest first: those that the vehicle brings along, then those of its flights.
class RecordedLogs {
public:
    // The arguments must outlive the object.
    RecordedLogs(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters,
                 const Flight& flight, const Radio& radio) noexcept;

    [[nodiscard]] FlightRecorder& recorder() noexcept { return recorder_; }
    [[nodiscard]] std::uint16_t count() const noexcept { return static_cast<std::uint16_t>(old_ + recorder_.count()); }
    // Those that the vehicle brings along and that are still there: they come first.
    [[nodiscard]] std::uint16_t brought_along() const noexcept { return old_; }
    void erase();

    // `index` counts from 0, the oldest. When a log goes, the indices of the others change, but not their serials.
    [[nodiscard]] std::uint32_t serial(std::uint16_t index) const noexcept;
    // Empty if that log is gone.
    [[nodiscard]] std::optional<std::uint16_t> index_of(std::uint32_t serial) const noexcept;

    [[nodiscard]] std::uint32_t size(std::uint16_t index) const noexcept;
    // Returns the number of bytes written to `out`: fewer than requested at the end of the log.
    std::size_t read(std::uint16_t index, std::uint32_t offset, ByteSpan out) const;
    // The epoch if unknown.
    [[nodiscard]] WallTime began_at(std::uint16_t index) const noexcept;
    // Without leading slash: log/2026-11-21/00_54_50.ulg, APM/LOGS/00000001.BIN.
    [[nodiscard]] std::string path(std::uint16_t index) const;
    // The folder of all logs, which FTP clients may call @MAV_LOG.
    [[nodiscard]] std::string_view folder() const noexcept { return is_px4_ ? "log" : "APM/LOGS"; }
    // The number that LOG_ENTRY has for the first log: PX4 counts from 0, ArduPilot from 1.
    [[nodiscard]] std::uint16_t first_id() const noexcept { return is_px4_ ? 0 : 1; }

private:
    [[nodiscard]] bool is_old(std::uint16_t index) const noexcept { return index < old_; }

    bool is_px4_;
    SystemId system_;
    WallTime booted_;
    std::uint16_t old_, brought_;  // logs that it brought along: still there, and in all
    FlightRecorder recorder_;
};

}  // namespace mavloom::sim
