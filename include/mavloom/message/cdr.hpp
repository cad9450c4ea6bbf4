// SPDX-License-Identifier: MIT
// Messages as ROS 2 messages: for Foxglove, Lichtblick, PlotJuggler and other programs that read "cdr" with "ros2msg"
// schemas, live or from MCAP files. A MAVLink payload is almost a CDR body: little-endian, its fields sorted by size.
// docs/formats/ros2msg.md describes the names and types. Nothing here keeps a reference to a definition. All functions
// are safe from any thread.
//
// Sources: the ROS 2 interface definition (names, types, constants); CDR as DDS-RTPS defines it: encapsulation CDR_LE,
// each number aligned to its size, relative to the first byte after the encapsulation header.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/dialect/dialect.hpp"

namespace mavloom::message {

// The name of a message's schema: "mavlink/msg/VfrHud" for VFR_HUD.
[[nodiscard]] std::string ros2_type(const dialect::Message& definition);

// The text of that schema (encoding "ros2msg"): the fields in the order of the payload, units in comments, enum entries
// as constants before their field.
[[nodiscard]] std::string ros2msg(const dialect::Message& definition);

// Encodes the payloads of one message type as CDR. The constructor allocates; `encode` does not. Immutable.
class CdrEncoder {
public:
    explicit CdrEncoder(const dialect::Message& definition);

    // The most bytes that `encode` writes, whatever the payload.
    [[nodiscard]] std::size_t max_size() const noexcept { return max_size_; }

    // Writes header and body to the start of `out`, which has room for `max_size()` bytes, and returns their size.
    // Bytes that the sender cut off (trailing zeros in MAVLink 2, extension fields in MAVLink 1) become 0. Bytes beyond
    // the definition are dropped. Text ends at its first NUL. Readers refuse text that is not UTF-8, so bytes that are
    // not become U+FFFD.
    std::size_t encode(ByteView payload, ByteSpan out) const noexcept;

private:
    struct Step {  // bytes of the payload that are copied together, or one text
        std::uint8_t from, size, alignment;
        bool is_text;
    };
    // The constructor knows this about the next position in the body: position % modulus == remainder.
    struct Position {
        std::size_t modulus = 8, remainder = 0;
    };
    void add_text(const dialect::Field& field, Position& next);
    void add_numbers(const dialect::Field& field, Position& next);

    std::vector<Step> steps_;  // in the order of the payload, without gaps
    std::size_t payload_size_;
    std::size_t max_size_;
};

}  // namespace mavloom::message
