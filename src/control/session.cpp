// SPDX-License-Identifier: MIT
#include "control/sessions.hpp"

#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <istream>

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
    patience_.wait_for_client();
    asio::async_read_until(socket_, input_, '\n', [self = shared_from_this()](error_code error, std::size_t) {
        if (!error) self->ask();
    });
}

void ControlSession::ask() {
    std::string line;
    std::istream stream(&input_);
    std::getline(stream, line);
    patience_.wait_for_served();
    ask_served(
        served_, socket_.get_executor(), [line](Served& served) { return served.answer(line); },
        [self = shared_from_this()](const Later<Lines>& answer) { self->write(answer()); });
}

void ControlSession::write(const Lines& lines) {
    patience_.wait_for_client();
    output_.clear();
    for (const auto& line : lines) output_.append(line).push_back('\n');
    asio::async_write(socket_, asio::buffer(output_), [self = shared_from_this()](error_code error, std::size_t) {
        if (!error) self->read();
    });
}

}  // namespace mavloom::control
