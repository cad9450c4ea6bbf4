// SPDX-License-Identifier: MIT
#include "sim/store/recorded_logs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

#include "flight/physics/math.hpp"
#include "sim/recorder/format.hpp"
#include "sim/store/calendar.hpp"

namespace mavloom::sim {

namespace {

// The same for all vehicles.
ByteView header_of(const LogFormat& format) {
    static const std::vector<std::uint8_t> ulog = ulog_format().attitude_header(),
                                           flash = dataflash_format().attitude_header();
    return &format == &ulog_format() ? ulog : flash;
}

// 20 to 200 KiB.
std::uint32_t records_of(std::uint32_t record, SystemId system, std::uint16_t number) noexcept {
    constexpr std::uint32_t least = 20 * 1024, spread = 178 * 1024;
    return (least + (number * 28'657u + system.value * 10'946u) % spread) / record;
}

constexpr Nanoseconds between_logs = std::chrono::hours{1};
constexpr std::size_t max_logs = 1000;

}  // namespace

LogImage::LogImage(bool is_px4, SystemId system, std::uint16_t number) noexcept
    : format_(&LogFormat::of(is_px4)),
      system_(system),
      number_(number),
      header_(header_of(*format_)),
      size_(header_size() + records_of(record_size(), system, number) * record_size()) {}

LogImage LogImage::endless(bool is_px4, SystemId system) noexcept {
    LogImage image(is_px4, system, 0);
    image.size_ = std::numeric_limits<std::uint32_t>::max();
    return image;
}

std::uint32_t LogImage::record_size() const noexcept { return format_->attitude_size(); }

std::size_t LogImage::read(std::uint32_t offset, ByteSpan out) const noexcept {
    if (offset >= size_) return 0;
    const std::size_t length = std::min<std::size_t>(out.size(), size_ - offset);
    std::array<std::uint8_t, LogFormat::largest_record> record;
    for (std::size_t done = 0; done < length;) {
        const std::uint32_t at = offset + static_cast<std::uint32_t>(done);
        ByteView rest = header_.subspan(std::min<std::size_t>(at, header_.size()));
        if (rest.empty()) {
            const std::uint32_t in_records = at - header_size();
            write_record(in_records / record_size(), record);
            rest = ByteView(record).first(record_size()).subspan(in_records % record_size());
        }
        const std::size_t part = std::min(rest.size(), length - done);
        std::memcpy(out.data() + done, rest.data(), part);
        done += part;
    }
    return length;
}

// The vehicle turns slowly; system and number decide where it begins.
void LogImage::write_record(std::uint32_t index, ByteSpan record) const noexcept {
    const auto time = static_cast<std::uint64_t>(index * (record_interval / std::chrono::microseconds{1}));
    const double yaw = 0.01 * index + 0.1 * number_ + system_.value;
    format_->write_attitude(time, Quaternion(flight::math::cos(yaw / 2), 0, 0, flight::math::sin(yaw / 2)), record);
}

RecordedLogs::RecordedLogs(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters,
                           const Flight& flight, const Radio& radio) noexcept
    : is_px4_(options.autopilot == Autopilot::px4),
      system_(options.system),
      booted_(options.utc_at_start),
      old_(static_cast<std::uint16_t>(std::min(options.logs, max_logs))),
      brought_(old_),
      recorder_(options, firmware, parameters, flight, radio) {}

void RecordedLogs::erase() {
    old_ = 0;
    recorder_.erase();
}

std::uint32_t RecordedLogs::serial(std::uint16_t index) const noexcept {
    return is_old(index) ? index : brought_ + recorder_.dropped() + index - old_;
}

std::optional<std::uint16_t> RecordedLogs::index_of(std::uint32_t number) const noexcept {
    if (number < brought_) return number < old_ ? std::optional(static_cast<std::uint16_t>(number)) : std::nullopt;
    const std::uint32_t first = brought_ + recorder_.dropped();
    if (number < first || number - first >= recorder_.count()) return std::nullopt;
    return static_cast<std::uint16_t>(old_ + number - first);
}

std::uint32_t RecordedLogs::size(std::uint16_t index) const noexcept {
    if (is_old(index)) return LogImage(is_px4_, system_, index).size();
    return recorder_.size(static_cast<std::uint16_t>(index - old_));
}

std::size_t RecordedLogs::read(std::uint16_t index, std::uint32_t offset, ByteSpan out) const {
    if (is_old(index)) return LogImage(is_px4_, system_, index).read(offset, out);
    return recorder_.read(static_cast<std::uint16_t>(index - old_), offset, out);
}

// The newest log that the vehicle brought along began when the vehicle was created.
WallTime RecordedLogs::began_at(std::uint16_t index) const noexcept {
    if (!is_old(index)) return recorder_.began_at(static_cast<std::uint16_t>(index - old_));
    if (booted_ == WallTime{}) return {};
    return booted_ - between_logs * (brought_ - 1 - index);
}

std::string RecordedLogs::path(std::uint16_t index) const {
    const std::uint32_t number = serial(index) + 1;
    if (!is_px4_) return fmt::format("{}/{:08}.BIN", folder(), number);
    const WallTime began = began_at(index);
    if (began == WallTime{}) return fmt::format("{}/sess{:03}/log100.ulg", folder(), number);  // PX4, time unknown
    const Calendar at = calendar_of(began);
    return fmt::format("{}/{:04}-{:02}-{:02}/{:02}_{:02}_{:02}.ulg", folder(), at.year, at.month, at.day, at.hour,
                       at.minute, at.second);
}

}  // namespace mavloom::sim
