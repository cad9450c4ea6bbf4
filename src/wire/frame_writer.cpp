// SPDX-License-Identifier: MIT
#include "mavloom/wire/frame_writer.hpp"

#include <algorithm>
#include <cstring>

#include "mavloom/wire/crc.hpp"

namespace mavloom::wire {

namespace {

// Drops trailing zeros, but keeps at least one byte.
std::size_t truncated_length(ByteView payload) noexcept {
    std::size_t length = payload.size();
    while (length > 1 && payload[length - 1] == 0) --length;
    return length;
}

std::size_t write_header_v1(std::uint8_t* p, const FrameHeader& header, const MessageInfo& info,
                            std::size_t length) noexcept {
    p[0] = stx_v1;
    p[1] = static_cast<std::uint8_t>(length);
    p[2] = header.sequence;
    p[3] = header.source.system.value;
    p[4] = header.source.component.value;
    p[5] = static_cast<std::uint8_t>(info.id.value);
    return header_length_v1;
}

std::size_t write_header_v2(std::uint8_t* p, const FrameHeader& header, const MessageInfo& info, std::size_t length,
                            bool is_signed) noexcept {
    p[0] = stx_v2;
    p[1] = static_cast<std::uint8_t>(length);
    p[2] = is_signed ? incompat_signed : std::uint8_t{0};
    p[3] = header.compat_flags;
    p[4] = header.sequence;
    p[5] = header.source.system.value;
    p[6] = header.source.component.value;
    p[7] = static_cast<std::uint8_t>(info.id.value);
    p[8] = static_cast<std::uint8_t>(info.id.value >> 8);
    p[9] = static_cast<std::uint8_t>(info.id.value >> 16);
    return header_length_v2;
}

}  // namespace

FrameView write_frame(std::span<std::uint8_t, max_frame_length> out, const FrameHeader& header, const MessageInfo& info,
                      ByteView payload, Signing signing) noexcept {
    const bool v1 = header.version == Version::v1;
    assert(!v1 || fits_v1(info));
    const std::size_t full = v1 ? info.min_length : info.max_length;
    payload = payload.first(std::min(payload.size(), full));
    const std::size_t length = v1 ? full : std::min(std::max<std::size_t>(truncated_length(payload), 1), full);

    std::uint8_t* p = out.data();
    const bool is_signed = !v1 && signing.signer != nullptr;
    p += v1 ? write_header_v1(p, header, info, length) : write_header_v2(p, header, info, length, is_signed);
    const std::size_t given = std::min(payload.size(), length);
    if (given != 0) std::memcpy(p, payload.data(), given);
    std::memset(p + given, 0, length - given);
    p += length;
    const auto covered = static_cast<std::size_t>(p - out.data()) - 1;
    store_le(p, crc_update(crc_update(crc_seed, ByteView{out.data() + 1, covered}), info.crc_extra));
    auto size = static_cast<std::size_t>(p - out.data()) + checksum_length;
    if (is_signed) size = signing.signer->sign(out, size, signing.now);
    return FrameView::unchecked({out.data(), size});
}

}  // namespace mavloom::wire
