// SPDX-License-Identifier: MIT
// Opens a WebSocket to a server. One attempt; the caller repeats it.
//
// It runs on the thread of a `Thread`, and so do its callbacks.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/http/session.hpp"
#include "mavloom/http/thread.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::http {

struct ClientOptions {
    std::vector<net::Address> addresses{};     // tried in this order
    std::string host{};                        // as typed, for the Host header: HOST or HOST:PORT
    std::string path = "/";                    // with the query
    std::string subprotocol{};                 // empty: none
    std::optional<net::Address> bind{};        // the address of this side
    std::chrono::milliseconds patience{5000};  // for the connection, and again for the handshake
    SessionOptions session{};
};

struct ClientEvents {
    // Exactly one of the two is called, unless the Client is destroyed first.
    std::function<SessionEvents(const std::shared_ptr<Session>&)> on_open;
    // `unreachable`: no connection. `bad_input`: the far side is no WebSocket server, or refused this client.
    std::function<void(const SetupError&)> on_failed;
};

struct ClientState;  // private

class Client {
public:
    [[nodiscard]] static Client connect(const Thread& thread, ClientOptions options, ClientEvents events);
    Client(Client&&) noexcept;
    Client& operator=(Client&&) = delete;
    // Ends the attempt or the session, and waits until no callback runs. Not in one of its callbacks.
    ~Client();

private:
    Client(std::shared_ptr<Core> core, std::shared_ptr<ClientState> state) noexcept;

    std::shared_ptr<Core> core_;
    std::shared_ptr<ClientState> state_;
};

}  // namespace mavloom::http
