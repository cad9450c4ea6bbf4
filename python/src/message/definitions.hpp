// SPDX-License-Identifier: MIT
// Definitions: a dialect together with its field names as interned Python strings. With interned names, reading an
// attribute only compares pointers. Immutable after construction, and shared by every message that was decoded with it.
// Created and destroyed with the GIL held.
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
    // The names of one message and of its fields, in the order of the definition.
    struct Names {
        nb::object message;
        std::vector<nb::object> fields;
        // The same, but null if an attribute of class Message takes precedence, such as `name`.
        std::vector<PyObject*> attributes;
        // The dict that to_dict() copies and then fills: {"mavpackettype": name, field: None, ...}.
        nb::dict unfilled;
        // Whether the attribute could mean the field as well as the frame's header: `frame`, `id`, `seq`, `version`.
        std::vector<bool> ambiguous;
        // The sender's clock: the field `time_boot_ms`, else `usec`. Null if there is none.
        const dialect::Field* clock = nullptr;
    };

    // `path` is the file that the dialect was read from, `key` is unique for each state of it; both are empty for the
    // built-in dialect.
    Definitions(dialect::Dialect dialect, std::string path, std::string key);

    // Returns the built-in definitions, which are created once.
    [[nodiscard]] static std::shared_ptr<const Definitions> builtin();
    // Returns the built-in definitions with those of an XML file, which are added or replace built-in ones. Raises if
    // the file is wrong.
    [[nodiscard]] static std::shared_ptr<const Definitions> load(const std::string& path);

    [[nodiscard]] const dialect::Dialect& dialect() const noexcept { return dialect_; }
    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    // The absolute path of the file, its size and its time of change when it was read.
    [[nodiscard]] const std::string& key() const noexcept { return key_; }
    // `message` is one of dialect().messages().
    [[nodiscard]] const Names& names(const dialect::Message& message) const noexcept {
        return names_[static_cast<std::size_t>(&message - dialect_.messages().data())];
    }

    // The key "mavpackettype" of Message.to_dict().
    [[nodiscard]] const nb::object& type_key() const noexcept { return type_key_; }

private:
    dialect::Dialect dialect_;
    std::string path_;
    std::string key_;
    nb::object type_key_;
    std::vector<Names> names_;  // by message
};

void bind_dialect(nb::module_& module);

class MavutilStyle;

// The Python class Dialect.
struct PyDialect {
    std::shared_ptr<const Definitions> definitions;
    // Not null for the dialect of a connection of mavloom.mavutil: it creates messages of that module.
    std::shared_ptr<MavutilStyle> style;
};

// Both convert an argument `dialect`. None means the built-in dialect, without a style.
[[nodiscard]] std::shared_ptr<const Definitions> definitions_of(const nb::object& dialect);
[[nodiscard]] std::shared_ptr<MavutilStyle> style_of(const nb::object& dialect);

}  // namespace mavloom::python
