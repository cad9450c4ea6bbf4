// SPDX-License-Identifier: MIT
#include "signals.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>

#include "mavloom/base/clock.hpp"
#include "mavloom/shm/lost_mapping.hpp"

namespace mavloom::app {

namespace {

std::atomic<int> received_signal{0};
std::atomic<Signals::OnStop> stop_function{nullptr};
std::atomic<void*> stop_context{nullptr};
std::atomic<bool> hangup_is_remembered{false};
std::atomic<bool> hangup{false};
std::atomic<bool> has_begun{false};  // a Signals object exists or existed
std::atomic<Nanoseconds::rep> received_at{0};
std::atomic<int> requests{0}, tolerated_requests{1};

// Wrappers, and the kernel at the death of a parent with several threads, may send the same request several times.
constexpr Nanoseconds same_request = std::chrono::milliseconds(200);

// Notes the request to end. Returns how many there were.
int note_request(int signal) {
    const auto now = mono_now().time_since_epoch();
    auto last = received_at.load();
    const bool is_new = last == 0 || now - Nanoseconds(last) >= same_request;
    if (is_new && received_at.compare_exchange_strong(last, now.count())) ++requests;
    received_signal = signal;
    return requests;
}

void handle(int signal) {
    const int saved_errno = errno;
    if (signal == SIGHUP && hangup_is_remembered) {
        hangup = true;
    } else if (note_request(signal) > tolerated_requests || !has_begun) {
        ::_exit(128 + signal);
    }
    if (const auto stop = stop_function.load()) stop(stop_context.load());
    errno = saved_errno;
}

enum class Ignored : bool { stay, are_taken };

// Does not set SA_RESTART, so a signal interrupts a write that blocks on a slow reader. SIGHUP: the terminal was
// closed.
void install(void (*handler)(int), Ignored ignored) noexcept {
    struct sigaction action {};
    action.sa_handler = handler;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction present {};
        ::sigaction(signal, nullptr, &present);
        if (ignored == Ignored::stay && present.sa_handler == SIG_IGN) continue;
        ::sigaction(signal, &action, nullptr);
    }
}

}  // namespace

Signals::Signals(OnStop on_stop, void* context, OnHangup on_hangup, OnRepeat on_repeat) {
    tolerated_requests = on_repeat == OnRepeat::hurry ? 2 : 1;
    hangup_is_remembered = on_hangup == OnHangup::remember;
    stop_context = context;
    stop_function = on_stop;
    has_begun = true;
    install(handle, Ignored::are_taken);
}

void Signals::watch() noexcept { install(handle, Ignored::stay); }

// For any other address, the default action takes place when the instruction runs again: the program ends.
static void on_bus_error(int, siginfo_t* info, void*) {
    if (!shm::replace_lost_mapping(info->si_addr)) std::signal(SIGBUS, SIG_DFL);
}

void Signals::survive_lost_rings() noexcept {
    struct sigaction action {};
    action.sa_sigaction = on_bus_error;
    action.sa_flags = SA_SIGINFO;
    if (::sigaction(SIGBUS, &action, nullptr) == 0) shm::survives_lost_mappings();
}

Signals::~Signals() { stop_function = nullptr; }

bool Signals::take_hangup() noexcept { return hangup.exchange(false); }

bool Signals::received() noexcept { return received_signal.load() != 0; }

bool Signals::repeated() noexcept { return requests.load() > 1; }

Exit Signals::status(Exit otherwise) noexcept {
    switch (received_signal.load()) {
        case SIGINT: return Exit::interrupted;
        case SIGTERM: return Exit::terminated;
        case SIGHUP: return Exit::hung_up;
        default: return otherwise;
    }
}

}  // namespace mavloom::app
