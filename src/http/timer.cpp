// SPDX-License-Identifier: MIT
#include "mavloom/http/timer.hpp"

#include <boost/asio/steady_timer.hpp>

#include "http/core.hpp"

namespace mavloom::http {

struct Timer::State : std::enable_shared_from_this<State> {
    State(asio::io_context& context, std::chrono::milliseconds every, std::function<void()> to_do)
        : timer(context), period(every), work(std::move(to_do)) {}

    // A call that comes late does not make the next ones come in a burst.
    void wait() {
        timer.expires_after(period);
        timer.async_wait([weak = weak_from_this()](const error_code& error) {
            const auto state = weak.lock();
            if (error || !state) return;
            state->work();
            state->wait();
        });
    }

    asio::steady_timer timer;
    const std::chrono::milliseconds period;
    std::function<void()> work;
};

Timer::Timer(const Thread& thread, std::chrono::milliseconds period, std::function<void()> work)
    : core_(thread.core()), state_(std::make_shared<State>(core_->context(), period, std::move(work))) {
    asio::post(core_->context(), [weak = std::weak_ptr(state_)] {
        if (const auto state = weak.lock()) state->wait();
    });
}

Timer::~Timer() {
    if (core_ == nullptr) return;
    core_->run_and_wait([this] { state_.reset(); });
}

}  // namespace mavloom::http
