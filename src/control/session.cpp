// SPDX-License-Identifier: MIT
#include "control/sessions.hpp"

#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <istream>
#include <utility>

namespace mavloom::control {

void ControlSession::turn_away(Local::socket& socket) {
    error_code error;
    socket.non_blocking(true, error);
    socket.write_some(
        asio::buffer(std::string_view(R"({"ok":false,"error":"too many requests are being answered; try again"})"
                                      "\n")),
        error);
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
