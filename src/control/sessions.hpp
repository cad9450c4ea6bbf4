// SPDX-License-Identifier: MIT
// The client sessions that control.cpp accepts. Each session keeps itself alive until its client is gone. All sessions
// run on the control thread.
#pragma once

#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/streambuf.hpp>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "control/ask_served.hpp"

namespace mavloom::control {

using Local = asio::local::stream_protocol;
using boost::system::error_code;

// Records since when a session waits for its client, so that the acceptor can disconnect the longest idle client.
class IdleTime {
public:
    // The session now waits for its client: for a request, or for the client to read the answer.
    void wait_for_client() noexcept { since_ = std::chrono::steady_clock::now(); }
    // The session now waits for the served program.
    void wait_for_served() noexcept { since_ = busy; }

    [[nodiscard]] bool is_busy() const noexcept { return since_ == busy; }
    // When the session began to wait for its client.
    [[nodiscard]] std::chrono::steady_clock::time_point since() const noexcept { return since_; }

private:
    static constexpr auto busy = std::chrono::steady_clock::time_point::max();
    std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

constexpr std::size_t longest_request = 64 * 1024;

// One client of the control socket. The session reads a request, writes the answer, and repeats.
class ControlSession : public std::enable_shared_from_this<ControlSession> {
public:
    ControlSession(Local::socket socket, Served& served) : socket_(std::move(socket)), served_(served) {}

    void read();
    void hang_up();
    [[nodiscard]] const IdleTime& idle_time() const noexcept { return idle_time_; }
    // Sends the client an error (too many clients), if the socket accepts the text at once.
    static void turn_away(Local::socket& socket);

private:
    void ask();
    void write();

    Local::socket socket_;
    Served& served_;
    IdleTime idle_time_;
    asio::streambuf input_{longest_request};
    Report report_;       // the answer that is being sent
    std::string output_;  // a piece of it
};

}  // namespace mavloom::control
