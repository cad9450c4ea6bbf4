// SPDX-License-Identifier: MIT
// Asks the served program from the control thread.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/post.hpp>
#include <utility>

#include "mavloom/control/served.hpp"

namespace mavloom::control {

namespace asio = boost::asio;

// Runs `ask` on the served program's thread, then calls `then` with the result on `back`. To keep its session alive
// meanwhile, the caller stores a shared pointer to it in `then`.
template <class Ask, class Then>
void ask_served(Served& served, const asio::any_io_executor& back, Ask ask, Then then) {
    served.post([&served, ask = std::move(ask), then = std::move(then), back]() mutable {
        asio::post(back, [result = ask(served), then = std::move(then)]() mutable { then(std::move(result)); });
    });
}

}  // namespace mavloom::control
