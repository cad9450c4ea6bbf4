// SPDX-License-Identifier: MIT
// Sends the frames of vehicles to live links or into the simulator's own ring. Private to module simserve; single owner
// thread.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mavloom/link/links.hpp"
#include "mavloom/sim/sink.hpp"
#include "simserve/shared_memory.hpp"

namespace mavloom::simserve {

class LinkSink final : public sim::Sink {
public:
    LinkSink(link::Links& links, SharedMemory& shared) noexcept : links_(links), shared_(shared) {}

    void send(LinkId link, const wire::FrameView& frame) override {
        ++frames_;
        bytes_ += frame.size();
        if (link == shared_.ring_link()) return shared_.write(frame);
        links_.send(link, frame);
    }
    [[nodiscard]] std::size_t queued_bytes(LinkId link) const override { return links_.queued_bytes(link); }

    [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }

private:
    link::Links& links_;
    SharedMemory& shared_;
    std::uint64_t frames_ = 0, bytes_ = 0;
};

}  // namespace mavloom::simserve
