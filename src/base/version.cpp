// SPDX-License-Identifier: MIT
#include "mavloom/base/version.hpp"

// cmake/WriteVersion.cmake writes this header at every build. Only this file includes it, so a new commit recompiles
// nothing else.
#include "mavloom_version_text.hpp"

namespace mavloom {

std::string_view version() noexcept { return MAVLOOM_VERSION_TEXT; }

}  // namespace mavloom
