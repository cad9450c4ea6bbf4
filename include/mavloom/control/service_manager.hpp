// SPDX-License-Identifier: MIT
// Tells the service manager that started this program how it is: ready, reloading, stopping, alive. One datagram each to the socket that
// $NOTIFY_SOCKET names; without one nothing is done. Who owns it calls it from one thread. Nothing allocates after `from_environment`.
// Protocol: systemd's sd_notify(3), which promises to stay.
#pragma once

#include <chrono>
#include <string_view>

#include "mavloom/base/clock.hpp"

namespace mavloom::control {

class ServiceManager {
public:
    // Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID.
    [[nodiscard]] static ServiceManager from_environment();
    ServiceManager(ServiceManager&& other) noexcept;
    ServiceManager& operator=(ServiceManager&&) = delete;
    ~ServiceManager();

    void ready() const noexcept { send("READY=1"); }
    void reloading() const noexcept;  // `ready` ends it
    void stopping() const noexcept { send("STOPPING=1"); }

    // When `feed` is due next; far away where no watchdog looks.
    [[nodiscard]] MonoTime watchdog_due() const noexcept { return due_; }
    // "I am alive", if it is time to say so: half of the watchdog's interval.
    void feed(MonoTime now) noexcept;

private:
    ServiceManager(int fd, std::chrono::microseconds watchdog) noexcept;
    void send(std::string_view message) const noexcept;

    int fd_ = -1;  // connected; -1: nobody to tell
    std::chrono::nanoseconds half_interval_{};
    MonoTime due_ = MonoTime::max();
};

}  // namespace mavloom::control
