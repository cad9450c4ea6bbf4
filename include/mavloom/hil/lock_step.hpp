// SPDX-License-Identifier: MIT
// The rules of time between a simulated vehicle and the autopilot that flies it: when the next step may begin, and what
// each answer means.
//
// The times of the steps are the autopilot's clock, so no time is ever repeated, and none goes back, even if the
// autopilot is started again. An autopilot that is booting does not answer: steps then come in real time. From its
// first answer on, each step waits for the answer to the one before, but for no longer than `answer_limit`. After
// `max_missed` steps without an answer they come in real time again, until `enough_in_row` steps in a row are
// answered. That many answers in a row also make up for earlier steps without one.
//
// Plain values; reads no clock. Single owner; nothing allocates.
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

#include "mavloom/base/clock.hpp"
#include "mavloom/flight/moment.hpp"
#include "mavloom/hil/step_times.hpp"

namespace mavloom::hil {

using flight::FlightTime;

// As fast as the autopilot answers.
inline constexpr double any_speed = std::numeric_limits<double>::infinity();

enum class State : std::uint8_t {
    waiting,    // for an autopilot
    booting,    // it is there, and has not answered yet
    lock_step,  // each step waits for an answer
    lost,       // it has stopped answering
    real_time,  // it flies without lock-step
};
inline constexpr std::string_view state_names[] = {"waiting", "booting", "lock-step", "lost", "real-time"};

// The time of a step as HIL messages have it.
[[nodiscard]] constexpr std::uint64_t wire_time(FlightTime time) noexcept {
    return static_cast<std::uint64_t>(time / std::chrono::microseconds{1});
}

// The step that an answer belongs to, by its time.
enum class Answer : std::uint8_t {
    in_time,   // to the last step
    late,      // to an earlier step
    repeated,  // this step, or one after it, had its answer
    foreign,   // to no step: the time is not one of ours
    unasked,   // from an autopilot with a clock of its own
};

struct StepCounters {
    std::uint64_t steps = 0;
    std::uint64_t answered = 0;
    std::uint64_t unanswered = 0;  // since the first answer
    std::uint64_t late = 0, repeated = 0, foreign = 0;
    std::uint64_t losses = 0;  // how often it became `lost`
};

class LockStep {
public:
    static constexpr Nanoseconds answer_limit = std::chrono::seconds{1};
    static constexpr unsigned max_missed = 10, enough_in_row = 10;

    // `speed`: of the flight, relative to real time; `any_speed`. `has_own_clock`: a board, which flies in real time.
    LockStep(Nanoseconds step, double speed, bool has_own_clock) noexcept;

    // An autopilot came, or it went.
    void begin(MonoTime now) noexcept;
    void end() noexcept;

    // When the next step may begin. MonoTime::max(): not before something else happens.
    [[nodiscard]] MonoTime due() const noexcept;
    // Begins the next step and returns its time. Call it only when the step is due.
    FlightTime take(MonoTime now) noexcept;
    // The autopilot answered the step of this time. `knows_lock_step`: its flags state so.
    Answer answer(std::uint64_t time_us, bool knows_lock_step, MonoTime now) noexcept;

    // Neither does anything twice.
    void pause(MonoTime now) noexcept;
    void resume(MonoTime now) noexcept;
    [[nodiscard]] bool is_paused() const noexcept { return is_paused_; }
    // While it is paused, this many steps may begin.
    void allow(std::uint64_t steps) noexcept { allowed_ += steps; }
    // While it is paused: some of these steps have not begun, or the answer to the last one is on its way.
    [[nodiscard]] bool is_stepping(MonoTime now) const noexcept;

    [[nodiscard]] State state() const noexcept { return state_; }
    // Of the last step.
    [[nodiscard]] FlightTime time() const noexcept { return time_; }
    [[nodiscard]] Nanoseconds step() const noexcept { return step_; }
    [[nodiscard]] const StepCounters& counters() const noexcept { return counters_; }
    // From a step to its answer.
    [[nodiscard]] const StepTimes& answer_times() const noexcept { return answer_times_; }
    // Times real time, without pauses, since the autopilot answered first; 0 before.
    [[nodiscard]] double speed_reached() const noexcept;

private:
    [[nodiscard]] bool is_paced() const noexcept { return state_ != State::lock_step; }
    [[nodiscard]] Nanoseconds pace() const noexcept;
    void count_unanswered(MonoTime now) noexcept;
    void lose(MonoTime now) noexcept;
    void measure(MonoTime now) noexcept;
    void count(Answer answer) noexcept;
    [[nodiscard]] Answer judge(std::uint64_t time_us) const noexcept;
    void leave_boot(Answer answer, bool knows_lock_step) noexcept;
    void note_row(std::uint64_t time_us) noexcept;
    void accept(MonoTime now) noexcept;

    const Nanoseconds step_;
    const double speed_;
    const bool has_own_clock_;
    State state_ = State::waiting;
    FlightTime time_{}, began_{};      // began_: the last step before the autopilot came
    std::uint64_t newest_answer_ = 0;  // the time of the newest step that was answered
    bool is_answered_ = true, is_paused_ = false, is_measuring_ = false, flies_by_own_clock_ = false;
    MonoTime sent_{}, due_{}, heard_{};
    unsigned missed_ = 0;  // steps without an answer since the last row of enough answers
    unsigned in_row_ = 0;  // answers to steps that follow each other
    std::uint64_t allowed_ = 0;
    FlightTime measured_flight_{};
    Nanoseconds measured_real_{};
    StepCounters counters_;
    StepTimes answer_times_;
};

}  // namespace mavloom::hil
