// SPDX-License-Identifier: MIT
// Parsers that are shared by the endpoint grammar and the configuration file. Pure functions, safe from any thread.
// Errors are `usage`.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/endpoint/endpoint.hpp"

namespace mavloom::endpoint {

// The scheme of this name. The error (`usage`) suggests the nearest name, or lists all.
[[nodiscard]] SetupResult<Scheme> parse_scheme(std::string_view name);

using dialect::parse_positive;
using mavloom::in_quotes;
using mavloom::shown;

// Return the names of the options that the scheme takes, and the default of one option as text (empty: no default).
[[nodiscard]] std::vector<std::string_view> option_names_for(Scheme scheme);
[[nodiscard]] std::string_view default_option_text(Scheme scheme, std::string_view name) noexcept;

// The keys of [router] in the configuration file. Users sometimes give them as endpoint options; the error then states
// where they belong.
inline constexpr std::array<std::string_view, 9> router_keys{
    "name",      "dedup_ms",        "unknown_component", "unknown_target", "route_timeout",
    "heartbeat", "request_streams", "metrics",           "metrics_detail"};

struct OptionText {
    std::string key;
    std::string value;
};

// Returns the text after the '?' that begins the options, or nothing if there are no options. The path of a bare
// recording, which ends in ".tlog", may itself contain a '?'.
[[nodiscard]] std::optional<std::string_view> query_of(std::string_view endpoint);

// Splits and decodes "a=1&b=x%20y". A repeated key, a missing value and an invalid escape are errors.
[[nodiscard]] SetupResult<std::vector<OptionText>> split_query(std::string_view query);
[[nodiscard]] SetupResult<std::string> percent_decoded(std::string_view text);

// Origins of web pages, as browsers send them, separated by commas: https://app.example.com. "*" is all.
[[nodiscard]] SetupResult<std::vector<std::string>> parse_origins(std::string_view text);

// "HOST:PORT" or "[IPv6]:PORT". Only error texts use `scheme`.
[[nodiscard]] SetupResult<HostPort> parse_host_port(std::string_view text, std::string_view scheme);
// A host from a URL or a `host` key. The result has no brackets. Only error texts use `scheme` and `port`.
[[nodiscard]] SetupResult<std::string> parse_host(std::string_view text, std::string_view scheme, std::string_view port);
[[nodiscard]] SetupResult<std::uint16_t> parse_port(std::string_view text);
// The address at which a router or simulator serves metrics: a numeric one, because no name is looked up.
[[nodiscard]] SetupResult<HostPort> parse_server_address(std::string_view text);
[[nodiscard]] SetupResult<void> check_server_address(const HostPort& address);
// Checks that the scheme can use this address. For example, 0.0.0.0 is not a destination, and a multicast group needs
// udpmcast.
[[nodiscard]] SetupResult<void> check_address(Scheme scheme, const HostPort& address);
// Checks that the path, device or ring name fits the scheme.
[[nodiscard]] SetupResult<void> check_path(Scheme scheme, std::string_view path);

// "[::1]:14550", "localhost:14550".
[[nodiscard]] std::string to_text(const HostPort& address);

[[nodiscard]] tl::unexpected<SetupError> usage(std::string text);
// Stores a parsed value in `target`, or returns the parser's error.
template <class T, class Target>
SetupResult<void> put(SetupResult<T> parsed, Target& target) {
    if (!parsed) return tl::unexpected(std::move(parsed.error()));
    target = static_cast<Target>(std::move(*parsed));
    return {};
}

[[nodiscard]] SetupResult<std::uint64_t> parse_integer(std::string_view text, std::uint64_t least, std::uint64_t most);
// Parse the size and the time after which a recording continues in a new file.
[[nodiscard]] SetupResult<std::uint64_t> parse_rotate_bytes(std::string_view text);
[[nodiscard]] SetupResult<std::chrono::nanoseconds> parse_rotate_every(std::string_view text);
// Parses the size of a ring in bytes: a power of two.
[[nodiscard]] SetupResult<std::uint64_t> parse_ring_capacity(std::string_view text);
[[nodiscard]] SetupResult<bool> parse_bool(std::string_view text);

[[nodiscard]] SetupResult<FilterTerms> parse_filter(std::string_view text);
// "1" or "1/1": a system, or a component of it.
[[nodiscard]] SetupResult<FilterTerms> parse_sender(std::string_view text);
[[nodiscard]] SetupResult<std::vector<RateTerm>> parse_rates(std::string_view text);

}  // namespace mavloom::endpoint
