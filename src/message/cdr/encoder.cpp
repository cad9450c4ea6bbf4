// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <string_view>

#include "mavloom/message/cdr.hpp"
#include "mavloom/message/utf8.hpp"
#include "message/cdr/names.hpp"
#include "message/full_payload.hpp"

namespace mavloom::message {
namespace {

constexpr std::array<std::uint8_t, 4> header{0x00, 0x01, 0x00, 0x00};  // CDR_LE, no options
constexpr std::size_t length_size = 4;                                 // of the length before a text
constexpr std::size_t max_bytes_of_a_character = 3;                    // U+FFFD in the place of one byte

std::uint8_t* align(std::uint8_t* at, const std::uint8_t* body, std::size_t alignment) noexcept {
    while ((static_cast<std::size_t>(at - body) & (alignment - 1)) != 0) *at++ = 0;
    return at;
}

// The number of ASCII characters other than NUL that `bytes` begins with, found eight at a time.
std::size_t plain_prefix(std::string_view bytes) noexcept {
    constexpr std::uint64_t ones = 0x0101010101010101, high_bits = 0x80 * ones;
    std::size_t length = 0;
    for (; length + 8 <= bytes.size(); length += 8) {
        const auto eight = load_le<std::uint64_t>(reinterpret_cast<const std::uint8_t*>(bytes.data()) + length);
        if (((eight | (eight - ones)) & high_bits) != 0) break;  // a byte above 0x7f, or a 0 from which 1 is borrowed
    }
    const auto is_plain = [](char c) { return static_cast<signed char>(c) > 0; };
    while (length < bytes.size() && is_plain(bytes[length])) ++length;
    return length;
}

// Copies text up to its first NUL.
char* write_valid_utf8(char* at, std::string_view bytes) noexcept {
    while (true) {
        const auto plain = plain_prefix(bytes);
        std::memcpy(at, bytes.data(), plain);
        at += plain;
        bytes.remove_prefix(plain);
        if (bytes.empty() || bytes.front() == '\0') return at;
        const auto c = decode_utf8(bytes);
        at = write_utf8(at, c.value);
        bytes.remove_prefix(c.length);
    }
}

// Writes a CDR string: its length with the closing NUL, its bytes, and the NUL.
std::uint8_t* write_string(std::uint8_t* at, const std::uint8_t* from, std::size_t size) noexcept {
    const auto* const end = std::find(from, from + size, std::uint8_t{0});
    auto* const text = reinterpret_cast<char*>(at + length_size);
    char* const text_end = write_valid_utf8(
        text, {reinterpret_cast<const char*>(from), static_cast<std::size_t>(end - from)});
    *text_end = '\0';
    store_le(at, static_cast<std::uint32_t>(text_end + 1 - text));
    return reinterpret_cast<std::uint8_t*>(text_end + 1);
}

}  // namespace

CdrEncoder::CdrEncoder(const dialect::Message& definition)
    : payload_size_(definition.wire.max_length), max_size_(header.size()) {
    Position next;
    for (const auto* field : in_wire_order(definition)) {
        field->is_text() ? add_text(*field, next) : add_numbers(*field, next);
    }
}

void CdrEncoder::add_text(const dialect::Field& field, Position& next) {
    steps_.push_back({field.offset, field.array_length, length_size, true});
    max_size_ += length_size - 1 + length_size + max_bytes_of_a_character * field.size() + 1;
    next = {1, 0};  // depends on the text
}

// Extends the step before if the field follows it without padding, whatever the texts before are.
void CdrEncoder::add_numbers(const dialect::Field& field, Position& next) {
    const std::size_t alignment = dialect::size_of(field.type);
    const bool is_aligned = alignment <= next.modulus && next.remainder % alignment == 0;
    if (is_aligned && !steps_.empty() && !steps_.back().is_text) {
        steps_.back().size = static_cast<std::uint8_t>(steps_.back().size + field.size());
    } else {
        steps_.push_back(
            {field.offset, static_cast<std::uint8_t>(field.size()), static_cast<std::uint8_t>(alignment), false});
        max_size_ += alignment - 1;
    }
    max_size_ += field.size();
    if (!is_aligned) next = {std::max(next.modulus, alignment), (next.remainder + alignment - 1) & ~(alignment - 1)};
    next.remainder = (next.remainder + field.size()) % next.modulus;
}

std::size_t CdrEncoder::encode(ByteView payload, ByteSpan out) const noexcept {
    assert(out.size() >= max_size_);
    const FullPayload full(payload, payload_size_);
    std::memcpy(out.data(), header.data(), header.size());
    const std::uint8_t* const body = out.data() + header.size();
    std::uint8_t* at = out.data() + header.size();
    for (const auto& step : steps_) {
        at = align(at, body, step.alignment);
        if (step.is_text) {
            at = write_string(at, full.data() + step.from, step.size);
        } else {
            std::memcpy(at, full.data() + step.from, step.size);
            at += step.size;
        }
    }
    return static_cast<std::size_t>(at - out.data());
}

}  // namespace mavloom::message
