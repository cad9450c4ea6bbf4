// SPDX-License-Identifier: MIT
// Messages as ROS 2's own types, which viewers show without set-up: positions on a map, poses in space, texts in a log.
// Private to module web. Sources: ROS 2's packages sensor_msgs, geometry_msgs, tf2_msgs, rcl_interfaces, std_msgs and
// builtin_interfaces; REP 103 for axes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/message/view.hpp"

namespace mavloom::web {

// All that a standard message is made of. Views; they own nothing.
struct StandardInput {
    message::MessageView view;          // of the message `Standard::from`
    const message::MessageView* other;  // of the latest `Standard::other`; null: none has arrived
    Source source;
    WallTime time;
};

struct Standard {
    MessageId from;
    std::optional<MessageId> other{};  // of the same source
    std::string_view topic;            // its last part
    std::string_view type;
    std::string (*schema)();
    // Appends the message as CDR.
    void (*encode)(const StandardInput& input, std::vector<std::uint8_t>& out);
};

[[nodiscard]] std::span<const Standard> standards() noexcept;

}  // namespace mavloom::web
