// SPDX-License-Identifier: MIT
// Reads and checks the configuration file: TOML with [router], [[endpoint]], [ring], [record], [web] and [log].
//
// A value in the file overrides the default, an environment variable overrides both, and an option of the command line
// overrides all. Each value records where it came from. An unknown section, key or value is an error with file, line
// and the nearest known spelling. The results are plain values; loading allocates. Format: docs/guide/configuration.md.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/shm/record.hpp"

namespace mavloom::config {

using route::UnknownComponent;
using route::UnknownTarget;
using shm::WhenFull;
enum class LogLevel : std::uint8_t { debug, info, warning, error };

struct RouterConfig {
    std::uint32_t dedup_ms = 0;  // 0: off
    UnknownComponent unknown_component = UnknownComponent::system;
    UnknownTarget unknown_target = UnknownTarget::drop;
    std::chrono::nanoseconds route_timeout{};
    std::optional<std::pair<std::uint8_t, std::uint8_t>> heartbeat{};  // own system and component id; empty: off
    // The rate that the router requests for ArduPilot's telemetry streams. It sends the requests under the id in
    // `heartbeat`. 0: off.
    std::uint16_t request_streams_hz = 0;
    friend bool operator==(const RouterConfig&, const RouterConfig&) = default;
};

// Error text for an endpoint with heartbeat=true, if the router has no id of its own to send heartbeats with.
inline constexpr std::string_view heartbeat_needs_id =
    "heartbeat=true needs the id that the router sends it with: --heartbeat SYS/COMP, as in 255/191, or the same as "
    "heartbeat in [router]";

// Under which name and port a running router can be asked: keys of [router] that a reload does not change.
struct ServiceConfig {
    std::string name;                             // empty: the ring's name, or "router" without a ring
    std::optional<endpoint::HostPort> metrics{};  // empty: no metrics
    bool has_metrics_detail = false;
    friend bool operator==(const ServiceConfig&, const ServiceConfig&) = default;
};

struct RingConfig {
    std::string name;  // empty: no ring
    std::uint64_t capacity_bytes = 0;
    WhenFull full = WhenFull::evict;  // never `wait`: routing must not block
    std::uint16_t mode = 0;
    std::optional<std::uint16_t> inlet_mode;  // empty: same as `mode`
    friend bool operator==(const RingConfig&, const RingConfig&) = default;
};

struct RecordConfig {
    std::string path;  // empty: no recording
    std::uint64_t rotate_bytes = 0;
    std::chrono::nanoseconds rotate_every{};
};

// The server of web pages and viewers beside a router or a simulator (docs/guide/web.md).
struct WebConfig {
    std::optional<endpoint::HostPort> listen{};  // empty: none
    std::vector<std::string> origins{};          // web pages that may connect
    std::vector<std::string> hosts{};            // further names of this machine
    std::string token_file{};                    // holds what each client must send; empty: all may read
    friend bool operator==(const WebConfig&, const WebConfig&) = default;
};

enum class Origin : std::uint8_t { by_default, file, environment, option };

// One effective value, as text in the file's syntax, and its origin.
struct Setting {
    std::string key;
    std::string value;  // empty: not set, and there is no default
    Origin origin = Origin::by_default;
    std::uint32_t line = 0;  // in the file, if `origin` is `file`
    std::string variable;    // the name of the variable or option, if `origin` is one of these
};

struct Section {
    std::string name;   // such as "router"; "endpoint" occurs once per endpoint
    std::string label;  // of the endpoint; empty for other sections
    std::vector<Setting> settings;
    std::uint32_t line = 0;  // 0: not in the file
};

struct Config {
    RouterConfig router;
    ServiceConfig service;
    RingConfig ring;
    RecordConfig record;
    WebConfig web;
    LogLevel log_level = LogLevel::info;
    std::vector<endpoint::Endpoint> endpoints;

    std::vector<Section> sections;  // all of the above as text, for `mavloom check`
    // Anything unusual that is not an error, one line each. Report each line once.
    std::vector<std::string> notes;
};

// NAME=VALUE pairs whose name begins with a prefix. For example, MAVLOOM_ROUTER_DEDUP_MS sets `dedup_ms` of [router];
// the names for [ring], [record], [web] and [log] are formed the same way. A variable that matches no key is an error
// in two cases: MAVLOOM_ is followed by a section's name, or the name resembles that of a key. Otherwise it only adds a
// note.
using Environment = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] Environment environment_of(const char* const* envp, std::string_view prefix = "MAVLOOM_");

// A value that an option of the command line gives to a key.
struct Override {
    std::string_view option;  // for errors: "--heartbeat"
    std::string_view section, key;
    std::string value;
};
using Overrides = std::span<const Override>;

// Checks that the dialect defines every message named in filters and rates. Errors are `bad_input`, with file, line
// and the nearest name.
[[nodiscard]] SetupResult<void> check_message_names(const Config& config, std::string_view file_name,
                                                    const dialect::Dialect& dialect);

// Returns a warning, with file and line, for each setting that is legal but may do harm. An example is a rate limit on
// a message that a protocol waits for.
[[nodiscard]] std::vector<std::string> config_warnings(const Config& config, std::string_view file_name,
                                                       const dialect::Dialect& dialect);

// Checks that the endpoints' key files can be loaded. Errors are `bad_input`, with file and line.
[[nodiscard]] SetupResult<void> check_key_files(const Config& config, std::string_view file_name);

// Refuses two endpoints that bind the same port (`bad_input`, with file and line). It resolves no names, so it cannot
// find every conflict.
[[nodiscard]] SetupResult<void> check_ports(const Config& config, std::string_view file_name);

// Runs every check that a router makes on a configuration that parsed without errors. It refuses:
// - everything that `check_message_names` and `check_key_files` refuse
// - an endpoint that `Links::add` would refuse, or a ring as an endpoint
// - [ring] without a name, or [record] without a path
// - two different modes for one group
// Errors are `bad_input`, with file and line.
[[nodiscard]] SetupResult<void> check_for_router(const Config& config, std::string_view file_name,
                                                 const dialect::Dialect& dialect);

// Errors are `bad_input`. They begin with FILE:LINE: or, for a variable, with "environment:". Errors of an override are
// `usage`, and begin with the option.
[[nodiscard]] SetupResult<Config> parse_config(std::string_view text, std::string_view file_name,
                                               const Environment& environment = {}, Overrides overrides = {});
[[nodiscard]] SetupResult<Config> load_config(const std::filesystem::path& file, const Environment& environment = {},
                                              Overrides overrides = {});

}  // namespace mavloom::config
