// SPDX-License-Identifier: MIT
// Which Mavloom this is. Any thread; allocates nothing.
#pragma once

#include <string_view>

namespace mavloom {

// "0.1.0" for a release; between releases and outside a clean checkout the commit follows: "0.1.0+g1a2b3c4d", "0.1.0+g1a2b3c4d-dirty".
// The number stands in CMakeLists.txt, project().
[[nodiscard]] std::string_view version() noexcept;

}  // namespace mavloom
