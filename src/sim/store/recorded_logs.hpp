// SPDX-License-Identifier: MIT
// The logs that a vehicle has recorded, for download. Private to module sim; single owner.
//
// Their content is computed from system id and number, so that logs take no memory: a header that readers of the format
// accept, then records of a fixed length. PX4 writes ULog, ArduPilot DataFlash. Sources: PX4 guide, "ULog File Format";
// ArduPilot's developer documentation, "Log Message Types".
#pragma once

#include <cstdint>
#include <string>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::sim {

// The bytes of one log. The same arguments give the same bytes.
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

    bool is_px4_;
    SystemId system_;
    std::uint16_t number_;
    ByteView header_;
    std::uint32_t size_;
};

class RecordedLogs {
public:
    explicit RecordedLogs(const VehicleOptions& options) noexcept;

    [[nodiscard]] std::uint16_t count() const noexcept { return count_; }
    void erase() noexcept { count_ = 0; }

    // `index` counts from 0, the oldest; the newest log began when the vehicle booted.
    [[nodiscard]] LogImage image(std::uint16_t index) const noexcept;
    // The epoch if unknown.
    [[nodiscard]] WallTime began_at(std::uint16_t index) const noexcept;
    // Without leading slash: log/2026-11-21/00_54_50.ulg, APM/LOGS/00000001.BIN.
    [[nodiscard]] std::string path(std::uint16_t index) const;
    // The folder of all logs, which FTP clients may call @MAV_LOG.
    [[nodiscard]] std::string_view folder() const noexcept { return is_px4_ ? "log" : "APM/LOGS"; }
    // The number that LOG_ENTRY has for the first log: PX4 counts from 0, ArduPilot from 1.
    [[nodiscard]] std::uint16_t first_id() const noexcept { return is_px4_ ? 0 : 1; }

private:
    bool is_px4_;
    SystemId system_;
    WallTime booted_;
    std::uint16_t count_, recorded_;
};

}  // namespace mavloom::sim
