// SPDX-License-Identifier: MIT
// What stands at a position of a tlog. Pure functions over untrusted bytes; private to module record.
#pragma once

#include "mavloom/base/bytes.hpp"
#include "mavloom/record/tlog.hpp"

namespace mavloom::record {

struct Found {
    enum class Kind : std::uint8_t {
        nothing,        // no record begins here
        record,         // a plausible time and an intact frame
        unknown_flags,  // the same, but with an incompatibility flag that is not defined
    };
    Kind kind = Kind::nothing;
    std::size_t size = 0;  // of the whole record
    const wire::MessageInfo* info = nullptr;
};

// `bytes` begins at the position in question and holds all that is left of the file, or at least two longest records.
[[nodiscard]] Found examine_record(ByteView bytes, const wire::MessageTable& table) noexcept;

// How many bytes at the front cannot begin a record: no start byte stands where it would have to, or no plausible time before it. All but the last
// eight at most.
[[nodiscard]] std::size_t skip_startless(ByteView bytes) noexcept;

// The length of the record at the front, by its header alone; 0 where `bytes` does not hold it whole.
[[nodiscard]] std::size_t record_length(ByteView bytes) noexcept;

// The same for a record that another one can be told to follow without looking at its checksum: its time is within a day of `before_us`, its id is
// known, and its frame has no undefined flag and is not longer than its definition. 0 where it has to be examined.
[[nodiscard]] std::size_t joined_record_length(ByteView bytes, std::uint64_t before_us,
                                               const wire::MessageTable& table) noexcept;

}  // namespace mavloom::record
