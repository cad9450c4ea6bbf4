// SPDX-License-Identifier: MIT
#include "http/connection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/write.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/status.hpp>
#include <boost/beast/http/verb.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <utility>

#include "http/stream.hpp"
#include "http/token.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/net/tcp.hpp"

namespace mavloom::http {

namespace beast = boost::beast;
using beast::http::field;
using beast::http::verb;

namespace {

constexpr std::string_view wrong_token_text =
    "this server needs a token: add ?token=TOKEN to the address, or send the header 'Authorization: Bearer TOKEN'\n";
// A page may only load what this server has, and no other page may embed it.
constexpr std::string_view security_headers =
    "Content-Security-Policy: default-src 'self'; img-src 'self' data: blob:; frame-ancestors 'none'\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "X-Content-Type-Options: nosniff\r\n";

std::string_view header_for(int status) {
    return status == 405   ? "Allow: GET, HEAD\r\n"
           : status == 401 ? "WWW-Authenticate: Bearer\r\n"
           : status == 426 ? "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                           : "";
}

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

const auto* find_path(const auto& routes, std::string_view path) {
    const auto found = std::ranges::find_if(routes, [&](const auto& route) { return route.path == path; });
    return found == routes.end() ? nullptr : &*found;
}

// The first of our subprotocols that the client offers.
std::string choose(const std::vector<std::string>& ours, std::string_view offered) {
    const auto is_offered = [&](std::string_view name) {
        for (auto rest = offered; !rest.empty();) {
            const auto comma = std::min(rest.find(','), rest.size());
            auto item = rest.substr(0, comma);
            rest.remove_prefix(std::min(comma + 1, rest.size()));
            item.remove_prefix(std::min(item.find_first_not_of(" \t"), item.size()));
            item = item.substr(0, item.find_last_not_of(" \t") + 1);
            if (item == name) return true;
        }
        return false;
    };
    const auto found = std::ranges::find_if(ours, is_offered);
    return found == ours.end() ? std::string() : *found;
}

constexpr std::string_view get_and_head_only = "GET and HEAD only\n";

std::string wrong_host_text(const std::string& option) {
    return fmt::format("the Host header must be this address{}\n",
                       option.empty() ? " or localhost" : ", localhost, or a name of " + option);
}

std::string switching_protocols(std::string_view key, const std::string& subprotocol) {
    return fmt::format(
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Accept: {}\r\n{}\r\n",
        accept_key(key), subprotocol.empty() ? "" : fmt::format("Sec-WebSocket-Protocol: {}\r\n", subprotocol));
}

void count(Counters& counters, Ended why) {
    switch (why) {
        case Ended::by_us:
        case Ended::by_peer: return;
        case Ended::silent: return counters.add(Count::ws_silent);
        case Ended::protocol: return counters.add(Count::ws_protocol);
        case Ended::size: return counters.add(Count::ws_size);
        case Ended::fragments: return counters.add(Count::ws_fragments);
        case Ended::kind: return counters.add(Count::ws_kind);
        case Ended::lost: return counters.add(Count::ws_lost);
    }
}

}  // namespace

Connection::Connection(Tcp::socket socket, std::shared_ptr<ServerState> server)
    : socket_(std::move(socket)),
      server_(std::move(server)),
      deadline_(socket_.get_executor()),
      idle_since_(std::chrono::steady_clock::now()),
      input_(server_->options.limits.header_bytes + server_->options.limits.body_bytes + 1024) {
    net::set_stream_options(socket_.native_handle(), max_unsent_bytes);
    error_code gone;
    local_ = address_of(socket_.local_endpoint(gone));
    remote_ = address_of(socket_.remote_endpoint(gone));
}

void Connection::turn_away(Tcp::socket& socket) {
    error_code error;
    socket.non_blocking(true, error);
    socket.write_some(asio::buffer(std::string_view(
                          "HTTP/1.1 503 Service Unavailable\r\nRetry-After: 1\r\nContent-Length: 0\r\n\r\n")),
                      error);
}

void Connection::hang_up() {
    error_code error;
    socket_.close(error);
}

// Closes the socket at the deadline. Pending operations then fail, and the connection is destroyed with its last
// handler. A new deadline does not cancel a wait whose handler is already queued, so the handler checks the time
// itself.
void Connection::wait_for_client() {
    idle_since_ = std::chrono::steady_clock::now();
    deadline_.expires_after(server_->options.limits.patience);
    deadline_.async_wait([weak = weak_from_this()](error_code error) {
        const auto self = weak.lock();
        if (!error && self && self->deadline_.expiry() <= std::chrono::steady_clock::now()) self->time_out();
    });
}

// A client may keep the connection after an answer, and need it no more.
void Connection::time_out() {
    const bool is_unused = was_answered_ && !parser_->got_some() && input_.size() == 0;
    if (socket_.is_open() && !is_unused) report(Count::timed_out, "no whole request came in time");
    hang_up();
}

// The time that the program takes does not count against the client.
void Connection::wait_for_handler() {
    idle_since_ = busy;
    deadline_.expires_at(asio::steady_timer::time_point::max());
}

void Connection::read() {
    wait_for_client();
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(server_->options.limits.header_bytes));
    parser_->body_limit(server_->options.limits.body_bytes);
    beast::http::async_read(socket_, input_, *parser_,
                            [self = shared_from_this()](error_code error, std::size_t) { self->take(error); });
}

