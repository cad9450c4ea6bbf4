// SPDX-License-Identifier: MIT
#include "simserve/hil/hil_port.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "mavloom/base/counted.hpp"
#include "mavloom/base/durations.hpp"

namespace mavloom::simserve {

using namespace std::chrono_literals;
using config::LogLevel;
using hil::State;

namespace {

// PX4 sends at once.
constexpr Nanoseconds introduction_limit = 1s, silence_limit = 5s;
// A peer that takes no bytes gets no further steps until it does.
constexpr std::size_t max_queued_bytes = 32'768;
constexpr Nanoseconds blocked_pause = 10ms;

// A link's name without that of its endpoint, with which each line begins.
std::string short_name(std::string_view link) { return std::string(link.substr(link.rfind('#') + 1)); }

}  // namespace

HilPort::HilPort(const hil::PairOptions& options, std::vector<hil::TimedFault> faults, link::Links& links,
                 const Notice& notice)
    : pair_(options), faults_(std::move(faults)), links_(links), notice_(notice), is_board_(options.has_own_clock) {}

void HilPort::opened(link::EndpointId endpoint, std::string label) {
    endpoint_ = endpoint;
    label_ = std::move(label);
}

// ---- links ----------------------------------------------------------------------------------------------------------

void HilPort::on_link_up(LinkId link, std::string_view name) {
    if (!link_) return begin(link, name);
    newcomers_.push_back({link, short_name(name)});
}

void HilPort::on_link_down(LinkId link, std::string_view why) {
    std::erase_if(newcomers_, [&](const Newcomer& newcomer) { return newcomer.link == link; });
    if (link_ != link) return;
    say(LogLevel::info, fmt::format("{} left ({}); the vehicle is back at its start", peer_, why));
    end();
}

void HilPort::begin(LinkId link, std::string_view name) {
    link_ = link;
    peer_ = short_name(name);
    came_ = mono_now();
    is_stranger_ = said_silent_ = said_lost_ = said_back_ = said_double_ = said_not_finite_ = false;
    pair_.begin(came_);
    say(LogLevel::info, fmt::format("{} is there", peer_));
    note_state();
}

void HilPort::end() {
    link_.reset();
    peer_.clear();
    pair_.end();
    note_state();
}

// An autopilot that was started again may come before its old connection is seen to end, so this is decided after the
// turn.
void HilPort::settle() {
    if (link_ && (is_stranger_ || (!newcomers_.empty() && may_be_replaced()))) {
        links_.close(*link_);
        end();
    }
    if (newcomers_.empty()) return;
    if (!link_) {
        begin(newcomers_.front().link, newcomers_.front().name);
        newcomers_.erase(newcomers_.begin());
    }
    refuse_newcomers();
}

bool HilPort::may_be_replaced() const { return !pair_.is_known() && mono_now() > came_ + introduction_limit; }

void HilPort::refuse_newcomers() {
    for (const auto& [link, name] : newcomers_) {
        say(LogLevel::warning, fmt::format("{} was disconnected: {} flies this vehicle, and there is one autopilot a "
                                           "port",
                                           name, peer_));
        links_.close(link);
    }
    newcomers_.clear();
}

// ---- steps ----------------------------------------------------------------------------------------------------------

void HilPort::receive(LinkId link, const wire::FrameView& frame) {
    if (link != link_) return;
    const MonoTime now = mono_now();
    const auto heard = pair_.receive(frame, now);
    if (heard == hil::Heard::stranger && !pair_.is_known() && !is_stranger_ && !is_board_) {
        is_stranger_ = true;
        say(LogLevel::warning,
            fmt::format("{} was disconnected: its HEARTBEAT is not that of PX4, but of {}", peer_, what_it_sent()));
    }
    if (pair_.lock_step().state() != state_) note_state();
    if (heard == hil::Heard::controls && due() <= now) step(now);
}

void HilPort::step(MonoTime now) {
    if (links_.queued_bytes(*link_) > max_queued_bytes) {
        blocked_until_ = now + blocked_pause;
        return;
    }
    fail_due();
    const auto not_finite = pair_.counters().not_finite;
    for (const auto& frame : pair_.step(now)) links_.send(*link_, frame);
    if (pair_.counters().not_finite != not_finite && !std::exchange(said_not_finite_, true))
        say(LogLevel::warning,
            "the vehicle's motion became infinite, so it is back at its start; check its body, mass, pushes and wind");
    if (pair_.lock_step().state() != state_) note_state();
    own_times_.add(mono_now() - now);
}

void HilPort::fail_due() {
    for (; next_fault_ < faults_.size() && faults_[next_fault_].at <= pair_.lock_step().time(); ++next_fault_) {
        const auto& [at, fault] = faults_[next_fault_];
        const auto done = pair_.fail(fault);
        if (done) continue;
        ++refused_orders_;
        say(LogLevel::warning,
            fmt::format("order 'fail {}' at {:g} s: {}", flight::text_of(fault), seconds(at), done.error().text));
    }
}

// ---- what users see -------------------------------------------------------------------------------------------------

void HilPort::say(LogLevel level, std::string_view text) {
    if (lines_.spend()) notice_(level, fmt::format("{}: {}", label_, text));
}

void HilPort::note_state() {
    const State before = std::exchange(state_, pair_.lock_step().state());
    const auto vehicle = fmt::format("vehicle {} is flown", pair_.status().system.value);
    if (before == State::booting && state_ == State::lock_step) say(LogLevel::info, vehicle + " in lock-step");
    if (before == State::booting && state_ == State::real_time)
        say(LogLevel::info, vehicle + (is_board_ ? " in real time"
                                                 : " in real time: the autopilot keeps a clock of its own, as a PX4 "
                                                   "that was built without lock-step"));
    if (before == State::real_time && state_ == State::lost && !std::exchange(said_lost_, true))
        say(LogLevel::warning, "has sent no HIL_ACTUATOR_CONTROLS for some seconds; the motors keep the last ones");
    if (state_ == State::lost && !std::exchange(said_lost_, true))
        say(LogLevel::warning,
            fmt::format(
                "no answer to {} steps, so steps come in real time until {} in a row are answered. An autopilot "
                "does not answer if it was stopped, if its gyroscope or accelerometer failed, if it terminated the "
                "flight, or if sensors come more often than its parameter IMU_INTEG_RATE",
                hil::LockStep::max_missed, hil::LockStep::enough_in_row));
    const bool is_back = before == State::lost && (state_ == State::lock_step || state_ == State::real_time);
    if (is_back && !std::exchange(said_back_, true))
        say(LogLevel::info, state_ == State::lock_step ? "answers again: lock-step" : "sends again");
}

void HilPort::maintain(MonoTime now) {
    if (const auto suppressed = lines_.refill(); suppressed != 0)
        notice_(LogLevel::warning, fmt::format("{}: {}", label_, counted(suppressed, "more event")));
    if (!link_ || pair_.is_known() || is_board_ || said_silent_ || now < came_ + silence_limit) return;
    said_silent_ = true;
    say(LogLevel::warning, fmt::format("{} has sent {} for {:.0f} s, so it is no PX4. Another one may take its place",
                                       peer_, what_it_sent(), std::chrono::duration<double>(silence_limit).count()));
}

void HilPort::note_double(const HilPort& other) {
    const SystemId system = pair_.status().system;
    if (!pair_.is_known() || !other.pair_.is_known() || other.pair_.status().system != system) return;
    if (std::exchange(said_double_, true)) return;
    say(LogLevel::warning, fmt::format("the autopilots here and at {} both have system id {}, so ground stations take "
                                       "them for one; start each PX4 with a number of its own (-i)",
                                       other.label_, system.value));
}

std::string HilPort::what_it_sent() const {
    const auto* const counters = links_.counters(*link_);
    if (counters == nullptr) return "nothing";
    const auto junk = counters->junk_bytes.value();
    if (is_stranger_) return "another autopilot or of a ground station";
    if (junk != 0) return fmt::format("{} that are no MAVLink", counted(junk, "byte"));
    return counters->frames_in.value() == 0 ? "nothing" : "no HEARTBEAT and no HIL_ACTUATOR_CONTROLS";
}

HilReport HilPort::report() const {
    const auto& lock_step = pair_.lock_step();
    std::vector<std::string> faults;
    for (const flight::Fault& fault : pair_.faults()) faults.push_back(flight::text_of(fault));
    return {.port = label_,
            .peer = peer_,
            .status = pair_.status(),
            .steps = lock_step.counters(),
            .counters = pair_.counters(),
            .faults = std::move(faults),
            .speed_reached = lock_step.speed_reached(),
            .answer_median = lock_step.answer_times().at(0.5),
            .answer_p99 = lock_step.answer_times().at(0.99),
            .own_median = own_times_.at(0.5),
            .own_p99 = own_times_.at(0.99)};
}

}  // namespace mavloom::simserve
