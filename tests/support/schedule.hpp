// SPDX-License-Identifier: MIT
// Runs a few actors step by step, in every order that a bound on preemptions allows: exhaustive for the schedules that
// find faults, unlike stress. A step is one operation on a ModelWord. Stores that are not sequentially consistent may
// be delayed in the actor's store buffer, as x86 does it. A relaxed store may overtake delayed stores of other words,
// as ARM does it.
//
//     explore({.preemptions = 2}, [](Schedule& schedule) {
//         ...state of this run...
//         schedule.add([&] { ... });
//         schedule.add([&] { ... });
//         schedule.run();
//         ...checks...
//     });
//
// Actors are fibers of one thread. One that is killed is never resumed, so that its stack must own nothing.
#pragma once

#include <ucontext.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#if defined(__SANITIZE_ADDRESS__)
#define MAVLOOM_FIBERS_ASAN
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define MAVLOOM_FIBERS_ASAN
#elif __has_feature(thread_sanitizer)
#define MAVLOOM_FIBERS_TSAN
#endif
#endif
#ifdef MAVLOOM_FIBERS_ASAN
#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>
#endif
#ifdef MAVLOOM_FIBERS_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace mavloom::test {

class Schedule;
inline Schedule* running_schedule = nullptr;

// A stack that can be switched to and from.
class Fiber {
public:
    Fiber() : stack_(std::make_unique<std::byte[]>(stack_bytes)) {}

    void start(void (*entry)()) {
#ifdef MAVLOOM_FIBERS_ASAN
        ASAN_UNPOISON_MEMORY_REGION(stack_.get(), stack_bytes);  // a killed actor's frames
#endif
#ifdef MAVLOOM_FIBERS_TSAN
        if (tsan_ != nullptr) __tsan_destroy_fiber(tsan_);
        tsan_ = __tsan_create_fiber(0);
#endif
        ::getcontext(&context_);
        context_.uc_stack.ss_sp = stack_.get();
        context_.uc_stack.ss_size = stack_bytes;
        context_.uc_link = nullptr;
        ::makecontext(&context_, entry, 0);
        fake_stack_ = nullptr;
    }
#ifdef MAVLOOM_FIBERS_TSAN
    ~Fiber() {
        if (tsan_ != nullptr) __tsan_destroy_fiber(tsan_);
    }
    Fiber(Fiber&& other) noexcept
        : context_(other.context_), stack_(std::move(other.stack_)), tsan_(std::exchange(other.tsan_, nullptr)) {}
#endif

    // From the scheduler into this fiber, and back.
    void enter(ucontext_t& scheduler) {
#ifdef MAVLOOM_FIBERS_ASAN
        void* fake = nullptr;
        __sanitizer_start_switch_fiber(&fake, stack_.get(), stack_bytes);
#endif
#ifdef MAVLOOM_FIBERS_TSAN
        scheduler_tsan_ = __tsan_get_current_fiber();
        __tsan_switch_to_fiber(tsan_, 0);
#endif
        ::swapcontext(&scheduler, &context_);
#ifdef MAVLOOM_FIBERS_ASAN
        __sanitizer_finish_switch_fiber(fake, nullptr, nullptr);
#endif
    }
    void entered() {
#ifdef MAVLOOM_FIBERS_ASAN
        __sanitizer_finish_switch_fiber(fake_stack_, &scheduler_stack_, &scheduler_stack_bytes_);
#endif
    }
    void leave(ucontext_t& scheduler, bool for_good) {
#ifdef MAVLOOM_FIBERS_ASAN
        __sanitizer_start_switch_fiber(for_good ? nullptr : &fake_stack_, scheduler_stack_, scheduler_stack_bytes_);
#else
        static_cast<void>(for_good);
#endif
#ifdef MAVLOOM_FIBERS_TSAN
        __tsan_switch_to_fiber(scheduler_tsan_, 0);
#endif
        ::swapcontext(&context_, &scheduler);
        entered();
    }

private:
    static constexpr std::size_t stack_bytes = 64 << 10;
    ucontext_t context_{};
    std::unique_ptr<std::byte[]> stack_;
    void* fake_stack_ = nullptr;
#ifdef MAVLOOM_FIBERS_ASAN
    const void* scheduler_stack_ = nullptr;
    std::size_t scheduler_stack_bytes_ = 0;
#endif
#ifdef MAVLOOM_FIBERS_TSAN
    void* tsan_ = nullptr;
    void* scheduler_tsan_ = nullptr;
#endif
};

