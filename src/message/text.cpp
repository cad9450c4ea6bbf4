// SPDX-License-Identifier: MIT
#include <bit>
#include <chrono>
#include <cmath>
#include <optional>
#include <type_traits>

#include "mavloom/message/format.hpp"
#include "mavloom/message/modes.hpp"
#include "mavloom/message/utf8.hpp"
#include "mavloom/message/view.hpp"
#include "mavloom/message/visit.hpp"
#include "message/command_params.hpp"
#include "message/cursor.hpp"
#include "message/invalid.hpp"
#include "message/scale.hpp"

namespace mavloom::message {
namespace {

constexpr std::string_view no_value = "-";

// ---- strings

void put_escape(Cursor& out, char32_t c) {
    constexpr std::string_view hex = "0123456789abcdef";
    out.put_unchecked('\\');
    switch (c) {
        case '"':
        case '\\': return out.put_unchecked(static_cast<char>(c));
        case '\n': return out.put_unchecked('n');
        case '\r': return out.put_unchecked('r');
        case '\t': return out.put_unchecked('t');
        default: break;
    }
    out.put_unchecked(c < 0x100 ? 'x' : 'u');
    for (int shift = c < 0x100 ? 4 : 12; shift >= 0; shift -= 4) out.put_unchecked(hex[c >> shift & 0xf]);
}

// Writes text with control characters escaped. A vehicle may be hostile, so nothing that controls a terminal may pass.
void put_visible(Cursor& out, std::string_view bytes, bool quoted) {
    out.reserve(bytes.size() * 6);
    while (!bytes.empty()) {
        if (const char plain = bytes.front(); plain >= ' ' && plain < 0x7f && plain != '"' && plain != '\\') {
            out.put_unchecked(plain);
            bytes.remove_prefix(1);
            continue;
        }
        const auto c = decode_utf8(bytes);
        if (is_control(c.value) || (quoted && (c.value == '"' || c.value == '\\'))) {
            put_escape(out, c.value);
        } else {
            out.set(write_utf8(out.at(), c.value));
        }
        bytes.remove_prefix(c.length);
    }
}

void put_quoted(Cursor& out, std::string_view bytes) {
    out.put('"');
    put_visible(out, bytes, true);
    out.put('"');
}

// ---- enums

void put_hex(Cursor& out, std::uint64_t value) {
    out.reserve(2 + 16);
    out.put_unchecked("0x");
    const int digits = value == 0 ? 1 : (static_cast<int>(std::bit_width(value)) + 3) / 4;
    for (int i = digits - 1; i >= 0; --i) out.put_unchecked("0123456789abcdef"[value >> (4 * i) & 0xf]);
}

// Writes flags as A|B: first the single-bit entries, then entries of several bits that still add a bit.
// Bits without a name follow as one hexadecimal number.
void put_flags(Cursor& out, const dialect::Enum& flags, std::uint64_t value) {
    std::uint64_t unnamed = value;
    bool first = true;
    const auto put_separated = [&](auto put) {
        if (!first) out.put('|');
        first = false;
        put();
    };
    for (const bool single : {true, false}) {
        for (const auto& entry : flags.entries) {
            if (std::has_single_bit(entry.value) != single || (entry.value & value) != entry.value ||
                (entry.value & unnamed) == 0)
                continue;
            unnamed &= ~entry.value;
            put_separated([&] { out.put(entry.name); });
        }
    }
    if (unnamed != 0) put_separated([&] { put_hex(out, unnamed); });
}

// Returns false and writes nothing if the enum has no name for the value. The caller then writes a number.
bool put_enum(Cursor& out, const dialect::Enum& enumeration, bool bitmask, std::uint64_t value) {
    if (const auto* entry = enumeration.find(value)) {
        out.put(entry->name);
        return true;
    }
    if (!bitmask || value == 0) return false;
    put_flags(out, enumeration, value);
    return true;
}

// ---- numbers

void put_units(Cursor& out, std::string_view units) {
    if (units.empty()) return;
    out.put(' ');
    out.put(units);
}

template <class Float>
void put_float(Cursor& out, Float value) {
    out.reserve(number_room);
    if (std::isfinite(value)) return out.set(write_float(out.at(), value));
    out.put_unchecked(std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
}

template <class Integer>
void put_scaled(Cursor& out, Integer value, unsigned decimals) {
    const bool negative = value < 0;
    const auto bits = static_cast<std::uint64_t>(value);
    out.reserve(number_room);
    out.set(write_scaled(out.at(), negative, negative ? 0 - bits : bits, decimals));
}

// The bits of a field in its own width, without sign extension.
template <class Integer>
std::uint64_t flag_bits(Integer value) noexcept {
    return static_cast<std::uint64_t>(static_cast<std::make_unsigned_t<Integer>>(value));
}

// Writes one element. Returns true if units should follow, that is, not after a name or "-".
template <class T>
bool put_element(Cursor& out, const MessageView& view, const dialect::Field& field, const Scale& scale,
                 std::size_t index) {
    const auto value = view.get<T>(field, index);
    if constexpr (std::is_integral_v<T>) {
        const auto bits = field.bitmask ? flag_bits(value) : static_cast<std::uint64_t>(value);
        if (field.enumeration != nullptr && put_enum(out, *field.enumeration, field.bitmask, bits)) return false;
    }
    if (is_invalid(view, field, index)) {
        out.put(no_value);
        return false;
    }
    if constexpr (std::is_integral_v<T>) {
        if (field.bitmask) {
            put_hex(out, flag_bits(value));
        } else if (scale.factor != 1) {
            put_float(out, static_cast<float>(static_cast<double>(value) * scale.factor));
        } else {
            put_scaled(out, value, scale.decimals);
        }
    } else {
        put_float(out, value);
    }
    return true;
}

bool all_invalid(const MessageView& view, const dialect::Field& field) noexcept {
    for (std::size_t i = 0; i < field.count(); ++i)
        if (!is_invalid(view, field, i)) return false;
    return true;
}

template <class T>
bool put_elements(Cursor& out, const MessageView& view, const dialect::Field& field, const Scale& scale) {
    if (all_invalid(view, field)) {
        out.put(no_value);
        return false;
    }
    for (std::size_t i = 0; i < field.count(); ++i) {
        out.put(i == 0 ? '[' : ',');
        put_element<T>(out, view, field, scale, i);
    }
    out.put(']');
    return true;
}

// Writes a byte array that holds neither quantities nor names (payloads, identifiers): two hexadecimal digits per byte.
// Zeros at the end are only counted.
void put_bytes(Cursor& out, const MessageView& view, const dialect::Field& field) {
    std::size_t used = field.count();
    while (used > 0 && view.get<std::uint8_t>(field, used - 1) == 0) --used;
    out.put("0x");
    for (std::size_t i = 0; i < used; ++i) out.put_hex_byte(view.get<std::uint8_t>(field, i));
    if (used == field.count()) return;
    out.put("(+");
    out.put_unsigned(field.count() - used);
    out.put(" zeros)");
}

bool is_opaque(const dialect::Field& field) noexcept {
    constexpr std::uint8_t shortest = 8;  // shorter arrays are as short, and easier to read, as numbers
    return field.type == dialect::FieldType::u8 && field.array_length >= shortest && field.units.empty() &&
           field.invalid.empty() && field.enumeration == nullptr;
}

template <class T>
void put_typed(Cursor& out, const MessageView& view, const dialect::Field& field) {
    const auto scale = std::is_integral_v<T> ? scale_of(field) : Scale{field.units};
    const bool number = field.is_array() ? put_elements<T>(out, view, field, scale)
                                         : put_element<T>(out, view, field, scale, 0);
    if (number) put_units(out, scale.units);
}

void put_value(Cursor& out, const MessageView& view, const dialect::Field& field) {
    if (field.is_text()) return put_quoted(out, view.text(field));
    if (field.type == dialect::FieldType::char8) {
        const auto character = view.get<char>(field);
        return put_quoted(out, {&character, character == 0 ? 0u : 1u});
    }
    if (is_opaque(field)) return put_bytes(out, view, field);
    visit_type(field.type, [&](auto tag) { put_typed<decltype(tag)>(out, view, field); });
}

// ---- parameters of commands

std::optional<std::uint64_t> whole_number(double value) noexcept {
    constexpr double beyond = 18446744073709551616.0;  // 2^64
    if (!(value >= 0 && value < beyond) || value != std::floor(value)) return std::nullopt;
    return static_cast<std::uint64_t>(value);
}

void put_param_value(Cursor& out, const MessageView& view, const CommandParams::Param& param) {
    const auto value = view.number(*param.field);
    const auto whole = whole_number(value);
    if (param.enumeration != nullptr && whole && put_enum(out, *param.enumeration, param.enumeration->bitmask, *whole))
        return;
    if (param.is_unset(view)) return out.put(no_value);
    if (param.degrees_e7) {
        put_scaled(out, view.integer(*param.field), 7);
        return put_units(out, "deg");
    }
    visit_type(param.field->type, [&](auto tag) {
        if constexpr (std::is_floating_point_v<decltype(tag)>) {
            put_float(out, view.get<decltype(tag)>(*param.field));
        } else {
            put_scaled(out, view.get<decltype(tag)>(*param.field), 0);
        }
    });
    put_units(out, param.definition->units);
}

// Writes " (Hold)" after the custom mode of a HEARTBEAT.
void put_mode(Cursor& out, const MessageView& view, const dialect::Field& field) {
    if (field.name != "custom_mode") return;
    const auto mode = heartbeat_mode(view.payload());
    if (mode.empty()) return;
    out.put(" (");
    out.put(mode);
    out.put(')');
}

void put_label(Cursor& out, const dialect::Field& field, const std::optional<CommandParams::Param>& param) {
    out.put(field.name);
    if (!param || param->definition->label.empty()) return;
    out.put('(');
    put_visible(out, param->definition->label, false);
    out.put(')');
}

void put_fields(Cursor& out, const MessageView& view, const dialect::Dialect& dialect) {
    const CommandParams params(view, dialect);
    const bool is_heartbeat = has_mode(view.definition());
    for (const auto& field : view.definition().fields) {
        out.put("  ");
        const auto param = params.find(field);
        put_label(out, field, param);
        out.put('=');
        if (param) {
            put_param_value(out, view, *param);
        } else {
            put_value(out, view, field);
        }
        if (is_heartbeat) put_mode(out, view, field);
    }
}

// ---- the line

void put_two(Cursor& out, std::int64_t below_100) {
    out.put(static_cast<char>('0' + below_100 / 10));
    out.put(static_cast<char>('0' + below_100 % 10));
}

// Writes the time of day in UTC.
void put_time(Cursor& out, WallTime time) {
    constexpr std::int64_t second = 1'000'000, day = 86400 * second;
    const auto us = (unix_us(time) % day + day) % day;
    put_two(out, us / second / 3600);
    out.put(':');
    put_two(out, us / second / 60 % 60);
    out.put(':');
    put_two(out, us / second % 60);
    out.put('.');
    for (const std::int64_t pair : {us / 10000 % 100, us / 100 % 100, us % 100}) put_two(out, pair);
}

void put_source(Cursor& out, Source source) {
    out.put_unsigned(source.system.value);
    out.put('/');
    out.put_unsigned(source.component.value);
}

void put_unknown(Cursor& out, const wire::FrameView& frame) {
    out.put('#');
    out.put_unsigned(frame.id().value);
    out.put("  payload=0x");
    for (const auto byte : frame.payload()) out.put_hex_byte(byte);
}

}  // namespace

bool has_elements(const dialect::Field& field) noexcept {
    return field.is_array() && !field.is_text() && !is_opaque(field);
}

void append_field_label(TextBuffer& buffer, const MessageView& view, const dialect::Field& field,
                        const dialect::Dialect& dialect) {
    Cursor out(buffer);
    put_label(out, field, CommandParams(view, dialect).find(field));
}

void append_field_value(TextBuffer& buffer, const MessageView& view, const dialect::Field& field,
                        const dialect::Dialect& dialect) {
    Cursor out(buffer);
    if (const auto param = CommandParams(view, dialect).find(field)) put_param_value(out, view, *param);
    else put_value(out, view, field);
    if (has_mode(view.definition())) put_mode(out, view, field);
}

void append_element(TextBuffer& buffer, const MessageView& view, const dialect::Field& field, std::size_t index) {
    Cursor out(buffer);
    visit_type(field.type, [&](auto tag) {
        const auto scale = std::is_integral_v<decltype(tag)> ? scale_of(field) : Scale{field.units};
        if (put_element<decltype(tag)>(out, view, field, scale, index)) put_units(out, scale.units);
    });
}

double scaled_number(const MessageView& view, const dialect::Field& field, std::size_t index) noexcept {
    if (is_invalid(view, field, index)) return std::nan("");
    const auto value = view.number(field, index);
    const bool is_whole = field.type != dialect::FieldType::f32 && field.type != dialect::FieldType::f64;
    if (!is_whole) return value;
    const auto scale = scale_of(field);
    return value * scale.factor / std::pow(10, scale.decimals);
}

void append_text(TextBuffer& buffer, const Received& received, const dialect::Dialect& dialect) {
    Cursor out(buffer);
    put_time(out, received.time);
    out.put(' ');
    put_visible(out, received.link, false);
    out.put(' ');
    put_source(out, received.frame.source());
    out.put(' ');
    if (received.message == nullptr) {
        put_unknown(out, received.frame);
    } else {
        out.put(received.message->name);
        put_fields(out, MessageView(*received.message, received.frame.payload()), dialect);
    }
    out.put('\n');
}

}  // namespace mavloom::message
