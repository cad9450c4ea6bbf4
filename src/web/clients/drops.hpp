// SPDX-License-Identifier: MIT
// How much a client has lost because it reads too slowly, as far as the client knows. Private to module web.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "mavloom/base/clock.hpp"
#include "mavloom/http/session.hpp"

namespace mavloom::web {

class Drops {
public:
    // The number of messages that the client has lost so far, if it is time to send it that number again.
    [[nodiscard]] std::optional<std::uint64_t> news(const http::Session& session, MonoTime now) noexcept {
        const auto drops = session.counters().dropped_full.value() + session.counters().dropped_old.value();
        if (drops == known_ || now - reported_ < period) return {};
        reported_ = now;
        return known_ = drops;
    }

private:
    static constexpr auto period = std::chrono::seconds(2);
    std::uint64_t known_ = 0;
    MonoTime reported_{};
};

}  // namespace mavloom::web
