// SPDX-License-Identifier: MIT
// Reads a recording into a summary, piece by piece, so that the caller can show its progress and handle signals.
#pragma once

#include "mavloom/base/result.hpp"
#include "mavloom/observe/summarizer.hpp"
#include "mavloom/record/tlog_reader.hpp"

namespace mavloom::feed {

enum class Summarized : std::uint8_t { more, nothing_yet, all };

// Reads about `max_bytes` further bytes. `nothing_yet`: a pipe is empty, or a signal ended the wait. A file that
// is no recording is the error `bad_input`; an empty one is not.
[[nodiscard]] SetupResult<Summarized> summarize(record::TlogReader& reader, observe::Summarizer& to,
                                                std::uint64_t max_bytes);

}  // namespace mavloom::feed
