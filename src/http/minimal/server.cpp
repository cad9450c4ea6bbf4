// SPDX-License-Identifier: MIT
// For -DMAVLOOM_MINIMAL=ON: a module without an HTTP server. These are the functions that `--metrics` calls.
#include "mavloom/http/server.hpp"
#include "mavloom/http/thread.hpp"

namespace mavloom::http {

class Core {};
struct ServerState {};

SetupResult<Thread> Thread::start(int) {
    return setup_error(SetupCode::usage,
                       "metrics: this program was built without them (MAVLOOM_MINIMAL); "
                       "`mavloom ctl NAME stats` prints the counters");
}

Thread::Thread(Thread&&) noexcept = default;
Thread& Thread::operator=(Thread&&) noexcept = default;
Thread::~Thread() = default;

// Nobody has a thread for it.
SetupResult<Server> Server::listen(const Thread&, ServerOptions) { return setup_error(SetupCode::usage, "no server"); }

Server::Server(Server&&) noexcept = default;
Server::~Server() = default;

}  // namespace mavloom::http
