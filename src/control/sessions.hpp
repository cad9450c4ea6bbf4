// SPDX-License-Identifier: MIT
// The two kinds of client session that control.cpp accepts. Each session keeps itself alive until its client is gone.
// All sessions run on the control thread.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/streambuf.hpp>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "mavloom/control/served.hpp"

namespace mavloom::control {

namespace asio = boost::asio;
using Local = asio::local::stream_protocol;
using Tcp = asio::ip::tcp;
using boost::system::error_code;

// Runs `ask` on the served program's thread, then calls `then` with the result on `back`. To keep its session alive
// meanwhile, the caller stores a shared pointer to it in `then`.
template <class Ask, class Then>
void ask_served(Served& served, const asio::any_io_executor& back, Ask ask, Then then) {
    served.post([&served, ask = std::move(ask), then = std::move(then), back]() mutable {
        asio::post(back, [result = ask(served), then = std::move(then)]() mutable { then(std::move(result)); });
    });
}

constexpr std::size_t longest_request = 64 * 1024, longest_http_header = 8 * 1024;

// One client of the control socket. The session reads a request, writes the answer, and repeats.
class ControlSession : public std::enable_shared_from_this<ControlSession> {
public:
    ControlSession(Local::socket socket, Served& served, std::shared_ptr<void> place)
        : socket_(std::move(socket)), served_(served), place_(std::move(place)) {}

    void read();
    // Sends the client an error (too many clients), if the socket accepts the text at once.
    static void turn_away(Local::socket& socket);

private:
    void ask();
    void write(const Lines& lines);

    Local::socket socket_;
    Served& served_;
    std::shared_ptr<void> place_;  // this session's share of the limit most_sessions
    asio::streambuf input_{longest_request};
    std::string output_;
};

// One HTTP client. It has 10 s (http_patience) to send its request, and 10 s more to read the answer.
class MetricsSession : public std::enable_shared_from_this<MetricsSession> {
public:
    MetricsSession(Tcp::socket socket, Served& served, std::shared_ptr<void> place)
        : socket_(std::move(socket)), deadline_(socket_.get_executor()), served_(served), place_(std::move(place)) {}

    void read();
    static void turn_away(Tcp::socket& socket);

private:
    struct Request;

    void hang_up_later();
    void handle();
    void answer(const Request& request);
    void write(const Request& request, std::string_view status, std::string_view body);

    Tcp::socket socket_;
    asio::steady_timer deadline_;
    Served& served_;
    std::shared_ptr<void> place_;
    asio::streambuf input_{longest_http_header};
    std::string output_;
};

}  // namespace mavloom::control
