// SPDX-License-Identifier: MIT
#include "fault/stages.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>

namespace mavloom::fault::detail {

std::optional<MonoTime> EpisodeClock::end_of_current(MonoTime now) noexcept {
    if (!begin_) begin_ = now;
    const Nanoseconds in_period = (now - *begin_) % episodes_.every;
    if (in_period < episodes_.every - episodes_.length) return std::nullopt;
    return now + (episodes_.every - in_period);
}

// The parser decides about all bytes in their order, so what it decides next is at the front of `bytes_`.
template <class Decide>
void CutIntoFrames::pass_decided(Piece piece, Next& next, Decide&& decide) {
    std::size_t begin = 0;
    const auto pass = [&](std::size_t bytes) {
        assert(begin + bytes <= bytes_.size());
        piece.bytes = ByteView(bytes_).subspan(begin, bytes);
        begin += bytes;
        next.pass(piece);
    };
    decide([&](const wire::ParseEvent& event) {
        using Kind = wire::ParseEvent::Kind;
        if (event.kind == Kind::junk) pass(event.bytes);
        if (event.kind == Kind::frame || event.kind == Kind::unknown_flags) pass(event.frame.size());
    });
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin));
}

void CutIntoFrames::take(const Piece& piece, MonoTime now, Next& next) noexcept {
    bytes_.insert(bytes_.end(), piece.bytes.begin(), piece.bytes.end());
    pass_decided(piece, next, [&](auto&& sink) {
        parser_.feed(piece.bytes, now, sink);
        parser_.report_junk(sink);
    });
}

void CutIntoFrames::tick(MonoTime now, WallTime time, Next& next) noexcept {
    pass_decided({.bytes = {}, .time = time}, next, [&](auto&& sink) { parser_.tick(now, sink); });
}

void CutIntoFrames::finish(WallTime time, Next& next) noexcept {
    if (!bytes_.empty()) next.pass({.bytes = bytes_, .time = time});
    bytes_.clear();
    parser_.finish([](const wire::ParseEvent&) {});
}

void BlackOut::take(const Piece& piece, MonoTime now, Next& next) noexcept {
    if (clock_.end_of_current(now)) tally_.note(piece);
    else next.pass(piece);
}

void Lose::take(const Piece& piece, MonoTime, Next& next) noexcept {
    if (draws_.chance(share_)) tally_.note(piece);
    else next.pass(piece);
}

void LoseInBursts::take(const Piece& piece, MonoTime, Next& next) noexcept {
    if (is_bad_) tally_.note(piece);
    else next.pass(piece);
    if (draws_.chance(is_bad_ ? out_of_ : into_)) is_bad_ = !is_bad_;
}

void Duplicate::take(const Piece& piece, MonoTime, Next& next) noexcept {
    next.pass(piece);
    if (!draws_.chance(share_)) return;
    tally_.note(piece);
    next.pass(piece);
}

void Corrupt::take(const Piece& piece, MonoTime, Next& next) noexcept {
    if (!draws_.chance(share_)) return next.pass(piece);
    changed_.assign(piece.bytes.begin(), piece.bytes.end());
    const std::uint64_t bit = draws_.below(8 * changed_.size());
    changed_[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    tally_.note(piece);
    Piece other = piece;
    other.bytes = changed_;
    next.pass(other);
}

void CutShort::take(const Piece& piece, MonoTime, Next& next) noexcept {
    if (!draws_.chance(share_) || piece.bytes.size() < 2) return next.pass(piece);
    Piece shorter = piece;
    shorter.bytes = piece.bytes.first(1 + draws_.below(piece.bytes.size() - 1));
    tally_.note(piece);
    next.pass(shorter);
}

void Delay::take(const Piece& piece, MonoTime now, Next& next) noexcept {
    const double jitter = static_cast<double>(jitter_.count()) * (2 * draws_.share() - 1);
    last_ = std::max(last_, now + mean_ + Nanoseconds(std::llround(jitter)));
    tally_.note(piece);
    next.pass_at(piece, last_);
}

void Stall::take(const Piece& piece, MonoTime now, Next& next) noexcept {
    const auto end = clock_.end_of_current(now);
    if (!end) return next.pass(piece);
    tally_.note(piece);
    next.pass_at(piece, *end);
}

void Reorder::take(const Piece& piece, MonoTime now, Next& next) noexcept {
    if (!draws_.chance(share_)) return next.pass(piece);
    tally_.note(piece);
    next.pass_at(piece, now + by_);
}

Nanoseconds Narrow::time_for(double bytes) const noexcept { return Nanoseconds(std::llround(bytes * ns_a_byte_)); }

void Narrow::take(const Piece& piece, MonoTime now, Next& next) noexcept {
    const MonoTime begin = std::max(free_at_, now);
    const auto size = static_cast<double>(piece.bytes.size());
    const auto waiting = std::chrono::duration<double, std::nano>(begin - now).count() / ns_a_byte_;
    if (begin > now && waiting + size > queue_bytes_) return dropped_.note(piece);
    free_at_ = begin + time_for(size);
    next.pass_at(piece, free_at_);
}

}  // namespace mavloom::fault::detail
