// SPDX-License-Identifier: MIT
// Counts those who look at bytes that somebody else ends. Any thread.
#pragma once

#include <atomic>

namespace mavloom::python {

class Looks {
public:
    // Whoever looks does so between these two. False: the bytes have ended.
    [[nodiscard]] bool begin() noexcept {
        int looks = count_.load(std::memory_order_relaxed);
        do
            if (looks == over) return false;
        while (!count_.compare_exchange_weak(looks, looks + 1, std::memory_order_acquire));
        return true;
    }
    // Whether nobody looks any more.
    bool end() noexcept { return count_.fetch_sub(1, std::memory_order_acq_rel) == 1; }

    // Nobody looks from now on. False: somebody does. Success again and again.
    [[nodiscard]] bool finish() noexcept {
        int nobody = 0;
        return count_.compare_exchange_strong(nobody, over, std::memory_order_acq_rel) || nobody == over;
    }

private:
    static constexpr int over = -1;
    std::atomic<int> count_{0};
};

}  // namespace mavloom::python
