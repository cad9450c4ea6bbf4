// SPDX-License-Identifier: MIT
// The connection below a Session, after the handshake. Http thread only.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "http/core.hpp"
#include "http/open_session.hpp"
#include "mavloom/http/session.hpp"

namespace mavloom::http {

struct WebSocketSetup {
    std::weak_ptr<Core> core;
    bool is_client = false;
    SessionOptions session;
    std::chrono::milliseconds patience;  // for the peer to read what waits, and again to close, after we did
    Peer peer;
    std::string first{};  // to be sent before the first frame: the answer to the handshake
    std::string read{};   // that was read with the header of the handshake
    std::function<SessionEvents(const std::shared_ptr<Session>&)> on_open;
    std::function<void(Ended)> on_ended;
};

// The object keeps itself alive until the connection ends.
std::shared_ptr<OpenSession> open_web_socket(Tcp::socket socket, WebSocketSetup setup);

// The answer to a Sec-WebSocket-Key header.
[[nodiscard]] std::string accept_key(std::string_view key);

}  // namespace mavloom::http
