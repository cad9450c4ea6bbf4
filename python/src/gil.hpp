// SPDX-License-Identifier: MIT
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

namespace mavloom::python {

namespace nb = nanobind;

// Releases the GIL until the end of the scope. A thread that takes the GIL back after the interpreter has ended would
// end the process. So once the interpreter begins to exit, every thread except the exiting one sleeps forever instead,
// as in Python 3.14.
class WithoutGil {
public:
    // Called by the exiting thread, without the GIL. Waits for the threads that are on their way back to the GIL.
    static void end() {
        exiting = std::this_thread::get_id();
        over.store(true);
        while (returning.load() != 0) std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
    [[nodiscard]] static bool ended() noexcept { return over.load(); }
    // Whether this thread, which runs without the GIL, will never get the GIL back.
    [[nodiscard]] static bool is_for_good() noexcept { return over.load() && std::this_thread::get_id() != exiting; }
    // Called in a forked child: the threads that were on their way back stayed in the parent.
    static void forked() noexcept {
        returning.store(0);
        over.store(false);
    }

private:
    inline static std::atomic<bool> over{false};
    inline static std::atomic<int> returning{0};
    inline static std::thread::id exiting;

    struct Counted {
        Counted() = default;
        Counted(const Counted&) = delete;
        Counted& operator=(const Counted&) = delete;
        ~Counted() { returning.fetch_sub(1); }
    };
    struct Turnstile {
        Turnstile() = default;
        Turnstile(const Turnstile&) = delete;
        Turnstile& operator=(const Turnstile&) = delete;
        ~Turnstile() {
            returning.fetch_add(1);
            if (!is_for_good()) return;
            returning.fetch_sub(1);
            for (;;) std::this_thread::sleep_for(std::chrono::hours{1});
        }
    };
    // Destroyed in reverse order: the thread passes the turnstile, takes the GIL, and then no longer counts as
    // returning.
    Counted counted_;
    nb::gil_scoped_release release_;
    Turnstile turnstile_;
};

// Locks a mutex whose holder may need the GIL. Never waits for it with the GIL held.
[[nodiscard]] inline std::unique_lock<std::mutex> lock_without_gil(std::mutex& mutex) {
    std::unique_lock lock(mutex, std::try_to_lock);
    if (!lock.owns_lock()) {
        const WithoutGil outside;
        lock.lock();
    }
    return lock;
}

// Runs Python's signal handlers and raises what they raise.
inline void check_signals() {
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
}

}  // namespace mavloom::python
