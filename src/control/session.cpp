// SPDX-License-Identifier: MIT
#include "control/sessions.hpp"

#include <fmt/format.h>

#include <boost/asio/error.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <istream>
#include <string_view>
#include <utility>

#include "control/json_request.hpp"

namespace mavloom::control {

// Does not wait for a client that reads nothing.
static void refuse(Local::socket& socket, std::string_view why) {
    error_code error;
    socket.non_blocking(true, error);
    socket.write_some(asio::buffer(failed(why).next_text()), error);
}

void ControlSession::turn_away(Local::socket& socket) {
    refuse(socket, "too many requests are being answered; try again");
}

// Pending operations fail, and the session is destroyed with its last handler.
void ControlSession::hang_up() {
    error_code error;
    socket_.close(error);
}

void ControlSession::read() {
    idle_time_.wait_for_client();
    asio::async_read_until(socket_, input_, '\n', [self = shared_from_this()](error_code error, std::size_t) {
        if (!error) self->ask();
        else if (error == asio::error::not_found)
            refuse(self->socket_, fmt::format("a request is one line of at most {} KiB", longest_request / 1024));
    });
}

void ControlSession::ask() {
    std::string line;
    std::istream stream(&input_);
    std::getline(stream, line);
    idle_time_.wait_for_served();
    ask_served(
        served_, socket_.get_executor(), [line](Served& served) { return served.answer(line); },
        [self = shared_from_this()](Report report) {
            self->report_ = std::move(report);
            self->write();
        });
}

// Formats the next piece only when the client has taken the last one.
void ControlSession::write() {
    idle_time_.wait_for_client();
    output_ = report_.next_text();
    if (output_.empty()) {
        report_ = {};
        return read();
    }
    asio::async_write(socket_, asio::buffer(output_), [self = shared_from_this()](error_code error, std::size_t) {
        if (!error) self->write();
    });
}

}  // namespace mavloom::control
