// SPDX-License-Identifier: MIT
// Finds the MAVLink frames in a byte stream (TCP, serial) that arrives in chunks of any size.
// The result does not depend on how the stream is split into chunks. Short chunks are copied into a buffer.
// Long chunks are parsed in place; only a frame that spans two chunks is copied.
// One owner thread; allocates nothing after construction.
//
// A start byte in noise may claim a frame of up to 280 bytes.
// If the stream then falls silent, that false start holds back the real frames behind it.
// After `hold` of silence, `tick` drops a false start if an intact frame follows it.
// A real frame whose sender merely paused is still completed.
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

    // Calls sink(const ParseEvent&) for everything that can be decided so far, in order. Views are valid until the call
    // returns.
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

    // Reports the junk that was found so far, although more of it may follow.
    template <class Sink>
    void report_junk(Sink&& sink) {
        scanner_.end_junk(sink);
    }

    // Call it when `deadline` has passed without new bytes.
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

    // Decides what can be decided if no bytes follow soon: whole frames of unknown id, and a run of junk that may not
    // have ended. An incomplete frame still waits, even if it holds back complete frames.
    template <class Sink>
    void settle(Sink&& sink) {
        begin_ += scanner_.scan(pending(), detail::End::idle, sink);
        scanner_.end_junk(sink);
    }

    // Call it when the stream has ended (closed, end of file). The remaining bytes become frames or junk. The parser
    // can be fed again afterwards.
    template <class Sink>
    void finish(Sink&& sink) {
        begin_ += scanner_.scan(pending(), detail::End::closed, sink);
        scanner_.end_junk(sink);
    }

    // When to call `tick`. Empty while no bytes are held back, or if `tick` has already examined them.
    [[nodiscard]] std::optional<MonoTime> deadline() const noexcept {
        if (begin_ == end_ || settled_) return std::nullopt;
        return last_byte_ + hold_;
    }

    [[nodiscard]] std::size_t pending_bytes() const noexcept { return end_ - begin_; }
    [[nodiscard]] const ParseCounters& counters() const noexcept { return scanner_.counters(); }

private:
    // At most one undecided frame is kept: its own bytes and, for an unknown id, one byte of look-ahead. Deciding a
    // start byte within that frame may take as many bytes again.
    static constexpr std::size_t max_kept = max_frame_length + 1;
    static constexpr std::size_t short_chunk = 128;
    // Holds several short chunks, so that the kept bytes are rarely moved.
    static constexpr std::size_t buffer_length = 1024;
    static constexpr std::size_t slack = detail::Scanner::enough_slack;
    static_assert(max_kept + std::max(max_kept, short_chunk) <= buffer_length);

    [[nodiscard]] ByteView pending() const noexcept { return {buffer_.data() + begin_, end_ - begin_}; }

    // Decides every start byte in the kept bytes, borrowing as little of the chunk as possible.
    // Returns the rest of the chunk, to be parsed in place.
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

    // How many more bytes the first candidate needs: 3 to know its length, then its length plus one byte of look-ahead.
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
    std::size_t begin_ = 0, end_ = 0;  // the kept bytes
    bool settled_ = false;             // `tick` has already examined the pending bytes
};

}  // namespace mavloom::wire
