// SPDX-License-Identifier: MIT
#include "message/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <type_traits>

#include "mavloom/base/suggest.hpp"
#include "mavloom/message/view.hpp"
#include "mavloom/message/visit.hpp"

namespace mavloom::python {
namespace {

using dialect::Field;

template <class T>
PyObject* number_of(T value) noexcept {
    if constexpr (std::is_floating_point_v<T>) return PyFloat_FromDouble(value);
    else if constexpr (sizeof(T) < sizeof(long)) return PyLong_FromLong(static_cast<long>(value));
    else if constexpr (std::is_signed_v<T>) return PyLong_FromLongLong(value);
    else return PyLong_FromUnsignedLongLong(value);
}

PyObject* text_of(std::string_view text, TextForm form) {
    if (form == TextForm::utf8)
        return PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace");
    text = text.substr(0, text.find('\0'));
    return PyUnicode_DecodeASCII(text.data(), static_cast<Py_ssize_t>(text.size()), "replace");
}

template <class T>
PyObject* list_of(const message::MessageView& view, const Field& field) {
    PyObject* list = PyList_New(field.array_length);
    for (std::size_t i = 0; list != nullptr && i < field.array_length; ++i) {
        PyObject* element = number_of(view.get<T>(field, i));
        if (element == nullptr) Py_CLEAR(list);
        else PyList_SET_ITEM(list, static_cast<Py_ssize_t>(i), element);
    }
    return list;
}

}  // namespace

PyObject* value_of(const dialect::Message& definition, ByteView payload, const Field& field, TextForm form) {
    const message::MessageView view(definition, payload);
    if (field.type == dialect::FieldType::char8) return text_of(view.text(field), form);
    return message::visit_type(field.type, [&](auto tag) -> PyObject* {
        using T = decltype(tag);
        return field.is_array() ? list_of<T>(view, field) : number_of(view.get<T>(field));
    });
}

nb::bytes raw_of(ByteView payload, const Field& field) {
    std::string bytes(field.size(), '\0');
    const std::size_t there = std::min(payload.size(), std::size_t{field.offset} + field.size());
    for (std::size_t at = field.offset; at < there; ++at) bytes[at - field.offset] = static_cast<char>(payload[at]);
    return nb::bytes(bytes.data(), bytes.size());
}

std::vector<std::string_view> field_names(const dialect::Message& definition) {
    std::vector<std::string_view> names;
    for (const auto& field : definition.fields) names.push_back(field.name);
    return names;
}

void set_attribute_error(const dialect::Message& definition, std::string_view name) {
    const auto text = fmt::format("{} has no field or attribute '{}'{}", definition.name, name,
                                  did_you_mean(name, field_names(definition)));
    PyErr_SetString(PyExc_AttributeError, text.c_str());
}

}  // namespace mavloom::python
