// SPDX-License-Identifier: MIT
// A sender as people write it.
#pragma once

#include <fmt/format.h>

#include <string>

#include "mavloom/base/ids.hpp"

namespace mavloom {

// "1/190": system and component. Allocates.
[[nodiscard]] inline std::string source_text(Source source) {
    return fmt::format("{}/{}", source.system.value, source.component.value);
}

}  // namespace mavloom
