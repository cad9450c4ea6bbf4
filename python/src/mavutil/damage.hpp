// SPDX-License-Identifier: MIT
// The reasons in the BAD_DATA messages of mavloom.mavutil, in pymavlink's words, which its tools print.
#pragma once

#include <string>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::python {

inline constexpr const char* bad_prefix = "Bad prefix";

// `frame` has a wrong checksum. `definition` is null for an id without definition.
[[nodiscard]] std::string crc_reason(const wire::FrameView& frame, const dialect::Message* definition);

}  // namespace mavloom::python
