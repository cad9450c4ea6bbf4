// SPDX-License-Identifier: MIT
// The compiled part of mavloom.columns() and mavloom.tables(): numpy arrays that own the memory that C++ filled.
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "errors.hpp"
#include "gil.hpp"
#include "mavloom/message/visit.hpp"
#include "message/filter.hpp"
#include "message/message.hpp"
#include "recording/columns.hpp"
#include "recording/progress.hpp"
#include "strings.hpp"

namespace mavloom::python {
namespace {

constexpr std::uint64_t bytes_between_signals = 4 << 20;  // some tens of milliseconds, even if all of it is damaged

// One dimension if `count` is 0, else two.
template <class T>
nb::object array_of(Values values, std::size_t rows, std::size_t count) {
    auto* data = values.get();
    const nb::capsule owner(data, [](void* held) noexcept { delete[] static_cast<std::uint8_t*>(held); });
    values.release();  // NOLINT(bugprone-unused-return-value): the capsule owns it
    if (count == 0) return nb::cast(nb::ndarray<nb::numpy, T>(data, {rows}, owner));
    return nb::cast(nb::ndarray<nb::numpy, T>(data, {rows, count}, owner));
}

// char[N] becomes numpy's fixed-length type S<N>.
nb::object array_of(Values values, std::size_t rows, const dialect::Field& field) {
    const nb::object array = message::visit_type(
        field.type, [&](auto tag) { return array_of<decltype(tag)>(std::move(values), rows, field.array_length); });
    if (field.type != dialect::FieldType::char8) return array;
    return array.attr("view")(fmt::format("S{}", field.count())).attr("reshape")(-1);
}

Values take(Table& table, std::size_t column) {
    const WithoutGil outside;
    return table.take(column);
}

// Returns (times, systems, components, {field: values}).
nb::tuple arrays_of(const Definitions& definitions, Table& table) {
    const auto rows = table.count();
    const auto& names = definitions.names(table.message()).fields;
    auto times = array_of<std::int64_t>(take(table, Table::time_column), rows, 0);
    auto systems = array_of<std::uint8_t>(take(table, Table::system_column), rows, 0);
    auto components = array_of<std::uint8_t>(take(table, Table::component_column), rows, 0);
    nb::dict fields;
    std::size_t column = Table::first_field;
    for (const auto place : table.fields()) {
        const nb::object name = place < names.size() ? nb::object(names[place]) : nb::cast(mode_column);
        fields[name] = array_of(take(table, column++), rows, field_at(table.message(), place));
    }
    return nb::make_tuple(times, systems, components, fields);
}

// Like fields_in, but raises for a name that is no field of the message.
std::vector<std::size_t> places_of(const dialect::Dialect& dialect, const dialect::Message& message,
                                   const FieldNames& fields) {
    for (const auto& name : fields.value_or(std::vector<std::string>{}))
        if (!has_column(message, name)) raise(dialect.field(fmt::format("{}.{}", message.name, name)).error());
    return fields_in(message, fields);
}

record::TlogReader open(const nb::handle& path, const dialect::Dialect& dialect) {
    return value_or_raise(record::TlogReader::open(path_of(path), dialect.wire_table()));
}

// Shows how much of a file was read, if the caller wants that. Not of a pipe, which has no size.
void show_progress(Progress& progress, const record::TlogReader& reader) {
    if (!progress.is_due()) return;
    const auto size = reader.is_file() ? reader.size() : 0;
    const auto part = static_cast<double>(reader.position()) / static_cast<double>(std::max<std::uint64_t>(size, 1));
    progress.show({.frames = reader.counters().records.value(),
                   .bytes = reader.position(),
                   .part = size == 0 ? std::nullopt : std::optional(part)});
}

// Calls `read` without the GIL until there is no more. Handles signals between the calls.
template <class Read>
void read_all(const record::TlogReader& reader, bool shows_progress, Read read) {
    auto progress = shows_progress ? Progress::on_stderr() : Progress();
    for (bool more = true; more; check_signals()) {
        show_progress(progress, reader);
        auto result = [&] {
            const WithoutGil outside;
            return read();
        }();
        more = value_or_raise(std::move(result));
    }
}

RowsQuery query_of(dialect::Filter filter, const OptionalInteger& begin, const OptionalInteger& end) {
    RowsQuery query{.filter = std::move(filter)};
    if (begin) query.begin = begin->in<std::int64_t>("start");
    if (end) query.end = end->in<std::int64_t>("end");
    return query;
}

nb::tuple read_columns_of(const nb::list& paths, const std::string& name, const OptionalInteger& system,
                          const OptionalInteger& component, const nb::object& instance, const OptionalInteger& begin,
                          const OptionalInteger& end, const FieldNames& fields, const nb::object& dialect,
                          bool progress) {
    const auto definitions = definitions_of(dialect);
    const auto& message = *value_or_raise(definitions->dialect().message(name));
    auto query = query_of(make_filter(definitions->dialect(), nb::none(), system, component), begin, end);
    query.instance = instance_from(instance);
    if (query.instance) check_instance(message, *query.instance);
    Table table(message, places_of(definitions->dialect(), message, fields));
    std::uint64_t lost_bytes = 0;
    for (const nb::handle path : paths) {
        auto reader = open(path, definitions->dialect());
        read_all(reader, progress, [&] { return read_rows(reader, query, table, bytes_between_signals); });
        lost_bytes += reader.counters().lost_bytes.value();
    }
    return nb::make_tuple(arrays_of(*definitions, table), lost_bytes);
}

// Raises for a field that no wanted message has.
void check_fields(const dialect::Dialect& dialect, const Tables& tables) {
    const auto infos = dialect.wire_table().messages();
    for (const auto& name : tables.fields.value_or(std::vector<std::string>{})) {
        bool found = false;
        for (std::size_t i = 0; i < infos.size() && !found; ++i)
            found = tables.wanted[i] && has_column(*dialect.find(infos[i].id), name);
        if (!found) raise_usage(fmt::format("fields: none of the messages has a field '{}'", name));
    }
}

nb::tuple read_tables_of(const nb::list& paths, const nb::object& type, const OptionalInteger& system,
                         const OptionalInteger& component, const OptionalInteger& begin, const OptionalInteger& end,
                         const FieldNames& fields, const nb::object& dialect, bool progress) {
    const auto definitions = definitions_of(dialect);
    const auto& known = definitions->dialect();
    const auto infos = known.wire_table().messages();
    const auto filter = make_filter(known, type, system, component);
    Tables tables{std::vector<bool>(infos.size()), std::vector<std::unique_ptr<Table>>(infos.size()), fields};
    for (std::size_t i = 0; i < infos.size(); ++i) {
        const bool named = !type.is_none() && filter.admits(infos[i].id);
        const auto& message = *known.find(infos[i].id);
        const auto places = fields_in(message, fields);
        tables.wanted[i] = named || (type.is_none() && !(fields && places.empty()));
        // A named message gets a table even if it does not occur.
        if (named) tables.tables[i] = std::make_unique<Table>(message, places);
    }
    check_fields(known, tables);
    const auto query = query_of(filter, begin, end);
    std::uint64_t lost_bytes = 0;
    for (const nb::handle path : paths) {
        auto reader = open(path, known);
        read_all(reader, progress, [&] { return read_tables(reader, known, query, tables, bytes_between_signals); });
        lost_bytes += reader.counters().lost_bytes.value();
    }
    nb::dict made;
    for (auto& table : tables.tables) {
        if (!table) continue;
        made[definitions->names(table->message()).message] = arrays_of(*definitions, *table);
        table.reset();  // the arrays hold copies
    }
    return nb::make_tuple(made, lost_bytes);
}

}  // namespace

void bind_columns(nb::module_& module) {
    module.def(
        "read_columns", &read_columns_of, nb::arg("paths"), nb::arg("name"), nb::arg("system").none(),
        nb::arg("component").none(), nb::arg("instance").none(), nb::arg("begin").none(), nb::arg("end").none(),
        nb::arg("fields").none(), nb::arg("dialect").none(), nb::arg("progress"),
        nb::sig("def read_columns(paths: list[str | os.PathLike[str]], name: str, system: int | None, component: int | "
                "None, "
                "instance: int | str | None, begin: int | None, end: int | None, fields: list[str] | None, "
                "dialect: Dialect | None, progress: bool) -> tuple[tuple[typing.Any, typing.Any, typing.Any, dict[str, "
                "typing.Any]], int]"),
        "Returns ((times, systems, components, {field: values}), bytes of damage), from which\n"
        "mavloom.columns() makes its result.");
    module.def(
        "read_tables", &read_tables_of, nb::arg("paths"), nb::arg("type").none(), nb::arg("system").none(),
        nb::arg("component").none(), nb::arg("begin").none(), nb::arg("end").none(), nb::arg("fields").none(),
        nb::arg("dialect").none(), nb::arg("progress"),
        nb::sig("def read_tables(paths: list[str | os.PathLike[str]], type: MessageTypes | None, system: int | None, "
                "component: int | None, begin: int | None, end: int | None, fields: list[str] | None, "
                "dialect: Dialect | None, progress: bool) -> tuple[dict[str, tuple[typing.Any, typing.Any, typing.Any, "
                "dict[str, typing.Any]]], int]"),
        "Returns ({message: as in read_columns}, bytes of damage), from which mavloom.tables() makes its\n"
        "result.");
}

}  // namespace mavloom::python
