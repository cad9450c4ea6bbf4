// SPDX-License-Identifier: MIT
// Writes a dialect as C++: tables from which a dialect::Dialect is built without reading XML, and a header with a typed
// struct per message and enum. The output depends only on the definitions: the same input gives the same bytes.
#pragma once

#include <filesystem>
#include <string>

#include "mavloom/base/result.hpp"
#include "mavloom/dialect/dialect.hpp"

namespace mavloom::dialectgen {

struct Options {
    std::filesystem::path out;  // headers below include/, tables below tables/
    std::string cpp_namespace;  // "mavloom::msg"
    std::string source;         // the XML's name, for the first line of each file
    bool is_builtin = false;    // defines mavloom::dialect::default_dialect() in place of NAMESPACE::dialect()
};

// Converts the namespace to a folder, "mavloom::msg" to "mavloom/msg".
[[nodiscard]] std::string include_folder(const Options& options);

[[nodiscard]] SetupResult<void> write_tables(const dialect::Dialect& dialect, const Options& options);
[[nodiscard]] SetupResult<void> write_headers(const dialect::Dialect& dialect, const Options& options);

}  // namespace mavloom::dialectgen
