// SPDX-License-Identifier: MIT
// The simulator for autopilots outside: each of its vehicles has an endpoint, at which one PX4 flies it in lock-step.
// See docs/guide/hil.md.
//
// The vehicles are independent: each has a flight clock of its own. One thread owns and drives the object; any thread
// may call `wake` and `post`. A step allocates nothing.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/config/config.hpp"
#include "mavloom/control/served.hpp"
#include "mavloom/hil/pair.hpp"
#include "mavloom/hil/timed_fault.hpp"
#include "mavloom/link/links.hpp"

namespace mavloom::control {
class PostBox;
}

namespace mavloom::simserve {

struct HilOptions {
    double speed = 1;  // of all flights; hil::any_speed: as fast as each autopilot answers
    hil::SensorRates rates{};
    WallTime utc_at_start{};  // the epoch: the time at which it is created
};

// A copy of the state of one vehicle and its autopilot.
struct HilReport {
    std::string port;
    std::string peer;  // the autopilot's link; empty if there is none
    hil::PairStatus status;
    hil::StepCounters steps;
    hil::PairCounters counters;
    std::vector<std::string> faults;  // on purpose: "gps off"
    double speed_reached = 0;
    // Of a step: from its sensor messages to the autopilot's answer, and our computing time.
    Nanoseconds answer_median{}, answer_p99{}, own_median{}, own_p99{};
};

class HilPort;

class HilSimulator final : public control::Served, private link::LinkHandler {
public:
    // Receives log lines. Called on the simulator's thread.
    using Notice = std::function<void(config::LogLevel, std::string_view)>;

    // `dialect` must outlive the simulator.
    [[nodiscard]] static SetupResult<std::unique_ptr<HilSimulator>> create(const dialect::Dialect& dialect,
                                                                           const HilOptions& options, Notice notice);
    HilSimulator(const HilSimulator&) = delete;
    HilSimulator& operator=(const HilSimulator&) = delete;
    ~HilSimulator() override;

    // Adds a vehicle and opens the endpoint of its autopilot. A port in use is an error. `faults` are in the order of
    // their times.
    [[nodiscard]] SetupResult<void> add(const flight::VehicleOptions& vehicle, const endpoint::Endpoint& endpoint,
                                        std::vector<hil::TimedFault> faults = {});

    // Runs one turn: waits until a step is due, something arrives, or `deadline`, and handles all of it.
    void turn(MonoTime deadline);

    // Async-signal-safe.
    void wake() noexcept { links_->wake(); }
    // control::Served.
    void post(std::function<void()> work) override;
    void drop_posted() override;
    [[nodiscard]] control::Report answer(std::string_view request) override;
    [[nodiscard]] control::Report metrics() override;

    // For reports and requests; on the simulator's thread only.
    [[nodiscard]] std::vector<HilReport> reports() const;
    // The vehicles whose autopilot has this system id; without one, all.
    [[nodiscard]] std::vector<hil::Pair*> pairs(std::optional<SystemId> system);
    // Faults of the time lines that a vehicle refused.
    [[nodiscard]] std::uint64_t refused_orders() const;
    // Moves paused flights by this time, rounded up to whole steps. Calls `then` between two turns, when their
    // autopilots have answered the last step, or after `limit`; the rest of the steps then follows.
    void step(std::vector<hil::Pair*> pairs, Nanoseconds time, Nanoseconds limit, std::function<void()> then);
    [[nodiscard]] link::Links& links() noexcept { return *links_; }
    [[nodiscard]] const HilOptions& options() const noexcept { return options_; }
    [[nodiscard]] Nanoseconds uptime() const { return mono_now() - created_; }
    void notify(config::LogLevel level, std::string_view text) const { notice_(level, text); }

private:
    HilSimulator(const HilOptions& options, Notice notice, std::unique_ptr<link::Links> links);

    void on_frame(const link::RxFrame& rx) override;
    void on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) override;
    void on_link_down(LinkId link, link::EndpointId endpoint, std::string_view why) override;
    void on_notice(link::EndpointId endpoint, std::string_view text) override;

    void exchange(MonoTime deadline);
    [[nodiscard]] MonoTime next_due() const noexcept;
    [[nodiscard]] HilPort* port_of(link::EndpointId endpoint) noexcept;
    void step_due(MonoTime now);
    void maintain(MonoTime now);
    void end_steps(MonoTime now);

    // A request to move paused flights that is not answered yet.
    struct Step {
        std::vector<hil::Pair*> pairs;
        MonoTime end{};
        std::function<void()> then;
    };

    const HilOptions options_;
    Notice notice_;
    std::unique_ptr<link::Links> links_;
    std::unique_ptr<control::PostBox> posted_;
    std::vector<std::unique_ptr<HilPort>> ports_;
    std::vector<Step> steps_;
    MonoTime created_ = mono_now(), maintain_due_{};
};

// Reports of the simulator, as those of report.hpp: a "hil" line for each vehicle, or for those with this system id.
// `first`: lines to put before them.
[[nodiscard]] control::Report report_hil(HilSimulator& simulator, std::optional<SystemId> system,
                                         std::string first = {});
// The report at the end of a run: JSON lines, or a text for people.
[[nodiscard]] std::string json_of(const std::vector<HilReport>& reports);
[[nodiscard]] std::string text_of(const std::vector<HilReport>& reports);

}  // namespace mavloom::simserve
