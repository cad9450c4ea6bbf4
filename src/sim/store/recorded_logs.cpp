// SPDX-License-Identifier: MIT
#include "sim/store/recorded_logs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

#include "sim/store/calendar.hpp"

namespace mavloom::sim {

namespace {

using Bytes = std::vector<std::uint8_t>;

void append(Bytes& to, std::string_view text, std::size_t width = 0) {
    to.insert(to.end(), text.begin(), text.end());
    to.resize(to.size() + (width > text.size() ? width - text.size() : 0));
}

template <class T>
void append_number(Bytes& to, T value) {
    const std::size_t at = to.size();
    to.resize(at + sizeof value);
    store_le(to.data() + at, value);
}

// --- ULog: a length and a type, then the message.

constexpr std::uint16_t ulog_attitude = 0;
constexpr std::uint32_t ulog_payload = 2 + 8 + 4 * 4;  // message id, timestamp, q
constexpr std::uint32_t ulog_record = 2 + 1 + ulog_payload;

void append_ulog(Bytes& to, char type, std::string_view body) {
    append_number(to, static_cast<std::uint16_t>(body.size()));
    append(to, {&type, 1});
    append(to, body);
}

Bytes make_ulog_header() {
    Bytes header;
    append(header, "ULog\x01\x12\x35\x01");
    append_number(header, std::uint64_t{0});          // time of the start
    append_ulog(header, 'B', std::string(40, '\0'));  // flags: none
    append_ulog(header, 'F', "vehicle_attitude:uint64_t timestamp;float[4] q;");
    append_ulog(header, 'I',
                "\x10"
                "char[3] sys_namePX4");
    append_ulog(header, 'A', {"\0\0\0vehicle_attitude", 3 + 16});  // instance 0, message id 0
    return header;
}

// --- DataFlash: two bytes of synchronisation and a type, then the message.

constexpr std::uint8_t flash_head[2] = {0xa3, 0x95};
constexpr std::uint8_t flash_format = 128, flash_message = 129, flash_attitude = 130;
constexpr std::uint8_t flash_format_length = 3 + 86;
constexpr std::uint8_t flash_message_length = 3 + 8 + 64;
constexpr std::uint8_t flash_record = 3 + 8 + 3 * 4;

void append_head(Bytes& to, std::uint8_t type) { to.insert(to.end(), {flash_head[0], flash_head[1], type}); }

void append_format(Bytes& to, std::uint8_t type, std::uint8_t length, std::string_view name, std::string_view format,
                   std::string_view columns) {
    append_head(to, flash_format);
    to.insert(to.end(), {type, length});
    append(to, name, 4);
    append(to, format, 16);
    append(to, columns, 64);
}

Bytes make_flash_header() {
    Bytes header;
    append_format(header, flash_format, flash_format_length, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
    append_format(header, flash_message, flash_message_length, "MSG", "QZ", "TimeUS,Message");
    append_format(header, flash_attitude, flash_record, "ATT", "Qfff", "TimeUS,Roll,Pitch,Yaw");
    append_head(header, flash_message);
    append_number(header, std::uint64_t{0});
    append(header, "Simulated by Mavloom", 64);
    return header;
}

ByteView header_of(bool is_px4) {
    static const Bytes ulog = make_ulog_header(), flash = make_flash_header();
    return is_px4 ? ulog : flash;
}

// 20 to 200 KiB.
std::uint32_t records_of(std::uint32_t record, SystemId system, std::uint16_t number) noexcept {
    constexpr std::uint32_t least = 20 * 1024, spread = 178 * 1024;
    return (least + (number * 28'657u + system.value * 10'946u) % spread) / record;
}

constexpr Nanoseconds between_logs = std::chrono::hours{1};
constexpr std::size_t most_logs = 1000;

}  // namespace

LogImage::LogImage(bool is_px4, SystemId system, std::uint16_t number) noexcept
    : is_px4_(is_px4),
      system_(system),
      number_(number),
      header_(header_of(is_px4)),
      size_(header_size() + records_of(record_size(), system, number) * record_size()) {}

LogImage LogImage::endless(bool is_px4, SystemId system) noexcept {
    LogImage image(is_px4, system, 0);
    image.size_ = std::numeric_limits<std::uint32_t>::max();
    return image;
}

std::uint32_t LogImage::record_size() const noexcept { return is_px4_ ? ulog_record : flash_record; }

std::size_t LogImage::read(std::uint32_t offset, ByteSpan out) const noexcept {
    if (offset >= size_) return 0;
    const std::size_t length = std::min<std::size_t>(out.size(), size_ - offset);
    std::array<std::uint8_t, std::max<std::size_t>(ulog_record, flash_record)> record;
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
    std::uint8_t* at = record.data();
    const auto put = [&](auto value) {
        store_le(at, value);
        at += sizeof value;
    };
    if (is_px4_) {
        put(static_cast<std::uint16_t>(ulog_payload));
        put(std::uint8_t{'D'});
        put(ulog_attitude);
        put(time);
        for (const double q : {std::cos(yaw / 2), 0.0, 0.0, std::sin(yaw / 2)}) put(static_cast<float>(q));
    } else {
        put(flash_head[0]);
        put(flash_head[1]);
        put(flash_attitude);
        put(time);
        for (const double angle : {0.0, 0.0, yaw}) put(static_cast<float>(angle));
    }
}

RecordedLogs::RecordedLogs(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters,
                           const Flight& flight, const Radio& radio) noexcept
    : is_px4_(options.autopilot == Autopilot::px4),
      system_(options.system),
      booted_(options.utc_at_start),
      old_(static_cast<std::uint16_t>(std::min(options.logs, most_logs))),
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
