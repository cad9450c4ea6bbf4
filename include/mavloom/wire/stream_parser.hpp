// SPDX-License-Identifier: MIT
// Finds the frames of a byte stream (TCP, serial) that arrives in chunks of any size; how it is chunked does not change what is found. Short
// chunks are copied behind what is kept; of long ones only a frame that spans two, the others are reported in place. One owner thread;
// allocates nothing after construction.
//
// A false start (a start byte in noise) may claim up to 280 bytes and so hold back real frames behind it at the end of a stream that fell
// silent. After `hold` of silence `tick` gives such a start up, but only if an intact frame lies behind it: a true frame whose sender merely
// paused is still completed.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <optional>

#include "mavloom/base/clock.hpp"
#include "mavloom/wire/detail/scanner.hpp"

namespace mavloom::wire {

class StreamParser {
public:
    static constexpr std::chrono::milliseconds default_hold{100};

    // `table` must outlive the parser.
    explicit StreamParser(const MessageTable& table, Nanoseconds hold = default_hold) : scanner_(table), hold_(hold) {}

    // Calls sink(const ParseEvent&) for all that is decided by now, in order. Views live until the call returns.
    template <class Sink>
    void feed(ByteView chunk, MonoTime now, Sink&& sink) {
        if (chunk.empty()) return;
        last_byte_ = now;
        if (chunk.size() <= short_chunk) {
            keep(chunk);
            begin_ += scanner_.scan(pending(), detail::End::open, sink, slack);
            return;
        }
        if (begin_ != end_) chunk = feed_pending(chunk, sink);
        const std::size_t used = scanner_.scan(chunk, detail::End::open, sink);
        if (used != chunk.size()) keep(chunk.subspan(used));
    }

    // To be called when `deadline` has passed without new bytes.
    template <class Sink>
    void tick(MonoTime now, Sink&& sink) {
        if (begin_ == end_ || now < last_byte_ + hold_) return;
        begin_ += scanner_.scan(pending(), detail::End::idle, sink);
        while (begin_ != end_ && scanner_.holds_known_frame(pending().subspan(1))) {
            scanner_.add_junk(sink);
            ++begin_;
            begin_ += scanner_.scan(pending(), detail::End::idle, sink);
        }
        scanner_.end_junk(sink);
        settled_ = true;
    }

    // The stream has ended (closed, end of file): what is left becomes frames or junk. The parser may be fed again afterwards.
    template <class Sink>
    void finish(Sink&& sink) {
        begin_ += scanner_.scan(pending(), detail::End::closed, sink);
        scanner_.end_junk(sink);
    }

    // When `tick` has something to do; empty while nothing is held back.
    [[nodiscard]] std::optional<MonoTime> deadline() const noexcept {
        if (begin_ == end_ || settled_) return std::nullopt;
        return last_byte_ + hold_;
    }

    [[nodiscard]] std::size_t pending_bytes() const noexcept { return end_ - begin_; }
    [[nodiscard]] const ParseCounters& counters() const noexcept { return scanner_.counters(); }

private:
    // At most one undecided frame is kept: its own bytes and, for an unknown id, one byte of look-ahead. A start within it that is decided
    // next needs as many again.
    static constexpr std::size_t most_kept = max_frame_length + 1;
    static constexpr std::size_t short_chunk = 128;
    static constexpr std::size_t buffer_length = 1024;  // several short chunks: what is kept seldom moves
    static constexpr std::size_t slack = detail::Scanner::enough_slack;
    static_assert(most_kept + std::max(most_kept, short_chunk) <= buffer_length);

    [[nodiscard]] ByteView pending() const noexcept { return {buffer_.data() + begin_, end_ - begin_}; }

    // Decides every start that lies in the kept bytes, with as little of the chunk as that takes; returns the rest, to be scanned in place.
    template <class Sink>
    ByteView feed_pending(ByteView chunk, Sink&& sink) {
        for (std::size_t old = end_ - begin_; old != 0;) {
            const ByteView borrowed = chunk.first(std::min(wanted(), chunk.size()));
            keep(borrowed);
            chunk = chunk.subspan(borrowed.size());
            const std::size_t used = scanner_.scan_one(pending(), detail::End::open, sink, slack);
            if (used == 0 && chunk.empty()) return {};
            begin_ += used;
            old -= std::min(used, old);
        }
        const std::size_t unused = end_ - begin_;
        begin_ = end_;
        return {chunk.data() - unused, chunk.size() + unused};
    }

    // How many more bytes the first start needs: to tell its length, then to be whole, and one of look-ahead for an unknown id.
    [[nodiscard]] std::size_t wanted() const noexcept {
        const std::size_t length = frame_length(pending());
        const std::size_t all = length == 0 ? std::size_t{3} : length + 1;
        return all > pending().size() ? all - pending().size() : 0;
    }

    void keep(ByteView bytes) noexcept {
        if (buffer_length - end_ < bytes.size()) {
            std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
            end_ -= begin_;
            begin_ = 0;
        }
        std::memcpy(buffer_.data() + end_, bytes.data(), bytes.size());
        end_ += bytes.size();
        settled_ = false;
    }

    detail::Scanner scanner_;
    Nanoseconds hold_;
    MonoTime last_byte_{};
    std::array<std::uint8_t, buffer_length + slack> buffer_{};
    std::size_t begin_ = 0, end_ = 0;  // what is kept
    bool settled_ = false;             // `tick` has looked at these pending bytes
};

}  // namespace mavloom::wire
