// SPDX-License-Identifier: MIT
// Sends the frames of vehicles to live links, or into the simulator's own ring or recording. Private to module
// simserve; single owner thread.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mavloom/link/links.hpp"
#include "mavloom/sim/sink.hpp"
#include "simserve/flight_clock.hpp"
#include "simserve/flight_recording.hpp"
#include "simserve/input_replay.hpp"
#include "simserve/shared_memory.hpp"
#include "simserve/slow_lines.hpp"

namespace mavloom::simserve {

class LinkSink final : public sim::Sink {
public:
    // All must outlive the object.
    LinkSink(link::Links& links, const FlightClock& clock, WallTime utc_at_start, SharedMemory& shared,
             FlightRecording& recording, const InputReplay& input) noexcept
        : links_(links),
          clock_(clock),
          utc_at_start_(utc_at_start),
          shared_(shared),
          recording_(recording),
          input_(input) {}

    void send(LinkId link, const wire::FrameView& frame) override {
        ++frames_;
        bytes_ += frame.size();
        if (link == recording_.link()) return recording_.write(utc_at_start_ + clock_.at(mono_now()).flight, frame);
        if (input_.owns(link)) return;
        lines_.note_sent(link, frame.size(), links_.now());
        if (link == shared_.ring_link()) return shared_.write(frame);
        links_.send(link, frame);
    }
    [[nodiscard]] bool has_room(LinkId link) const override {
        if (link == recording_.link() || input_.owns(link)) return true;
        return links_.queued_bytes(link) < bulk_bytes && lines_.has_room(link, links_.now());
    }
    // The links that are serial lines.
    [[nodiscard]] SlowLines& lines() noexcept { return lines_; }

    [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }

private:
    // Bulk transfers pause while a link's queue holds this much.
    static constexpr std::size_t bulk_bytes = 4096;

    link::Links& links_;
    const FlightClock& clock_;
    const WallTime utc_at_start_;
    SharedMemory& shared_;
    FlightRecording& recording_;
    const InputReplay& input_;
    SlowLines lines_;
    std::uint64_t frames_ = 0, bytes_ = 0;
};

}  // namespace mavloom::simserve
