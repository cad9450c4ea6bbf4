// SPDX-License-Identifier: MIT
// The compiled part of mavloom.columns() and mavloom.tables(): numpy arrays that own the memory that C++ filled.
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>

#include <algorithm>
#include <optional>

#include "bindings.hpp"
#include "errors.hpp"
#include "gil.hpp"
#include "mavloom/message/visit.hpp"
#include "message/filter.hpp"
#include "message/message.hpp"
#include "recording/columns.hpp"

namespace mavloom::python {
namespace {

constexpr std::uint64_t bytes_between_signals = 4 << 20;  // some tens of milliseconds, even if all of it is damaged

// One dimension if `count` is 0, else two.
template <class T>
nb::object array_of(Columns::Values values, std::size_t rows, std::size_t count) {
    auto* data = values.get();
    const nb::capsule owner(data, [](void* held) noexcept { delete[] static_cast<std::uint8_t*>(held); });
    values.release();  // NOLINT(bugprone-unused-return-value): the capsule owns it
    if (count == 0) return nb::cast(nb::ndarray<nb::numpy, T>(data, {rows}, owner));
    return nb::cast(nb::ndarray<nb::numpy, T>(data, {rows, count}, owner));
}

// char[N] becomes numpy's fixed-length type S<N>.
nb::object array_of(Columns::Values values, std::size_t rows, const dialect::Field& field) {
    const nb::object array = message::visit_type(
        field.type, [&](auto tag) { return array_of<decltype(tag)>(std::move(values), rows, field.array_length); });
    if (field.type != dialect::FieldType::char8) return array;
    return array.attr("view")(fmt::format("S{}", field.count())).attr("reshape")(-1);
}

const dialect::Message& message_of(const dialect::Dialect& dialect, const std::string& name, bool with_instance) {
    const auto* message = value_or_raise(dialect.message(name));
    if (with_instance && feed::instance_field(*message) == nullptr)
        raise_usage(fmt::format("{} has no field that distinguishes instances", name));
    return *message;
}

record::TlogReader open(const nb::object& path, const dialect::Dialect& dialect) {
    const auto file = nb::cast<nb::bytes>(nb::module_::import_("os").attr("fsencode")(path));
    return value_or_raise(record::TlogReader::open(std::string(file.c_str(), file.size()), dialect.wire_table()));
}

// Calls `read` without the GIL until there is no more. Handles signals between the calls.
template <class Read>
void read_all(Read read) {
    for (bool more = true; more; check_signals()) {
        auto result = [&] {
            const WithoutGil outside;
            return read();
        }();
        more = value_or_raise(std::move(result));
    }
}

// Returns (times, systems, components, {field: values}).
nb::tuple arrays_of(const Definitions& definitions, const dialect::Message& message, const Rows& rows) {
    auto columns = [&] {
        const WithoutGil outside;
        return columns_of(message, rows);
    }();
    nb::dict fields;
    const auto& names = definitions.names(message).fields;
    for (std::size_t i = 0; i < names.size(); ++i)
        fields[names[i]] = array_of(std::move(columns.fields[i]), columns.rows, message.fields[i]);
    return nb::make_tuple(array_of<std::int64_t>(std::move(columns.time_ns), columns.rows, 0),
                          array_of<std::uint8_t>(std::move(columns.system), columns.rows, 0),
                          array_of<std::uint8_t>(std::move(columns.component), columns.rows, 0), fields);
}

nb::tuple read_columns_of(const nb::object& path, const std::string& name, const OptionalInteger& system,
                          const OptionalInteger& component, std::optional<feed::Instance> instance,
                          const nb::object& dialect) {
    const auto definitions = definitions_of(dialect);
    const auto& message = message_of(definitions->dialect(), name, instance.has_value());
    auto reader = open(path, definitions->dialect());
    const ColumnsQuery query{&message, in<std::uint8_t>("system", system), in<std::uint8_t>("component", component),
                             std::move(instance)};
    Rows rows(message);
    read_all([&] { return read_rows(reader, query, rows, bytes_between_signals); });
    return nb::make_tuple(arrays_of(*definitions, message, rows), reader.counters().lost_bytes.value());
}

nb::tuple read_tables_of(const nb::object& path, const nb::object& type, const OptionalInteger& system,
                         const OptionalInteger& component, const nb::object& dialect) {
    const auto definitions = definitions_of(dialect);
    const auto& known = definitions->dialect();
    const auto infos = known.wire_table().messages();
    const auto filter = make_filter(known, type, system, component);
    Tables tables{std::vector<bool>(infos.size()), std::vector<std::unique_ptr<Rows>>(infos.size())};
    for (std::size_t i = 0; i < infos.size(); ++i) {
        const bool named = filter.ids && std::ranges::find(*filter.ids, infos[i].id) != filter.ids->end();
        tables.wanted[i] = !filter.ids || named;
        // A named message gets a table even if it does not occur.
        if (named) tables.rows[i] = std::make_unique<Rows>(*known.find(infos[i].id));
    }
    auto reader = open(path, known);
    read_all([&] {
        return read_tables(reader, known, {nullptr, filter.system, filter.component, {}}, tables, bytes_between_signals);
    });
    nb::dict made;
    for (std::size_t i = 0; i < infos.size(); ++i) {
        if (!tables.rows[i]) continue;
        const auto& message = *known.find(infos[i].id);
        made[definitions->names(message).message] = arrays_of(*definitions, message, *tables.rows[i]);
        tables.rows[i].reset();  // the arrays hold copies
    }
    return nb::make_tuple(made, reader.counters().lost_bytes.value());
}

}  // namespace

void bind_columns(nb::module_& module) {
    module.def(
        "read_columns", &read_columns_of, nb::arg("path"), nb::arg("name"), nb::arg("system").none(),
        nb::arg("component").none(), nb::arg("instance").none(), nb::arg("dialect").none(),
        nb::sig(
            "def read_columns(path: str | os.PathLike[str], name: str, system: int | None, component: int | None, "
            "instance: int | str | None, "
            "dialect: Dialect | None) -> tuple[tuple[typing.Any, typing.Any, typing.Any, dict[str, typing.Any]], int]"),
        "Returns ((times, systems, components, {field: values}), bytes of damage), from which\n"
        "mavloom.columns() makes its result.");
    module.def("read_tables", &read_tables_of, nb::arg("path"), nb::arg("type").none(), nb::arg("system").none(),
               nb::arg("component").none(), nb::arg("dialect").none(),
               nb::sig("def read_tables(path: str | os.PathLike[str], type: MessageTypes | None, system: int | None, "
                       "component: int | None, "
                       "dialect: Dialect | None) -> tuple[dict[str, tuple[typing.Any, typing.Any, typing.Any, "
                       "dict[str, typing.Any]]], int]"),
               "Returns ({message: as in read_columns}, bytes of damage), from which mavloom.tables() makes its\n"
               "result.");
}

}  // namespace mavloom::python
