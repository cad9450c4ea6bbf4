// SPDX-License-Identifier: MIT
// Converts Python values to payloads and frames.
// Every value is checked before anything is written. A value that does not fit raises UsageError with message, field
// and range. Call with the GIL held.
#pragma once

#include <nanobind/nanobind.h>

#include "integer.hpp"
#include "mavloom/message/builder.hpp"
#include "mavloom/wire/frame_writer.hpp"
#include "message/message.hpp"

namespace mavloom::python {

// Sets the fields that are given by name and leaves the others unchanged.
void set_fields(const dialect::Dialect& dialect, message::MessageBuilder& builder, const nb::kwargs& fields);

// Builds a message from a name, with these fields and 0 in all others (but HEARTBEAT.mavlink_version is 3), or from a
// Message, with these fields replaced.
[[nodiscard]] message::MessageBuilder build(const Definitions& definitions, const nb::object& message,
                                            const nb::kwargs& fields);

[[nodiscard]] wire::Version version_of(const char* what, const Integer& given);
// Raises UsageError if MAVLink 1 cannot carry the message.
void check_version(wire::Version version, const dialect::Message& message);

// Writes the frame to `out`. Raises UsageError if the header asks for MAVLink 1, which cannot carry the message.
[[nodiscard]] wire::FrameView write(wire::FrameBuffer& out, const wire::FrameHeader& header,
                                    const message::MessageBuilder& builder);

// Returns a view of `bytes` as a frame. Raises InputError if they are not exactly one valid frame.
[[nodiscard]] wire::FrameView whole_frame(const dialect::Dialect& dialect, ByteView bytes);
// Decodes such bytes to a Message.
[[nodiscard]] nb::object decode(const std::shared_ptr<const Origin>& origin, ByteView bytes, std::int64_t time_ns);

// A view of any bytes-like object, held for the lifetime of this object. Raises UsageError for an array of Python
// objects, because its bytes are pointers.
class Buffer {
public:
    explicit Buffer(const nb::object& object);
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;
    ~Buffer() { PyBuffer_Release(&view_); }

    [[nodiscard]] ByteView bytes() const noexcept {
        return {static_cast<const std::uint8_t*>(view_.buf), static_cast<std::size_t>(view_.len)};
    }

private:
    Py_buffer view_{};
};

}  // namespace mavloom::python
