// SPDX-License-Identifier: MIT
#include "recording/columns.hpp"

#include <algorithm>
#include <cstring>

#include "mavloom/message/visit.hpp"

namespace mavloom::python {
namespace {

bool is_wanted(const wire::FrameView& frame, const ColumnsQuery& query, const dialect::Field* instance) {
    if (query.system && frame.system().value != *query.system) return false;
    if (query.component && frame.component().value != *query.component) return false;
    if (instance == nullptr || !query.instance) return true;
    return feed::instance_of(*query.message, *instance, frame) == *query.instance;
}

std::unique_ptr<std::uint8_t[]> room_for(std::size_t bytes) {
    return std::make_unique_for_overwrite<std::uint8_t[]>(bytes);
}

// Copies `count` values of type T, beginning at `offset` of each row.
template <class T>
std::unique_ptr<std::uint8_t[]> gather(const Rows& rows, std::size_t offset, std::size_t count) {
    auto values = room_for(rows.count() * count * sizeof(T));
    auto* to = values.get();
    rows.each_run([&](const std::uint8_t* from, std::size_t many, std::size_t stride) {
        from += offset;
        const auto copy = [&](std::size_t each) {
            for (std::size_t i = 0; i < many; ++i, from += stride) {
                for (std::size_t k = 0; k < each; ++k, to += sizeof(T)) {
                    const T value = load_le<T>(from + k * sizeof(T));
                    std::memcpy(to, &value, sizeof value);
                }
            }
        };
        if (count == 1) copy(1);  // the case of nearly all fields
        else copy(count);
    });
    return values;
}

}  // namespace

void Rows::add(std::int64_t time_ns, const wire::FrameView& frame) {
    if (count_ == blocks_.size() * rows_per_block) blocks_.push_back(room_for(rows_per_block * stride_));
    auto* row = blocks_.back().get() + count_ % rows_per_block * stride_;
    store_le(row + time_offset, time_ns);
    row[system_offset] = frame.system().value;
    row[component_offset] = frame.component().value;
    const auto payload = frame.payload();
    const auto length = std::min(payload.size(), payload_length_);
    // Not memcpy: GCC 12 compiles it to `rep movs` here, which takes five times as long.
    std::copy_n(payload.begin(), length, row + prefix_bytes);
    if (length != payload_length_) std::memset(row + prefix_bytes + length, 0, payload_length_ - length);
    ++count_;
}

namespace {

// Calls take(record) for each record that next(bytes) returns. Returns true if there may be more.
template <class Next, class Take>
SetupResult<bool> read_records(record::TlogReader& reader, std::uint64_t most_bytes, Next next, Take take) {
    using Stop = record::TlogReader::Stop;
    const auto end = reader.position() + most_bytes;
    while (reader.position() < end) {
        const auto record = next(end - reader.position());
        if (record) {
            take(*record);
            continue;
        }
        if (record.error() == Stop::failed) return tl::unexpected(reader.error());
        return record.error() != Stop::end;
    }
    return true;
}

}  // namespace

SetupResult<bool> read_rows(record::TlogReader& reader, const ColumnsQuery& query, Rows& rows, std::uint64_t most_bytes) {
    const auto* instance = feed::instance_field(*query.message);
    return read_records(
        reader, most_bytes, [&](std::uint64_t most) { return reader.next_of(query.message->id(), most); },
        [&](const record::Record& record) {
            if (is_wanted(record.frame, query, instance))
                rows.add(record.time.time_since_epoch().count(), record.frame);
        });
}

SetupResult<bool> read_tables(record::TlogReader& reader, const dialect::Dialect& dialect, const ColumnsQuery& query,
                              Tables& tables, std::uint64_t most_bytes) {
    return read_records(
        reader, most_bytes, [&](std::uint64_t most) { return reader.next(most); },
        [&](const record::Record& record) {
            if (record.info == nullptr || !is_wanted(record.frame, query, nullptr)) return;
            const auto place = static_cast<std::size_t>(record.info - dialect.wire_table().messages().data());
            if (!tables.wanted[place]) return;
            auto& rows = tables.rows[place];
            if (!rows) rows = std::make_unique<Rows>(*dialect.find(record.frame.id()));
            rows->add(record.time.time_since_epoch().count(), record.frame);
        });
}

Columns columns_of(const dialect::Message& message, const Rows& rows) {
    Columns columns;
    columns.rows = rows.count();
    columns.time_ns = gather<std::int64_t>(rows, Rows::time_offset, 1);
    columns.system = gather<std::uint8_t>(rows, Rows::system_offset, 1);
    columns.component = gather<std::uint8_t>(rows, Rows::component_offset, 1);
    for (const auto& field : message.fields) {
        const auto offset = Rows::prefix_bytes + field.offset;
        columns.fields.push_back(message::visit_type(
            field.type, [&](auto tag) { return gather<decltype(tag)>(rows, offset, field.count()); }));
    }
    return columns;
}

}  // namespace mavloom::python
