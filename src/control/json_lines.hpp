// SPDX-License-Identifier: MIT
// JSON for the control socket: one object per line, with the keys in insertion order. Modules router and simserve
// include this header.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/link/snapshot.hpp"

namespace mavloom::control {

using Json = nlohmann::ordered_json;

// Appends one line: the object, with `counts` as its last keys. Strings from outside, such as names in URLs, may hold
// any bytes; invalid UTF-8 becomes U+FFFD.
void append_line(std::string& text, Json object, std::span<const link::NamedCount> counts = {});

// The line {"ok":true}, which ends a successful answer.
inline void append_ok(std::string& text) { append_line(text, {{"ok", true}}); }

// One line each; `append_sources` appends one for each source of the link.
void append_endpoint(std::string& text, const link::Snapshot::OfEndpoint& endpoint);
void append_gone(std::string& text, const link::Snapshot::OfEndpoint& endpoint);
void append_link(std::string& text, const link::Snapshot& snapshot, const link::Snapshot::OfLink& link);
void append_sources(std::string& text, const link::Snapshot::OfLink& link);

}  // namespace mavloom::control
