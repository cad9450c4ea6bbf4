// SPDX-License-Identifier: MIT
// Writes Prometheus' text exposition format, version 0.0.4. Plain values; allocates.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mavloom/link/snapshot.hpp"

namespace mavloom::control {

// Groups samples by metric, because the format requires all samples of one name to follow its TYPE line.
class MetricsText {
public:
    // Adds the sample mavloom_PREFIX_NAME_total.
    void add(std::string_view prefix, const link::NamedCount& count, std::string_view labels);
    void add(std::string_view prefix, std::span<const link::NamedCount> counts, std::string_view labels) {
        for (const auto& count : counts) add(prefix, count, labels);
    }
    // Adds a sample of the gauge mavloom_NAME.
    void add_gauge(std::string_view name, std::string_view help, std::string_view labels, double value);
    [[nodiscard]] std::string text() const;

    // NAME="VALUE", with backslash, quote and newline escaped in the value.
    [[nodiscard]] static std::string label(std::string_view name, std::string_view value);

private:
    // The lines of a metric.
    [[nodiscard]] std::string& family(std::string_view name, std::string_view help, std::string_view type);

    std::vector<std::pair<std::string, std::string>> families_;  // name and lines
};

}  // namespace mavloom::control
