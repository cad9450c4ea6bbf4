// SPDX-License-Identifier: MIT
// Writes Prometheus' text exposition format, version 0.0.4. Plain values; allocates.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mavloom::control {

// Groups samples by metric, because the format requires all samples of one name to follow its TYPE line.
class MetricsText {
public:
    // Adds the sample mavloom_PREFIX_NAME_total for each element of `counts`, which must have `name` and `value`.
    void add(std::string_view prefix, const auto& counts, std::string_view labels) {
        for (const auto& count : counts) add_total(prefix, count.name, labels, count.value);
    }
    void add_total(std::string_view prefix, std::string_view name, std::string_view labels, std::uint64_t value);
    [[nodiscard]] std::string text() const;

    // NAME="VALUE", with backslash, quote and newline escaped in the value.
    [[nodiscard]] static std::string label(std::string_view name, std::string_view value);

private:
    std::vector<std::pair<std::string, std::string>> families_;  // name and lines
};

}  // namespace mavloom::control
