// SPDX-License-Identifier: MIT
// One message of a tlog as columns: a contiguous array for each field, filled without an object for each message. Knows nothing of Python.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "filter.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/record/tlog_reader.hpp"

namespace mavloom::python {

struct ColumnsQuery {
    const dialect::Message* message = nullptr;
    std::optional<std::uint8_t> system, component;
    std::optional<Instance> instance;  // value of the field that is marked as the instance
};

// The rows of a query: receive time, source and the payload in its full length, one behind the other in blocks. Grows without moving what is there.
class Rows {
public:
    explicit Rows(const dialect::Message& message) noexcept
        : payload_length_(message.wire.max_length), stride_((prefix_bytes + payload_length_ + 7) / 8 * 8) {}

    void add(std::int64_t time_ns, const wire::FrameView& frame);
    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    // Calls take(first, rows, stride) for runs of rows that lie `stride` bytes apart: eight bytes of time, system, component, payload.
    template <class Take>
    void each_run(Take take) const {
        for (std::size_t done = 0; done < count_; done += rows_per_block)
            take(blocks_[done / rows_per_block].get(), std::min(rows_per_block, count_ - done), stride_);
    }
    static constexpr std::size_t time_offset = 0, system_offset = 8, component_offset = 9, prefix_bytes = 10;

private:
    static constexpr std::size_t rows_per_block = 1024;

    std::size_t payload_length_, stride_;
    std::size_t count_ = 0;
    std::vector<std::unique_ptr<std::uint8_t[]>> blocks_;
};

// Values in native byte order, row by row; the type and the number for each row are the field's.
struct Columns {
    using Values = std::unique_ptr<std::uint8_t[]>;
    std::size_t rows = 0;
    Values time_ns, system, component;  // int64, uint8, uint8
    std::vector<Values> fields;         // in the order of the definition
};

// Reads on until `most_bytes` went by, whatever they hold, or the file's end; true where there may be more. Errors as TlogReader has them.
[[nodiscard]] SetupResult<bool> read_rows(record::TlogReader& reader, const ColumnsQuery& query, Rows& rows,
                                          std::uint64_t most_bytes);

// The rows of many messages at once, by the message's place in the dialect's wire table; null for those that are not wanted or did not occur.
struct Tables {
    std::vector<bool> wanted;
    std::vector<std::unique_ptr<Rows>> rows;
};
// As read_rows, with `query` giving system and component; checks every checksum.
[[nodiscard]] SetupResult<bool> read_tables(record::TlogReader& reader, const dialect::Dialect& dialect,
                                            const ColumnsQuery& query, Tables& tables, std::uint64_t most_bytes);

[[nodiscard]] Columns columns_of(const dialect::Message& message, const Rows& rows);

}  // namespace mavloom::python
