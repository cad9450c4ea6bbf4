// SPDX-License-Identifier: MIT
// How a running router is looked at and changed: a Unix stream socket that takes one JSON request a line and answers in JSON lines
// (router_report.hpp), and, where asked, an HTTP address that gives metrics to Prometheus. Both run on a thread of their own and ask the
// router's thread between two of its turns, which copies counters; the text is made here. Whoever stalls or floods there harms himself only.
//
// The socket is RUN/NAME.ctl, mode 0600: /run/mavloom where it can be made, else $XDG_RUNTIME_DIR/mavloom (DESIGN.md section 5).
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/control/served.hpp"
#include "mavloom/endpoint/endpoint.hpp"

namespace mavloom::control {

// RUN/NAME.ctl; makes the folder RUN where it is missing.
[[nodiscard]] SetupResult<std::filesystem::path> control_path(std::string_view name);

struct ControlOptions {
    std::filesystem::path socket;  // empty: none
    std::optional<endpoint::HostPort> metrics;
};

class Control {
public:
    // A socket that is left from a router that is gone is taken over; one that is served is an error. `served` must outlive the object; its
    // turns must go on, or stop for good.
    [[nodiscard]] static SetupResult<std::unique_ptr<Control>> create(Served& served, const ControlOptions& options);
    ~Control();
    Control(const Control&) = delete;
    Control& operator=(const Control&) = delete;

    // The port that was given where port 0 was asked for; 0 without metrics.
    [[nodiscard]] std::uint16_t metrics_port() const noexcept;

private:
    class Impl;
    explicit Control(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

// Sends one request to the router called `name` and gives the lines of its answer without the last. Errors: no such router (`not_found`), no
// answer within `limit`, what the router said.
[[nodiscard]] SetupResult<std::vector<std::string>> ask_router(std::string_view name, std::string_view request,
                                                               std::chrono::milliseconds limit);

}  // namespace mavloom::control
