// SPDX-License-Identifier: MIT
// An HTTP/1.1 server: answers GET and HEAD by path, whole or as a stream, and opens WebSockets.
//
// It runs on the thread of a `Thread`, and so do all of its callbacks. Requests are bounded in bytes and time, and
// checked (Host and Origin headers) before any callback sees them. docs/design/http.md has the rules.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/http/counters.hpp"
#include "mavloom/http/session.hpp"
#include "mavloom/http/thread.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::http {

// Which requests are refused: those that a web page of somebody else may have caused (403), or without the token.
struct Access {
    // Host must be "localhost", a loopback address or the address that the client is connected to, because a page's own
    // name may lead here, too (DNS rebinding). Clients without a Host header pass.
    bool any_host = false;
    bool own_names = true;             // also the other addresses of this machine, its name, and its name with .local
    std::vector<std::string> hosts{};  // and these
    std::string hosts_option{};        // of the program, that adds to them; a refusal names it
    // An Origin header must be in this list, as in "https://app.example.com"; "*" allows all. The server's own origin
    // is allowed too, unless `any_host`. Requests without the header pass: it is browsers that send it.
    std::vector<std::string> origins{};
    // Each request must have it (else 401): in the header "Authorization: Bearer TOKEN", as "?token=TOKEN", or in the
    // cookie that the answer to the latter sets. Letters of a URL only. Empty: none is needed.
    std::string token{};
};

struct Limits {
    std::size_t clients = 64;  // HTTP connections; a newcomer replaces the one that has been idle longest
    // Many clients may connect at the same instant. One that has been idle for less than this is replaced only if there
    // are `clients` + `web_sockets` connections.
    std::chrono::milliseconds grace{1000};
    std::size_t web_sockets = 256;  // more are turned away (503); those that are closing do not count
    std::size_t header_bytes = 8192;
    std::size_t body_bytes = 0;  // no handler takes a body
    // For a whole request or handshake, from the connection or the last answer on; and for an answer to be read.
    std::chrono::milliseconds patience{5000};
};

struct Request {
    std::string path, query;  // as they came, still percent-encoded; the query is what follows '?'
    net::Address remote;
    std::string accept_encoding, if_none_match;  // these headers; empty if there are none
};

struct Response {
    int status = 200;
    std::string content_type = "text/plain; charset=utf-8";
    std::string headers{};                      // further ones, each with "\r\n" at its end
    std::shared_ptr<const std::string> body{};  // null: empty
};

// Call it once, on any thread, also after the server is gone. Until then the client waits, without time limit.
using Respond = std::function<void(Response)>;

struct Route {
    std::string path;
    std::function<void(const Request&, const Respond&)> get;
};

// An answer that lasts until one side ends it, such as one line for each message. It counts as a WebSocket for
// `Limits::web_sockets`.
struct StreamRoute {
    using Open = std::function<SessionEvents(const std::shared_ptr<Session>&)>;
    std::string path, content_type;
    SessionOptions session{};  // of which only `queue` and `silence` matter
    // Checks the request; an error is answered with 400 and its text. Else the result is called with the session, to
    // which any thread may push.
    std::function<SetupResult<Open>(const Request&)> get{};
};

struct WebSocketRoute {
    std::string path;
    // By preference: the first that the client offers is used. A client that offers others only is refused; one that
    // offers none is not.
    std::vector<std::string> subprotocols{};
    SessionOptions session{};
    std::function<SessionEvents(const std::shared_ptr<Session>&)> on_open{};
};

// A client that was refused or turned away: where it came from, what counts it, and the reason. If it got an answer,
// that states the reason too.
struct Refused {
    net::Address remote;
    Count counter;
    std::string_view reason;
};

struct ServerOptions {
    std::vector<net::Address> addresses{};  // with port 0, the kernel chooses one for all
    bool v6_only = false;
    Access access{};
    Limits limits{};
    std::vector<Route> routes{};
    std::vector<StreamRoute> streams{};
    std::vector<WebSocketRoute> web_sockets{};
    std::function<void(const Refused&)> on_refused{};  // may be empty
};

struct ServerState;  // private

class Server {
public:
    // `in_use` names the process that holds the port.
    [[nodiscard]] static SetupResult<Server> listen(const Thread& thread, ServerOptions options);
    Server(Server&&) noexcept;
    Server& operator=(Server&&) = delete;
    // Closes all connections, and waits until no callback runs. Not in one of its callbacks.
    ~Server();

    [[nodiscard]] const std::vector<net::Address>& addresses() const noexcept { return addresses_; }
    [[nodiscard]] const Counters& counters() const noexcept;

private:
    Server(std::shared_ptr<Core> core, std::shared_ptr<ServerState> state, std::vector<net::Address> addresses) noexcept;

    std::shared_ptr<Core> core_;
    std::shared_ptr<ServerState> state_;
    std::vector<net::Address> addresses_;
};

}  // namespace mavloom::http
