// SPDX-License-Identifier: MIT
#include "link/core/outlets.hpp"

#include <algorithm>
#include <cassert>

namespace mavloom::link::detail {

void Outlets::flush() {
    assert(flushing_.empty() && "an outlet must not flush the others");
    if (waiting_.empty()) return;
    flushing_.swap(waiting_);
    for (std::size_t i = 0; i < flushing_.size(); ++i) {
        Outlet* const outlet = flushing_[i];
        if (outlet == nullptr) continue;
        outlet->scheduled = false;
        outlet->flush();
        if (flushing_[i] != nullptr && outlet->blocked()) schedule(*outlet);
    }
    flushing_.clear();
}

void Outlets::expire_blocked(MonoTime now) {
    for (Outlet* outlet : waiting_) {
        if (outlet->blocked()) outlet->expire(now);
    }
}

void Outlets::forget(Outlet& outlet) noexcept {
    std::erase(waiting_, &outlet);
    std::ranges::replace(flushing_, &outlet, static_cast<Outlet*>(nullptr));
    outlet.scheduled = false;
}

}  // namespace mavloom::link::detail
