// SPDX-License-Identifier: MIT
// How much a message matters to a link that cannot carry everything: what a full queue drops first, which frame a newer one supersedes, and
// which messages a rate for all (`max_rate=*:N`) leaves alone. docs/guide/queues.md lists every message named here.
// Pure functions, safe from any thread; nothing allocates.
#pragma once

#include <string_view>

#include "mavloom/base/ids.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::dialect {

// The order in which a full queue drops: telemetry first.
enum class MessageClass : std::uint8_t {
    essential,  // a person or a protocol waits for it: HEARTBEAT, STATUSTEXT, commands, missions, parameters
    targeted,   // everything else with a target system
    telemetry,  // the rest, ids without definition included
};

// What one frame of a message means to the frames of it before and after.
enum class FrameMeaning : std::uint8_t {
    latest,       // the newest value; a newer frame of the same source and instance supersedes it
    piece,        // a piece of a whole: useless without the others
    event,        // something that happened once
    answer,       // what somebody asked for
    one_of_many,  // one of many things: an aircraft, an obstacle
    one_of_kind,  // one of several sensors or devices that no `instance` field tells apart
};

[[nodiscard]] bool is_essential(MessageId id) noexcept;
// `info` is null for an id without definition.
[[nodiscard]] MessageClass class_of(MessageId id, const wire::MessageInfo* info) noexcept;
[[nodiscard]] FrameMeaning meaning_of(MessageId id) noexcept;

// Whether the receiver can do with fewer frames of this message: telemetry that is no piece, event or answer. Only this is thinned by a rate
// for all messages.
[[nodiscard]] bool can_be_thinned(MessageId id, const wire::MessageInfo* info) noexcept;
// What goes wrong when single frames of this message are dropped, as the end of a warning: "commands and their answers may get lost". Empty
// where `can_be_thinned`.
[[nodiscard]] std::string_view harm_of_thinning(MessageId id, const wire::MessageInfo* info) noexcept;

}  // namespace mavloom::dialect
