// SPDX-License-Identifier: MIT
// Formats messages as text for people, as JSON for programs, and as CSV. docs/guide/listen.md describes the three
// forms. All functions append to the caller's buffer. Reuse the buffer: once it has grown, formatting does not
// allocate. Pure functions, safe from any thread with separate buffers.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/message/view.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::message {

using TextBuffer = fmt::basic_memory_buffer<char, 4096>;

// A frame, and what the receiver knows about it.
struct Received {
    WallTime time{};
    std::string_view link;  // the link's name
    wire::FrameView frame;
    // Null if there is no definition; JSON then has "name":null and "payload_hex".
    const dialect::Message* message = nullptr;
};

// Appends one JSON object and a newline:
// {"time_us":…,"link":"…","sys":1,"comp":1,"seq":7,"id":30,"name":"ATTITUDE","v":2,"signed":false,"fields":{…}}
void append_json(TextBuffer& out, const Received& received);

// Writes the same output as append_json, but faster, for programs that print many messages. The constructor prepares
// the keys of every message of a dialect and allocates. Afterwards the object is immutable and safe from any thread.
// The records of the dialect must outlive it.
class JsonFormatter {
public:
    explicit JsonFormatter(const dialect::Dialect& dialect);
    // Messages of other dialects work too, at the speed of append_json.
    void append(TextBuffer& out, const Received& received) const;

private:
    struct Step {                  // one field
        std::array<char, 28> key;  // `,"roll":`, or `{"roll":` for the first field
        std::uint8_t key_length;   // 0 if the key does not fit
        dialect::FieldType type;   // this and the next two members as in dialect::Field
        std::uint8_t offset;
        std::uint8_t array_length;
    };
    struct Prepared {
        std::string id_and_name;  // `,"id":30,"name":"ATTITUDE"`
        std::size_t first_step;
        std::size_t room;  // the maximum length of its line, without the link's name
    };
    [[nodiscard]] static Step step_of(const dialect::Field& field, char before) noexcept;
    [[nodiscard]] const Prepared* find(const dialect::Message* message) const noexcept;

    std::span<const dialect::Message> messages_;
    std::vector<Prepared> prepared_;  // by message
    std::vector<Step> steps_;         // by message and field
};

// Appends "12:34:56.789012 link 1/1 ATTITUDE  roll=0.01 rad …" and a newline.
// Adds units and enum names (A|B for flags), and labels the MAV_CMD parameters of COMMAND_LONG, COMMAND_INT,
// MISSION_ITEM and MISSION_ITEM_INT. `dialect` is used to look up the enums of command parameters.
void append_text(TextBuffer& out, const Received& received, const dialect::Dialect& dialect);

// One field, as append_text writes it: "param1(Radius)", and "5 m".
void append_field_label(TextBuffer& out, const MessageView& view, const dialect::Field& field,
                        const dialect::Dialect& dialect);
void append_field_value(TextBuffer& out, const MessageView& view, const dialect::Field& field,
                        const dialect::Dialect& dialect);
// An element of an array, with its units.
void append_element(TextBuffer& out, const MessageView& view, const dialect::Field& field, std::size_t index);
// False for text, and for bytes that are printed in hexadecimal digits.
[[nodiscard]] bool has_elements(const dialect::Field& field) noexcept;
// The number in the units that are printed; NaN if the sender marked it as invalid.
[[nodiscard]] double scaled_number(const MessageView& view, const dialect::Field& field, std::size_t index) noexcept;

// CSV of one message type (RFC 4180). The header row is time_us,link,sys,comp,seq,FIELD…; arrays are
// FIELD[0],FIELD[1]…. Each frame is one row; a frame without definition adds nothing.
void append_csv_header(TextBuffer& out, const dialect::Message& message);
void append_csv_row(TextBuffer& out, const Received& received);

// Appends the fields alone, without braces: `"roll":0.01,"pitch":…`. For other JSON writers of the project.
void append_json_fields(TextBuffer& out, const dialect::Message& message, ByteView payload);

}  // namespace mavloom::message
