// SPDX-License-Identifier: MIT
// The messages of mavloom.mavutil. They have pymavlink's form: every attribute is a field first, and attributes can be
// set. The class MavutilMessage is the base of one Python class for each message, which mavloom/mavutil/_messages.py
// makes. Call with the GIL held. Not synchronized: two threads must not change one message at the same time.
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "message/message.hpp"
#include "message/values.hpp"

namespace mavloom::python {

// How one connection makes its messages: their Python classes, and whether extension fields are hidden.
class MavutilStyle {
public:
    // `class_of(name)` returns the Python class of a message; for None, that of messages without a definition.
    explicit MavutilStyle(nb::object class_of) : class_of_(std::move(class_of)) {}

    [[nodiscard]] nb::handle class_of(const Definitions& definitions, const dialect::Message* message);

    // While set, messages have no extension fields in `to_dict` and text, as with pymavlink's MAVLink 1. The first
    // frame of MAVLink 2 ends it.
    std::atomic<bool> hides_extensions{false};

private:
    nb::object class_of_;
    std::vector<nb::object> classes_;  // by message; the last one is for messages without a definition
};

struct MavutilMessage {
    Message base;      // size 0: made by the user and not packed yet
    nb::object extra;  // a dict of the attributes that were set; null if none were
    bool hides_extensions = false;
    bool is_noted = false;  // by a connection

    [[nodiscard]] ByteView payload() const noexcept { return base.size == 0 ? ByteView() : base.frame().payload(); }
    // The fields that `to_dict` and text show.
    [[nodiscard]] std::span<const dialect::Field> fields() const noexcept;
    // Sets an attribute without any checks.
    void set(const nb::object& name, const nb::object& value);
};

[[nodiscard]] nb::object make_mavutil_message(const std::shared_ptr<const Origin>& origin,
                                              const dialect::Message* definition, std::int64_t time_ns,
                                              std::uint32_t link, const wire::FrameView& frame, std::uint8_t verdict);

// Returns null if `object` is not such a message.
[[nodiscard]] MavutilMessage* mavutil_message(nb::handle object) noexcept;

}  // namespace mavloom::python
