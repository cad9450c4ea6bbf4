// SPDX-License-Identifier: MIT
// Keeps the stream parsers and borders that hold bytes back until a deadline. Private to module link; single owner
// thread.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "mavloom/base/clock.hpp"

namespace mavloom::link::detail {

// A stream parser or a border that holds bytes back. `tick` is called once its deadline has passed.
class Ticker {
public:
    virtual ~Ticker() = default;
    [[nodiscard]] virtual std::optional<MonoTime> tick_due() const = 0;
    virtual void tick(MonoTime now) = 0;

    bool ticking = false;  // true while Tickers lists it
};

// A ticker may call `forget` for itself in its own `tick`.
class Tickers {
public:
    void keep(Ticker& ticker) {
        if (!std::exchange(ticker.ticking, true)) tickers_.push_back(&ticker);
    }
    void forget(Ticker& ticker) noexcept;
    // Calls `tick` of the tickers that are due, and forgets those that no longer have a deadline.
    void run(MonoTime now);
    [[nodiscard]] bool empty() const noexcept { return tickers_.empty(); }
    // The earliest deadline; MonoTime::max() if there is none.
    [[nodiscard]] MonoTime due() const;

private:
    std::vector<Ticker*> tickers_;
};

}  // namespace mavloom::link::detail
