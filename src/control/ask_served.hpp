// SPDX-License-Identifier: MIT
// Passes requests from the control thread to the served program, and its reports back.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/post.hpp>
#include <functional>
#include <utility>

#include "mavloom/control/served.hpp"

namespace mavloom::control {

namespace asio = boost::asio;

using Then = std::function<void(Report)>;

// Waits for the report, copies it, one piece between two turns of the served program, then calls `then` on `back`. Call
// it on the served program's thread.
inline void copy_report(Served& served, const asio::any_io_executor& back, Report report, Then then) {
    if (report.answer_later)
        return report.answer_later([&served, back, then = std::move(then)](Report known) mutable {
            copy_report(served, back, std::move(known), std::move(then));
        });
    if (!report.copy_more || !report.copy_more())
        return asio::post(back,
                          [report = std::move(report), then = std::move(then)]() mutable { then(std::move(report)); });
    served.post([&served, back, report = std::move(report), then = std::move(then)]() mutable {
        copy_report(served, back, std::move(report), std::move(then));
    });
}

// Calls `ask` on the served program's thread, then `then` with the copied report on `back`. To keep its session alive
// meanwhile, the caller stores a shared pointer to it in `then`.
template <class Ask>
void ask_served(Served& served, const asio::any_io_executor& back, Ask ask, Then then) {
    served.post([&served, ask = std::move(ask), then = std::move(then), back]() mutable {
        copy_report(served, back, ask(served), std::move(then));
    });
}

}  // namespace mavloom::control
