// SPDX-License-Identifier: MIT
// The io_context of a `Thread`. Servers and clients share its ownership, because their sockets need the context.
#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "mavloom/net/address.hpp"

namespace mavloom::http {

namespace asio = boost::asio;
using Tcp = asio::ip::tcp;
using boost::system::error_code;

class Core {
public:
    explicit Core(int niceness);
    Core(const Core&) = delete;
    Core& operator=(const Core&) = delete;
    ~Core() = default;  // the thread has ended, see `stop`

    [[nodiscard]] asio::io_context& context() noexcept { return context_; }
    // Runs `work` on the thread and waits for it. Runs it here if the thread has ended.
    void run_and_wait(const std::function<void()>& work);
    void stop();

private:
    asio::io_context context_{1};
    asio::executor_work_guard<asio::io_context::executor_type> work_{context_.get_executor()};
    std::thread thread_;
};

// Returns a function that any thread may call at any time. It calls `work` with the object on the http thread, if both
// still exist. Only that thread may own objects with sockets, so that their sockets end before the context does.
template <class... Values, class Object, class Work>
[[nodiscard]] std::function<void(Values...)> on_thread(std::weak_ptr<Core> core, std::weak_ptr<Object> object,
                                                       Work work) {
    return [core = std::move(core), object = std::move(object), work](Values... values) {
        const auto there = core.lock();
        if (!there) return;
        asio::post(there->context(), [object, work, values...] {
            if (const auto still = object.lock()) work(*still, values...);
        });
    };
}

[[nodiscard]] Tcp::endpoint endpoint_of(const net::Address& address);
[[nodiscard]] net::Address address_of(const Tcp::endpoint& endpoint);
// For people.
[[nodiscard]] std::string text_of(const error_code& error);
// Little waits in the kernel for one client.
inline constexpr int max_unsent_bytes = 64 * 1024;
// For one system call.
inline constexpr std::size_t write_size = 32'768;

}  // namespace mavloom::http
