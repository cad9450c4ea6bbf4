// SPDX-License-Identifier: MIT
// Reports this program's state to the service manager that started it, usually systemd: ready, reloading, stopping,
// alive.
//
// Each report is one datagram to the socket in $NOTIFY_SOCKET. Without that variable all calls do nothing. A report
// never blocks, and one that cannot be sent is lost. Single owner thread; no allocation after `from_environment`.
// Protocol: systemd's sd_notify(3), a stable interface.
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
    void reloading() const noexcept;  // `ready` ends the reload
    void stopping() const noexcept { send("STOPPING=1"); }

    // When to call `feed` next; MonoTime::max() without a watchdog.
    [[nodiscard]] MonoTime watchdog_due() const noexcept { return due_; }
    // Sends the watchdog's keep-alive if it is due. It is due every half watchdog interval.
    void feed(MonoTime now) noexcept;

private:
    ServiceManager(int fd, std::chrono::microseconds watchdog) noexcept;
    void send(std::string_view message) const noexcept;

    int fd_ = -1;  // connected socket; -1: no service manager
    std::chrono::nanoseconds half_interval_{};
    MonoTime due_ = MonoTime::max();
};

}  // namespace mavloom::control
