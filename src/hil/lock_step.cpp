// SPDX-License-Identifier: MIT
#include "mavloom/hil/lock_step.hpp"

#include <algorithm>
#include <cmath>

namespace mavloom::hil {

using namespace std::chrono_literals;

namespace {

constexpr Nanoseconds longest_debt = 100ms;  // steps that a stall delayed for longer are not made up for
constexpr Nanoseconds silent_limit = 3s;     // of an autopilot with a clock of its own

}  // namespace

LockStep::LockStep(Nanoseconds step, double speed, bool has_own_clock) noexcept
    : step_(step), speed_(speed), has_own_clock_(has_own_clock) {}

void LockStep::begin(MonoTime now) noexcept {
    state_ = State::booting;
    began_ = time_;
    newest_answer_ = {};
    is_answered_ = true;
    is_measuring_ = false;
    missed_ = in_row_ = 0;
    due_ = heard_ = now;
    flies_by_own_clock_ = has_own_clock_;
}

void LockStep::end() noexcept {
    state_ = State::waiting;
    is_measuring_ = false;
    allowed_ = 0;
}

MonoTime LockStep::due() const noexcept {
    if (state_ == State::waiting || (is_paused_ && allowed_ == 0)) return MonoTime::max();
    if (is_paced() || is_answered_) return due_;
    return std::max(due_, sent_ + answer_limit);
}

FlightTime LockStep::take(MonoTime now) noexcept {
    if (!is_answered_) count_unanswered(now);
    if (state_ == State::real_time && now > heard_ + silent_limit) lose(now);
    measure(now);
    if (is_paused_ && allowed_ != 0) --allowed_;
    const bool is_free = !is_paced() && speed_ == any_speed;
    due_ = is_free ? now : std::max(due_ + pace(), now - longest_debt);
    sent_ = now;
    is_answered_ = flies_by_own_clock_;
    ++counters_.steps;
    return time_ += step_;
}

// A booting or lost autopilot needs real time; a slow simulation stays slow.
Nanoseconds LockStep::pace() const noexcept {
    const double speed = is_paced() ? std::min(speed_, 1.0) : speed_;
    return Nanoseconds{static_cast<std::int64_t>(std::floor(static_cast<double>(step_.count()) / speed))};
}

void LockStep::count_unanswered(MonoTime now) noexcept {
    if (state_ == State::booting) return;
    ++counters_.unanswered;
    if (++missed_ >= max_missed && state_ == State::lock_step) lose(now);
}

void LockStep::lose(MonoTime now) noexcept {
    state_ = State::lost;
    due_ = now;
    ++counters_.losses;
}

void LockStep::measure(MonoTime now) noexcept {
    const bool counts = is_measuring_;
    is_measuring_ = !is_paused_ && (state_ == State::lock_step || state_ == State::real_time);
    if (!counts || !is_measuring_) return;
    measured_flight_ += step_;
    measured_real_ += now - sent_;
}

Answer LockStep::answer(std::uint64_t time_us, bool knows_lock_step, MonoTime now) noexcept {
    heard_ = now;
    if (state_ == State::waiting) return Answer::unasked;
    const Answer answer = judge(time_us);
    if (state_ == State::booting) leave_boot(answer, knows_lock_step);
    if (flies_by_own_clock_) {
        state_ = State::real_time;
        return Answer::unasked;
    }
    count(answer);
    if (answer != Answer::in_time && answer != Answer::late) return answer;
    note_row(time_us);
    if (answer == Answer::in_time) accept(now);
    return answer;
}

// An autopilot that answers each step late is not lost, but one that answers every fourth step is.
void LockStep::note_row(std::uint64_t time_us) noexcept {
    const bool follows = time_us == newest_answer_ + wire_time(step_);
    in_row_ = follows ? in_row_ + 1 : 1;
    newest_answer_ = time_us;
    if (in_row_ < enough_in_row) return;
    missed_ = 0;
    if (state_ == State::lost) state_ = State::lock_step;
}

void LockStep::count(Answer answer) noexcept {
    counters_.late += answer == Answer::late ? 1 : 0;
    counters_.repeated += answer == Answer::repeated ? 1 : 0;
    counters_.foreign += answer == Answer::foreign ? 1 : 0;
}

// An autopilot answers in the order of the steps.
Answer LockStep::judge(std::uint64_t time_us) const noexcept {
    const std::uint64_t last = wire_time(time_);
    if (time_us > last || time_us <= wire_time(began_)) return Answer::foreign;
    if (time_us <= newest_answer_) return Answer::repeated;
    return time_us < last ? Answer::late : Answer::in_time;
}

// One that does not know lock-step may still answer each step.
void LockStep::leave_boot(Answer answer, bool knows_lock_step) noexcept {
    if (flies_by_own_clock_) return;
    if (answer == Answer::in_time || (answer == Answer::late && knows_lock_step)) state_ = State::lock_step;
    else flies_by_own_clock_ = !knows_lock_step;
}

void LockStep::accept(MonoTime now) noexcept {
    is_answered_ = true;
    ++counters_.answered;
    answer_times_.add(now - sent_);
}

void LockStep::pause(MonoTime) noexcept {
    is_paused_ = true;
    allowed_ = 0;
}

bool LockStep::is_stepping(MonoTime now) const noexcept {
    if (!is_paused_ || state_ == State::waiting) return false;
    return allowed_ != 0 || (!is_answered_ && now < sent_ + answer_limit);
}

void LockStep::resume(MonoTime now) noexcept {
    if (!is_paused_) return;
    is_paused_ = is_measuring_ = false;
    due_ = sent_ = now;
}

double LockStep::speed_reached() const noexcept {
    if (measured_real_ <= Nanoseconds{}) return 0;
    return static_cast<double>(measured_flight_.count()) / static_cast<double>(measured_real_.count());
}

}  // namespace mavloom::hil
