// SPDX-License-Identifier: MIT
// Shortens nanobind's error for arguments of a wrong type or number, which spans lines and shows C++ types:
//   RingReader() takes (name: str, *, lossless: bool = False), not (int)
// nanobind has no hook for it, so the linker sends every call of PyErr_SetString through here (--wrap). Costs nothing
// where no error is raised.
#include <Python.h>

#include <optional>
#include <string>
#include <string_view>

// The names are the linker's.
extern "C" void __real_PyErr_SetString(PyObject* type, const char* text);  // NOLINT
extern "C" void __wrap_PyErr_SetString(PyObject* type, const char* text);  // NOLINT

namespace mavloom::python {
namespace {

constexpr std::string_view wrong = "(): incompatible function arguments. The following argument types are supported:\n";
constexpr std::string_view invoked = "\nInvoked with types: ";

void replace_all(std::string& text, std::string_view from, std::string_view to) {
    for (auto at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

// Removes the first item of a list, and the comma behind it.
std::string_view without_first(std::string_view list) noexcept {
    const auto comma = list.find(", ");
    return comma == list.npos ? std::string_view() : list.substr(comma + 2);
}

// The parameters in a line such as "    1. send(self, message: str) -> int".
std::string_view parameters_in(std::string_view line) noexcept {
    line = line.substr(0, line.rfind(") -> "));
    return line.substr(line.find('(') + 1);
}

// The types of the arguments, as (str, lossless=int).
std::string types_in(std::string_view given) {
    std::string types(given);
    if (const auto keywords = types.find("kwargs = { "); keywords != types.npos) {
        types.resize(types.size() - std::string_view(" }").size());
        replace_all(types, "kwargs = { ", "");
        replace_all(types, ": ", "=");
    }
    replace_all(types, "NoneType", "None");
    return types;
}

std::string shortened(std::string_view name, std::string_view signatures, std::string_view given) {
    const bool is_method = parameters_in(signatures.substr(0, signatures.find('\n'))).starts_with("self");
    if (name == "__init__") name = given.substr(0, given.find(','));
    if (is_method) given = without_first(given);
    std::string text(name), separator = "() takes (";
    for (auto end = signatures.find('\n'); end != signatures.npos; end = signatures.find('\n')) {
        const auto parameters = parameters_in(signatures.substr(0, end));
        text.append(separator).append(is_method ? without_first(parameters) : parameters) += ')';
        separator = " or (";
        signatures.remove_prefix(end + 1);
    }
    text.append(", not (").append(types_in(given)) += ')';
    for (const auto* module : {"mavloom._core.", "typing.", "collections.abc."}) replace_all(text, module, "");
    return text;
}

// Nothing if the text is no such error.
std::optional<std::string> shortened(std::string_view text) {
    const auto begin = text.find(wrong), end = text.rfind(invoked);
    if (begin == text.npos || end == text.npos) return std::nullopt;
    const auto from = begin + wrong.size();
    return shortened(text.substr(0, begin), text.substr(from, end - from), text.substr(end + invoked.size()));
}

}  // namespace
}  // namespace mavloom::python

void __wrap_PyErr_SetString(PyObject* type, const char* text) {
    const auto better = type == PyExc_TypeError ? mavloom::python::shortened(text) : std::nullopt;
    __real_PyErr_SetString(type, better ? better->c_str() : text);
}
