// SPDX-License-Identifier: MIT
// Names and text for generated C++. Pure functions, except write_file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mavloom/base/result.hpp"

namespace mavloom::dialectgen {

// Returns `text` as a C++ string literal in ASCII, with its quotes.
[[nodiscard]] std::string literal(std::string_view text);
// Converts "ATTITUDE_QUATERNION" to "AttitudeQuaternion". Keeps an underscore between two digits.
[[nodiscard]] std::string pascal_case(std::string_view name);
[[nodiscard]] std::string lower_case(std::string_view name);
// Returns `name`, with a trailing underscore if C++ or a generated struct already uses it. The result never begins with
// a digit.
[[nodiscard]] std::string safe_member(std::string_view name, std::string_view struct_name);
[[nodiscard]] std::string safe_enumerator(std::string_view name);

// Writes the file, unless it already has this content: an unchanged file causes no rebuild.
[[nodiscard]] SetupResult<void> write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace mavloom::dialectgen