void Connection::take(error_code error) {
    wait_for_handler();
    stays_open_ = false;
    listed_origin_.clear();
    set_cookie_.clear();
    if (error) return refuse_malformed(error);
    const auto request = parser_->release();
    server_->counters.add(Count::requests);
    is_head_ = request.method() == verb::head;
    version_ = request.version() == 10 ? 10 : 11;
    stays_open_ = request.keep_alive();
    answer(request);
}

void Connection::refuse_malformed(error_code error) {
    namespace http = beast::http;
    is_head_ = false;
    if (error == http::error::header_limit || error == http::error::buffer_overflow)
        return refuse(431, Count::header_size, "the header is too long\n");
    if (error == http::error::body_limit) return refuse_body();
    if (error == http::error::end_of_stream || error.category() == asio::error::get_system_category()) return;
    report(Count::bad_request, "it sent no HTTP");
    hang_up();
}

// No handler takes a body. Requests that usually have one are refused for what they are.
void Connection::refuse_body() {
    const auto method = parser_->get().method();
    if (method != verb::get && method != verb::head) return refuse(405, Count::wrong_method, get_and_head_only);
    refuse(413, Count::body_size, "the body is too long\n");
}

void Connection::answer(const BeastRequest& request) {
    const auto host = view_of(request[field::host]), origin = view_of(request[field::origin]);
    if (request.count(field::host) > 1) return refuse(400, Count::wrong_host, "there are two Host headers\n");
    if (!server_->allowed.has_host(host, local_, mono_now()))
        return refuse(403, Count::wrong_host, wrong_host_text(server_->options.access.hosts_option));
    if (!server_->allowed.has_origin(origin, host))
        return refuse(403, Count::wrong_origin, fmt::format("pages of {} may not connect here\n", shown(origin)));
    if (!origin.empty() && server_->allowed.is_listed(origin)) listed_origin_ = origin;
    if (request.method() != verb::get && request.method() != verb::head)
        return refuse(405, Count::wrong_method, get_and_head_only);
    if (!may_read(request)) return refuse(401, Count::wrong_token, wrong_token_text);
    answer_path(request);
}

