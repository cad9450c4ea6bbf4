// SPDX-License-Identifier: MIT
// An index that finds the place of a given time in a recording. `build` makes it in one pass, with one 16-byte entry
// for about every thousand records.
//
// Times may run backwards within a recording. A search finds the first record, in file order, at or after the given
// time. The index is immutable after `build`; any number of threads may search it.
#pragma once

#include <optional>
#include <vector>

#include "mavloom/record/tlog_reader.hpp"

namespace mavloom::record {

class TlogIndex {
public:
    static constexpr std::uint64_t default_spacing = 1024;  // records per entry

    // Reads `reader` from its current position to the end.
    [[nodiscard]] static SetupResult<TlogIndex> build(TlogReader& reader, std::uint64_t spacing = default_spacing);

    // Moves `reader`, which must read the same file, to the first record at or after `time`. If there is none, moves it
    // to the end of the file.
    [[nodiscard]] SetupResult<void> seek(TlogReader& reader, WallTime time) const;

    // The offset from which `seek` searches. All records before it are earlier than `time`.
    [[nodiscard]] std::uint64_t offset_before(WallTime time) const noexcept;

    [[nodiscard]] std::uint64_t records() const noexcept { return records_; }
    // The earliest and latest times, not always those of the first and last record. Empty for an empty recording.
    [[nodiscard]] std::optional<WallTime> earliest() const noexcept { return earliest_; }
    [[nodiscard]] std::optional<WallTime> latest() const noexcept { return latest_; }
    // How many records are earlier than the record before them.
    [[nodiscard]] std::uint64_t backward_steps() const noexcept { return backward_steps_; }
    [[nodiscard]] std::size_t entries() const noexcept { return entries_.size(); }

private:
    // `latest_before` is the latest time of all records before the entry's record. It never decreases from entry to
    // entry, so it can be searched.
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
