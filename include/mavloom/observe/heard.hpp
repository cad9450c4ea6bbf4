// SPDX-License-Identifier: MIT
// A frame that was received: what those who observe traffic need of it. A view; it owns nothing.
#pragma once

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
};

}  // namespace mavloom::observe
