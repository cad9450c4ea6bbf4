// SPDX-License-Identifier: MIT
// Resolves host names on a helper thread, so that a slow name server never blocks an event loop.
//
// The thread starts with the first question and resolves one name at a time. Numeric hosts do not need it: use
// Address::parse. Thread-safe: any thread may ask and collect answers. It allocates, so keep it off the frame path.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::net {

// Returns all addresses of `host`, IPv4 first, without duplicates. Blocks as long as the system's resolver does.
[[nodiscard]] SetupResult<std::vector<Address>> look_up(std::string_view host, std::uint16_t port);

class Resolver {
public:
    using Answer = SetupResult<std::vector<Address>>;
    struct Done {
        std::uint64_t ticket = 0;
        Answer answer;
    };

    // The helper thread calls `notify` when an answer is ready, without holding a lock. The destructor waits for a
    // running call of `notify`, and `notify` is not called after it. If a look-up is still in progress then, the helper
    // thread destroys the `notify` object when that look-up ends.
    explicit Resolver(std::function<void()> notify);
    Resolver(const Resolver&) = delete;
    Resolver& operator=(const Resolver&) = delete;
    // Does not wait for a look-up in progress.
    ~Resolver();

    // Queues a question and returns its ticket.
    [[nodiscard]] std::uint64_t ask(std::string host, std::uint16_t port);
    // Returns the next ready answer, in the order of the questions.
    [[nodiscard]] std::optional<Done> take();
    // Waits for the answer to one question. Returns nothing on timeout; `take` then returns the answer later.
    [[nodiscard]] std::optional<Answer> wait(std::uint64_t ticket, std::chrono::milliseconds limit);

private:
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace mavloom::net
