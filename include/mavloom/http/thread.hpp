// SPDX-License-Identifier: MIT
// The thread on which HTTP servers and WebSocket clients run, and all of their callbacks.
//
// One thread serves any number of servers and clients. Destroying the object ends the thread. Destroy the servers and
// clients first: the others then never call back again, but their connections stay open until they are destroyed.
#pragma once

#include <memory>

#include "mavloom/base/result.hpp"

namespace mavloom::http {

class Core;  // private

class Thread {
public:
    // `niceness`: by how much the thread gives precedence to others (nice(2)).
    [[nodiscard]] static SetupResult<Thread> start(int niceness = 0);
    Thread(Thread&&) noexcept;
    Thread& operator=(Thread&&) noexcept;
    ~Thread();

    [[nodiscard]] const std::shared_ptr<Core>& core() const noexcept { return core_; }

private:
    explicit Thread(std::shared_ptr<Core> core) noexcept;
    std::shared_ptr<Core> core_;
};

}  // namespace mavloom::http
