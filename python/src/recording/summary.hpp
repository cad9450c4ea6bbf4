// SPDX-License-Identifier: MIT
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <string>

#include "mavloom/observe/summary.hpp"
#include "message/message.hpp"

namespace mavloom::python {

struct RecordingSummary {
    std::shared_ptr<const Origin> origin;  // has the names of the messages
    observe::Summary summary;
    std::uint64_t junk_bytes, damaged_places;
};

// Reads a whole file without the GIL, and handles signals meanwhile. With `shows_progress`, shows how far it is.
[[nodiscard]] RecordingSummary summary_of(const std::string& path, const std::shared_ptr<const Origin>& origin,
                                          bool shows_progress);

}  // namespace mavloom::python
