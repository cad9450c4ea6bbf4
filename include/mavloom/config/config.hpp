// SPDX-License-Identifier: MIT
// The configuration file: TOML with [router], [[endpoint]], [ring], [record], [log] and [web] (DESIGN.md sections 4 and 5,
// docs/guide/configuration.md). Each value knows where it came from; the order is default, file, environment. Nothing is guessed: an unknown
// section, key or value is an error with file, line and the nearest spelling. Immutable values; loading allocates.
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
    std::optional<std::pair<std::uint8_t, std::uint8_t>> heartbeat;  // system and component; empty: off
    std::uint16_t request_streams_hz = 0;                            // of ArduPilot, by the id of `heartbeat`; 0: off
    friend bool operator==(const RouterConfig&, const RouterConfig&) = default;
};

// An endpoint asks for the router's heartbeat, which has no id to be sent by.
inline constexpr std::string_view heartbeat_needs_id =
    "heartbeat=true needs heartbeat = \"SYS/COMP\" in [router], the id that the router sends by";

struct RingConfig {
    std::string name;  // empty: no ring
    std::uint64_t capacity_bytes = 0;
    WhenFull full = WhenFull::evict;  // never `wait`: routing waits for nobody
    std::uint16_t mode = 0;
    friend bool operator==(const RingConfig&, const RingConfig&) = default;
};

struct RecordConfig {
    std::string path;  // empty: nothing is recorded
    std::uint64_t rotate_bytes = 0;
    std::chrono::nanoseconds rotate_every{};
};

struct WebConfig {
    endpoint::HostPort listen;
};

enum class Origin : std::uint8_t { by_default, file, environment };

// One effective value in the words of the file, and where it came from.
struct Setting {
    std::string key;
    std::string value;  // empty: not set, and nothing stands in for it
    Origin origin = Origin::by_default;
    std::uint32_t line = 0;  // of the file
    std::string variable;    // of the environment
};

struct Section {
    std::string name;   // "router"; "endpoint" once for each
    std::string label;  // of an endpoint
    std::vector<Setting> settings;
    std::uint32_t line = 0;  // 0: the file has none
};

struct Config {
    RouterConfig router;
    RingConfig ring;
    RecordConfig record;
    LogLevel log_level = LogLevel::info;
    WebConfig web;
    std::vector<endpoint::Endpoint> endpoints;

    std::vector<Section> sections;   // all of the above, for people and for `check`
    std::vector<std::string> notes;  // what was found odd and is no error: to be said once
};

// NAME=VALUE pairs that begin with MAVLOOM_. Those of a section (MAVLOOM_ROUTER_..., _RING_, _RECORD_, _LOG_, _WEB_) set its keys, as
// MAVLOOM_ROUTER_DEDUP_MS does. One that sets nothing is an error where it has the beginning of a section or is near to a key, else a note.
using Environment = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] Environment environment_of(const char* const* envp);

// Looks up the messages that filters and rates name. An error is `bad_input`, with file, line and the nearest name.
[[nodiscard]] SetupResult<void> check_message_names(const Config& config, std::string_view file_name,
                                                    const dialect::Dialect& dialect);

// What the configuration will do that somebody may not want, one line each with file and line: a rate on a message that a protocol waits for.
[[nodiscard]] std::vector<std::string> config_warnings(const Config& config, std::string_view file_name,
                                                       const dialect::Dialect& dialect);

// Reads the key files that the endpoints name. An error is `bad_input`, with file and line.
[[nodiscard]] SetupResult<void> check_key_files(const Config& config, std::string_view file_name);

// All that a router refuses in a configuration that reads well: the two above, a ring as an endpoint, [ring] without a name, [record] without a
// path, two modes for one group. An error is `bad_input`, with file and line.
[[nodiscard]] SetupResult<void> check_for_router(const Config& config, std::string_view file_name,
                                                 const dialect::Dialect& dialect);

// Errors are `bad_input` and begin with FILE:LINE: or the variable's name.
[[nodiscard]] SetupResult<Config> parse_config(std::string_view text, std::string_view file_name,
                                               const Environment& environment = {});
[[nodiscard]] SetupResult<Config> load_config(const std::filesystem::path& file, const Environment& environment = {});

}  // namespace mavloom::config