bool Connection::may_read(const BeastRequest& request) {
    const auto query = split_target(view_of(request.target())).second;
    query_ = query;
    const auto& token = server_->options.access.token;
    if (token.empty()) return true;
    const TokenPlaces places{view_of(request[field::authorization]), query, view_of(request[field::cookie])};
    if (!has_token(places, token, local_.port())) return false;
    query_ = query_without_token(query);
    if (is_same_secret(token_in(query), token)) set_cookie_ = token_cookie(token, local_.port());
    return true;
}

void Connection::answer_path(const BeastRequest& request) {
    const auto path = split_target(view_of(request.target())).first;
    const auto* const route = find_path(server_->options.routes, path);
    const auto* const web_socket = find_path(server_->options.web_sockets, path);
    if (web_socket != nullptr && beast::websocket::is_upgrade(request)) return open(request, *web_socket);
    if (route != nullptr) return call(request, *route);
    if (const auto* const stream = find_path(server_->options.streams, path)) return open(request, *stream);
    if (web_socket == nullptr) return refuse(404, Count::wrong_path, fmt::format("this server has {}\n", paths()));
    refuse(426, Count::bad_handshake, fmt::format("{0} is a WebSocket: connect to ws://HOST:PORT{0}\n", path));
}

std::string Connection::paths() const {
    std::string all;
    const auto add = [&](const std::string& path, std::string_view what) {
        all += fmt::format("{}{}{}", all.empty() ? "" : ", ", path, what);
    };
    for (const auto& route : server_->options.routes) add(route.path, "");
    for (const auto& route : server_->options.streams) add(route.path, " (a stream)");
    for (const auto& route : server_->options.web_sockets) add(route.path, " (a WebSocket)");
    return all;
}

// A client that sends frames before it has the answer to its handshake breaks the protocol.
void Connection::open(const BeastRequest& request, const WebSocketRoute& route) {
    stays_open_ = false;
    const auto key = view_of(request[field::sec_websocket_key]);
    if (key.size() != 24)
        return refuse(400, Count::bad_handshake, "the header Sec-WebSocket-Key is missing or wrong\n");
    if (request[field::sec_websocket_version] != "13")
        return refuse(426, Count::bad_handshake, "only version 13 of WebSockets is supported\n");
    if (input_.size() != 0) return refuse(400, Count::bad_handshake, "no data before the handshake is answered\n");
    if (!has_room_for_session()) return refuse(503, Count::turned_away, "too many WebSockets and streams are open\n");
    const auto offered = view_of(request[field::sec_websocket_protocol]);
    const auto subprotocol = choose(route.subprotocols, offered);
    if (!offered.empty() && subprotocol.empty() && !route.subprotocols.empty())
        return refuse(400, Count::bad_handshake,
                      fmt::format("this WebSocket speaks {}\n", fmt::join(route.subprotocols, ", ")));
    const auto server = server_;
    server->counters.add(Count::web_sockets);
    server->open.push_back(open_web_socket(
        std::move(socket_), {.core = server->core,
                             .session = route.session,
                             .patience = server->options.limits.patience,
                             .peer = {remote_, std::string(view_of(request[field::origin])), subprotocol},
                             .first = switching_protocols(key, subprotocol),
                             .on_open = route.on_open,
                             .on_ended = [server](Ended why) { count(server->counters, why); }}));
}

void Connection::open(const BeastRequest& request, const StreamRoute& route) {
    stays_open_ = false;
    const auto path = split_target(view_of(request.target())).first;
    auto opened = route.get({std::string(path), query_, remote_, {}, {}});
    if (!opened) return refuse(400, Count::wrong_query, opened.error().text + "\n");
    if (is_head_) return write({.content_type = route.content_type});
    if (!has_room_for_session()) return refuse(503, Count::turned_away, "too many WebSockets and streams are open\n");
    const auto server = server_;
    server->counters.add(Count::streams);
    server->open.push_back(
        open_stream(std::move(socket_), {.core = server->core,
                                         .session = route.session,
                                         .patience = 2 * route.session.silence,
                                         .peer = {remote_, std::string(view_of(request[field::origin])), ""},
                                         .first = head(200, route.content_type, "Cache-Control: no-store\r\n"),
                                         .on_open = std::move(*opened),
                                         .on_ended = [server](Ended why) {
                                             if (why == Ended::silent) server->counters.add(Count::timed_out);
                                         }}));
}

