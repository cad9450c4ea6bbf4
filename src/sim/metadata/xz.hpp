// SPDX-License-Identifier: MIT
// Compression by xz, for metadata files. Private to module sim; a pure function.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace mavloom::sim {

// Empty if there is not enough memory.
[[nodiscard]] std::vector<std::uint8_t> compress_xz(std::string_view text);

}  // namespace mavloom::sim
