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

#include "mavloom/net/local_sender.hpp"
#include "mavloom/runtime/endpoint.hpp"

namespace mavloom::runtime {

class Router;

// True for 1 to 64 of A-Z a-z 0-9 _ -.
[[nodiscard]] bool is_router_name(std::string_view name) noexcept;
// RUN/NAME.ctl; makes the folder RUN where it is missing.
[[nodiscard]] SetupResult<std::filesystem::path> control_path(std::string_view name);

// RUN/NAME.in, where the router that writes the ring NAME takes frames from programs of this machine; makes the folder likewise.
[[nodiscard]] SetupResult<std::filesystem::path> inlet_path(std::string_view ring);
// For who sends there, whoever the router belongs to: the first RUN/NAME.in that somebody serves, else why one that is there
// cannot be sent to, else `not_found`; makes nothing.
[[nodiscard]] SetupResult<net::LocalSender> connect_inlet(std::string_view ring);

struct ControlOptions {
    std::filesystem::path socket;  // empty: none
    std::optional<HostPort> metrics;
};

class Control {
public:
    // A socket that is left from a router that is gone is taken over; one that is served is an error. `router` must outlive the object; its
    // turns must go on, or stop for good.
    [[nodiscard]] static SetupResult<std::unique_ptr<Control>> create(Router& router, const ControlOptions& options);
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

}  // namespace mavloom::runtime
