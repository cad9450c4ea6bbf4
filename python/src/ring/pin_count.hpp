// SPDX-License-Identifier: MIT
// PinCount: counts the accesses in progress to bytes whose lifetime another thread may end. Any thread.
#pragma once

#include <atomic>

namespace mavloom::python {

class PinCount {
public:
    // Enclose each access in `pin` and `unpin`. `pin` returns false if the bytes have ended.
    [[nodiscard]] bool pin() noexcept {
        int pins = count_.load(std::memory_order_relaxed);
        do
            if (pins == over) return false;
        while (!count_.compare_exchange_weak(pins, pins + 1, std::memory_order_acquire));
        return true;
    }
    // Returns true if no access is left.
    bool unpin() noexcept { return count_.fetch_sub(1, std::memory_order_acq_rel) == 1; }

    // Ends the bytes: no access can begin any more. Returns false while an access is in progress. Once it has returned
    // true, later calls return true, too.
    [[nodiscard]] bool finish() noexcept {
        int nobody = 0;
        return count_.compare_exchange_strong(nobody, over, std::memory_order_acq_rel) || nobody == over;
    }

private:
    static constexpr int over = -1;
    std::atomic<int> count_{0};
};

}  // namespace mavloom::python
