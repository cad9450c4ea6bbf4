// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <type_traits>

#include "mavloom/message/format.hpp"
#include "mavloom/message/modes.hpp"
#include "mavloom/message/utf8.hpp"
#include "mavloom/message/visit.hpp"
#include "message/full_payload.hpp"
#include "message/number.hpp"

namespace mavloom::message {
namespace {

// A JSON reader that uses doubles loses digits of larger integers.
constexpr std::uint64_t largest_exact = std::uint64_t{1} << 53;

// ---- strings

// True if none of the eight bytes needs an escape or decoding: printable ASCII except '"' and '\'.
bool all_plain(const char* eight) noexcept {
    constexpr std::uint64_t ones = 0x0101010101010101u, tops = 0x8080808080808080u;
    std::uint64_t word;
    std::memcpy(&word, eight, sizeof word);
    // Each term sets the top bit of a byte that matches: 128 and up, 127, below space, '"', '\'.
    // Only a matching byte causes a carry, so plain text never gives a false match.
    const auto found = word | (word + ones) | (word - ones * ' ') | ((word ^ ones * '"') - ones) |
                       ((word ^ ones * '\\') - ones);
    return (found & tops) == 0;
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

// Escapes control characters even where JSON allows them, so that printed lines cannot control a terminal.
char* write_character(char* at, char32_t c) noexcept {
    return c == '"' || c == '\\' || is_control(c) ? write_escaped(at, c) : write_utf8(at, c);
}

// Copies `bytes` and returns the end, or null if a byte needs more than copying.
// Copies eight bytes at a time; the last eight overlap with those before.
char* copy_plain(char* at, std::string_view bytes) noexcept {
    constexpr std::size_t word = sizeof(std::uint64_t);
    if (bytes.size() < word) {
        for (const char c : bytes) {
            if (!is_plain(c)) return nullptr;
            *at++ = c;
        }
        return at;
    }
    for (std::size_t i = 0;; i += word) {
        i = std::min(i, bytes.size() - word);
        if (!all_plain(bytes.data() + i)) return nullptr;
        std::memcpy(at + i, bytes.data() + i, word);
        if (i + word == bytes.size()) return at + bytes.size();
    }
}

char* write_characters(char* at, std::string_view bytes) noexcept {
    while (!bytes.empty()) {
        const auto c = decode_utf8(bytes);
        at = write_character(at, c.value);
        bytes.remove_prefix(c.length);
    }
    return at;
}

char* write_string(char* at, std::string_view bytes) noexcept {
    *at++ = '"';
    char* end = copy_plain(at, bytes);
    at = end != nullptr ? end : write_characters(at, bytes);
    *at++ = '"';
    return at;
}

// Writes keys and other text of our own, which needs no escapes.
char* write_text(char* at, std::string_view text) noexcept {
    std::memcpy(at, text.data(), text.size());
    return at + text.size();
}
template <std::size_t size>
char* write_literal(char* at, const char (&text)[size]) noexcept {
    std::memcpy(at, text, size - 1);
    return at + size - 1;
}

// ---- values

template <class Float>
char* write_special(char* at, Float value) noexcept {
    return write_text(at, std::isnan(value) ? "\"NaN\"" : value > 0 ? "\"Infinity\"" : "\"-Infinity\"");
}

char* write_quoted(char* at, bool negative, std::uint64_t magnitude) noexcept {
    *at++ = '"';
    if (negative) *at++ = '-';
    at = write_unsigned(at, magnitude);
    *at++ = '"';
    return at;
}

template <class T>
char* write_value(char* at, T value) noexcept {
    if constexpr (std::is_floating_point_v<T>) {
        return std::isfinite(value) ? write_float(at, value) : write_special(at, value);
    } else if constexpr (sizeof(T) == 8) {
        const bool negative = value < 0;
        const auto magnitude = negative ? 0 - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
        if (magnitude > largest_exact) return write_quoted(at, negative, magnitude);
        return write_integer(at, static_cast<std::int64_t>(value));
    } else if constexpr (std::is_same_v<T, std::uint8_t>) {
        return write_byte(at, value);
    } else if constexpr (std::is_signed_v<T>) {
        return write_integer(at, value);
    } else {
        return write_unsigned(at, value);
    }
}

// `array_length` is as in dialect::Field: 0 for a scalar.
template <class T>
char* write_numbers(char* at, const std::uint8_t* from, std::size_t array_length) noexcept {
    if (array_length == 0) [[likely]]
        return write_value(at, load_le<T>(from));
    *at++ = '[';
    for (std::size_t i = 0; i < array_length; ++i) {
        at = write_value(at, load_le<T>(from + i * sizeof(T)));
        *at++ = ',';
    }
    at[-1] = ']';
    return at;
}

// Writes a char or char[] value as a string without its trailing NULs.
char* write_characters_of(char* at, const std::uint8_t* from, std::size_t array_length) noexcept {
    std::size_t used = std::max<std::size_t>(array_length, 1);
    while (used > 0 && from[used - 1] == 0) --used;
    return write_string(at, {reinterpret_cast<const char*>(from), used});
}

char* write_field_value(char* at, const std::uint8_t* from, dialect::FieldType type, std::size_t array_length) noexcept {
    if (type == dialect::FieldType::char8) return write_characters_of(at, from, array_length);
    return visit_type(type, [&](auto tag) { return write_numbers<decltype(tag)>(at, from, array_length); });
}

char* write_key(char* at, std::string_view name) noexcept {
    *at++ = '"';
    at = write_text(at, name);
    return write_literal(at, "\":");
}

// ---- room: how many bytes a message can need; reserved once, so that the functions below need no checks

constexpr std::size_t longest_escape = 6;  // "\u001b" for one byte
// "-2.2250738585072014e-308" and a comma. Integers in quotes are shorter.
constexpr std::size_t longest_element = 26;

std::size_t room_of(const dialect::Message& message) noexcept {
    std::size_t room = number_room;
    for (const auto& field : message.fields)
        room += field.name.size() + 6 +
                (field.type == dialect::FieldType::char8 ? longest_escape : longest_element) * field.count();
    return room;
}

// Makes room for `bytes` in the buffer, and returns the end of its content.
char* room_in(TextBuffer& buffer, std::size_t bytes) {
    if (buffer.capacity() - buffer.size() < bytes) buffer.reserve(buffer.size() + bytes);
    return buffer.data() + buffer.size();
}

void commit(TextBuffer& buffer, const char* end) { buffer.resize(static_cast<std::size_t>(end - buffer.data())); }

// ---- the object

// Everything except the link's name, the message's name and its fields.
constexpr std::size_t header_room = 160 + 6 * number_room;

char* write_fields(char* at, const dialect::Message& message, ByteView payload) noexcept {
    const FullPayload full(payload, message.wire.max_length);
    for (const auto& field : message.fields) {
        at = write_key(at, field.name);
        at = write_field_value(at, full.data() + field.offset, field.type, field.array_length);
        *at++ = ',';
    }
    return message.fields.empty() ? at : at - 1;
}

// Writes the object up to the sequence number.
char* write_header(char* at, const Received& received) noexcept {
    at = write_literal(at, "{\"time_us\":");
    at = write_integer(at, unix_us(received.time));
    at = write_literal(at, ",\"link\":");
    at = write_string(at, received.link);
    at = write_literal(at, ",\"sys\":");
    at = write_byte(at, received.frame.system().value);
    at = write_literal(at, ",\"comp\":");
    at = write_byte(at, received.frame.component().value);
    at = write_literal(at, ",\"seq\":");
    return write_byte(at, received.frame.sequence());
}

char* write_id_and_name(char* at, MessageId id, const dialect::Message* message) noexcept {
    at = write_literal(at, ",\"id\":");
    at = write_unsigned(at, id.value);
    if (message == nullptr) return write_literal(at, ",\"name\":null");
    at = write_literal(at, ",\"name\":\"");
    at = write_text(at, message->name);
    *at++ = '"';
    return at;
}

char* write_version(char* at, const wire::FrameView& frame) noexcept {
    at = write_literal(at, ",\"v\":2,\"signed\":false");
    if (frame.is_v2() && !frame.is_signed()) [[likely]]
        return at;
    at -= std::string_view("2,\"signed\":false").size();
    *at++ = frame.is_v2() ? '2' : '1';
    return frame.is_signed() ? write_literal(at, ",\"signed\":true") : write_literal(at, ",\"signed\":false");
}

// Writes what follows the fields: the end of the object, and of a HEARTBEAT the name of the sender's mode.
char* write_end(char* at, const dialect::Message& message, ByteView payload) noexcept {
    if (!has_mode(message)) [[likely]]
        return write_literal(at, "}}\n");
    const auto mode = heartbeat_mode(payload);
    if (mode.empty()) return write_literal(at, "},\"mode\":null}\n");
    at = write_literal(at, "},\"mode\":\"");
    at = write_text(at, mode);
    return write_literal(at, "\"}\n");
}

char* write_payload_hex(char* at, ByteView payload) noexcept {
    constexpr std::string_view hex = "0123456789abcdef";
    at = write_literal(at, ",\"payload_hex\":\"");
    for (const auto byte : payload) {
        *at++ = hex[byte >> 4];
        *at++ = hex[byte & 0xf];
    }
    return write_literal(at, "\"}\n");
}

void append_unknown(TextBuffer& buffer, const Received& received) {
    const auto payload = received.frame.payload();
    char* at = room_in(buffer, header_room + longest_escape * received.link.size() + 2 * payload.size());
    at = write_header(at, received);
    at = write_id_and_name(at, received.frame.id(), nullptr);
    at = write_version(at, received.frame);
    commit(buffer, write_payload_hex(at, payload));
}

}  // namespace

void append_json_fields(TextBuffer& buffer, const dialect::Message& message, ByteView payload) {
    char* at = room_in(buffer, room_of(message));
    commit(buffer, write_fields(at, message, payload));
}

void append_json(TextBuffer& buffer, const Received& received) {
    if (received.message == nullptr) return append_unknown(buffer, received);
    const auto& message = *received.message;
    char* at = room_in(buffer,
                       header_room + longest_escape * received.link.size() + message.name.size() + room_of(message));
    at = write_header(at, received);
    at = write_id_and_name(at, received.frame.id(), &message);
    at = write_version(at, received.frame);
    at = write_literal(at, ",\"fields\":{");
    at = write_fields(at, message, received.frame.payload());
    commit(buffer, write_end(at, message, received.frame.payload()));
}

// ---- JsonFormatter: everything that is known in advance is prepared

namespace {

std::string id_and_name_of(const dialect::Message& message) {
    std::string text(header_room + message.name.size(), '\0');
    text.resize(static_cast<std::size_t>(write_id_and_name(text.data(), message.id(), &message) - text.data()));
    return text;
}

}  // namespace

JsonFormatter::Step JsonFormatter::step_of(const dialect::Field& field, char before) noexcept {
    Step step{{before}, 0, field.type, field.offset, field.array_length};
    const auto length = field.name.size() + 4;
    if (length > step.key.size()) return step;
    write_key(step.key.data() + 1, field.name);
    step.key_length = static_cast<std::uint8_t>(length);
    return step;
}

JsonFormatter::JsonFormatter(const dialect::Dialect& dialect) : messages_(dialect.messages()) {
    prepared_.reserve(messages_.size());
    for (const auto& message : messages_) {
        auto id_and_name = id_and_name_of(message);
        const auto room = header_room + id_and_name.size() + room_of(message) + sizeof(Step);
        prepared_.push_back({std::move(id_and_name), steps_.size(), room});
        for (const auto& field : message.fields)
            steps_.push_back(step_of(field, &field == message.fields.data() ? '{' : ','));
    }
}

const JsonFormatter::Prepared* JsonFormatter::find(const dialect::Message* message) const noexcept {
    const std::less<> before;
    if (message == nullptr || before(message, messages_.data()) || !before(message, messages_.data() + messages_.size()))
        return nullptr;
    return &prepared_[static_cast<std::size_t>(message - messages_.data())];
}

void JsonFormatter::append(TextBuffer& buffer, const Received& received) const {
    const auto* prepared = find(received.message);
    if (prepared == nullptr) return append_json(buffer, received);
    char* at = room_in(buffer, prepared->room + longest_escape * received.link.size());
    at = write_header(at, received);
    at = write_text(at, prepared->id_and_name);
    at = write_version(at, received.frame);
    at = write_literal(at, ",\"fields\":{");
    const auto& fields = received.message->fields;
    if (!fields.empty()) --at;  // each step includes the character before its key
    const FullPayload full(received.frame.payload(), received.message->wire.max_length);
    const auto* step = steps_.data() + prepared->first_step;
    for (std::size_t i = 0; i < fields.size(); ++i, ++step) {
        // Copies the whole step, which is cheaper than copying only the length of its key.
        std::memcpy(at, step, sizeof *step);
        at = step->key_length != 0 ? at + step->key_length : write_key(at + 1, fields[i].name);
        at = write_field_value(at, full.data() + step->offset, step->type, step->array_length);
    }
    commit(buffer, write_end(at, *received.message, received.frame.payload()));
}

}  // namespace mavloom::message
