// SPDX-License-Identifier: MIT
// Pieces that the endpoint grammar and the configuration file share. Pure functions, safe from any thread.
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

using SchemeSet = std::uint16_t;  // bit n: the scheme with that enumerator

[[nodiscard]] constexpr SchemeSet set_of(Scheme scheme) noexcept {
    return static_cast<SchemeSet>(1u << static_cast<unsigned>(scheme));
}

inline constexpr SchemeSet udp_schemes = set_of(Scheme::udpin) | set_of(Scheme::udpout) | set_of(Scheme::udpbcast) |
                                         set_of(Scheme::udpmcast);
inline constexpr SchemeSet tcp_schemes = set_of(Scheme::tcpin) | set_of(Scheme::tcpout);
inline constexpr SchemeSet address_schemes = udp_schemes | tcp_schemes;

[[nodiscard]] std::span<const std::string_view> scheme_names() noexcept;

using dialect::parse_positive;
using mavloom::in_quotes;
using mavloom::shown;

// The options that the scheme takes, and the text of the value that stands where none is given (empty: not set).
[[nodiscard]] std::vector<std::string_view> option_names_for(Scheme scheme);
[[nodiscard]] std::string_view default_option_text(Scheme scheme, std::string_view name) noexcept;

// The keys of [router] in a configuration file: people type them as options of one endpoint, and the error says where they belong.
inline constexpr std::array<std::string_view, 6> router_keys{"dedup_ms",      "unknown_component", "unknown_target",
                                                             "route_timeout", "heartbeat",         "request_streams"};

struct OptionText {
    std::string key;
    std::string value;
};

// What stands behind the '?' where options begin; empty where there is none. A bare path that ends in ".tlog" may have one in its name.
[[nodiscard]] std::optional<std::string_view> query_of(std::string_view endpoint);

// "a=1&b=x%20y", decoded; a key given twice, a missing value and a bad escape are errors.
[[nodiscard]] SetupResult<std::vector<OptionText>> split_query(std::string_view query);
[[nodiscard]] SetupResult<std::string> percent_decoded(std::string_view text);

// "HOST:PORT" or "[IPv6]:PORT".
[[nodiscard]] SetupResult<HostPort> parse_host_port(std::string_view text, std::string_view scheme);
// A host as a URL or a `host` key has it: the result has no brackets.
[[nodiscard]] SetupResult<std::string> parse_host(std::string_view text, std::string_view scheme, std::string_view port);
[[nodiscard]] SetupResult<std::uint16_t> parse_port(std::string_view text);
// Whether the scheme can be used with this address: nothing is sent to 0.0.0.0, a multicast group needs udpmcast, ...
[[nodiscard]] SetupResult<void> check_address(Scheme scheme, const HostPort& address);
// Whether the path, device or ring name fits the scheme.
[[nodiscard]] SetupResult<void> check_path(Scheme scheme, std::string_view path);

// "[::1]:14550", "localhost:14550".
[[nodiscard]] std::string to_text(const HostPort& address);

[[nodiscard]] tl::unexpected<SetupError> usage(std::string text);
// Puts a parsed value where it belongs; the error passes through.
template <class T, class Target>
SetupResult<void> put(SetupResult<T> parsed, Target& target) {
    if (!parsed) return tl::unexpected(std::move(parsed.error()));
    target = static_cast<Target>(std::move(*parsed));
    return {};
}

[[nodiscard]] SetupResult<std::uint64_t> parse_integer(std::string_view text, std::uint64_t least, std::uint64_t most);
// When a recording goes on in a new file: by size, by time.
[[nodiscard]] SetupResult<std::uint64_t> parse_rotate_bytes(std::string_view text);
[[nodiscard]] SetupResult<std::chrono::nanoseconds> parse_rotate_every(std::string_view text);
[[nodiscard]] SetupResult<bool> parse_bool(std::string_view text);

[[nodiscard]] SetupResult<FilterTerms> parse_filter(std::string_view text);
[[nodiscard]] SetupResult<std::vector<RateTerm>> parse_rates(std::string_view text);

}  // namespace mavloom::endpoint
