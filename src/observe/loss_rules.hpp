// SPDX-License-Identifier: MIT
// Alarms from sequence numbers: loss on a link, and two senders with one id. Private to module observe.
//
// The limits are our own choice. They judge spans of 10 s with at least 10 frames that show the fault:
// - Loss: 5 % of what was sent. It ends below 2.5 %.
// - Two senders: 10 % of the frames are late or out of sequence. Two counters that mix give half of them.
#pragma once

#include <map>
#include <span>
#include <utility>

#include "mavloom/base/clock.hpp"
#include "mavloom/observe/alarm.hpp"
#include "mavloom/observe/loss.hpp"

namespace mavloom::observe {

class LossRules {
public:
    static constexpr Nanoseconds span = std::chrono::seconds{10};

    // `losses` has all senders of all links that are up; others are forgotten.
    void judge(Alarms& alarms, std::span<const SenderLoss> losses, WallTime time, MonoTime now);

private:
    static constexpr std::size_t max_senders = 4096;
    struct Begin {
        MonoTime time{};
        SenderLoss loss{};
        MonoTime noted{};
    };
    void forget_others(Alarms& alarms, WallTime time, MonoTime now);
    static void judge_one(Alarms& alarms, const SenderLoss& begin, const SenderLoss& end, WallTime time);

    std::map<std::pair<LinkId, Source>, Begin> begins_;
};

}  // namespace mavloom::observe
