// SPDX-License-Identifier: MIT
// Reads a message of a tlog into columns: one contiguous array for each field, and no object for each message.
// Does not depend on Python. Not synchronized.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/feed/filter.hpp"
#include "mavloom/feed/instance.hpp"
#include "mavloom/record/tlog_reader.hpp"

namespace mavloom::python {

struct ColumnsQuery {
    const dialect::Message* message = nullptr;
    std::optional<std::uint8_t> system, component;
    std::optional<feed::Instance> instance;  // value of the field that is marked as the instance
};

// The rows of a query, stored in blocks. Each row holds receive time, source and the payload in its full length. Adding
// a row never moves the others.
class Rows {
public:
    explicit Rows(const dialect::Message& message) noexcept
        : payload_length_(message.wire.max_length), stride_((prefix_bytes + payload_length_ + 7) / 8 * 8) {}

    void add(std::int64_t time_ns, const wire::FrameView& frame);
    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    // Calls take(first, rows, stride) for each run of rows that lie `stride` bytes apart. A row is eight bytes of time,
    // then system, component and payload.
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

// Values in native byte order, row by row. Type and number of values in a row are those of the field.
struct Columns {
    using Values = std::unique_ptr<std::uint8_t[]>;
    std::size_t rows = 0;
    Values time_ns, system, component;  // int64, uint8, uint8
    std::vector<Values> fields;         // in the order of the definition
};

// Reads the next `most_bytes` bytes of the file, whatever they hold, or up to its end. Returns true if there may be
// more. Errors are those of TlogReader.
[[nodiscard]] SetupResult<bool> read_rows(record::TlogReader& reader, const ColumnsQuery& query, Rows& rows,
                                          std::uint64_t most_bytes);

// The rows of many messages, by the position of the message in the dialect's wire table. A null entry means that the
// message is not wanted or did not occur.
struct Tables {
    std::vector<bool> wanted;
    std::vector<std::unique_ptr<Rows>> rows;
};
// Like read_rows, but `query` only selects system and component, and every checksum is checked.
[[nodiscard]] SetupResult<bool> read_tables(record::TlogReader& reader, const dialect::Dialect& dialect,
                                            const ColumnsQuery& query, Tables& tables, std::uint64_t most_bytes);

[[nodiscard]] Columns columns_of(const dialect::Message& message, const Rows& rows);

}  // namespace mavloom::python
