// SPDX-License-Identifier: MIT
// FrameRing: the frames of an endpoint in a bounded ring of bytes. The writer never waits: it overwrites the oldest
// frames. Each reader keeps its own Position, and `next` counts the frames that it missed. The ring holds whole frames
// only. Not synchronized: the owner's mutex guards it. Allocates once, at construction; the kernel provides the memory
// page by page at first use.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>

#include "mavloom/wire/frame.hpp"

namespace mavloom::feed {

class FrameRing {
public:
    struct Head {
        std::int64_t time_ns = 0;
        std::uint32_t link = 0;
        std::uint16_t size = 0;    // of the frame; `padding`: the rest up to the end of the memory is unused
        std::uint8_t verdict = 0;  // see mavloom/ring/frames.hpp
    };
    // The position of a reader: its next byte and the number of its next frame. Neither wraps.
    struct Position {
        std::uint64_t byte = 0, frame = 0;
    };

    static constexpr std::size_t max_capacity = std::size_t{1} << (sizeof(std::size_t) == 8 ? 36 : 30);

    // Rounds the capacity up to a power of two, at least 64 KiB. It must not exceed max_capacity.
    explicit FrameRing(std::size_t capacity_bytes)
        : capacity_(std::bit_ceil(std::max<std::size_t>(capacity_bytes, 64 * 1024))),
          memory_(std::make_unique_for_overwrite<std::uint8_t[]>(capacity_)) {}

    void push(Head head, const wire::FrameView& frame) noexcept {
        head.size = static_cast<std::uint16_t>(frame.size());
        const std::size_t length = length_of(head.size);
        const std::size_t to_end = capacity_ - index(head_.byte);
        const bool wraps = to_end < length;
        evict(length + (wraps ? to_end : 0));
        if (wraps) {
            write({.size = padding}, head_.byte);
            head_.byte += to_end;
        }
        write(head, head_.byte);
        std::memcpy(memory_.get() + index(head_.byte) + sizeof(Head), frame.bytes().data(), frame.size());
        head_.byte += length;
        ++head_.frame;
    }

    // Reads the next frame of a reader; false if there is none. The view is valid until the next push. Adds the number
    // of overwritten frames to `missed`.
    bool next(Position& at, std::uint64_t& missed, Head& head, wire::FrameView& frame) const noexcept {
        missed += catch_up(at);
        if (at.frame == head_.frame) return false;
        at.byte = skip_padding(at.byte);
        head = read(at.byte);
        frame = wire::FrameView::unchecked({memory_.get() + index(at.byte) + sizeof(Head), head.size});
        at.byte += length_of(head.size);
        ++at.frame;
        return true;
    }
    // How many frames `next` would add to `missed`.
    [[nodiscard]] std::uint64_t overwritten(const Position& at) const noexcept {
        return at.frame < tail_.frame ? tail_.frame - at.frame : 0;
    }
    [[nodiscard]] Position newest() const noexcept { return head_; }
    // Whether `frames` more frames of any length fit without overwriting frames that this reader has not read.
    [[nodiscard]] bool has_room(const Position& reader, std::size_t frames) const noexcept {
        // Counts one frame more for the padding at the wrap.
        const std::size_t needed = (frames + 1) * length_of(wire::max_frame_length);
        return head_.byte - reader.byte + needed <= capacity_;
    }

private:
    static constexpr std::uint16_t padding = 0xffff;

    [[nodiscard]] static std::size_t length_of(std::uint16_t frame_size) noexcept {
        return (sizeof(Head) + frame_size + 15) / 16 * 16;
    }
    [[nodiscard]] std::size_t index(std::uint64_t byte) const noexcept { return byte & (capacity_ - 1); }
    void write(const Head& head, std::uint64_t byte) noexcept {
        std::memcpy(memory_.get() + index(byte), &head, sizeof head);
    }
    [[nodiscard]] Head read(std::uint64_t byte) const noexcept {
        Head head;
        std::memcpy(&head, memory_.get() + index(byte), sizeof head);
        return head;
    }
    [[nodiscard]] std::uint64_t skip_padding(std::uint64_t byte) const noexcept {
        return read(byte).size == padding ? byte + capacity_ - index(byte) : byte;
    }
    void evict(std::size_t needed) noexcept {
        while (head_.byte + needed - tail_.byte > capacity_) {
            tail_.byte = skip_padding(tail_.byte);
            tail_.byte += length_of(read(tail_.byte).size);
            ++tail_.frame;
        }
    }
    std::uint64_t catch_up(Position& at) const noexcept {
        const auto missed = overwritten(at);
        if (missed != 0) at = tail_;
        return missed;
    }

    std::size_t capacity_;
    std::unique_ptr<std::uint8_t[]> memory_;
    Position head_, tail_;  // the next frame to write, the oldest frame that is left
};

static_assert(sizeof(FrameRing::Head) == 16);

}  // namespace mavloom::feed
