// SPDX-License-Identifier: MIT
// Lets other programs query and change a running router or simulator, over a Unix socket and optionally over HTTP.
//
// The Unix stream socket takes one JSON request per line and answers with JSON lines (docs/guide/route.md). The HTTP
// address, if there is one, serves metrics to Prometheus.
//
// The control thread posts each request to the program's thread. That thread copies its counters in pieces, one piece
// between two turns of its loop. The control thread then formats the answer in pieces, at a low priority. It sends each
// piece after the client has taken the previous one. HTTP clients have a thread of their own (module http), which asks
// the control thread. Up to 64 clients of each kind can be connected. A further client replaces the one that has been
// idle longest.
//
// The socket is RUN/NAME.ctl, mode 0600. `net::run_path` chooses the folder RUN: $MAVLOOM_RUN if set, else
// /run/mavloom, else $XDG_RUNTIME_DIR/mavloom.
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

// Returns RUN/NAME.ctl and creates the folder RUN if it is missing.
[[nodiscard]] SetupResult<std::filesystem::path> control_path(std::string_view name);

struct ControlOptions {
    std::filesystem::path socket;  // empty: no control socket
    std::optional<endpoint::HostPort> metrics;
    // Reports that another program removed the socket, and whether it could be created again. Called on the thread of
    // `served`.
    std::function<void(std::string_view)> on_notice;
};

class Control {
public:
    // Replaces a socket that a dead program left behind. A socket that another program serves is an error (`in_use`).
    // `served` must outlive the object. A request is answered only while the loop of `served` runs turns.
    [[nodiscard]] static SetupResult<std::unique_ptr<Control>> create(Served& served, const ControlOptions& options);
    ~Control();
    Control(const Control&) = delete;
    Control& operator=(const Control&) = delete;

    // The bound port, even if port 0 was requested. Returns 0 if there are no metrics.
    [[nodiscard]] std::uint16_t metrics_port() const noexcept;

private:
    class Impl;
    explicit Control(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

// Sends one request to the program `name` and returns the lines of its answer, without the final status line. Errors:
// `not_found` if no such program runs; `unreachable` if it does not answer within `limit` or reports an error.
[[nodiscard]] SetupResult<std::vector<std::string>> send_request(std::string_view name, std::string_view request,
                                                                 std::chrono::milliseconds limit);

// Returns the routers and simulators whose control sockets are in the folder RUN, for people: "bird (simulator)". Waits
// up to 0.3 s for each that is busy.
[[nodiscard]] std::vector<std::string> running_programs();

}  // namespace mavloom::control
