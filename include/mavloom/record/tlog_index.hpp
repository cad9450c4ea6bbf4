// SPDX-License-Identifier: MIT
// Where in a recording a moment is: one entry per some thousand records, made in one pass. Recordings whose time runs backwards in places are
// in order: the answer is the first record, in the order of the file, that is not before the moment asked for.
// Immutable after `build`; any number of threads may search. 16 bytes an entry.
#pragma once

#include <optional>
#include <vector>

#include "mavloom/record/tlog_reader.hpp"

namespace mavloom::record {

class TlogIndex {
public:
    static constexpr std::uint64_t default_spacing = 1024;  // records an entry

    // Reads `reader` from where it is to the end.
    [[nodiscard]] static SetupResult<TlogIndex> build(TlogReader& reader, std::uint64_t spacing = default_spacing);

    // Puts `reader`, which reads the same file, on the first record at or after `time`; at the end of the file if there is none.
    [[nodiscard]] SetupResult<void> seek(TlogReader& reader, WallTime time) const;

    // The offset from which `seek` looks: no record before it is at or after `time`.
    [[nodiscard]] std::uint64_t offset_before(WallTime time) const noexcept;

    [[nodiscard]] std::uint64_t records() const noexcept { return records_; }
    // Empty recordings have no times. The earliest is not always the first, the latest not always the last.
    [[nodiscard]] std::optional<WallTime> earliest() const noexcept { return earliest_; }
    [[nodiscard]] std::optional<WallTime> latest() const noexcept { return latest_; }
    // How often a record is earlier than the one before it.
    [[nodiscard]] std::uint64_t backward_steps() const noexcept { return backward_steps_; }
    [[nodiscard]] std::size_t entries() const noexcept { return entries_.size(); }

private:
    // `latest_before`, the latest time of all records in front of the entry's, never falls from entry to entry: that makes it searchable.
    struct Entry {
        WallTime latest_before;
        std::uint64_t offset;
    };

    void add(const Record& record, std::uint64_t spacing);

    std::vector<Entry> entries_;
    std::optional<WallTime> earliest_, latest_;
    WallTime last_{};
    std::uint64_t records_ = 0, backward_steps_ = 0;
};

}  // namespace mavloom::record
