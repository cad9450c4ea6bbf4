// SPDX-License-Identifier: MIT
// The stages of faults, one for each kind. Private to module fault; Links' thread runs them. None allocates once it has
// seen its largest piece.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fault/draws.hpp"
#include "fault/log.hpp"
#include "mavloom/base/counter.hpp"
#include "mavloom/endpoint/fault.hpp"
#include "mavloom/link/stage.hpp"
#include "mavloom/wire/stream_parser.hpp"

namespace mavloom::fault::detail {

using link::Next;
using link::Piece;

// Finds the current episode. Time counts from the first call.
class EpisodeClock {
public:
    explicit EpisodeClock(const endpoint::Episodes& episodes) noexcept : episodes_(episodes) {}
    // The end of the episode that `now` is in; empty: it is in none.
    [[nodiscard]] std::optional<MonoTime> end_of_current(MonoTime now) noexcept;

private:
    endpoint::Episodes episodes_;
    std::optional<MonoTime> begin_;
};

// Cuts what a stream reads into frames, and what lies between them. The rest of a read waits for the next one; in
// silence, as long as the parser of a stream waits.
class CutIntoFrames final : public link::Stage {
public:
    explicit CutIntoFrames(const wire::MessageTable& table) : parser_(table) {}
    void take(const Piece& piece, MonoTime now, Next& next) noexcept override;
    [[nodiscard]] std::optional<MonoTime> tick_due() const noexcept override { return parser_.deadline(); }
    void tick(MonoTime now, WallTime time, Next& next) noexcept override;
    void finish(WallTime time, Next& next) noexcept override;

private:
    template <class Decide>
    void pass_decided(Piece piece, Next& next, Decide&& decide);

    wire::StreamParser parser_;
    std::vector<std::uint8_t> bytes_;  // that the parser has not decided yet
};

class BlackOut final : public link::Stage {
public:
    BlackOut(const endpoint::Episodes& episodes, Tally tally) noexcept : clock_(episodes), tally_(std::move(tally)) {}
    void take(const Piece& piece, MonoTime now, Next& next) noexcept override;

private:
    EpisodeClock clock_;
    Tally tally_;
};

// Meets each piece with a chance that does not depend on the others.
class ByChance : public link::Stage {
public:
    ByChance(double share, Seed seed, Tally tally) noexcept : share_(share), draws_(seed), tally_(std::move(tally)) {}

protected:
    double share_;
    Draws draws_;
    Tally tally_;
};

class Lose final : public ByChance {
public:
    using ByChance::ByChance;
    void take(const Piece& piece, MonoTime now, Next& next) noexcept override;
};

// Gilbert-Elliott: in the bad state all is lost, in the good one nothing. After each piece, the state changes with the
// chance `into_` or `out_of_`.
class LoseInBursts final : public link::Stage {
public:
    LoseInBursts(double share, double burst, Seed seed, Tally tally) noexcept
        : into_(share / ((1 - share) * burst)), out_of_(1 / burst), draws_(seed), tally_(std::move(tally)) {}
    void take(const Piece& piece, MonoTime now, Next& next) noexcept override;

private:
    double into_, out_of_;
    bool is_bad_ = false;
    Draws draws_;
    Tally tally_;
};

class Duplicate final : public ByChance {
public:
    using ByChance::ByChance;
    void take(const Piece& piece, MonoTime now, Next& next) noexcept override;
};

// Inverts one bit.
class Corrupt final : public ByChance {
public:
    using ByChance::ByChance;
    void take(const Piece& piece, MonoTime now, Next& next) noexcept override;

private:
    std::vector<std::uint8_t> changed_;
};

// Passes only the beginning of a piece, at least one byte.
class CutShort final : public ByChance {
public:
    using ByChance::ByChance;
    void take(const Piece& piece, MonoTime now, Next& next) noexcept override;
};

// No piece overtakes another.
class Delay final : public link::Stage {
public:
    Delay(Nanoseconds mean, Nanoseconds jitter, Seed seed, Tally tally) noexcept
        : mean_(mean), jitter_(jitter), draws_(seed), tally_(std::move(tally)) {}
    void take(const Piece& piece, MonoTime now, Next& next) noexcept override;

private:
    Nanoseconds mean_, jitter_;
    MonoTime last_{};
    Draws draws_;
    Tally tally_;
};

class Stall final : public link::Stage {
public:
    Stall(const endpoint::Episodes& episodes, Tally tally) noexcept : clock_(episodes), tally_(std::move(tally)) {}
    void take(const Piece& piece, MonoTime now, Next& next) noexcept override;

private:
    EpisodeClock clock_;
    Tally tally_;
};

class Reorder final : public link::Stage {
public:
    Reorder(double share, Nanoseconds by, Seed seed, Tally tally) noexcept
        : share_(share), by_(by), draws_(seed), tally_(std::move(tally)) {}
    void take(const Piece& piece, MonoTime now, Next& next) noexcept override;

private:
    double share_;
    Nanoseconds by_;
    Draws draws_;
    Tally tally_;
};

// A line that carries `bytes_s`. A piece that does not fit into the queue, which includes the piece on the line, is
// dropped. An empty line takes any piece.
class Narrow final : public link::Stage {
public:
    Narrow(std::uint64_t bytes_s, std::uint64_t queue_bytes, Tally dropped) noexcept
        : ns_a_byte_(1e9 / static_cast<double>(bytes_s)),
          queue_bytes_(static_cast<double>(queue_bytes)),
          dropped_(std::move(dropped)) {}
    void take(const Piece& piece, MonoTime now, Next& next) noexcept override;

private:
    [[nodiscard]] Nanoseconds time_for(double bytes) const noexcept;

    double ns_a_byte_, queue_bytes_;
    MonoTime free_at_{};  // when all that was taken has left
    Tally dropped_;
};

}  // namespace mavloom::fault::detail
