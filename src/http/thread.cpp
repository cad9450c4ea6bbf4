// SPDX-License-Identifier: MIT
#include "mavloom/http/thread.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <boost/asio/steady_timer.hpp>
#include <cstring>
#include <future>
#include <system_error>

#include "http/core.hpp"
#include "mavloom/base/thread.hpp"

namespace mavloom::http {

// With its first timer or socket, Asio opens descriptors of its own, and throws if there are none. Later it needs no
// more.
Core::Core(int niceness) {
    [[maybe_unused]] const asio::steady_timer first(context_);
    thread_ = thread_without_signals([this, niceness] {
        if (niceness != 0) ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), niceness);  // of this thread only
        context_.run();
    });
}

// Two rounds: asio queues the completions of a handler that runs now behind the first.
void Core::run_and_wait(const std::function<void()>& work) {
    if (!thread_.joinable()) return work();
    for (const bool is_first : {true, false}) {
        std::promise<void> done;
        asio::post(context_, [&] {
            if (!is_first) work();
            done.set_value();
        });
        done.get_future().wait();
    }
}

void Core::stop() {
    context_.stop();
    if (thread_.joinable()) thread_.join();
}

SetupResult<Thread> Thread::start(int niceness) {
    try {
        return Thread(std::make_shared<Core>(niceness));
    } catch (const boost::system::system_error& error) {
        return system_error("http thread", error.code().value());
    } catch (const std::system_error& error) {
        return system_error("http thread", error.code().value());
    }
}

Thread::Thread(std::shared_ptr<Core> core) noexcept : core_(std::move(core)) {}
Thread::Thread(Thread&&) noexcept = default;
Thread& Thread::operator=(Thread&& other) noexcept {
    if (core_) core_->stop();
    core_ = std::move(other.core_);
    return *this;
}
Thread::~Thread() {
    if (core_) core_->stop();
}

Tcp::endpoint endpoint_of(const net::Address& address) {
    Tcp::endpoint endpoint;
    std::memcpy(endpoint.data(), address.data(), address.size());
    endpoint.resize(address.size());
    return endpoint;
}

net::Address address_of(const Tcp::endpoint& endpoint) {
    return net::Address::from_sockaddr(endpoint.data(), static_cast<socklen_t>(endpoint.size())).value_or(net::Address());
}

std::string text_of(const error_code& error) {
    if (error == asio::error::eof) return "closed by the far side";
    if (error == asio::error::connection_reset || error == asio::error::broken_pipe) return "the connection broke";
    return error.message();
}

}  // namespace mavloom::http
