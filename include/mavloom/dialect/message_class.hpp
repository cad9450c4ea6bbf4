// SPDX-License-Identifier: MIT
// Classifies messages for links that cannot carry everything. The classification decides which frames a full queue
// drops first, which frames a newer frame supersedes, and which messages `max_rate=*:N` does not limit.
// docs/guide/queues.md lists every message that this module treats specially. Pure functions, safe from any thread;
// nothing allocates.
#pragma once

#include <string_view>

#include "mavloom/base/ids.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::dialect {

// A full queue drops telemetry first, then targeted, then essential messages.
enum class MessageClass : std::uint8_t {
    essential,  // a user or a protocol waits for it: HEARTBEAT, STATUSTEXT, commands, missions, parameters
    targeted,   // all others that have a target system
    telemetry,  // all others, including ids without definition
};

// How one frame relates to earlier and later frames of the same message.
enum class FrameMeaning : std::uint8_t {
    latest,       // the latest value; a newer frame of the same source and instance supersedes it
    piece,        // part of a transfer that is useless without the other parts
    event,        // reports something that happened once
    answer,       // answers a request
    one_of_many,  // describes one of many objects: an aircraft, an obstacle
    one_of_kind,  // from one of several sensors or devices that no `instance` field distinguishes
};

[[nodiscard]] bool is_essential(MessageId id) noexcept;
// `info` is null for an id without definition, here and below.
[[nodiscard]] MessageClass class_of(MessageId id, const wire::MessageInfo* info) noexcept;
[[nodiscard]] FrameMeaning meaning_of(MessageId id) noexcept;

// True for telemetry that is not a piece, an event or an answer. A rate for all messages limits only these.
[[nodiscard]] bool can_be_thinned(MessageId id, const wire::MessageInfo* info) noexcept;
// The harm of dropping single frames of this message, worded as the end of a warning: "commands and their answers may
// get lost". Empty if `can_be_thinned`.
[[nodiscard]] std::string_view harm_of_thinning(MessageId id, const wire::MessageInfo* info) noexcept;

}  // namespace mavloom::dialect
