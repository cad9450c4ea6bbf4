// SPDX-License-Identifier: MIT
// Outbox: a bounded list of frames. Any thread may add frames; the loop thread sends them. The frames of one thread
// keep their order.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <vector>

#include "mavloom/link/links.hpp"
#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::feed {

class Outbox {
public:
    static constexpr std::size_t capacity = 4096;

    class Entry {
    public:
        Entry(link::EndpointId to, const wire::FrameView& frame);
        [[nodiscard]] link::EndpointId to() const noexcept { return to_; }
        [[nodiscard]] wire::FrameView frame() const noexcept {
            return wire::FrameView::unchecked({bytes_.data(), size_});
        }

    private:
        link::EndpointId to_;
        std::uint16_t size_;
        wire::FrameBuffer bytes_;  // only the first size_ bytes are set
    };

    enum class Put : std::uint8_t {
        first,   // the outbox was empty: wake the loop thread
        queued,  // the loop thread will see it
        closed,
    };
    // Any thread. Copies the frame; waits while the outbox is full.
    Put put(link::EndpointId to, const wire::FrameView& frame);

    // Loop thread: returns all frames and makes room.
    [[nodiscard]] std::vector<Entry> take();
    // Loop thread: returns all frames and refuses new ones from now on.
    [[nodiscard]] std::vector<Entry> close();

private:
    std::mutex mutex_;
    std::condition_variable room_made_;
    // Guarded by mutex_:
    std::vector<Entry> entries_;
    bool closed_ = false;
};

}  // namespace mavloom::feed
