// SPDX-License-Identifier: MIT
// Included once by a property test: RapidCheck prints the seed of each run, and this makes it take one from
// MAVLOOM_SEED to repeat a failure.
#pragma once

#include <cstdlib>
#include <string>

namespace mavloom::test {

inline const bool seed_is_set = [] {
    const char* seed = std::getenv("MAVLOOM_SEED");
    if (seed == nullptr) return false;
    const char* others = std::getenv("RC_PARAMS");
    const auto parameters = std::string(others != nullptr ? others : "") + " seed=" + seed;
    ::setenv("RC_PARAMS", parameters.c_str(), 1);  // before main: RapidCheck reads it at its first use
    return true;
}();

}  // namespace mavloom::test
