// SPDX-License-Identifier: MIT
#include "mavloom/record/tlog_index.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>

namespace mavloom::record {

void TlogIndex::add(const Record& record, std::uint64_t spacing) {
    if (records_ % spacing == 0) entries_.push_back({latest_.value_or(WallTime::min()), record.offset});
    if (records_ != 0 && record.time < last_) ++backward_steps_;
    last_ = record.time;
    earliest_ = std::min(earliest_.value_or(record.time), record.time);
    latest_ = std::max(latest_.value_or(record.time), record.time);
    ++records_;
}

SetupResult<TlogIndex> TlogIndex::build(TlogReader& reader, std::uint64_t spacing) {
    assert(spacing != 0);
    TlogIndex index;
    while (true) {
        const auto record = reader.next();
        if (record) index.add(*record, spacing);
        else if (record.error() == TlogReader::Stop::failed) return tl::unexpected(reader.error());
        else if (record.error() == TlogReader::Stop::nothing_yet) return system_error("cannot index a pipe", EINTR);
        else return index;
    }
}

std::uint64_t TlogIndex::offset_before(WallTime time) const noexcept {
    // Finds the last entry before which all records are earlier than `time`.
    const auto behind = std::partition_point(entries_.begin(), entries_.end(),
                                             [&](const Entry& e) { return e.latest_before < time; });
    return behind == entries_.begin() ? 0 : std::prev(behind)->offset;
}

SetupResult<void> TlogIndex::seek(TlogReader& reader, WallTime time) const {
    if (auto done = reader.seek(offset_before(time)); !done) return done;
    while (true) {
        const auto record = reader.next();
        if (record && record->time >= time) return reader.seek(record->offset);
        if (record) continue;
        if (record.error() == TlogReader::Stop::failed) return tl::unexpected(reader.error());
        return {};
    }
}

}  // namespace mavloom::record
