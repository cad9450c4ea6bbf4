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

class NameUser;

class LookUps {
public:
    // `wake` is called on another thread when an answer has arrived.
    explicit LookUps(std::function<void()> wake) : resolver_(std::move(wake)) {}

    // Call it when frames begin to flow: from then on, no call may wait for a look-up.
    void stop_waiting() noexcept { may_wait_ = false; }
    [[nodiscard]] bool may_wait() const noexcept { return may_wait_; }
    // Passes the answers that have arrived to their users.
    void deliver();

private:
    friend class NameUser;
    net::Resolver resolver_;
    bool may_wait_ = true;
    std::vector<std::pair<std::uint64_t, NameUser*>> questions_;  // by ticket
};

// An endpoint that looks up host names.
class NameUser {
public:
    explicit NameUser(LookUps& look_ups) : look_ups_(look_ups) {}
    NameUser(const NameUser&) = delete;
    NameUser& operator=(const NameUser&) = delete;
    virtual ~NameUser();
    virtual void on_resolved(net::Resolver::Answer&& answer) = 0;

    // Passes the answer to `on_resolved`: at once for a numeric host, in a later turn for a name.
    void look_up(const endpoint::HostPort& host);
    // Returns the answer for a numeric host at once. For a name, waits up to `limit` for the answer if no frames flow
    // yet. If there is no answer by then, returns empty, and `on_resolved` gets the answer in a later turn.
    [[nodiscard]] std::optional<net::Resolver::Answer> look_up_now(const endpoint::HostPort& host,
                                                                   std::chrono::milliseconds limit);

private:
    LookUps& look_ups_;
};

}  // namespace mavloom::link::detail
