// SPDX-License-Identifier: MIT
// One formatter, two forms: a line of text for people, and the JSON object of DESIGN.md section 5 for programs. Appends to the caller's
// buffer, which is reused from message to message: no allocation per field, none per message once the buffer has grown.
// Pure functions of their arguments; safe from any thread with separate buffers.
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
#include "mavloom/wire/frame.hpp"

namespace mavloom::message {

using TextBuffer = fmt::basic_memory_buffer<char, 4096>;

// A frame together with what its reader knows of it.
struct Received {
    WallTime time{};
    std::string_view link;  // the link's name
    wire::FrameView frame;
    const dialect::Message* message = nullptr;  // null: no definition; printed with "name":null and "payload_hex"
};

// {"time_us":…,"link":"…","sys":1,"comp":1,"seq":7,"id":30,"name":"ATTITUDE","v":2,"signed":false,"fields":{…}} and a newline.
void append_json(TextBuffer& out, const Received& received);

// The same object, faster: the keys of every message of a dialect are made ahead. For programs that print many messages.
// Allocates when built, then like append_json. The dialect's records must outlive it; immutable, safe from any thread.
class JsonFormatter {
public:
    explicit JsonFormatter(const dialect::Dialect& dialect);
    // A message of another dialect is printed too, by append_json.
    void append(TextBuffer& out, const Received& received) const;

private:
    struct Step {                  // a field
        std::array<char, 28> key;  // `,"roll":`; `{` before the first of a message
        std::uint8_t key_length;   // 0: longer than fits here
        dialect::FieldType type;   // these three as in dialect::Field
        std::uint8_t offset;
        std::uint8_t array_length;
    };
    struct Prepared {
        std::string id_and_name;  // `,"id":30,"name":"ATTITUDE"`
        std::size_t first_step;
        std::size_t room;  // the most bytes that its line takes, without the link's name
    };
    [[nodiscard]] static Step step_of(const dialect::Field& field, char before) noexcept;
    [[nodiscard]] const Prepared* find(const dialect::Message* message) const noexcept;

    std::span<const dialect::Message> messages_;
    std::vector<Prepared> prepared_;  // by message
    std::vector<Step> steps_;         // by message and field
};

// "12:34:56.789012 link 1/1 ATTITUDE  roll=0.01 rad …" and a newline: units and enum names (flags as A|B) where they help; MAV_CMD
// parameters of COMMAND_LONG, COMMAND_INT and MISSION_ITEM_INT by their labels. `dialect` finds the enums of commands.
void append_text(TextBuffer& out, const Received& received, const dialect::Dialect& dialect);

// CSV of one message type (RFC 4180): a header row time_us,link,sys,comp,seq,FIELD…, arrays as FIELD[0],FIELD[1]…; then a row a frame.
void append_csv_header(TextBuffer& out, const dialect::Message& message);
void append_csv_row(TextBuffer& out, const Received& received);

// The values alone: `"roll":0.01,"pitch":…` without braces (JSON), as other JSON writers of the project need them.
void append_json_fields(TextBuffer& out, const dialect::Message& message, ByteView payload);

}  // namespace mavloom::message
