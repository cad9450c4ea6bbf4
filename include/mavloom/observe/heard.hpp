// SPDX-License-Identifier: MIT
// A frame that was received: what those who observe traffic need of it. A view; it owns nothing.
#pragma once

#include <chrono>
#include <string_view>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::observe {

struct Heard {
    wire::FrameView frame;
    LinkId link{};
    std::string_view link_name{};
    WallTime time{};  // when it was received
    MonoTime now{};   // never set back; for ages and silence
    // From its arrival to `now`, because who reads was busy or stopped. By this, clocks of senders are judged.
    Nanoseconds waited{};
};

// A time that is not near `now` is that of a recording, or this machine's clock was set: then it is 0.
[[nodiscard]] constexpr Nanoseconds waited_since(WallTime arrival, WallTime now) noexcept {
    const auto waited = now - arrival;
    return waited > Nanoseconds{} && waited <= std::chrono::minutes{1} ? waited : Nanoseconds{};
}

}  // namespace mavloom::observe
