// SPDX-License-Identifier: MIT
// What listen and record share: options that name sources and bound the run, and the receiver made from them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "mavloom/feed/receiver.hpp"

namespace mavloom::app {

// --only and --from.
class Selection {
public:
    std::vector<std::string> only;  // message names or ids, separated by commas
    std::string from;               // SYS or SYS/COMP

    void declare(Arguments command);
    // Resolves the words; an unknown name is an error with the nearest one.
    [[nodiscard]] SetupResult<void> resolve(const dialect::Dialect& dialect);
    [[nodiscard]] bool takes(const wire::FrameView& frame) const noexcept;

private:
    std::vector<MessageId> ids_;  // sorted; empty: all
    std::optional<SystemId> system_;
    std::optional<ComponentId> component_;
};

// Says which ports were given to endpoints that asked for any. Whoever waits for these lines may end the program at once: call it when Signals is there.
void say_ports(const Common& common, const std::vector<link::EndpointInfo>& endpoints);

struct ReceiveOptions {
    std::vector<std::string> sources;
    std::string duration;  // --for
    std::string buffer = "64M";
    std::string count_text;
    std::uint64_t count = 0;  // 0: no bound; set by `open`

    void declare(Arguments command);
    [[nodiscard]] SetupResult<std::unique_ptr<feed::Receiver>> open(const Common& common,
                                                                    const dialect::Dialect& dialect);
    // When --for ends; the end of time without it. Call after `open`, which has checked the words.
    [[nodiscard]] MonoTime end(MonoTime start) const;

private:
    [[nodiscard]] SetupResult<void> parse_count();
};

}  // namespace mavloom::app
