// SPDX-License-Identifier: MIT
#include "mavloom/message/utf8.hpp"

namespace mavloom::message {
namespace {

struct Lead {
    std::uint8_t continuations;  // 0: not a lead byte
    // The valid range of the second byte, which excludes overlong forms and surrogates.
    std::uint8_t first_low = 0x80, first_high = 0xbf;
};

constexpr Lead lead_of(std::uint8_t byte) noexcept {
    if (byte >= 0xc2 && byte <= 0xdf) return {1};
    if (byte == 0xe0) return {2, 0xa0, 0xbf};
    if (byte == 0xed) return {2, 0x80, 0x9f};
    if (byte >= 0xe1 && byte <= 0xef) return {2};
    if (byte == 0xf0) return {3, 0x90, 0xbf};
    if (byte >= 0xf1 && byte <= 0xf3) return {3};
    if (byte == 0xf4) return {3, 0x80, 0x8f};
    return {0};
}

}  // namespace

CodePoint decode_utf8(std::string_view bytes) noexcept {
    const auto at = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); };
    if (at(0) < 0x80) return {at(0), 1};
    const auto lead = lead_of(at(0));
    if (lead.continuations == 0) return {replacement_character, 1};
    char32_t value = at(0) & (0x3fu >> lead.continuations);
    for (std::uint8_t i = 1; i <= lead.continuations; ++i) {
        const std::uint8_t low = i == 1 ? lead.first_low : 0x80, high = i == 1 ? lead.first_high : 0xbf;
        if (i >= bytes.size() || at(i) < low || at(i) > high) return {replacement_character, i};
        value = value << 6 | (at(i) & 0x3fu);
    }
    return {value, static_cast<std::uint8_t>(lead.continuations + 1)};
}

char* write_utf8(char* at, char32_t code_point) noexcept {
    const auto tail = [&](unsigned shift) { return static_cast<char>(0x80 | (code_point >> shift & 0x3f)); };
    if (code_point < 0x80) {
        *at++ = static_cast<char>(code_point);
    } else if (code_point < 0x800) {
        *at++ = static_cast<char>(0xc0 | code_point >> 6);
        *at++ = tail(0);
    } else if (code_point < 0x10000) {
        *at++ = static_cast<char>(0xe0 | code_point >> 12);
        *at++ = tail(6);
        *at++ = tail(0);
    } else {
        *at++ = static_cast<char>(0xf0 | code_point >> 18);
        *at++ = tail(12);
        *at++ = tail(6);
        *at++ = tail(0);
    }
    return at;
}

bool is_control(char32_t code_point) noexcept {
    return code_point < 0x20 || (code_point >= 0x7f && code_point < 0xa0) || code_point == 0x200e ||
           code_point == 0x200f || (code_point >= 0x2028 && code_point <= 0x202e) ||
           (code_point >= 0x2066 && code_point <= 0x2069);
}

}  // namespace mavloom::message