// Sessions that are closing take no place. There may be peers that never close: beyond a bound, the oldest of these
// sessions is cut for a newcomer.
bool Connection::has_room_for_session() {
    auto& all = server_->open;
    const auto most = server_->options.limits.web_sockets;
    const auto is_closing = [](const auto& one) { return one.lock()->is_closing(); };
    std::erase_if(all, [](const auto& one) { return one.expired(); });
    const auto closing = static_cast<std::size_t>(std::ranges::count_if(all, is_closing));
    if (all.size() - closing >= most || net::few_descriptors_left(socket_.native_handle())) return false;
    if (all.size() < 2 * most + 16) return true;
    const auto oldest = std::ranges::find_if(all, is_closing);
    oldest->lock()->cut();
    all.erase(oldest);
    return true;
}

void Connection::call(const BeastRequest& request, const Route& route) {
    const auto path = split_target(view_of(request.target())).first;
    server_->waiting.insert(shared_from_this());
    const auto header = [&](field name) { return std::string(view_of(request[name])); };
    route.get({std::string(path), query_, remote_, header(field::accept_encoding), header(field::if_none_match)},
              on_thread<Response>(server_->core, weak_from_this(),
                                  [](Connection& there, const Response& response) { there.respond(response); }));
}

void Connection::respond(const Response& response) {
    if (server_->waiting.erase(shared_from_this()) != 0) write(response);
}

void Connection::report(Count why, std::string_view reason) const {
    server_->counters.add(why);
    if (const auto& on_refused = server_->options.on_refused) on_refused({remote_, why, reason});
}

void Connection::refuse(int status, Count why, std::string_view text) {
    report(why, text.substr(0, text.find('\n')));
    write({.status = status, .body = std::make_shared<const std::string>(text)});
}

// Lets pages of listed origins read the answer (Fetch Standard, "CORS protocol"). Caches keep one answer for each
// origin.
std::string Connection::sharing() const {
    if (!server_->allowed.has_list()) return {};
    const auto reader = listed_origin_.empty() ? std::string()
                                               : fmt::format("Access-Control-Allow-Origin: {}\r\n", listed_origin_);
    return reader + "Vary: Origin\r\n";
}

// Without a length, the answer ends with the connection (RFC 9112, section 6.3).
std::string Connection::head(int status, std::string_view content_type, std::string_view more) const {
    namespace http = beast::http;
    return fmt::format(
        "HTTP/{}.{} {} {}\r\nContent-Type: {}\r\n{}Connection: {}\r\n{}{}{}{}\r\n", version_ / 10, version_ % 10,
        status, view_of(http::obsolete_reason(http::int_to_status(static_cast<unsigned>(status)))), content_type, more,
        stays_open_ ? "keep-alive" : "close", header_for(status), sharing(), set_cookie_, security_headers);
}

void Connection::write(const Response& response) {
    wait_for_client();
    static const auto empty = std::make_shared<const std::string>();
    body_ = response.body ? response.body : empty;
    const auto length = response.status == 304 ? "" : fmt::format("Content-Length: {}\r\n", body_->size());
    head_ = head(response.status, response.content_type, length + response.headers);
    if (is_head_) body_ = empty;
    asio::async_write(socket_, std::array<asio::const_buffer, 2>{asio::buffer(head_), asio::buffer(*body_)},
                      [self = shared_from_this()](error_code error, std::size_t) {
                          self->body_.reset();
                          if (error) return;
                          self->was_answered_ = true;
                          if (self->stays_open_) self->read();
                          else self->hang_up();
                      });
}

}  // namespace mavloom::http
