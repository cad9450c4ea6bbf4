// SPDX-License-Identifier: MIT
// Fields of a frame's header as Python sees them. Functions; any thread.
#pragma once

#include "mavloom/wire/frame.hpp"

namespace mavloom::python {

[[nodiscard]] inline int system_of(const wire::FrameView& frame) { return frame.system().value; }
[[nodiscard]] inline int component_of(const wire::FrameView& frame) { return frame.component().value; }
[[nodiscard]] inline int sequence_of(const wire::FrameView& frame) { return frame.sequence(); }

}  // namespace mavloom::python
