// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <type_traits>

#include "mavloom/message/format.hpp"
#include "mavloom/message/view.hpp"
#include "message/cursor.hpp"
#include "message/utf8.hpp"
#include "message/visit.hpp"

namespace mavloom::message {
namespace {

constexpr std::uint64_t largest_exact = std::uint64_t{1}
                                        << 53;  // beyond it a reader that uses doubles would lose digits

// ---- strings

// True when no byte of the eight needs an escape or a second look: printable ASCII except '"' and '\'.
bool all_plain(const char* eight) noexcept {
    constexpr std::uint64_t ones = 0x0101010101010101u, tops = 0x8080808080808080u;
    std::uint64_t word;
    std::memcpy(&word, eight, sizeof word);
    const auto has_zero = [](std::uint64_t w) { return (w - ones) & ~w & tops; };
    const auto below_space = (word - ones * 0x20) & ~word & tops;
    return ((word & tops) | below_space | has_zero(word ^ ones * '"') | has_zero(word ^ ones * '\\') |
            has_zero(word ^ ones * 0x7f)) == 0;
}

bool is_plain(char c) noexcept { return c >= ' ' && c < 0x7f && c != '"' && c != '\\'; }

char* write_escaped(char* at, char32_t c) noexcept {
    constexpr std::string_view hex = "0123456789abcdef", shorts = "btn?fr";  // \b is 8, \r is 13
    *at++ = '\\';
    if (c == '"' || c == '\\') {
        *at++ = static_cast<char>(c);
    } else if (c >= 8 && c <= 13 && c != 11) {
        *at++ = shorts[c - 8];
    } else {
        *at++ = 'u';
        for (int shift = 12; shift >= 0; shift -= 4) *at++ = hex[c >> shift & 0xf];
    }
    return at;
}

// Controls are escaped even where JSON allows them, so that a line shown on a terminal cannot command it.
char* write_character(char* at, char32_t c) noexcept {
    return c == '"' || c == '\\' || is_control(c) ? write_escaped(at, c) : write_utf8(at, c);
}

void put_string(Cursor& out, std::string_view bytes) {
    constexpr std::size_t longest = 6;  // \u001b for one byte
    out.reserve(bytes.size() * longest + 2 + sizeof(std::uint64_t));
    char* at = out.at();
    *at++ = '"';
    while (!bytes.empty()) {
        if (bytes.size() >= 8 && all_plain(bytes.data())) {
            std::memcpy(at, bytes.data(), 8);
            at += 8;
            bytes.remove_prefix(8);
            continue;
        }
        if (is_plain(bytes.front())) {
            *at++ = bytes.front();
            bytes.remove_prefix(1);
            continue;
        }
        const auto c = decode_utf8(bytes);
        at = write_character(at, c.value);
        bytes.remove_prefix(c.length);
    }
    *at++ = '"';
    out.set(at);
}

// ---- values

template <class Float>
void put_float(Cursor& out, Float value) {
    if (std::isfinite(value)) [[likely]]
        return out.set(write_float(out.at(), value));
    out.put_unchecked(std::isnan(value) ? "\"NaN\"" : value > 0 ? "\"Infinity\"" : "\"-Infinity\"");
}

template <class Integer>
void put_integer(Cursor& out, Integer value) {
    const bool negative = value < 0;
    const auto magnitude = negative ? 0 - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
    const bool quoted = sizeof value == 8 && magnitude > largest_exact;
    if (quoted) out.put_unchecked('"');
    if (negative) out.put_unchecked('-');
    out.set(write_unsigned(out.at(), magnitude));
    if (quoted) out.put_unchecked('"');
}

// The caller has reserved the room.
template <class T>
void put_value(Cursor& out, T value) {
    if constexpr (std::is_floating_point_v<T>) {
        put_float(out, value);
    } else {
        put_integer(out, value);
    }
}

constexpr std::size_t value_room = number_room + 3;  // and quotes, and a comma

template <class T>
void put_elements(Cursor& out, const MessageView& view, const dialect::Field& field) {
    out.reserve(field.array_length * value_room + 2);
    out.put_unchecked('[');
    for (std::size_t i = 0; i < field.array_length; ++i) {
        if (i > 0) out.put_unchecked(',');
        put_value(out, view.get<T>(field, i));
    }
    out.put_unchecked(']');
}

void put_characters(Cursor& out, const MessageView& view, const dialect::Field& field) {
    if (field.is_array()) return put_string(out, view.text(field));
    const auto character = view.get<char>(field);
    put_string(out, {&character, character == 0 ? 0u : 1u});
}

void put_field_value(Cursor& out, const MessageView& view, const dialect::Field& field) {
    if (field.type == dialect::FieldType::char8) return put_characters(out, view, field);
    visit_type(field.type, [&](auto tag) {
        using T = decltype(tag);
        if (field.is_array()) {
            put_elements<T>(out, view, field);
        } else {
            put_value(out, view.get<T>(field));
        }
    });
}

void put_fields(Cursor& out, const dialect::Message& message, ByteView payload) {
    const MessageView view(message, payload);
    bool first = true;
    for (const auto& field : message.fields) {
        out.reserve(field.name.size() + 4 + value_room);
        if (!first) out.put_unchecked(',');
        first = false;
        out.put_unchecked('"');
        out.put_unchecked(field.name);
        out.put_unchecked("\":");
        put_field_value(out, view, field);
    }
}

// ---- the object

void put_key(Cursor& out, std::string_view key_with_punctuation, std::uint64_t value) {
    out.put_unchecked(key_with_punctuation);
    out.set(write_unsigned(out.at(), value));
}

void put_header(Cursor& out, const Received& received) {
    out.reserve(64 + number_room);
    out.put_unchecked("{\"time_us\":");
    out.set(write_integer(out.at(), unix_us(received.time)));
    out.put_unchecked(",\"link\":");
    put_string(out, received.link);
    out.reserve(64 + 4 * number_room);
    put_key(out, ",\"sys\":", received.frame.system().value);
    put_key(out, ",\"comp\":", received.frame.component().value);
    put_key(out, ",\"seq\":", received.frame.sequence());
    put_key(out, ",\"id\":", received.frame.id().value);
}

void put_name(Cursor& out, const Received& received) {
    const auto* message = received.message;
    out.reserve(64 + (message != nullptr ? message->name.size() : 0));
    if (message != nullptr) {
        out.put_unchecked(",\"name\":\"");
        out.put_unchecked(message->name);
        out.put_unchecked('"');
    } else {
        out.put_unchecked(",\"name\":null");
    }
    out.put_unchecked(received.frame.is_v2() ? ",\"v\":2" : ",\"v\":1");
    out.put_unchecked(received.frame.is_signed() ? ",\"signed\":true" : ",\"signed\":false");
}

void put_payload_hex(Cursor& out, ByteView payload) {
    out.put(",\"payload_hex\":\"");
    for (const auto byte : payload) out.put_hex_byte(byte);
    out.put("\"}\n");
}

}  // namespace

void append_json_fields(TextBuffer& buffer, const dialect::Message& message, ByteView payload) {
    Cursor out(buffer);
    put_fields(out, message, payload);
}

void append_json(TextBuffer& buffer, const Received& received) {
    Cursor out(buffer);
    put_header(out, received);
    put_name(out, received);
    if (received.message == nullptr) return put_payload_hex(out, received.frame.payload());
    out.put(",\"fields\":{");
    put_fields(out, *received.message, received.frame.payload());
    out.put("}}\n");
}

}  // namespace mavloom::message
