// SPDX-License-Identifier: MIT
#include "mavloom/base/version.hpp"

// Written by cmake/WriteVersion.cmake at every build. Nothing else includes it, so that a new commit compiles this file only.
#include "mavloom_version_text.hpp"

namespace mavloom {

std::string_view version() noexcept { return MAVLOOM_VERSION_TEXT; }

}  // namespace mavloom
