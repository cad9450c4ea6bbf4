// SPDX-License-Identifier: MIT
// One endpoint of the simulator for autopilots outside, with the vehicle that is flown there. It decides which link
// flies the vehicle: the first one, until it is gone. Another one is closed, unless the first never showed to be an
// autopilot. Private to module simserve; single owner thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/line_budget.hpp"
#include "mavloom/hil/pair.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/simserve/hil_simulator.hpp"

namespace mavloom::simserve {

class HilPort {
public:
    using Notice = HilSimulator::Notice;

    // `faults` are in the order of their times. `links` and `notice` must outlive the object.
    HilPort(const hil::PairOptions& options, std::vector<hil::TimedFault> faults, link::Links& links,
            const Notice& notice);

    // Call it first.
    void opened(link::EndpointId endpoint, std::string label);
    [[nodiscard]] link::EndpointId endpoint() const noexcept { return endpoint_; }

    void on_link_up(LinkId link, std::string_view name);
    void on_link_down(LinkId link, std::string_view why);
    void receive(LinkId link, const wire::FrameView& frame);
    [[nodiscard]] MonoTime due() const noexcept { return std::max(pair_.due(), blocked_until_); }
    // Makes the step that is due, and queues its frames.
    void step(MonoTime now);
    // Closes the links that must go. Call it after each turn.
    void settle();
    // Call it about once a second.
    void maintain(MonoTime now);

    [[nodiscard]] hil::Pair& pair() noexcept { return pair_; }
    // Warns once about an autopilot at another port that has the same system id.
    void note_double(const HilPort& other);
    [[nodiscard]] HilReport report() const;
    [[nodiscard]] std::uint64_t refused_orders() const noexcept { return refused_orders_; }

private:
    void begin(LinkId link, std::string_view name);
    void end();
    void fail_due();
    void note_state();
    void say(config::LogLevel level, std::string_view text);
    void refuse_newcomers();
    [[nodiscard]] bool may_be_replaced() const;
    [[nodiscard]] std::string what_it_sent() const;

    hil::Pair pair_;
    const std::vector<hil::TimedFault> faults_;
    std::size_t next_fault_ = 0;
    std::uint64_t refused_orders_ = 0;  // faults of the time line
    link::Links& links_;
    const Notice& notice_;
    const bool is_board_;
    link::EndpointId endpoint_{};
    std::string label_, peer_;  // peer_: the link's name
    struct Newcomer {
        LinkId link;
        std::string name;
    };
    std::optional<LinkId> link_{};
    std::vector<Newcomer> newcomers_;         // of this turn
    hil::State state_ = hil::State::waiting;  // as last reported
    bool is_stranger_ = false, said_silent_ = false, said_lost_ = false, said_back_ = false, said_double_ = false,
         said_not_finite_ = false;
    MonoTime came_{}, blocked_until_{};
    LineBudget lines_;
    hil::StepTimes own_times_;
};

}  // namespace mavloom::simserve
