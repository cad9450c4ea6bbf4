// SPDX-License-Identifier: MIT
// The input side of listen and record: their common options, and the receiver made from them.
// The options name the sources, select messages and limit the run.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "mavloom/dialect/filter.hpp"
#include "mavloom/feed/receiver.hpp"
#include "mavloom/feed/sources.hpp"

namespace mavloom::app {

// The options --only and --from.
struct Selection {
    std::vector<std::string> only;  // message names or ids, separated by commas
    std::string from;               // SYS or SYS/COMP
    dialect::Filter filter;         // made by `compile`

    void declare(Arguments command);
    // An unknown name is an error that suggests the nearest one.
    [[nodiscard]] SetupResult<void> compile(const dialect::Dialect& dialect);
};

// Logs the ports of endpoints that were opened with port 0. Call it after Signals is constructed: a program that waits
// for these lines may send a signal at once.
void log_ports(const Common& common, const std::vector<link::EndpointInfo>& endpoints);

// The bytes of a recording. 0: it is a link, a ring or a pipe.
[[nodiscard]] std::uint64_t recorded_bytes(const endpoint::Endpoint& endpoint);
// The bytes that were read of the recordings, and received from the links.
[[nodiscard]] std::uint64_t bytes_read(feed::Receiver& receiver);
// How much was read of the recordings, 0 to 1. Empty if there is no recording, or only pipes.
[[nodiscard]] std::optional<double> part_read(const feed::Sources& sources);

struct ReceiveOptions {
    std::vector<std::string> sources;
    std::string duration;  // --for
    std::string buffer = "64M";
    std::string count_text;
    std::uint64_t count = 0;  // 0: no limit; `open` sets it from count_text

    enum class Source : std::uint8_t { required, optional };
    void declare(Arguments command, Source source = Source::required);
    // Events are logged, or passed to `notice`.
    [[nodiscard]] SetupResult<std::unique_ptr<feed::Receiver>> open(const Common& common,
                                                                    const dialect::Dialect& dialect,
                                                                    feed::Receiver::Notice notice = {});
    // Returns the time at which --for ends, or MonoTime::max() without it. Call after `open`, which validates the
    // duration.
    [[nodiscard]] MonoTime end(MonoTime start) const;

private:
    [[nodiscard]] SetupResult<void> parse_count();
};

}  // namespace mavloom::app
