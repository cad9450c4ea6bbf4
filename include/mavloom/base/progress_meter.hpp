// SPDX-License-Identifier: MIT
// ProgressMeter: how far long work is, as one line of text for a terminal. Pure; one owner thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "mavloom/base/clock.hpp"

namespace mavloom {

// How far the work is.
struct ProgressMade {
    std::optional<std::uint64_t> frames{};
    std::uint64_t bytes = 0;
    std::optional<double> part{};  // of the whole, 0 to 1; empty: the end is not known
};

class ProgressMeter {
public:
    explicit ProgressMeter(MonoTime begin) noexcept : begin_(begin), earlier_{begin, {}}, later_{begin, {}} {}

    // "[###...]  45 %  1234 frames  5.6 MB  00:12  98 frames/s  00:15 left", of less than `width` characters: pieces
    // for which there is no room are left out. The rate is that of the last seconds. Call it with times that grow.
    [[nodiscard]] std::string line(const ProgressMade& made, MonoTime now, int width);

private:
    struct Moment {
        MonoTime time;
        ProgressMade made;
    };
    [[nodiscard]] std::string rate_text(const ProgressMade& made, MonoTime now) const;

    MonoTime begin_;
    Moment earlier_, later_;  // the rate counts from the earlier one
};

}  // namespace mavloom
