// SPDX-License-Identifier: MIT
// Included once by a property test: RapidCheck prints the seed of each run, and this makes it take one from
// MAVLOOM_SEED to repeat a failure.
#pragma once

#include <cstdlib>
#include <string>

namespace mavloom::test {

inline const bool seed_is_set = [] {
    const char* seed = std::getenv("MAVLOOM_SEED");
    if (seed != nullptr && std::getenv("RC_PARAMS") == nullptr)
        ::setenv("RC_PARAMS", ("seed=" + std::string(seed)).c_str(),
                 1);  // before main: RapidCheck reads it at its first use
    return seed != nullptr;
}();

}  // namespace mavloom::test
