// SPDX-License-Identifier: MIT
// What mavloom.columns() is made of: numpy arrays that own what C++ filled.
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <optional>

#include "bindings.hpp"
#include "columns.hpp"
#include "errors.hpp"
#include "filter.hpp"
#include "gil.hpp"
#include "mavloom/message/visit.hpp"
#include "message.hpp"

namespace mavloom::python {
namespace {

constexpr std::size_t records_between_signals = 1 << 16;

// `count` 0: one dimension, else two.
template <class T>
nb::object array_of(Columns::Values values, std::size_t rows, std::size_t count) {
    auto* data = values.get();
    const nb::capsule owner(data, [](void* held) noexcept { delete[] static_cast<std::uint8_t*>(held); });
    values.release();  // NOLINT(bugprone-unused-return-value): the capsule has it
    if (count == 0) return nb::cast(nb::ndarray<nb::numpy, T>(data, {rows}, owner));
    return nb::cast(nb::ndarray<nb::numpy, T>(data, {rows, count}, owner));
}

// char[] as bytes: the package makes fixed-length strings of them.
nb::object array_of(Columns::Values values, std::size_t rows, const dialect::Field& field) {
    return message::visit_type(
        field.type, [&](auto tag) { return array_of<decltype(tag)>(std::move(values), rows, field.array_length); });
}

const dialect::Message& message_of(const dialect::Dialect& dialect, const std::string& name, bool with_instance) {
    const auto* message = value_or_raise(dialect.message(name));
    const bool has_instance = std::ranges::any_of(message->fields, [](const auto& field) { return field.instance; });
    if (with_instance && !has_instance) raise_usage(fmt::format("{} has no field that tells instances apart", name));
    return *message;
}

nb::tuple read(const nb::object& path, const std::string& name, std::optional<std::uint8_t> system,
               std::optional<std::uint8_t> component, std::optional<std::int64_t> instance, const nb::object& dialect) {
    const auto definitions = definitions_of(dialect);
    const auto& message = message_of(definitions->dialect(), name, instance.has_value());
    const auto file = nb::cast<nb::bytes>(nb::module_::import_("os").attr("fsencode")(path));
    auto reader = value_or_raise(
        record::TlogReader::open(std::string(file.c_str(), file.size()), definitions->dialect().wire_table()));
    const ColumnsQuery query{&message, system, component, instance};
    Rows rows(message);
    for (bool more = true; more; check_signals()) {
        auto read = [&] {
            const WithoutGil outside;
            return read_rows(reader, query, rows, records_between_signals);
        }();
        more = value_or_raise(std::move(read));
    }
    auto columns = [&] {
        const WithoutGil outside;
        return columns_of(message, rows);
    }();

    nb::dict arrays;
    const auto& names = definitions->names(message).fields;
    for (std::size_t i = 0; i < names.size(); ++i)
        arrays[names[i]] = array_of(std::move(columns.fields[i]), columns.rows, message.fields[i]);
    return nb::make_tuple(array_of<std::int64_t>(std::move(columns.time_ns), columns.rows, 0),
                          array_of<std::uint8_t>(std::move(columns.system), columns.rows, 0),
                          array_of<std::uint8_t>(std::move(columns.component), columns.rows, 0), arrays,
                          reader.counters().lost_bytes.value());
}

}  // namespace

void bind_columns(nb::module_& module) {
    module.def(
        "read_columns", &read, nb::arg("path"), nb::arg("name"), nb::arg("system").none(), nb::arg("component").none(),
        nb::arg("instance").none(), nb::arg("dialect").none(),
        nb::sig("def read_columns(path: str | os.PathLike[str], name: str, system: int | None, component: int | None, "
                "instance: int | None, "
                "dialect: Dialect | None) -> tuple[typing.Any, typing.Any, typing.Any, dict[str, typing.Any], int]"),
        "Times, systems, components, {field: values}, bytes of damage: what mavloom.columns() is made of.");
}

}  // namespace mavloom::python
