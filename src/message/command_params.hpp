// SPDX-License-Identifier: MIT
// Finds the meaning of the parameters in a COMMAND_LONG, COMMAND_INT, MISSION_ITEM or MISSION_ITEM_INT, according to
// its command. In messages with x, y and z, these are parameters 5, 6 and 7. Borrows the message and the dialect, which
// must outlive it; allocates nothing.
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
        const dialect::Enum* enumeration;  // null for a plain number
        bool degrees_e7;                   // an integer latitude or longitude in a global frame

        // True if the sender left the parameter unset: NaN, or INT32_MAX for an integer position.
        [[nodiscard]] bool is_unset(const MessageView& view) const noexcept;
    };

    // Other messages have no parameters.
    CommandParams(const MessageView& view, const dialect::Dialect& dialect) noexcept;

    // Returns empty if the field is not a parameter, or the command does not define it.
    [[nodiscard]] std::optional<Param> find(const dialect::Field& field) const noexcept;

private:
    const dialect::Dialect* dialect_;
    const dialect::EnumEntry* command_ = nullptr;
    bool global_frame_ = false;
};

}  // namespace mavloom::message
