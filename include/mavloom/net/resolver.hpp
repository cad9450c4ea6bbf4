// SPDX-License-Identifier: MIT
// Host names to addresses on a helper thread, so that a slow name server never holds up a loop. The thread starts with the first question;
// one question is asked at a time. A numeric host never needs it (Address::parse).
// Thread-safe: any thread may ask and collect. Allocates; not for the frame path.
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

// All addresses of `host`, IPv4 first, each once. Blocks as long as the system's resolver does.
[[nodiscard]] SetupResult<std::vector<Address>> look_up(std::string_view host, std::uint16_t port);

class Resolver {
public:
    using Answer = SetupResult<std::vector<Address>>;
    struct Done {
        std::uint64_t ticket = 0;
        Answer answer;
    };

    // `notify` is called on the helper thread, without a lock held, when an answer is ready; the destructor waits until it has returned, and
    // it is not called afterwards. But where a look-up is then still under way it is kept, and destroyed on the helper thread at its end.
    explicit Resolver(std::function<void()> notify);
    Resolver(const Resolver&) = delete;
    Resolver& operator=(const Resolver&) = delete;
    // Does not wait for a look-up under way.
    ~Resolver();

    [[nodiscard]] std::uint64_t ask(std::string host, std::uint16_t port);
    // The next answer that is ready, in the order of the questions.
    [[nodiscard]] std::optional<Done> take();
    // Waits for one question; nothing when `limit` passes first (the answer then comes by `take`).
    [[nodiscard]] std::optional<Answer> wait(std::uint64_t ticket, std::chrono::milliseconds limit);

private:
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace mavloom::net
