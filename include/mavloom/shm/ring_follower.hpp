// SPDX-License-Identifier: MIT
// Follows a ring by its name: reads what stands there, waits for a writer that went, drains a ring that was removed or replaced, and opens the name again
// when it comes back. One owner thread; move-only; opening allocates.
#pragma once

#include <optional>
#include <string>

#include "mavloom/shm/ring_reader.hpp"

namespace mavloom::shm {

class RingFollower {
public:
    // Opens nothing yet; the ring may come later. `options.from` counts for a ring that is there at the first look: later ones are read from their
    // oldest record.
    RingFollower(std::string name, const ReaderOptions& options) : name_(std::move(name)), options_(options) {}

    // Opens the ring if it is there. False: it is not, or cannot be read (`error`).
    [[nodiscard]] bool try_open();
    // The next record, which lives until the next call; waits until `deadline`. Then `empty`, or `no_writer` where there is no ring or nobody writes to
    // it. `damaged` as long as a damaged ring bears the name.
    [[nodiscard]] ReadResult<RingRecord> read(MonoTime deadline);

    // The same without waiting, for a loop that sleeps elsewhere; it polls again when the reader's `arm` says, or after `look_distance` while no ring is open.
    [[nodiscard]] ReadResult<RingRecord> poll();
    // The ring that is open, until the next call; null without one.
    [[nodiscard]] RingReader* reader() noexcept { return reader_ ? &*reader_ : nullptr; }

    // Between two looks at a name that leads nowhere, or at a ring that nobody writes to.
    static constexpr Nanoseconds look_distance = std::chrono::milliseconds(20);

    [[nodiscard]] bool is_open() const noexcept { return reader_.has_value(); }
    // Why the last try to open failed; null when it did not.
    [[nodiscard]] const SetupError* error() const noexcept { return error_ ? &*error_ : nullptr; }
    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] std::uint64_t missed() const noexcept { return missed_ + (reader_ ? reader_->missed() : 0); }
    [[nodiscard]] std::uint64_t opened() const noexcept { return opened_; }  // how many rings so far

private:
    void drop();
    // Whether another ring may stand under the name now, or soon: the one that was open is left.
    [[nodiscard]] bool moved_on(ReadError error);

    std::string name_;
    ReaderOptions options_;
    std::optional<RingReader> reader_;
    std::optional<SetupError> error_;
    bool looked_ = false;
    std::uint64_t missed_ = 0;  // of the rings that are gone
    std::uint64_t opened_ = 0;
};

}  // namespace mavloom::shm
