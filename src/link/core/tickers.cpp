// SPDX-License-Identifier: MIT
#include "link/core/tickers.hpp"

#include <algorithm>

namespace mavloom::link::detail {

void Tickers::run(MonoTime now) {
    for (std::size_t i = 0; i < tickers_.size();) {
        Ticker& ticker = *tickers_[i];
        const auto due = ticker.tick_due();
        if (due && *due <= now) ticker.tick(now);
        if (i >= tickers_.size() || tickers_[i] != &ticker) continue;  // it removed itself
        if (ticker.tick_due()) {
            ++i;
        } else {
            ticker.ticking = false;
            tickers_[i] = tickers_.back();
            tickers_.pop_back();
        }
    }
}

MonoTime Tickers::due() const {
    MonoTime earliest = MonoTime::max();
    for (const Ticker* ticker : tickers_) earliest = std::min(earliest, ticker->tick_due().value_or(MonoTime::max()));
    return earliest;
}

void Tickers::forget(Ticker& ticker) noexcept {
    std::erase(tickers_, &ticker);
    ticker.ticking = false;
}

}  // namespace mavloom::link::detail
