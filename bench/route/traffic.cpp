// SPDX-License-Identifier: MIT
#include "traffic.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>

#include "mavloom/wire/crc.hpp"

namespace mavloom::bench {

namespace {

constexpr std::size_t header_bytes = 10, checksum_bytes = 2, time_bytes = 8;
constexpr std::size_t number_at = header_bytes, sent_at = number_at + 8, carried_until = sent_at + 8;
constexpr std::size_t pattern_count = 512;

// ATTITUDE, ATTITUDE_QUATERNION, LOCAL_POSITION_NED, GLOBAL_POSITION_INT, SERVO_OUTPUT_RAW, ATTITUDE_TARGET,
// POSITION_TARGET_LOCAL_NED, ALTITUDE. They have no target. Their first 16 bytes, which this file overwrites, hold
// plain numbers and no enum, so that a router that decodes accepts any value.
constexpr std::array<std::uint32_t, 8> suitable{30, 31, 32, 33, 36, 83, 85, 141};

std::uint32_t id_of(const std::uint8_t* frame) noexcept {
    return frame[7] | static_cast<std::uint32_t>(frame[8]) << 8 | static_cast<std::uint32_t>(frame[9]) << 16;
}

bool is_suitable(std::uint32_t id) noexcept {
    return std::find(suitable.begin(), suitable.end(), id) != suitable.end();
}

std::size_t frame_bytes(const std::uint8_t* frame) noexcept {
    return header_bytes + frame[1] + checksum_bytes + ((frame[2] & 1u) != 0 ? 13u : 0u);
}

}  // namespace

std::optional<Traffic> Traffic::load(const char* flight, unsigned systems, unsigned components, unsigned links) {
    if (systems == 0 || systems > 255 || components == 0 || components > 255 || links == 0) return std::nullopt;
    std::ifstream in(flight, std::ios::binary);
    const std::vector<char> file{std::istreambuf_iterator<char>(in), {}};
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(file.data());
    Traffic traffic;
    for (std::size_t at = time_bytes; at + header_bytes < file.size() && traffic.patterns_.size() < pattern_count;) {
        const auto* frame = bytes + at;
        const std::size_t size = frame_bytes(frame);
        if (at + size > file.size()) break;
        at += size + time_bytes;
        if (frame[0] != 0xfd || frame[2] != 0 || !is_suitable(id_of(frame))) continue;
        if (size > max_frame_bytes || size < carried_until + checksum_bytes) continue;
        const auto crc = wire::crc_update(wire::crc_seed, ByteView{frame + 1, size - 1 - checksum_bytes});
        const int extra = wire::crc_extra_between(crc, load_le<std::uint16_t>(frame + size - checksum_bytes));
        if (extra < 0) return std::nullopt;
        Pattern& pattern = traffic.patterns_.emplace_back();
        std::copy_n(frame, size, pattern.bytes.begin());
        pattern.size = size;
        pattern.crc_extra = static_cast<std::uint8_t>(extra);
    }
    if (traffic.patterns_.empty()) return std::nullopt;
    traffic.systems_ = systems;
    traffic.components_ = components;
    traffic.links_ = links;
    return traffic;
}

// Writes everything except the checksum. Returns the size of the frame including the checksum.
std::size_t Traffic::fill(std::span<std::uint8_t, max_frame_bytes> out, std::uint64_t number,
                          std::uint64_t time_ns) const noexcept {
    const Pattern& pattern = patterns_[number % patterns_.size()];
    std::memcpy(out.data(), pattern.bytes.data(), max_frame_bytes);
    const std::uint64_t source = number % sources();
    out[4] = static_cast<std::uint8_t>(number / sources());
    out[5] = static_cast<std::uint8_t>(1 + source % systems_);
    out[6] = static_cast<std::uint8_t>(1 + source / systems_);
    store_le(&out[number_at], number);
    store_le(&out[sent_at], time_ns);
    return pattern.size;
}

std::size_t Traffic::write(std::span<std::uint8_t, max_frame_bytes> out, std::uint64_t number,
                           std::uint64_t time_ns) const noexcept {
    const std::size_t size = fill(out, number, time_ns);
    const auto crc = wire::crc_update(wire::crc_seed, ByteView{&out[1], size - 1 - checksum_bytes});
    store_le(&out[size - checksum_bytes], wire::crc_update(crc, patterns_[number % patterns_.size()].crc_extra));
    return size;
}

Received Traffic::check(ByteView bytes) const noexcept {
    Received result{.size = bytes.size()};
    if (bytes.size() < header_bytes || bytes[0] != 0xfd) {
        if (!bytes.empty() && bytes[0] == 0xfe)
            result.kind = Received::Kind::foreign;  // the generator sends no MAVLink 1
        return result;
    }
    const std::size_t size = frame_bytes(bytes.data());
    if (size > bytes.size()) return result;
    result.size = size;
    if (!is_suitable(id_of(bytes.data()))) {
        result.kind = Received::Kind::foreign;
        return result;
    }
    if (size < carried_until + checksum_bytes) return result;
    result.number = load_le<std::uint64_t>(&bytes[number_at]);
    result.sent_ns = load_le<std::uint64_t>(&bytes[sent_at]);
    std::array<std::uint8_t, max_frame_bytes> sent;
    if (write(sent, result.number, result.sent_ns) == size && std::memcmp(sent.data(), bytes.data(), size) == 0)
        result.kind = Received::Kind::whole;
    return result;
}

std::vector<int> numbers_in(std::string_view list) {
    std::vector<int> numbers;
    for (const char *at = list.data(), *end = at + list.size(); at < end; ++at) {
        const auto [rest, error] = std::from_chars(at, end, numbers.emplace_back());
        if (error != std::errc{} || (rest != end && *rest != ',')) return {};
        at = rest;
    }
    return numbers;
}

}  // namespace mavloom::bench
