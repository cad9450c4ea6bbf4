// SPDX-License-Identifier: MIT
#include "message/filter.hpp"

#include <fmt/format.h>

#include <string>
#include <variant>

#include "errors.hpp"
#include "strings.hpp"

namespace mavloom::python {
namespace {

[[noreturn]] void raise_no_type(const nb::handle& type) {
    PyErr_Format(PyExc_TypeError, "type= takes names of messages, not %R", type.ptr());
    throw nb::python_error();
}

std::string wanted_name(const nb::handle& type) {
    const nb::object name = PyType_Check(type.ptr()) ? nb::object(type.attr("__name__")) : nb::borrow(type);
    if (!PyUnicode_Check(name.ptr())) raise_no_type(type);
    return nb::cast<std::string>(name);
}

std::vector<std::string> wanted_names(const nb::object& type) {
    if (type.is_none()) return {};
    if (PyUnicode_Check(type.ptr()) || PyType_Check(type.ptr())) return {wanted_name(type)};
    if (PyObject_HasAttrString(type.ptr(), "__iter__") == 0) raise_no_type(type);
    std::vector<std::string> names;
    for (const nb::handle one : nb::iter(type)) names.push_back(wanted_name(one));
    return names;
}

}  // namespace

dialect::Filter make_filter(const dialect::Dialect& dialect, const nb::object& type, const OptionalInteger& system,
                            const OptionalInteger& component) {
    dialect::FilterTerms terms{.messages = wanted_names(type)};
    if (system) terms.systems.push_back(system->in<std::uint8_t>("system"));
    if (component) terms.components.push_back(component->in<std::uint8_t>("component"));
    if (terms.messages.empty() && !type.is_none()) return dialect::Filter::none();
    dialect::Filter filter;
    value_or_raise(filter.allow(dialect, terms));
    return filter;
}

std::optional<message::Instance> instance_from(const nb::object& given) {
    if (given.is_none()) return std::nullopt;
    if (PyUnicode_Check(given.ptr())) return nb::cast<std::string>(given);
    Integer number;
    number.take(given);
    return number.in<std::int64_t>("instance");
}

void check_instance(const dialect::Message& message, const message::Instance& instance) {
    const auto* field = message::instance_field(message);
    if (field == nullptr) raise_usage(fmt::format("{} has no field that distinguishes instances", message.name));
    const bool has_text = field->type == dialect::FieldType::char8;
    if (has_text != std::holds_alternative<std::string>(instance))
        raise_usage(fmt::format("instance: {}.{} is {}", message.name, field->name,
                                has_text ? "text, not a number" : "a number, not text"));
}

void check_condition(const nb::object& condition) {
    if (condition.is_none() || PyCallable_Check(condition.ptr()) != 0) return;
    PyErr_Format(PyExc_TypeError,
                 "condition= takes a callable that is given the message, not %R (text is never evaluated); type= takes "
                 "the names of messages",
                 condition.ptr());
    throw nb::python_error();
}

}  // namespace mavloom::python
