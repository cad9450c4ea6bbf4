// SPDX-License-Identifier: MIT
// Prints what `mavloom doctor` found, as text and as JSON.
#pragma once

#include <span>
#include <string>

#include "mavloom/observe/diagnosis.hpp"

namespace mavloom::app {

struct TextStyle {
    int width = 80;  // columns
    bool has_color = false;
};

[[nodiscard]] std::string doctor_text(const observe::Evidence& evidence, std::span<const observe::Finding> findings,
                                      TextStyle style);
// One JSON object and a newline. docs/guide/doctor.md lists the keys.
[[nodiscard]] std::string doctor_json(const observe::Evidence& evidence, std::span<const observe::Finding> findings);

}  // namespace mavloom::app
