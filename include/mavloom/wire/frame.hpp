// SPDX-License-Identifier: MIT
// A read-only view of one MAVLink frame, version 1 or 2, in the bytes that arrived.
// A FrameView owns nothing and is valid as long as those bytes. The accessors do no bounds checks.
// For received data, only the parsers create views, and they check every length first.
// Source: MAVLink guide, "Packet Serialization".
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/ids.hpp"

namespace mavloom::wire {

inline constexpr std::uint8_t stx_v1 = 0xfe;
inline constexpr std::uint8_t stx_v2 = 0xfd;
inline constexpr std::size_t header_length_v1 = 6;   // STX len seq sys comp id
inline constexpr std::size_t header_length_v2 = 10;  // STX len incompat compat seq sys comp id[3]
inline constexpr std::size_t checksum_length = 2;
inline constexpr std::size_t signature_length = 13;  // link id, 6 bytes of time, 6 bytes of hash
inline constexpr std::size_t max_payload_length = 255;
inline constexpr std::size_t max_frame_length = header_length_v2 + max_payload_length + checksum_length +
                                                signature_length;                    // 280
inline constexpr std::size_t min_frame_length = header_length_v1 + checksum_length;  // 8
inline constexpr std::uint8_t incompat_signed = 0x01;  // the only incompatibility flag that is defined

enum class Version : std::uint8_t { v1 = 1, v2 = 2 };

[[nodiscard]] constexpr bool is_start(std::uint8_t byte) noexcept { return byte == stx_v1 || byte == stx_v2; }

// Returns the length that the frame starting with `bytes` claims; the frame may extend beyond `bytes`.
// Returns 0 if `bytes` does not begin with a start byte or has fewer than three bytes.
[[nodiscard]] constexpr std::size_t frame_length(ByteView bytes) noexcept {
    if (bytes.size() < 3 || !is_start(bytes[0])) return 0;
    if (bytes[0] == stx_v1) return min_frame_length + bytes[1];
    const bool is_signed = (bytes[2] & incompat_signed) != 0;
    return header_length_v2 + checksum_length + bytes[1] + (is_signed ? signature_length : 0);
}

class FrameView {
public:
    constexpr FrameView() noexcept = default;

    // `bytes` must be exactly one frame: it begins with a start byte and has the length that its header gives.
    [[nodiscard]] static FrameView unchecked(ByteView bytes) noexcept {
        assert(bytes.size() >= min_frame_length && bytes.size() <= max_frame_length);
        return FrameView(bytes.data(), bytes.size());
    }

    [[nodiscard]] ByteView bytes() const noexcept { return {data_, size_}; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] bool empty() const noexcept { return size_ == 0; }

    [[nodiscard]] Version version() const noexcept { return is_v2() ? Version::v2 : Version::v1; }
    [[nodiscard]] bool is_v2() const noexcept { return data_[0] == stx_v2; }
    [[nodiscard]] std::uint8_t incompat_flags() const noexcept { return is_v2() ? data_[2] : std::uint8_t{0}; }
    [[nodiscard]] std::uint8_t compat_flags() const noexcept { return is_v2() ? data_[3] : std::uint8_t{0}; }
    [[nodiscard]] bool is_signed() const noexcept { return (incompat_flags() & incompat_signed) != 0; }
    [[nodiscard]] std::uint8_t sequence() const noexcept { return data_[is_v2() ? 4 : 2]; }
    [[nodiscard]] SystemId system() const noexcept { return SystemId{data_[is_v2() ? 5 : 3]}; }
    [[nodiscard]] ComponentId component() const noexcept { return ComponentId{data_[is_v2() ? 6 : 4]}; }
    [[nodiscard]] Source source() const noexcept { return {system(), component()}; }
    [[nodiscard]] MessageId id() const noexcept {
        if (!is_v2()) return MessageId{data_[5]};
        return MessageId{load_le<std::uint32_t>(data_ + 6) >> 8};  // three bytes from data_[7] on
    }
    [[nodiscard]] std::size_t header_length() const noexcept { return is_v2() ? header_length_v2 : header_length_v1; }
    [[nodiscard]] std::uint8_t payload_length() const noexcept { return data_[1]; }
    [[nodiscard]] ByteView payload() const noexcept { return {data_ + header_length(), payload_length()}; }
    [[nodiscard]] std::uint16_t checksum() const noexcept {
        return load_le<std::uint16_t>(data_ + header_length() + payload_length());
    }
    // The 13 signature bytes, or empty if the frame is not signed.
    [[nodiscard]] ByteView signature() const noexcept {
        return is_signed() ? ByteView{data_ + size_ - signature_length, signature_length} : ByteView{};
    }

private:
    constexpr FrameView(const std::uint8_t* data, std::size_t size) noexcept : data_(data), size_(size) {}

    const std::uint8_t* data_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace mavloom::wire