struct Bounds {
    int preemptions = 2;  // switches away from an actor that could continue
    int delays = 0;       // stores that stay in their actor's buffer for a while
};

class Schedule {
public:
    explicit Schedule(const Bounds& bounds, std::vector<Fiber>& fibers) : bounds_(bounds), fibers_(fibers) {}

    // `kill_after` steps it is never heard of again; what it has stored is there.
    void add(std::function<void()> body, int kill_after = -1) { actors_.push_back({std::move(body), {}, kill_after}); }

    // Runs all actors to their ends. False when everybody who is left sleeps and nobody would wake them.
    bool run() {
        while (fibers_.size() < actors_.size()) fibers_.emplace_back();
        preemptions_ = delays_ = 0;
        current_ = none;
        running_schedule = this;
        for (std::size_t i = 0; i < actors_.size(); ++i) fibers_[i].start(&Schedule::enter_actor);
        while (pick()) {
            fibers_[current_].enter(scheduler_);
        }
        running_schedule = nullptr;
        return std::ranges::all_of(actors_, [](const Actor& actor) { return actor.done; });
    }

    // Before every operation of an actor: others may go first.
    void step() {
        Actor& self = actors_[current_];
        if (self.kill_after >= 0 && self.steps++ == self.kill_after) {
            self.done = true;
            flush(self);
            fibers_[current_].leave(scheduler_, true);
        }
        const std::size_t before = current_;
        if (preemptions_ == bounds_.preemptions || !other_is_runnable()) return;
        if (choose(2) == 0) return;
        ++preemptions_;
        preempted_ = true;
        fibers_[before].leave(scheduler_, false);
    }

    // True: this store stays in the buffer.
    bool delay() {
        if (delays_ == bounds_.delays || choose(2) == 0) return false;
        ++delays_;
        return true;
    }
    void buffer(const void* word, std::uint64_t value, std::function<void()> apply) {
        actors_[current_].buffer.push_back({word, value, std::move(apply)});
    }
    [[nodiscard]] const std::uint64_t* buffered(const void* word) const {
        const auto& buffer = actors_[current_].buffer;
        const auto found = std::find_if(buffer.rbegin(), buffer.rend(), [&](const Store& s) { return s.word == word; });
        return found == buffer.rend() ? nullptr : &found->value;
    }
    void flush() { flush(actors_[current_]); }
    // Only the stores of this word.
    void flush(const void* word) {
        auto& buffer = actors_[current_].buffer;
        for (const Store& store : buffer)
            if (store.word == word) store.apply();
        std::erase_if(buffer, [&](const Store& store) { return store.word == word; });
    }

    // Until `wake` of the same word.
    void sleep(const void* word) {
        flush();
        actors_[current_].asleep_on = word;
        fibers_[current_].leave(scheduler_, false);
    }
    // Until `wake` of the same word, or for a while: true. By then every store is out of its buffer.
    bool nap(const void* word) {
        actors_[current_].naps = true;
        sleep(word);
        const bool over = std::exchange(actors_[current_].naps, false) && actors_[current_].asleep_on != nullptr;
        actors_[current_].asleep_on = nullptr;
        if (over)
            for (Actor& actor : actors_) flush(actor);
        return over;
    }
    void wake(const void* word) {
        for (Actor& actor : actors_)
            if (actor.asleep_on == word) actor.asleep_on = nullptr;
    }

