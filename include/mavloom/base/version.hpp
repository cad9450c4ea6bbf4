// SPDX-License-Identifier: MIT
// The version of this build. Safe from any thread; allocates nothing.
#pragma once

#include <string_view>

namespace mavloom {

// Returns "0.1.0" for a release. Other builds append the commit: "0.1.0+g1a2b3c4d", or "0.1.0+g1a2b3c4d-dirty" with
// local changes. The number is set by project() in CMakeLists.txt.
[[nodiscard]] std::string_view version() noexcept;

}  // namespace mavloom
