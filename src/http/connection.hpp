// SPDX-License-Identifier: MIT
// One HTTP connection of a server, and what all of them share. Http thread only.
#pragma once

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "http/access.hpp"
#include "http/core.hpp"
#include "http/web_socket/web_socket.hpp"
#include "mavloom/http/server.hpp"

namespace mavloom::http {

using BeastRequest = boost::beast::http::request<boost::beast::http::string_body>;

class Connection;

struct Listener {
    explicit Listener(asio::io_context& context) : acceptor(context), retry(context) {}

    Tcp::acceptor acceptor;
    asio::steady_timer retry;
};

struct ServerState {
    ServerState(std::weak_ptr<Core> the_core, ServerOptions the_options)
        : core(std::move(the_core)), options(std::move(the_options)), allowed(options.access) {}

    std::weak_ptr<Core> core;
    ServerOptions options;
    Allowed allowed;
    Counters counters;
    std::vector<std::unique_ptr<Listener>> listeners;
    std::vector<std::weak_ptr<Connection>> connections;
    std::set<std::shared_ptr<Connection>> waiting;  // for handlers; only this set owns them meanwhile
    std::vector<std::weak_ptr<OpenSession>> open;
};

// Keeps itself alive until its client is gone or has become a WebSocket.
class Connection : public std::enable_shared_from_this<Connection> {
public:
    Connection(Tcp::socket socket, std::shared_ptr<ServerState> server);

    void read();
    void hang_up();
    // Since when the connection waits for its client; far in the future if it waits for a handler.
    [[nodiscard]] std::chrono::steady_clock::time_point idle_since() const noexcept { return idle_since_; }
    [[nodiscard]] bool is_busy() const noexcept { return idle_since_ == busy; }
    // Sends the client status 503, if the socket takes the text at once.
    static void turn_away(Tcp::socket& socket);

private:
    using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;
    static constexpr auto busy = std::chrono::steady_clock::time_point::max();

    void wait_for_client();
    void time_out();
    void wait_for_handler();
    void take(error_code error);
    void refuse_malformed(error_code error);
    void refuse_body();
    void answer(const BeastRequest& request);
    [[nodiscard]] bool may_read(const BeastRequest& request);
    void answer_path(const BeastRequest& request);
    void open(const BeastRequest& request, const WebSocketRoute& route);
    void open(const BeastRequest& request, const StreamRoute& route);
    [[nodiscard]] bool has_room_for_session();
    void respond(const Response& response);
    void call(const BeastRequest& request, const Route& route);
    void refuse(int status, Count why, std::string_view text);
    void report(Count why, std::string_view reason) const;
    void write(const Response& response);
    [[nodiscard]] std::string head(int status, std::string_view content_type, std::string_view more) const;
    [[nodiscard]] std::string sharing() const;
    [[nodiscard]] std::string paths() const;

    Tcp::socket socket_;
    std::shared_ptr<ServerState> server_;
    net::Address local_, remote_;
    asio::steady_timer deadline_;
    std::chrono::steady_clock::time_point idle_since_;
    boost::beast::flat_buffer input_;
    std::optional<Parser> parser_;
    bool is_head_ = false, stays_open_ = false;
    bool was_answered_ = false;  // at least once
    unsigned version_ = 11;      // 10 or 11, for HTTP/1.0 and HTTP/1.1
    std::string listed_origin_;  // of the page that caused the request; empty: there is none
    std::string query_;          // of the request, without a token
    std::string set_cookie_;     // a header of the answer; empty: none
    std::string head_;
    std::shared_ptr<const std::string> body_;
};

}  // namespace mavloom::http
