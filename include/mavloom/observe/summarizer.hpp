// SPDX-License-Identifier: MIT
// Summarizer: what happened in a recording, from its frames in the order of the file.
//
// It has no file and reads no clock: one owner calls it with frames and times. A frame of a known sender costs no
// allocation. Bounded in memory, also if senders invent ids.
//
// A step of the recorded times back by more than a second, or forward by more than an hour, counts as a jump of the
// clock and not as time: computers without a battery for their clock set it when they find the network.
#pragma once

#include <memory>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/observe/summary.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::observe {

struct SummaryParts;  // private

class Summarizer {
public:
    static constexpr std::size_t max_senders = 1024;
    static constexpr std::size_t max_entries = 1000;  // of each list: modes, texts, parameters, jumps
    static constexpr Nanoseconds longest_step = std::chrono::hours{1}, longest_step_back = std::chrono::seconds{1};

    enum class Tracks : std::uint8_t { no, yes };  // yes: the positions become Journey::track
    // `dialect` must outlive the object and its summaries.
    explicit Summarizer(const dialect::Dialect& dialect, Tracks tracks = Tracks::no);
    Summarizer(Summarizer&&) noexcept;
    ~Summarizer();

    // `info` belongs to the wire table of the dialect; null for an id without definition.
    void add(const wire::FrameView& frame, const wire::MessageInfo* info, WallTime time);
    [[nodiscard]] Summary summary() const;

private:
    std::unique_ptr<SummaryParts> parts_;
};

}  // namespace mavloom::observe
