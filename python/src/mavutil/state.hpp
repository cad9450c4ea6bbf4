// SPDX-License-Identifier: MIT
// MavutilState: what a connection of mavloom.mavutil remembers of the messages that it has read, in pymavlink's form:
// the newest message of each name, for each system, and the loss by sequence numbers. Call with the GIL held.
#pragma once

#include <nanobind/nanobind.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "mavutil/message.hpp"

namespace mavloom::python {

class MavutilState {
public:
    // `messages_of(system)` returns the dict of newest messages of a new system; it is called once for each.
    explicit MavutilState(nb::object messages_of) : messages_of_(std::move(messages_of)) {}

    // Notes a message. The first vehicle becomes the target. Returns true if the connection must look at it as well: a
    // heartbeat, a summary (HIGH_LATENCY2), a parameter, a GPS position or a message without definition. Returns
    // nullopt and does nothing if a connection has noted it before.
    std::optional<bool> note(const nb::object& message);
    // Adds a message to those of the target, whatever its sender. Counts nothing.
    void add_to_target(const nb::object& message);

    [[nodiscard]] nb::dict messages(std::uint8_t system);
    [[nodiscard]] nb::dict last_sequences() const;

    std::uint8_t target = 0;
    std::uint64_t count = 0, loss = 0;
    std::int64_t time_ns = 0;  // of the last message
    double uptime_s = 0;       // the sender's clock, from the last message that has it

private:
    // Bounds the memory that an endless series of new instance names can use.
    static constexpr Py_ssize_t max_messages = 4096;

    void add(const nb::dict& messages, const nb::object& message, const MavutilMessage& of);
    // Messages of a radio concern all systems behind it.
    void add_to_all(const nb::object& message, const MavutilMessage& of);
    void add_instance_of(const nb::dict& messages, const nb::object& message, const MavutilMessage& of,
                         const dialect::Field& instance);
    bool note_made(const nb::object& message, const MavutilMessage& of);
    void note_sequence(Source source, std::uint8_t sequence);
    void note_uptime(const MavutilMessage& message);

    nb::object messages_of_;
    nb::object instances_key_ = nb::steal(PyUnicode_InternFromString("_instances"));
    std::array<nb::object, 256> messages_;  // by system
    std::map<Source, std::uint8_t> sequences_;
    std::map<Source, std::uint8_t>::iterator last_ = sequences_.end();  // of the last message
};

}  // namespace mavloom::python