    // ---- for explore()
    [[nodiscard]] bool next_run() {
        while (!choices_.empty() && choices_.back().taken + 1 == choices_.back().of) choices_.pop_back();
        if (choices_.empty()) return false;
        ++choices_.back().taken;
        at_ = 0;
        actors_.clear();
        return true;
    }

private:
    struct Store {
        const void* word;
        std::uint64_t value;
        std::function<void()> apply;
    };
    struct Actor {
        std::function<void()> body;
        std::deque<Store> buffer;
        int kill_after = -1;
        int steps = 0;
        bool done = false;
        const void* asleep_on = nullptr;
        bool naps = false;
        [[nodiscard]] bool runnable() const { return !done && (asleep_on == nullptr || naps); }
    };
    struct Choice {
        int taken, of;
    };
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    static void enter_actor() {
        Schedule& self = *running_schedule;
        const std::size_t mine = self.current_;
        self.fibers_[mine].entered();
        self.actors_[mine].body();
        self.flush();
        self.actors_[mine].done = true;
        self.fibers_[mine].leave(self.scheduler_, true);
    }

    static void flush(Actor& actor) {
        for (const Store& store : actor.buffer) store.apply();
        actor.buffer.clear();
    }

    [[nodiscard]] bool other_is_runnable() const {
        for (std::size_t i = 0; i < actors_.size(); ++i)
            if (i != current_ && actors_[i].runnable()) return true;
        return false;
    }

    int choose(int of) {
        if (at_ == choices_.size()) choices_.push_back({0, of});
        if (choices_[at_].of != of) throw std::logic_error("a run is not repeatable");
        return choices_[at_++].taken;
    }

    bool pick() {
        std::vector<std::size_t> runnable;
        for (std::size_t i = 0; i < actors_.size(); ++i)
            if (actors_[i].runnable() && !(preempted_ && i == current_)) runnable.push_back(i);
        preempted_ = false;
        if (runnable.empty()) return false;
        current_ = runnable[runnable.size() == 1 ? 0 : static_cast<std::size_t>(choose(static_cast<int>(runnable.size())))];
        return true;
    }

    Bounds bounds_;
    std::vector<Fiber>& fibers_;
    std::vector<Actor> actors_;
    std::vector<Choice> choices_;
    std::size_t at_ = 0;
    std::size_t current_ = none;
    int preemptions_ = 0, delays_ = 0;
    bool preempted_ = false;
    ucontext_t scheduler_{};
};

// Every schedule within the bounds; returns how many there were. A run that fails an assertion of gtest ends the search
// (`failed`).
template <class Run, class Failed>
std::size_t explore(const Bounds& bounds, Run&& run, Failed&& failed) {
    static thread_local std::vector<Fiber> fibers;
    if (fibers.capacity() < 8) fibers.reserve(8);
    Schedule schedule(bounds, fibers);
    std::size_t runs = 0;
    do {
        run(schedule);
        ++runs;
    } while (!failed() && schedule.next_run());
    return runs;
}

// std::atomic's interface, a step each.
template <class T>
class ModelWord {
public:
    T load(std::memory_order) const {
        if (running_schedule == nullptr) return value_;
        running_schedule->step();
        const std::uint64_t* own = running_schedule->buffered(this);
        return own != nullptr ? static_cast<T>(*own) : value_;
    }
    void store(T value, std::memory_order order) {
        if (running_schedule == nullptr) {
            value_ = value;
            return;
        }
        running_schedule->step();
        if (order != std::memory_order_seq_cst && running_schedule->delay()) {
            running_schedule->buffer(this, value, [this, value] { value_ = value; });
            return;
        }
        if (order == std::memory_order_relaxed) running_schedule->flush(this);
        else running_schedule->flush();
        value_ = value;
    }
    T fetch_or(T bits, std::memory_order) {
        return change([bits](T old) { return old | bits; });
    }
    T fetch_and(T bits, std::memory_order) {
        return change([bits](T old) { return old & bits; });
    }
    T fetch_add(T more, std::memory_order) {
        return change([more](T old) { return static_cast<T>(old + more); });
    }

private:
    template <class Change>
    T change(Change&& make) {
        if (running_schedule != nullptr) {
            running_schedule->step();
            running_schedule->flush();
        }
        return std::exchange(value_, make(value_));
    }

    T value_{};
};

}  // namespace mavloom::test
