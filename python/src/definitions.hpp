// SPDX-License-Identifier: MIT
// A dialect as Python sees it: the definitions, and the names of their fields as interned Python strings, so that reading an attribute is a comparison of
// pointers. Immutable after construction, shared by every message that was decoded with it; made and destroyed with the GIL held.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <string>
#include <vector>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::python {

namespace nb = nanobind;

class Definitions {
public:
    // Of one message, in the order of its fields.
    struct Names {
        nb::object message;
        std::vector<nb::object> fields;
        // The same, but null where class Message has an attribute of that name itself, which then stands (`name`, `id`, `seq`, ...).
        std::vector<PyObject*> attributes;
    };

    // `path` is the file that it was read from, empty for the built-in dialect.
    Definitions(dialect::Dialect dialect, std::string path);

    // The built-in definitions, made once.
    [[nodiscard]] static std::shared_ptr<const Definitions> builtin();
    // The built-in ones with those of an XML file added or replaced; raises where the file is wrong.
    [[nodiscard]] static std::shared_ptr<const Definitions> load(const std::string& path);

    [[nodiscard]] const dialect::Dialect& dialect() const noexcept { return dialect_; }
    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    // `message` is one of dialect().messages().
    [[nodiscard]] const Names& names(const dialect::Message& message) const noexcept {
        return names_[static_cast<std::size_t>(&message - dialect_.messages().data())];
    }

private:
    dialect::Dialect dialect_;
    std::string path_;
    std::vector<Names> names_;  // by message
};

void bind_dialect(nb::module_& module);

// What users hold: class Dialect.
struct PyDialect {
    std::shared_ptr<const Definitions> definitions;
};

// The definitions of an argument `dialect`, the built-in ones for None.
[[nodiscard]] std::shared_ptr<const Definitions> definitions_of(const nb::object& dialect);

}  // namespace mavloom::python
