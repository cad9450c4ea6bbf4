// SPDX-License-Identifier: MIT
// Finds the frames of a byte stream (TCP, serial) that arrives in chunks of any size; how it is chunked does not change what is found. Whole
// frames within a chunk are reported in place; only a frame that spans chunks is copied. One owner thread; allocates nothing after
// construction.
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
        if (pending_ != 0) chunk = feed_pending(chunk, sink);
        const std::size_t used = scanner_.scan(chunk, detail::End::open, sink);
        if (used != chunk.size()) keep(chunk.subspan(used));
    }

    // To be called when `deadline` has passed without new bytes.
    template <class Sink>
    void tick(MonoTime now, Sink&& sink) {
        if (pending_ == 0 || now < last_byte_ + hold_) return;
        consume(scanner_.scan(pending(), detail::End::idle, sink));
        while (pending_ != 0 && scanner_.holds_known_frame(pending().subspan(1))) {
            scanner_.add_junk(sink);
            consume(1);
            consume(scanner_.scan(pending(), detail::End::idle, sink));
        }
        scanner_.end_junk(sink);
        settled_ = true;
    }

    // The stream has ended (closed, end of file): what is left becomes frames or junk. The parser may be fed again afterwards.
    template <class Sink>
    void finish(Sink&& sink) {
        consume(scanner_.scan(pending(), detail::End::closed, sink));
        scanner_.end_junk(sink);
    }

    // When `tick` has something to do; empty while nothing is held back.
    [[nodiscard]] std::optional<MonoTime> deadline() const noexcept {
        if (pending_ == 0 || settled_) return std::nullopt;
        return last_byte_ + hold_;
    }

    [[nodiscard]] std::size_t pending_bytes() const noexcept { return pending_; }
    [[nodiscard]] const ParseCounters& counters() const noexcept { return scanner_.counters(); }

private:
    // At most one undecided frame is kept: its own bytes and, for an unknown id, one byte of look-ahead. A start within it that is decided
    // next needs as many again.
    static constexpr std::size_t most_kept = max_frame_length + 1;

    [[nodiscard]] ByteView pending() const noexcept { return {kept_.data(), pending_}; }

    // Decides every start that lies in the kept bytes, with as little of the chunk as that takes; returns the rest, to be scanned in place.
    template <class Sink>
    ByteView feed_pending(ByteView chunk, Sink&& sink) {
        settled_ = false;
        const std::size_t old = pending_;
        std::size_t at = 0;
        while (at < old) {
            const ByteView borrowed = chunk.first(std::min(wanted(at), chunk.size()));
            keep(borrowed);
            chunk = chunk.subspan(borrowed.size());
            const std::size_t used = scanner_.scan_one(pending().subspan(at), detail::End::open, sink);
            if (used == 0 && chunk.empty()) {
                consume(at);
                return {};
            }
            at += used;
        }
        const std::size_t unused = pending_ - at;
        pending_ = 0;
        return {chunk.data() - unused, chunk.size() + unused};
    }

    // How many more bytes the start at `at` needs: to tell its length, then to be whole, and one of look-ahead for an unknown id.
    [[nodiscard]] std::size_t wanted(std::size_t at) const noexcept {
        const ByteView start = pending().subspan(at);
        const std::size_t length = frame_length(start);
        const std::size_t all = length == 0 ? std::size_t{3} : length + 1;
        return all > start.size() ? all - start.size() : 0;
    }

    void keep(ByteView rest) noexcept {
        std::memcpy(kept_.data() + pending_, rest.data(), rest.size());
        pending_ += rest.size();
        settled_ = false;
    }

    void consume(std::size_t bytes) noexcept {
        pending_ -= bytes;
        std::memmove(kept_.data(), kept_.data() + bytes, pending_);
    }

    detail::Scanner scanner_;
    Nanoseconds hold_;
    MonoTime last_byte_{};
    std::array<std::uint8_t, 2 * most_kept> kept_{};
    std::size_t pending_ = 0;
    bool settled_ = false;  // `tick` has looked at these pending bytes
};

}  // namespace mavloom::wire
