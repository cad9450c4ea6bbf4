// SPDX-License-Identifier: MIT
// The connection below a Session that only sends: an answer without length, which ends with the connection. Http
// thread only.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "http/core.hpp"
#include "http/open_session.hpp"
#include "mavloom/http/session.hpp"

namespace mavloom::http {

struct StreamSetup {
    std::weak_ptr<Core> core;
    SessionOptions session;
    // A client that has read nothing for so long, although something waits, is disconnected.
    std::chrono::milliseconds patience;
    Peer peer;
    std::string first;  // the header of the answer
    std::function<SessionEvents(const std::shared_ptr<Session>&)> on_open;
    std::function<void(Ended)> on_ended;
};

// The object keeps itself alive until the connection ends.
std::shared_ptr<OpenSession> open_stream(Tcp::socket socket, StreamSetup setup);

}  // namespace mavloom::http
