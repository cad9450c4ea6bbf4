// SPDX-License-Identifier: MIT
// Plays what clients sent in an earlier session, at its flight times. Private to module simserve; single owner thread.
//
// Each sender is a link of its own, which nobody reads. Reads the file as it plays.
#pragma once

#include <filesystem>
#include <map>
#include <optional>

#include "mavloom/base/ids.hpp"
#include "mavloom/record/tlog_reader.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::simserve {

class InputReplay {
public:
    // Without a file, nothing is played. `utc_at_start`: that of the earlier session. A file without frames is an
    // error.
    [[nodiscard]] SetupResult<void> open(const std::filesystem::path& path, const wire::MessageTable& table,
                                         WallTime utc_at_start);

    // FlightTime::max() if nothing follows. Input from before the flight is due at 0.
    [[nodiscard]] sim::FlightTime next_due() const noexcept { return due_; }
    // The next frame. Call it only if something is due; then call `advance`.
    [[nodiscard]] const record::Record& next() const noexcept { return *next_; }
    void advance();

    // The link of a sender; LinkId{} until `set_link`.
    [[nodiscard]] LinkId link_of(Source source) const;
    void set_link(Source source, LinkId link) { links_[source] = link; }
    // True for the links of senders.
    [[nodiscard]] bool owns(LinkId link) const noexcept;
    // Of the file so far, bytes that were not played: damaged ones, and those of a frame that was cut off.
    [[nodiscard]] std::uint64_t lost_bytes() const noexcept {
        return reader_ ? reader_->counters().lost_bytes.value() : 0;
    }
    // The file cannot be read any further.
    [[nodiscard]] const std::optional<SetupError>& error() const noexcept { return error_; }
    [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }

private:
    std::optional<record::TlogReader> reader_;
    std::optional<record::Record> next_;
    std::optional<SetupError> error_;
    WallTime utc_at_start_{};
    sim::FlightTime due_ = sim::FlightTime::max();
    std::map<Source, LinkId> links_;
    std::uint64_t frames_ = 0;
};

}  // namespace mavloom::simserve
