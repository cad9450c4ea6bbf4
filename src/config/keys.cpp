// SPDX-License-Identifier: MIT
#include "mavloom/config/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ranges>

#include "mavloom/base/name.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::config {

namespace {

template <class E, std::size_t n>
SetupResult<void> put_choice(std::string_view text, const std::array<std::string_view, n>& choices, E& target) {
    const auto choice = std::find(choices.begin(), choices.end(), text);
    if (choice == choices.end())
        return endpoint::usage(fmt::format("{} is not one of {}{}", in_quotes(text), fmt::join(choices, ", "),
                                           did_you_mean(text, choices)));
    target = static_cast<E>(choice - choices.begin());
    return {};
}

SetupResult<void> set_heartbeat(Config& config, std::string_view text) {
    if (text == "off") {
        config.router.heartbeat.reset();
        return {};
    }
    const auto slash = text.find('/');
    const auto system = endpoint::parse_integer(text.substr(0, slash), 1, 255);
    const auto component = slash == std::string_view::npos ? system
                                                           : endpoint::parse_integer(text.substr(slash + 1), 1, 255);
    if (slash == std::string_view::npos || !system || !component)
        return endpoint::usage(fmt::format("{} is neither off nor SYS/COMP, each from 1 to 255", in_quotes(text)));
    config.router.heartbeat.emplace(static_cast<std::uint8_t>(*system), static_cast<std::uint8_t>(*component));
    return {};
}

SetupResult<void> set_request_streams(Config& config, std::string_view text) {
    if (text == "off") {
        config.router.request_streams_hz = 0;
        return {};
    }
    const auto rate = endpoint::parse_integer(text, 1, 1000);
    if (!rate) return endpoint::usage(fmt::format("{} is neither off nor a rate from 1 to 1000 Hz", in_quotes(text)));
    config.router.request_streams_hz = static_cast<std::uint16_t>(*rate);
    return {};
}

SetupResult<void> set_route_timeout(Config& config, std::string_view text) {
    const auto timeout = endpoint::parse_duration(text);
    if (timeout && timeout->count() <= 0) return endpoint::usage("the timeout of routes must be above 0");
    return endpoint::put(timeout, config.router.route_timeout);
}

SetupResult<void> set_capacity(Config& config, std::string_view text) {
    return endpoint::put(endpoint::parse_ring_capacity(text), config.ring.capacity_bytes);
}

SetupResult<void> put_name(std::string_view text, std::string_view whose, std::string& name) {
    if (!is_name(text))
        return endpoint::usage(
            fmt::format("{} is not a {} name (letters, digits, '_' and '-', at most 64)", in_quotes(text), whose));
    name = std::string(text);
    return {};
}

SetupResult<void> set_metrics(Config& config, std::string_view text) {
    return endpoint::put(endpoint::parse_server_address(text), config.service.metrics);
}

SetupResult<void> set_full(Config& config, std::string_view text) {
    if (text == "wait")
        return endpoint::usage(
            "a router does not wait for readers: type evict, which reports to readers how many records they missed, or "
            "drop_newest");
    constexpr std::array<std::string_view, 2> choices{"evict", "drop_newest"};
    bool drops = false;
    if (auto chosen = put_choice(text, choices, drops); !chosen) return chosen;
    config.ring.full = drops ? WhenFull::drop_newest : WhenFull::evict;
    return {};
}

// Without quotes TOML reads 600 as a decimal number and 0o600 as 384. Neither has a leading 0, which 0600 must have.
SetupResult<void> put_mode(std::string_view text, auto& mode) {
    if (!text.starts_with('0'))
        return endpoint::usage(
            fmt::format("{} is not a file mode; for example, type \"0600\" or \"0640\", in quotes", in_quotes(text)));
    return endpoint::put(endpoint::parse_mode(text), mode);
}

SetupResult<void> set_record_path(Config& config, std::string_view text) {
    if (auto good = endpoint::check_path(endpoint::Scheme::tlog, text); !good) return good;
    config.record.path = std::string(text);
    return {};
}

// Names, separated by commas.
std::vector<std::string> split_list(std::string_view text) {
    std::vector<std::string> all;
    while (!text.empty()) {
        auto part = text.substr(0, text.find(','));
        text.remove_prefix(std::min(text.size(), part.size() + 1));
        while (part.starts_with(' ')) part.remove_prefix(1);
        while (part.ends_with(' ')) part.remove_suffix(1);
        if (!part.empty()) all.emplace_back(part);
    }
    return all;
}

constexpr std::array<std::string_view, 2> components{"system", "drop"};
constexpr std::array<std::string_view, 2> targets{"drop", "flood"};
constexpr std::array<std::string_view, 4> levels{"debug", "info", "warning", "error"};

constexpr std::array all_keys{
    ConfigKey{"router",
              "name",
              "",
              [](Config& c, std::string_view t) { return put_name(t, "router", c.service.name); },
              {"--name", "NAME",
               "the router's name for `mavloom ctl` and `stat`: A-Z a-z 0-9 _ - (default: the name of the ring, or "
               "router)"}},
    ConfigKey{"router",
              "dedup_ms",
              "0",
              [](Config& c, std::string_view t) {
                  return endpoint::put(endpoint::parse_integer(t, 0, 60'000), c.router.dedup_ms);
              },
              {"--dedup-ms", "MS", "drop a frame if the same bytes arrived less than this long ago (default: 0, off)"}},
    ConfigKey{"router",
              "unknown_component",
              "system",
              [](Config& c, std::string_view t) { return put_choice(t, components, c.router.unknown_component); },
              {"--unknown-component", "system|drop",
               "where frames for an unseen component go: to its system's links (default), or nowhere"}},
    ConfigKey{"router",
              "unknown_target",
              "drop",
              [](Config& c, std::string_view t) { return put_choice(t, targets, c.router.unknown_target); },
              {"--unknown-target", "drop|flood",
               "where frames for an unseen system go: nowhere (default), or to all other links"}},
    ConfigKey{"router",
              "route_timeout",
              "60",
              set_route_timeout,
              {"--route-timeout", "TIME", "forget a source that is silent for this long (default: 60s)"}},
    ConfigKey{
        "router",
        "heartbeat",
        "off",
        set_heartbeat,
        {"--heartbeat", "SYS/COMP", "send the router's own heartbeats with this id, as in 255/191 (default: off)"}},
    ConfigKey{"router",
              "request_streams",
              "off",
              set_request_streams,
              {"--request-streams", "HZ",
               "request all streams of each ArduPilot at this rate, under the id of --heartbeat (default: off)"}},
    ConfigKey{"router",
              "metrics",
              "",
              set_metrics,
              {"--metrics", "HOST:PORT", "serve Prometheus metrics at http://HOST:PORT/metrics"}},
    ConfigKey{"router",
              "metrics_detail",
              "false",
              [](Config& c, std::string_view t) {
                  return endpoint::put(endpoint::parse_bool(t), c.service.has_metrics_detail);
              },
              {"--metrics-detail", nullptr,
               "let the metrics distinguish the components of each system, and list more messages"}},
    ConfigKey{"ring",
              "name",
              "",
              [](Config& c, std::string_view t) { return put_name(t, "ring", c.ring.name); },
              {"--ring", "NAME",
               "write every good frame into the ring /dev/shm/mavloom.NAME for programs on this machine, and forward "
               "the frames that they send"}},
    ConfigKey{"ring",
              "capacity",
              "8MiB",
              set_capacity,
              {"--ring-capacity", "BYTES", "size of the ring: a power of two, 64k to 64G (default: 8MiB)"}},
    ConfigKey{"ring",
              "full",
              "evict",
              set_full,
              {"--ring-full", "evict|drop_newest",
               "what happens if lossless readers still need all of the ring: they miss records (default), or the ring "
               "misses the new frame"}},
    ConfigKey{"ring",
              "mode",
              "0600",
              [](Config& c, std::string_view t) { return put_mode(t, c.ring.mode); },
              {"--ring-mode", "MODE", "permissions of the ring and its inlet: who reads and sends (default: 0600)"}},
    ConfigKey{"ring",
              "inlet_mode",
              "",
              [](Config& c, std::string_view t) { return put_mode(t, c.ring.inlet_mode); },
              {"--ring-inlet-mode", "MODE", "permissions of the inlet alone: who sends (default: that of --ring-mode)"}},
    ConfigKey{"record", "path", "", set_record_path},
    ConfigKey{"record", "rotate_bytes", "",
              [](Config& c, std::string_view t) {
                  return endpoint::put(endpoint::parse_rotate_bytes(t), c.record.rotate_bytes);
              }},
    ConfigKey{"record", "rotate_every", "",
              [](Config& c, std::string_view t) {
                  return endpoint::put(endpoint::parse_rotate_every(t), c.record.rotate_every);
              }},
    ConfigKey{"web",
              "listen",
              "",
              [](Config& c, std::string_view t) { return set_web_listen(c.web, t); },
              {"--web", "HOST:PORT",
               "serve the page and viewers at http://HOST:PORT, for example 127.0.0.1:8088 (docs/guide/web.md)"}},
    ConfigKey{"web",
              "origin",
              "",
              [](Config& c, std::string_view t) { return set_web_origins(c.web, t); },
              {"--web-origin", "URL,...", "web pages that may connect to --web, as in https://app.foxglove.dev"}},
    ConfigKey{"web",
              "host",
              "",
              [](Config& c, std::string_view t) { return set_web_hosts(c.web, t); },
              {"--web-host", "NAME,...", "further names of this machine that clients of --web use"}},
    ConfigKey{"web",
              "token_file",
              "",
              [](Config& c, std::string_view t) { return set_web_token_file(c.web, t); },
              {"--web-token-file", "FILE", "clients of --web must send the token that this file holds"}},
    ConfigKey{"log",
              "level",
              "info",
              [](Config& c, std::string_view t) { return put_choice(t, levels, c.log_level); },
              {"--log-level", "LEVEL", "what to report on stderr: debug, info (default), warning or error"}},
};

constexpr bool is_router_key(const ConfigKey& key) { return key.section == "router"; }
static_assert(std::ranges::equal(all_keys | std::views::filter(is_router_key), endpoint::router_keys, {},
                                 &ConfigKey::name));

constexpr std::array<std::string_view, 5> sections{"router", "ring", "record", "log", "web"};

}  // namespace

SetupResult<void> set_web_listen(WebConfig& web, std::string_view text) {
    return endpoint::put(endpoint::parse_server_address(text), web.listen);
}
SetupResult<void> set_web_origins(WebConfig& web, std::string_view text) {
    return endpoint::put(endpoint::parse_origins(text), web.origins);
}
SetupResult<void> set_web_hosts(WebConfig& web, std::string_view text) {
    web.hosts = split_list(text);
    return {};
}
SetupResult<void> set_web_token_file(WebConfig& web, std::string_view text) {
    if (text.empty()) return endpoint::usage("it names no file, so everybody could read");
    web.token_file = text;
    return {};
}

std::span<const ConfigKey> config_keys() noexcept { return all_keys; }
std::span<const std::string_view> config_sections() noexcept { return sections; }

}  // namespace mavloom::config
