// SPDX-License-Identifier: MIT
// What param1 to param7 of a COMMAND_LONG, COMMAND_INT or MISSION_ITEM(_INT) mean for the command that it carries. In the messages with
// x, y, z these are parameters 5, 6 and 7. Borrows message and dialect; allocates nothing.
// Source: MAVLink guide, "Command Protocol" and "Mission Protocol".
#pragma once

#include <optional>

#include "mavloom/message/view.hpp"

namespace mavloom::message {

class CommandParams {
public:
    struct Param {
        const dialect::Field* field;
        const dialect::CommandParam* definition;
        const dialect::Enum* enumeration;  // null: a plain number
        bool degrees_e7;                   // an integer latitude or longitude in a global frame

        // NaN, and INT32_MAX for an integer position, say: not given, keep what is set.
        [[nodiscard]] bool is_unset(const MessageView& view) const noexcept;
    };

    // For any other message there are no parameters.
    CommandParams(const MessageView& view, const dialect::Dialect& dialect) noexcept;

    // Empty for a field that is no parameter, or one that the command does not define.
    [[nodiscard]] std::optional<Param> find(const dialect::Field& field) const noexcept;

private:
    const dialect::Dialect* dialect_;
    const dialect::EnumEntry* command_ = nullptr;
    bool global_frame_ = false;
};

}  // namespace mavloom::message
