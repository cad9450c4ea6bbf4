// SPDX-License-Identifier: MIT
// Names and text for generated C++. Pure functions, except write_file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mavloom/base/result.hpp"

namespace mavloom::dialectgen {

// A C++ string literal, quotes included, in ASCII.
[[nodiscard]] std::string literal(std::string_view text);
// "ATTITUDE_QUATERNION" to "AttitudeQuaternion"; an underscore stays between two digits.
[[nodiscard]] std::string pascal_case(std::string_view name);
[[nodiscard]] std::string lower_case(std::string_view name);
// `name`, with a trailing underscore where C++ or a generated struct has another use for it, never beginning with a
// digit.
[[nodiscard]] std::string safe_member(std::string_view name, std::string_view struct_name);
[[nodiscard]] std::string safe_enumerator(std::string_view name);

// Leaves a file that has this content already untouched, so that nothing is rebuilt for it.
[[nodiscard]] SetupResult<void> write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace mavloom::dialectgen
