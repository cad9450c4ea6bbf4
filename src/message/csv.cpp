// SPDX-License-Identifier: MIT
#include <cmath>
#include <type_traits>

#include "mavloom/message/format.hpp"
#include "mavloom/message/modes.hpp"
#include "mavloom/message/utf8.hpp"
#include "mavloom/message/view.hpp"
#include "mavloom/message/visit.hpp"
#include "message/cursor.hpp"

namespace mavloom::message {
namespace {

// Writes text in quotes, with quotes in it doubled. Keeps tabs and line ends.
// Other control characters become U+FFFD, because RFC 4180 does not allow them.
void put_cell(Cursor& out, std::string_view bytes) {
    out.reserve(bytes.size() * 3 + 2);
    out.put_unchecked('"');
    while (!bytes.empty()) {
        const auto c = decode_utf8(bytes);
        const bool kept = !is_control(c.value) || c.value == '\t' || c.value == '\n' || c.value == '\r';
        if (c.value == '"') out.put_unchecked('"');
        out.set(write_utf8(out.at(), kept ? c.value : replacement_character));
        bytes.remove_prefix(c.length);
    }
    out.put_unchecked('"');
}

template <class T>
void put_number(Cursor& out, T value) {
    out.reserve(number_room);
    if constexpr (!std::is_floating_point_v<T>) {
        out.set(std::is_signed_v<T> ? write_integer(out.at(), static_cast<std::int64_t>(value))
                                    : write_unsigned(out.at(), static_cast<std::uint64_t>(value)));
    } else if (std::isfinite(value)) {
        out.set(write_float(out.at(), value));
    } else {
        out.put_unchecked(std::isnan(value) ? "NaN" : value > 0 ? "Infinity" : "-Infinity");
    }
}

void put_columns(Cursor& out, const MessageView& view, const dialect::Field& field) {
    if (field.is_text()) {
        out.put(',');
        return put_cell(out, view.text(field));
    }
    if (field.type == dialect::FieldType::char8) {
        const auto character = view.get<char>(field);
        out.put(',');
        return put_cell(out, {&character, character == 0 ? 0u : 1u});
    }
    visit_type(field.type, [&](auto tag) {
        for (std::size_t i = 0; i < field.count(); ++i) {
            out.put(',');
            put_number(out, view.get<decltype(tag)>(field, i));
        }
    });
}

// The last column of HEARTBEAT. It is empty, not empty text, if the sender has no mode.
void put_mode(Cursor& out, ByteView heartbeat) {
    out.put(',');
    if (const auto mode = heartbeat_mode(heartbeat); !mode.empty()) put_cell(out, mode);
}

}  // namespace

void append_csv_header(TextBuffer& buffer, const dialect::Message& message) {
    Cursor out(buffer);
    out.put("time_us,link,sys,comp,seq");
    for (const auto& field : message.fields) {
        const bool one_column = field.is_text() || !field.is_array();
        for (std::size_t i = 0; i < (one_column ? 1 : field.count()); ++i) {
            out.put(',');
            out.put(field.name);
            if (one_column) continue;
            out.put('[');
            out.put_unsigned(i);
            out.put(']');
        }
    }
    if (has_mode(message)) out.put(",mode");
    out.put('\n');
}

void append_csv_row(TextBuffer& buffer, const Received& received) {
    if (received.message == nullptr) return;
    Cursor out(buffer);
    out.put_integer(unix_us(received.time));
    out.put(',');
    put_cell(out, received.link);
    for (const std::uint8_t number :
         {received.frame.system().value, received.frame.component().value, received.frame.sequence()}) {
        out.put(',');
        out.put_unsigned(number);
    }
    const MessageView view(*received.message, received.frame.payload());
    for (const auto& field : received.message->fields) put_columns(out, view, field);
    if (has_mode(*received.message)) put_mode(out, received.frame.payload());
    out.put('\n');
}

}  // namespace mavloom::message
