// SPDX-License-Identifier: MIT
// From Python values to payloads and frames. Every value is checked before anything is written: what does not fit raises UsageError with message,
// field and range. The GIL is held.
#pragma once

#include <nanobind/nanobind.h>

#include "integer.hpp"
#include "mavloom/message/builder.hpp"
#include "mavloom/wire/frame_writer.hpp"
#include "message.hpp"

namespace mavloom::python {

// Sets the fields that are given by name; the others stay.
void set_fields(const dialect::Dialect& dialect, message::MessageBuilder& builder, const nb::kwargs& fields);

// A message by name, with these fields and zeros elsewhere; or a Message, with these fields replaced.
[[nodiscard]] message::MessageBuilder build(const Definitions& definitions, const nb::object& message,
                                            const nb::kwargs& fields);

[[nodiscard]] wire::Version version_of(const char* what, const Integer& given);
// Raises UsageError where MAVLink 1 has no room for a message.
void check_version(wire::Version version, const dialect::Message& message);

// The frame of what was built; MAVLink 1 where the message fits there, else UsageError.
[[nodiscard]] wire::FrameView write(wire::FrameBuffer& out, const wire::FrameHeader& header,
                                    const message::MessageBuilder& builder);

// The one whole frame that these bytes are; raises InputError where they are none.
[[nodiscard]] wire::FrameView whole_frame(const dialect::Dialect& dialect, ByteView bytes);
// Makes a Message of it.
[[nodiscard]] nb::object decode(const std::shared_ptr<const Origin>& origin, ByteView bytes, std::int64_t time_ns);

// A view of any bytes-like object, held as long as this lives. An array of Python objects is refused (UsageError): its bytes are pointers.
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
