// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "control/sessions.hpp"

namespace mavloom::control {

namespace beast = boost::beast;
namespace http = beast::http;

constexpr auto http_patience = std::chrono::seconds(5);

struct MetricsSession::Request {
    http::verb method;
    std::string target;
    std::string host;  // empty: not given
    unsigned version;  // 10 or 11, for HTTP/1.0 and HTTP/1.1
    bool keep_alive;
};

void MetricsSession::turn_away(Tcp::socket& socket) {
    error_code error;
    socket.non_blocking(true, error);
    socket.write_some(asio::buffer(std::string_view("HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\n\r\n")),
                      error);
}

void MetricsSession::hang_up() {
    error_code error;
    socket_.close(error);
}

void MetricsSession::read() {
    idle_time_.wait_for_client();
    hang_up_later();
    asio::async_read_until(socket_, input_, "\r\n\r\n", [self = shared_from_this()](error_code error, std::size_t) {
        if (!error) self->handle();
    });
}

// Closes the socket at the deadline. Pending operations then fail, and the session is destroyed with its last
// handler. A new deadline does not cancel a wait whose handler is already queued, so the handler checks the time
// itself.
void MetricsSession::hang_up_later() {
    deadline_.expires_after(http_patience);
    deadline_.async_wait([weak = weak_from_this()](error_code error) {
        const auto self = weak.lock();
        const bool is_over = !error && self && self->deadline_.expiry() <= std::chrono::steady_clock::now();
        if (is_over) self->hang_up();
    });
}

void MetricsSession::handle() {
    // The time that the program takes does not count against the client.
    deadline_.expires_at(asio::steady_timer::time_point::max());
    http::request_parser<http::empty_body> parser;
    error_code error;
    input_.consume(parser.put(input_.data(), error));
    if (error || !parser.is_done()) return;
    const auto& head = parser.get();
    answer({head.method(), std::string(head.target()), std::string(head[http::field::host]), head.version(),
            parser.keep_alive()});
}

// Returns the name without port, brackets and the dot that may end a full name.
static std::string_view name_in(std::string_view host) {
    const auto bracket = host.find(']');
    if (host.starts_with('[')) return host.substr(1, bracket == std::string_view::npos ? 0 : bracket - 1);
    host = host.substr(0, host.find(':'));
    return host.ends_with('.') ? host.substr(0, host.size() - 1) : host;
}

// "localhost", a loopback address, or the address that the client is connected to. Other names may lead here too, also
// those of web pages.
bool MetricsSession::is_host_of_this_machine(std::string_view host) const {
    const auto name = name_in(host);
    if (beast::iequals({name.data(), name.size()}, "localhost")) return true;
    error_code error;
    const auto address = asio::ip::make_address(name, error);
    return !error && (address.is_loopback() || address == socket_.local_endpoint(error).address());
}

static MetricsReports::Text text_of(std::string_view text) { return std::make_shared<const std::string>(text); }

void MetricsSession::answer(const Request& request) {
    if (reports_.requires_local_host() && !request.host.empty() && !is_host_of_this_machine(request.host))
        return write(request, "403 Forbidden", text_of("the Host header must be this address or localhost\n"));
    if (request.method != http::verb::get && request.method != http::verb::head)
        return write(request, "405 Method Not Allowed\r\nAllow: GET, HEAD", text_of("GET and HEAD only\n"));
    if (std::string_view(request.target).substr(0, request.target.find('?')) != "/metrics")
        return write(request, "404 Not Found", text_of("metrics are at /metrics\n"));
    idle_time_.wait_for_served();
    reports_.get(socket_.get_executor(), [self = shared_from_this(), request](const MetricsReports::Text& text) {
        self->write(request, "200 OK", text);
    });
}

void MetricsSession::write(const Request& request, std::string_view status, MetricsReports::Text body) {
    idle_time_.wait_for_client();
    head_ = fmt::format(
        "HTTP/{}.{} {}\r\nContent-Type: text/plain; version=0.0.4; charset=utf-8\r\nContent-Length: {}\r\n"
        "Connection: {}\r\n\r\n",
        request.version / 10, request.version % 10, status, body->size(), request.keep_alive ? "keep-alive" : "close");
    body_ = request.method == http::verb::head ? text_of("") : std::move(body);
    hang_up_later();
    const auto then = [self = shared_from_this(), stays_open = request.keep_alive](error_code error, std::size_t) {
        self->body_.reset();
        if (!error && stays_open) self->read();
    };
    asio::async_write(socket_, std::array<asio::const_buffer, 2>{asio::buffer(head_), asio::buffer(*body_)}, then);
}

}  // namespace mavloom::control
