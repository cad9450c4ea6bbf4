// SPDX-License-Identifier: MIT
// Reads messages of tlogs into columns: one contiguous array for each field, and no object for each message.
// Does not depend on Python. Not synchronized.
//
// Memory: rows are gathered into columns in groups, and a group's rows are used again. At its peak, a table takes what
// its arrays take, and once more its largest column.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/dialect/filter.hpp"
#include "mavloom/message/instance.hpp"
#include "mavloom/message/modes.hpp"
#include "mavloom/record/tlog_reader.hpp"

namespace mavloom::python {

// Which messages become rows.
struct RowsQuery {
    dialect::Filter filter{};
    std::optional<message::Instance> instance{};  // value of the field that is marked as the instance
    // Recorded times in ns: from `begin` on, and before `end`.
    std::int64_t begin = std::numeric_limits<std::int64_t>::min(), end = std::numeric_limits<std::int64_t>::max();
};

// Rows in blocks. Each row holds receive time, source, the payload in its full length and, of a HEARTBEAT, the name of
// the sender's mode. Adding a row never moves the others.
class Rows {
public:
    explicit Rows(const dialect::Message& message) noexcept
        : payload_length_(message.wire.max_length),
          has_mode_(message::has_mode(message)),
          stride_((prefix_bytes + payload_length_ + (has_mode_ ? mode_bytes : 0) + 7) / 8 * 8) {}

    void add(std::int64_t time_ns, const wire::FrameView& frame);
    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    // Forgets the rows and keeps their memory.
    void clear() noexcept { count_ = 0; }
    // Calls take(first, rows, stride) for each run of rows that lie `stride` bytes apart. A row is eight bytes of time,
    // then system, component, payload and mode.
    template <class Take>
    void each_run(Take take) const {
        for (std::size_t done = 0; done < count_; done += rows_per_block)
            take(blocks_[done / rows_per_block].get(), std::min(rows_per_block, count_ - done), stride_);
    }
    static constexpr std::size_t time_offset = 0, system_offset = 8, component_offset = 9, prefix_bytes = 10;
    static constexpr std::size_t mode_bytes = 24;  // the longest name, and the zeros that follow it

private:
    static constexpr std::size_t rows_per_block = 1024;

    std::size_t payload_length_;
    bool has_mode_;
    std::size_t stride_;
    std::size_t count_ = 0;
    std::vector<std::unique_ptr<std::uint8_t[]>> blocks_;
};

// Memory that returns to the system when it is freed, unlike that of small heap blocks.
class Pages {
public:
    explicit Pages(std::size_t bytes);
    Pages(Pages&& other) noexcept : data_(std::exchange(other.data_, nullptr)), bytes_(other.bytes_) {}
    Pages& operator=(Pages&&) = delete;
    ~Pages();

    [[nodiscard]] std::uint8_t* data() const noexcept { return data_; }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }

private:
    std::uint8_t* data_;
    std::size_t bytes_;
};

// One column of a message: where it is in a row, and its values so far.
struct Column {
    dialect::FieldType type;
    std::size_t offset;  // in a row
    std::size_t count;   // of values in a row
    std::vector<Pages> groups{};

    [[nodiscard]] std::size_t row_bytes() const noexcept { return count * dialect::size_of(type); }
};

// Values in native byte order, row by row.
using Values = std::unique_ptr<std::uint8_t[]>;

// The last column of HEARTBEAT. It is no field: its position is that after the last field.
inline constexpr std::string_view mode_column = "mode";
// Whether the message has a field of this name, or the column `mode`.
[[nodiscard]] bool has_column(const dialect::Message& message, std::string_view name) noexcept;
// The field at a position, or what the column `mode` would be as a field.
[[nodiscard]] dialect::Field field_at(const dialect::Message& message, std::size_t place) noexcept;

// The fields that become columns, by name; all if it is empty.
using FieldNames = std::optional<std::vector<std::string>>;
// The positions of the fields of a message that `names` selects.
[[nodiscard]] std::vector<std::size_t> fields_in(const dialect::Message& message, const FieldNames& names);

// The rows of one message, as they are read.
class Table {
public:
    // `fields` are the positions of the fields that become columns.
    Table(const dialect::Message& message, std::span<const std::size_t> fields);

    void add(std::int64_t time_ns, const wire::FrameView& frame);
    [[nodiscard]] std::size_t count() const noexcept { return gathered_ + rows_.count(); }
    [[nodiscard]] const dialect::Message& message() const noexcept { return *message_; }
    [[nodiscard]] std::span<const std::size_t> fields() const noexcept { return fields_; }

    // The columns: receive time (int64), system and component (uint8), then the fields. Taking a column frees its
    // memory in the table.
    static constexpr std::size_t time_column = 0, system_column = 1, component_column = 2, first_field = 3;
    [[nodiscard]] Values take(std::size_t column);

private:
    static constexpr std::size_t rows_per_group = 65'536;

    void gather_group();

    const dialect::Message* message_;
    std::vector<std::size_t> fields_;
    std::vector<Column> columns_;
    Rows rows_;
    std::size_t gathered_ = 0;  // rows that are in the groups of the columns
};

// Reads the next `max_bytes` bytes of the file, whatever they hold, or up to its end. Returns true if there may be
// more. Errors are those of TlogReader.
[[nodiscard]] SetupResult<bool> read_rows(record::TlogReader& reader, const RowsQuery& query, Table& table,
                                          std::uint64_t max_bytes);

// The tables of many messages, by the position of the message in the dialect's wire table. Null: not wanted, or did not
// occur yet.
struct Tables {
    std::vector<bool> wanted;
    std::vector<std::unique_ptr<Table>> tables;
    FieldNames fields{};
};
// Like read_rows, but checks every checksum.
[[nodiscard]] SetupResult<bool> read_tables(record::TlogReader& reader, const dialect::Dialect& dialect,
                                            const RowsQuery& query, Tables& tables, std::uint64_t max_bytes);

}  // namespace mavloom::python
