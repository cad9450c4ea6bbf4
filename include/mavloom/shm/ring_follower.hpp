// SPDX-License-Identifier: MIT
// Reads a ring by name for as long as the program runs, across restarts of the writer and replacements of the ring.
//
// The follower waits for a missing ring or writer, drains a ring that was removed or replaced, then opens the name
// again. One owner thread; move-only. Opening allocates.
#pragma once

#include <optional>
#include <string>

#include "mavloom/shm/ring_reader.hpp"

namespace mavloom::shm {

class RingFollower {
public:
    // Opens nothing yet; the ring may be created later. `options.from` applies only to a ring that exists at the first
    // attempt. Every later ring is read from its oldest record.
    RingFollower(std::string name, const ReaderOptions& options) : name_(std::move(name)), options_(options) {}

    // Opens the ring if it exists. Returns false if it does not exist or cannot be read; see `error`.
    [[nodiscard]] bool try_open();
    // Returns the next record, which is valid until the next call. Waits until `deadline`. Then it returns `no_writer`
    // if there is no ring or no writer, otherwise `empty`. As long as the ring under this name is damaged, returns
    // `damaged`.
    [[nodiscard]] ReadResult<RingRecord> read(MonoTime deadline);

    // Like `read`, but does not wait; for a loop that sleeps elsewhere. The loop polls again after the time that the
    // reader's `arm` returns, or after `poll_interval` while no ring is open.
    [[nodiscard]] ReadResult<RingRecord> poll();
    // The reader of the open ring, valid until the next call. Null if no ring is open.
    [[nodiscard]] RingReader* reader() noexcept { return reader_ ? &*reader_ : nullptr; }

    // Time between two attempts to open a missing ring, or two checks of a ring without a writer.
    static constexpr Nanoseconds poll_interval = std::chrono::milliseconds(20);

    [[nodiscard]] bool is_open() const noexcept { return reader_.has_value(); }
    // Why the last attempt to open failed. Null if it did not fail.
    [[nodiscard]] const SetupError* error() const noexcept { return error_ ? &*error_ : nullptr; }
    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] std::uint64_t missed() const noexcept { return missed_ + (reader_ ? reader_->missed() : 0); }
    [[nodiscard]] std::uint64_t opened() const noexcept { return opened_; }  // number of rings opened so far

private:
    void drop();
    // Closes the current ring if its name no longer leads to it. Returns true if it did, so that the caller tries the
    // next ring.
    [[nodiscard]] bool moved_on(ReadError error);

    std::string name_;
    ReaderOptions options_;
    std::optional<RingReader> reader_;
    std::optional<SetupError> error_;
    bool attempted_ = false;
    std::uint64_t missed_ = 0;  // of the rings that are closed
    std::uint64_t opened_ = 0;
};

}  // namespace mavloom::shm
