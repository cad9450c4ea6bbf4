// SPDX-License-Identifier: MIT
// Converts the fields of a payload to Python values. Bytes that the sender cut off read as 0. Call with the GIL held.
#pragma once

#include <nanobind/nanobind.h>

#include <string_view>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/dialect/dialect.hpp"

namespace mavloom::python {

namespace nb = nanobind;

// The form of a char[] field as a str.
enum class TextForm : std::uint8_t {
    utf8,   // without trailing NULs; U+FFFD in place of invalid bytes
    ascii,  // up to the first NUL; U+FFFD in place of each byte above 127, as pymavlink has it
};

// Returns a new reference, or null with an exception set. Numbers become int or float, arrays lists, char[] str.
[[nodiscard]] PyObject* value_of(const dialect::Message& definition, ByteView payload, const dialect::Field& field,
                                 TextForm form = TextForm::utf8);

// The bytes of a field in its full length.
[[nodiscard]] nb::bytes raw_of(ByteView payload, const dialect::Field& field);

[[nodiscard]] std::vector<std::string_view> field_names(const dialect::Message& definition);

// Sets an AttributeError that suggests the nearest field.
void set_attribute_error(const dialect::Message& definition, std::string_view name);

// Raises the pending Python exception if `value` is not valid.
inline void set_item(nb::dict& dict, const nb::object& key, const nb::object& value) {
    if (!value.is_valid() || PyDict_SetItem(dict.ptr(), key.ptr(), value.ptr()) != 0) throw nb::python_error();
}

[[nodiscard]] inline nb::dict copy_of(const nb::dict& dict) {
    auto copy = nb::steal<nb::dict>(PyDict_Copy(dict.ptr()));
    if (!copy.is_valid()) throw nb::python_error();
    return copy;
}

[[nodiscard]] inline nb::bytes bytes_of(ByteView bytes) { return nb::bytes(bytes.data(), bytes.size()); }

}  // namespace mavloom::python
