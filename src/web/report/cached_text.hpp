// SPDX-License-Identifier: MIT
// A text that clients share for a while, so that they cannot cause much work. Private to module web.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "mavloom/base/clock.hpp"

namespace mavloom::web {

class CachedText {
public:
    // The text that `make` returned at most `lives` ago.
    template <class Make>
    [[nodiscard]] const std::shared_ptr<const std::string>& get(Make&& make) {
        if (const auto now = mono_now(); text_ == nullptr || now - made_ > lives) {
            text_ = std::make_shared<const std::string>(make());
            made_ = now;
        }
        return text_;
    }

private:
    static constexpr auto lives = std::chrono::milliseconds(250);

    std::shared_ptr<const std::string> text_;
    MonoTime made_{};
};

}  // namespace mavloom::web
