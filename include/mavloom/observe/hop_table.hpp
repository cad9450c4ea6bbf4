// SPDX-License-Identifier: MIT
// The programs on the way of the frames: their rates, and alarms about the losses that grow.
// One owner thread.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/observe/alarm.hpp"
#include "mavloom/observe/hop.hpp"

namespace mavloom::observe {

class HopTable {
public:
    // Replaces the hops. Fills rates that are not given. Losses that grew since the last call are alarms: errors, if
    // the hop is down; sums of links are left out. A program may leave out losses that are 0.
    void set(std::vector<Hop> hops, Alarms& alarms, WallTime time, MonoTime now);
    [[nodiscard]] const std::vector<Hop>& all() const noexcept { return hops_; }

private:
    struct Passed {
        MonoTime time;
        std::uint64_t in, out;
    };
    using Flow = std::deque<Passed>;  // of the last seconds
    struct Growth {
        std::uint64_t first = 0, last = 0;  // the count before the alarm, and now
    };
    template <class Flowing>
    void fill_rates(Flowing& of, const std::string& name, MonoTime now);
    struct When {
        WallTime time;
        MonoTime now;
    };
    void watch(const std::string& name, const std::vector<NamedCount>& losses, Alarms& alarms, Alarm::Severity severity,
               When when);
    void watch(const std::string& name, const NamedCount& loss, Alarms& alarms, Alarm::Severity severity, When when);

    std::vector<Hop> hops_;
    std::map<std::string, Flow> flows_, new_flows_;        // by name of hop, or hop and link
    std::map<std::string, Growth> growths_, new_growths_;  // by name and loss
};

}  // namespace mavloom::observe
