// SPDX-License-Identifier: MIT
// The Python classes LinkStats and SourceStats: the counters of a link.
#pragma once

#include <nanobind/nanobind.h>

#include <string>
#include <vector>

#include "mavloom/feed/hub.hpp"

namespace mavloom::python {

namespace nb = nanobind;

// The counters of the endpoint, and those that the Python objects count themselves.
struct LinkStats : feed::EndpointStats {
    std::uint64_t missed = 0;    // by the link's own reader
    std::uint64_t not_kept = 0;  // messages that `latest` does not keep
    std::uint64_t no_peer = 0;   // messages not sent because there was no peer
    std::vector<std::string> hints{};
};

// Returns advice on what the user should check.
[[nodiscard]] std::vector<std::string> hints_of(const dialect::Dialect& dialect, const LinkStats& stats);

void bind_link_stats(nb::module_& module);

}  // namespace mavloom::python
