// SPDX-License-Identifier: MIT
// RateQuestion: asks a vehicle to send a message at another rate, and waits for its answer.
// Source: MAVLink guide, "Command Protocol" and MAV_CMD_SET_MESSAGE_INTERVAL.
//
// One thread asks, another one hears.
#pragma once

#include <atomic>
#include <mutex>

#include "mavloom/feed/receiver.hpp"
#include "mavloom/view/state.hpp"

namespace mavloom::app {

class RateQuestion {
public:
    explicit RateQuestion(feed::Receiver& receiver) : receiver_(receiver) {}

    // Sends the command to all sources, and forgets the question before.
    void ask(const view::RateRequest& request);
    // Each frame that arrives.
    void hear(const wire::FrameView& frame) {
        if (waits_.load(std::memory_order_relaxed) && frame.id() == answer_id) take_answer(frame);
    }
    [[nodiscard]] view::RateRequest::Answer answer();

private:
    static const MessageId answer_id;

    void take_answer(const wire::FrameView& frame);

    feed::Receiver& receiver_;
    std::uint8_t sequence_ = 0;
    std::atomic<bool> waits_{false};
    std::mutex mutex_;
    // Guarded by mutex_:
    Source to_{};
    std::uint64_t untaken_before_ = 0;
    std::optional<std::uint8_t> result_;
};

}  // namespace mavloom::app
