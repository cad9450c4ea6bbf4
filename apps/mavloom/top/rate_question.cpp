// SPDX-License-Identifier: MIT
#include "top/rate_question.hpp"

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::app {

// QGroundControl is component 190 of the same system.
static constexpr Source own_source{SystemId{255}, ComponentId{193}};

const MessageId RateQuestion::answer_id = msg::CommandAck::id;

static wire::FrameView command_for(wire::FrameBuffer& buffer, const view::RateRequest& request, std::uint8_t sequence) {
    const auto& to = request.key.source;
    const msg::CommandLong command{.target_system = to.system.value,
                                   .target_component = to.component.value,
                                   .command = msg::MAV_CMD_SET_MESSAGE_INTERVAL,
                                   .param1 = static_cast<float>(request.key.id.value),
                                   .param2 = request.interval_us()};
    std::array<std::uint8_t, msg::CommandLong::max_length> payload{};
    command.encode(payload);
    const auto& info = *dialect::default_dialect().wire_table().find(msg::CommandLong::id);
    return wire::write_frame(buffer, {.sequence = sequence, .source = own_source}, info, payload);
}

void RateQuestion::ask(const view::RateRequest& request) {
    {
        const std::lock_guard lock(mutex_);
        to_ = request.key.source;
        result_.reset();
        untaken_before_ = receiver_.untaken();
        waits_ = true;
    }
    wire::FrameBuffer buffer;
    receiver_.send(command_for(buffer, request, sequence_++));
}

// Older vehicles do not name whom they answer.
void RateQuestion::take_answer(const wire::FrameView& frame) {
    const auto ack = msg::CommandAck::decode(frame.payload());
    const bool is_for_us = ack.target_system == 0 ||
                           Source{SystemId{ack.target_system}, ComponentId{ack.target_component}} == own_source;
    const std::lock_guard lock(mutex_);
    if (frame.source() != to_ || ack.command != msg::MAV_CMD_SET_MESSAGE_INTERVAL || !is_for_us) return;
    result_ = ack.result;
    waits_ = false;
}

view::RateRequest::Answer RateQuestion::answer() {
    const std::lock_guard lock(mutex_);
    return {.result = result_, .is_untaken = receiver_.untaken() != untaken_before_};
}

}  // namespace mavloom::app
