// SPDX-License-Identifier: MIT
// Keeps the sockets and streams that have frames to send at the end of a turn. Private to module link; single owner
// thread.
#pragma once

#include <utility>
#include <vector>

#include "mavloom/base/clock.hpp"

namespace mavloom::link::detail {

// Sends queued bytes at the end of a turn: a UDP socket with all its peers, or one stream.
class Outlet {
public:
    virtual ~Outlet() = default;
    virtual void flush() = 0;
    // True while something is queued that the kernel does not accept, or whose host has left its network.
    [[nodiscard]] virtual bool blocked() const = 0;
    // Drops frames that became too old while the outlet was blocked.
    virtual void expire(MonoTime now) = 0;

    bool scheduled = false;  // true while Outlets lists it
};

// An outlet may call `forget` for itself, or any other, in its own `flush`.
class Outlets {
public:
    void schedule(Outlet& outlet) {
        if (std::exchange(outlet.scheduled, true)) return;
        waiting_.push_back(&outlet);
    }
    void forget(Outlet& outlet) noexcept;
    // Flushes each scheduled outlet once. An outlet that is still blocked stays scheduled.
    void flush();
    void expire_blocked(MonoTime now);
    [[nodiscard]] bool empty() const noexcept { return waiting_.empty(); }

private:
    std::vector<Outlet*> waiting_, flushing_;
};

}  // namespace mavloom::link::detail
