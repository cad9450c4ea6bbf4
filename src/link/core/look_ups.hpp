// SPDX-License-Identifier: MIT
// Look-ups of host names for endpoints. Private to module link; single owner thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/net/resolver.hpp"

namespace mavloom::link::detail {

class Asker;

class LookUps {
public:
    // `wake` is called on another thread when an answer has arrived.
    explicit LookUps(std::function<void()> wake) : resolver_(std::move(wake)) {}

    // From now on frames pass, and no look-up may delay them.
    void stop_waiting() noexcept { may_wait_ = false; }
    [[nodiscard]] bool may_wait() const noexcept { return may_wait_; }
    // Passes the answers that have arrived to their askers.
    void deliver();

private:
    friend class Asker;
    net::Resolver resolver_;
    bool may_wait_ = true;
    std::vector<std::pair<std::uint64_t, Asker*>> questions_;  // by ticket
};

// An endpoint that looks names up.
class Asker {
public:
    explicit Asker(LookUps& look_ups) : look_ups_(look_ups) {}
    Asker(const Asker&) = delete;
    Asker& operator=(const Asker&) = delete;
    virtual ~Asker();
    virtual void on_resolved(net::Resolver::Answer&& answer) = 0;

    // Passes the answer to `on_resolved`: that about a numeric host at once, that about a name in a later turn.
    void look_up(const endpoint::HostPort& host);
    // Returns the answer about a numeric host at once, and waits up to `limit` for the answer about a name if no frames
    // pass yet. Empty: the answer goes to `on_resolved` in a later turn.
    [[nodiscard]] std::optional<net::Resolver::Answer> look_up_now(const endpoint::HostPort& host,
                                                                   std::chrono::milliseconds limit);

private:
    LookUps& look_ups_;
};

// How long an endpoint waits for the address of the host that it calls.
[[nodiscard]] constexpr std::chrono::milliseconds look_up_limit(bool required) noexcept {
    return std::chrono::milliseconds(required ? 5000 : 250);
}
// The error after a look-up that took 5 s.
[[nodiscard]] SetupError no_answer(const endpoint::HostPort& host);

}  // namespace mavloom::link::detail
