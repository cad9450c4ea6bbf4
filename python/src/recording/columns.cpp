// SPDX-License-Identifier: MIT
#include "recording/columns.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <numeric>
#include <utility>

#include "mavloom/message/visit.hpp"

namespace mavloom::python {
namespace {

bool is_wanted(const record::Record& record, const RowsQuery& query, const dialect::Message& message) {
    const auto& frame = record.frame;
    const auto time_ns = record.time.time_since_epoch().count();
    if (time_ns < query.begin || time_ns >= query.end) return false;
    if (!query.filter.admits(frame)) return false;
    if (!query.instance) return true;
    const auto* field = message::instance_field(message);
    return field != nullptr && message::instance_of(message, *field, frame.payload()) == *query.instance;
}

std::unique_ptr<std::uint8_t[]> room_for(std::size_t bytes) {
    return std::make_unique_for_overwrite<std::uint8_t[]>(bytes);
}

// Copies `count` values of type T, beginning at `offset` of each row, to `to`.
template <class T>
void gather(const Rows& rows, std::size_t offset, std::size_t count, std::uint8_t* to) {
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
}

void gather(const Rows& rows, const Column& column, std::uint8_t* to) {
    message::visit_type(column.type, [&](auto tag) { gather<decltype(tag)>(rows, column.offset, column.count, to); });
}

}  // namespace

static constexpr bool modes_fit(std::span<const message::FlightMode> modes) {
    return std::ranges::all_of(modes, [](const auto& mode) { return mode.name.size() < Rows::mode_bytes; });
}
static_assert(modes_fit(message::px4_flight_modes) && modes_fit(message::plane_flight_modes) &&
              modes_fit(message::copter_flight_modes) && modes_fit(message::rover_flight_modes) &&
              modes_fit(message::sub_flight_modes) && modes_fit(message::tracker_flight_modes) &&
              modes_fit(message::blimp_flight_modes));

void Rows::add(std::int64_t time_ns, const wire::FrameView& frame) {
    if (count_ == blocks_.size() * rows_per_block) blocks_.push_back(room_for(rows_per_block * stride_));
    auto* row = blocks_[count_ / rows_per_block].get() + count_ % rows_per_block * stride_;
    store_le(row + time_offset, time_ns);
    row[system_offset] = frame.system().value;
    row[component_offset] = frame.component().value;
    const auto payload = frame.payload();
    const auto length = std::min(payload.size(), payload_length_);
    // Not memcpy: GCC 12 compiles it to `rep movs` here, which takes five times as long.
    std::copy_n(payload.begin(), length, row + prefix_bytes);
    if (length != payload_length_) std::memset(row + prefix_bytes + length, 0, payload_length_ - length);
    if (has_mode_) {
        const auto mode = message::heartbeat_mode(payload);
        std::fill_n(std::ranges::copy(mode, row + prefix_bytes + payload_length_).out, mode_bytes - mode.size(), 0);
    }
    ++count_;
}

Pages::Pages(std::size_t bytes) : data_(nullptr), bytes_(bytes) {
    void* made = ::mmap(nullptr, std::max<std::size_t>(bytes, 1), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS,
                        -1, 0);
    if (made == MAP_FAILED) throw std::bad_alloc();  // NOLINT(performance-no-int-to-ptr): MAP_FAILED is a cast
    data_ = static_cast<std::uint8_t*>(made);
}

Pages::~Pages() {
    if (data_ != nullptr) ::munmap(data_, std::max<std::size_t>(bytes_, 1));
}

// ---- Table

Table::Table(const dialect::Message& message, std::span<const std::size_t> fields)
    : message_(&message), fields_(fields.begin(), fields.end()), rows_(message) {
    using enum dialect::FieldType;
    columns_.reserve(first_field + fields.size());
    columns_.push_back({i64, Rows::time_offset, 1});
    columns_.push_back({u8, Rows::system_offset, 1});
    columns_.push_back({u8, Rows::component_offset, 1});
    for (const auto place : fields_) {
        const auto field = field_at(message, place);
        columns_.push_back({field.type, Rows::prefix_bytes + field.offset, field.count()});
    }
}

void Table::add(std::int64_t time_ns, const wire::FrameView& frame) {
    if (rows_.count() == rows_per_group) gather_group();
    rows_.add(time_ns, frame);
}

void Table::gather_group() {
    for (auto& column : columns_) {
        Pages group(rows_.count() * column.row_bytes());
        gather(rows_, column, group.data());
        column.groups.push_back(std::move(group));
    }
    gathered_ += rows_.count();
    rows_.clear();
}

Values Table::take(std::size_t column) {
    auto& from = columns_[column];
    auto values = room_for(count() * from.row_bytes());
    auto* to = values.get();
    for (auto& group : std::exchange(from.groups, {})) {
        const Pages pages(std::move(group));
        std::memcpy(to, pages.data(), pages.bytes());
        to += pages.bytes();
    }
    gather(rows_, from, to);
    return values;
}

bool has_column(const dialect::Message& message, std::string_view name) noexcept {
    return message.find(name) != nullptr || (name == mode_column && message::has_mode(message));
}

dialect::Field field_at(const dialect::Message& message, std::size_t place) noexcept {
    if (place < message.fields.size()) return message.fields[place];
    dialect::Field mode;
    mode.name = mode_column;
    mode.type = dialect::FieldType::char8;
    mode.offset = message.wire.max_length;
    mode.array_length = Rows::mode_bytes;
    return mode;
}

std::vector<std::size_t> fields_in(const dialect::Message& message, const FieldNames& names) {
    std::vector<std::size_t> places;
    for (std::size_t place = 0; place < message.fields.size(); ++place)
        if (!names || std::ranges::find(*names, message.fields[place].name) != names->end()) places.push_back(place);
    if (message::has_mode(message) && (!names || std::ranges::find(*names, mode_column) != names->end()))
        places.push_back(message.fields.size());
    return places;
}

// ---- reading

namespace {

// Calls take(record) for each record that next(bytes) returns. Returns true if there may be more.
template <class Next, class Take>
SetupResult<bool> read_records(record::TlogReader& reader, std::uint64_t max_bytes, Next next, Take take) {
    using Stop = record::TlogReader::Stop;
    const auto end = reader.position() + max_bytes;
    while (reader.position() < end) {
        const auto record = next(end - reader.position());
        if (record) {
            take(*record);
            continue;
        }
        if (record.error() == Stop::failed) return tl::unexpected(reader.error());
        if (record.error() == Stop::end && reader.found_no_record()) return tl::unexpected(reader.no_record_error());
        return record.error() != Stop::end;
    }
    return true;
}

}  // namespace

SetupResult<bool> read_rows(record::TlogReader& reader, const RowsQuery& query, Table& table, std::uint64_t max_bytes) {
    const auto& message = table.message();
    return read_records(
        reader, max_bytes, [&](std::uint64_t most) { return reader.next_of(message.id(), most); },
        [&](const record::Record& record) {
            if (is_wanted(record, query, message)) table.add(record.time.time_since_epoch().count(), record.frame);
        });
}

SetupResult<bool> read_tables(record::TlogReader& reader, const dialect::Dialect& dialect, const RowsQuery& query,
                              Tables& tables, std::uint64_t max_bytes) {
    return read_records(
        reader, max_bytes, [&](std::uint64_t most) { return reader.next(most); },
        [&](const record::Record& record) {
            if (record.info == nullptr) return;
            const auto place = static_cast<std::size_t>(record.info - dialect.wire_table().messages().data());
            if (!tables.wanted[place]) return;
            const auto& message = *dialect.find(record.frame.id());
            if (!is_wanted(record, query, message)) return;
            auto& table = tables.tables[place];
            if (!table) table = std::make_unique<Table>(message, fields_in(message, tables.fields));
            table->add(record.time.time_since_epoch().count(), record.frame);
        });
}

}  // namespace mavloom::python
