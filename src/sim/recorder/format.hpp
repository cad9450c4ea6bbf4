// SPDX-License-Identifier: MIT
// The formats in which vehicles write the logs of their flights: PX4 ULog, ArduPilot DataFlash. Private to module sim;
// a format is immutable and shared by all vehicles.
//
// Sources: PX4 guide, "ULog File Format", with the topics of PX4 1.17; ArduPilot's developer documentation, "Log
// Message Types", with the messages of ArduPilot 4.6. docs/guide/sim.md lists what a log contains.
#pragma once

#include <cstring>

#include "flight/firmware/firmware.hpp"
#include "mavloom/base/bytes.hpp"
#include "sim/recorder/record.hpp"

namespace mavloom::sim {

// The vehicle that writes the log.
struct LogSource {
    const Firmware& firmware;
    std::uint8_t battery_cells = 0;
};

// Writes little-endian values one after another.
class ByteWriter {
public:
    explicit ByteWriter(ByteSpan out) noexcept : out_(out) {}
    template <class T>
    void put(T value) noexcept {
        store_le(out_.data() + at_, value);
        at_ += sizeof value;
    }
    // With zeros up to `width`.
    void put_text(std::string_view text, std::size_t width) noexcept {
        std::memset(out_.data() + at_, 0, width);
        std::memcpy(out_.data() + at_, text.data(), std::min(text.size(), width));
        at_ += width;
    }
    [[nodiscard]] std::size_t size() const noexcept { return at_; }

private:
    ByteSpan out_;
    std::size_t at_ = 0;
};

// Appends with zeros up to `width`.
inline void append(std::vector<std::uint8_t>& to, std::string_view text, std::size_t width = 0) {
    to.insert(to.end(), text.begin(), text.end());
    to.resize(to.size() + (width > text.size() ? width - text.size() : 0));
}
template <class T>
void append_number(std::vector<std::uint8_t>& to, T value) {
    const std::size_t at = to.size();
    to.resize(at + sizeof value);
    store_le(to.data() + at, value);
}

class LogFormat {
public:
    [[nodiscard]] static const LogFormat& of(bool is_px4) noexcept;
    virtual ~LogFormat() = default;

    // Everything before the first record: definitions, parameters, version.
    [[nodiscard]] virtual std::vector<std::uint8_t> header(const LogSource& source, const LogHead& head) const = 0;
    [[nodiscard]] virtual std::uint32_t size(const LogRecord& record) const noexcept = 0;
    static constexpr std::size_t largest_record = 512;
    // Writes the bytes of a record to `out`, which has `largest_record` bytes.
    virtual void write(const LogSource& source, const LogHead& head, const LogRecord& record,
                       ByteSpan out) const noexcept = 0;

    // For a log of nothing but attitudes: everything before the first one, the size of one, and its bytes.
    [[nodiscard]] virtual std::vector<std::uint8_t> attitude_header() const = 0;
    [[nodiscard]] virtual std::uint32_t attitude_size() const noexcept = 0;
    virtual void write_attitude(std::uint64_t time_us, const Quaternion& attitude, ByteSpan out) const noexcept = 0;
};

[[nodiscard]] const LogFormat& ulog_format() noexcept;
[[nodiscard]] const LogFormat& dataflash_format() noexcept;

[[nodiscard]] inline std::uint64_t time_us(const LogRecord& record) noexcept { return record.time_ms * 1000ull; }
[[nodiscard]] inline Quaternion attitude_of(const Sample& sample) noexcept {
    const auto part = [&](std::size_t i) { return sample.attitude[i] / 32767.0; };
    return Quaternion(part(0), part(1), part(2), part(3)).normalized();
}
// UTC at a record; the epoch if unknown.
[[nodiscard]] inline WallTime utc_of(const LogHead& head, const LogRecord& record) noexcept {
    if (head.began == WallTime{}) return {};
    return head.began + std::chrono::milliseconds(std::int64_t{record.time_ms} - head.began_ms);
}

}  // namespace mavloom::sim
