// SPDX-License-Identifier: MIT
// Parses endpoints as users write them. Command lines, configuration files and Python share one grammar
// (docs/guide/endpoints.md). Parsing opens nothing and resolves no names. The results are plain values.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/dialect/filter.hpp"
#include "mavloom/dialect/terms.hpp"
#include "mavloom/endpoint/fault.hpp"
#include "mavloom/endpoint/schemes.hpp"
#include "mavloom/route/choices.hpp"

namespace mavloom::endpoint {

struct HostPort {
    std::string host;  // a name, IPv4, or IPv6 without brackets
    std::uint16_t port = 0;
    friend bool operator==(const HostPort&, const HostPort&) = default;
};

using dialect::FilterTerms;
using dialect::RateTerm;

using route::GroupMode;

struct EndpointOptions {
    static constexpr std::uint64_t max_queue_bytes = std::uint64_t{1} << 30;  // offsets in queues have 32 bits

    std::string name;  // empty: the URL without its query
    std::string group;
    GroupMode group_mode = GroupMode::all;
    // False: `group_mode` is the default, and another endpoint of the group may set the mode.
    bool has_group_mode = false;
    std::uint32_t mtu_bytes = 1280;                     // 0: one frame per datagram
    std::optional<std::chrono::nanoseconds> idle;       // default: 60 s for UDP peers, none for others
    std::uint64_t queue_bytes = 1 << 20;                // at most max_queue_bytes
    std::optional<std::chrono::nanoseconds> queue_age;  // default: 1 s for telemetry, 10 s for other frames
    std::vector<RateTerm> max_rate;
    std::optional<std::uint64_t> max_bytes_per_s;
    FilterTerms in_allow, in_block, out_allow, out_block;
    bool tap = false;
    bool is_private = false;
    // Whether the router sends its heartbeat here. Default: true if `sends_first` is true for the scheme and the
    // endpoint is not a tap.
    std::optional<bool> heartbeat;
    std::string sign_key_file, verify_key_file;
    std::uint64_t rcvbuf_bytes = 32u << 20;
    std::uint32_t max_peers = 256;
    std::string iface;
    std::optional<std::uint8_t> ttl;
    bool low_latency = false;
    // Endpoints that listen: whether their peers rank as own links, and get everything from their first datagram on,
    // although its source address may be forged. Default: those on this machine do.
    std::optional<bool> trusted;
    // sign_all=true: also signs frames that own links brought, although nobody has verified them.
    bool signs_own = false;
    // A vehicle that another stranger has is not learned here (learn=first).
    bool learns_first = false;
    bool required = false;
    // udpin: other sockets with this option may bind the same port. The newest of them receives.
    bool reuse = false;
    std::optional<HostPort> bind;
    bool fixed = false;              // udpbcast: keeps broadcasting after a peer answers
    std::optional<double> speed;     // tlog source: 1 = recorded pace, infinity = speed=max
    std::uint64_t rotate_bytes = 0;  // tlog destination; 0: no rotation
    std::chrono::nanoseconds rotate_every{};
    std::uint32_t baud = 57600;  // serial; 0: auto
    std::string flow = "none";
    bool from_oldest = false;      // shm: oldest records first
    std::optional<bool> lossless;  // shm; empty: the command decides
    // wsin: web pages that may connect, as in "https://app.example.com"; "*": all.
    std::vector<std::string> origins;
    bool foreign = false;  // shm source: also rings of users who are not trusted
    // Faults on purpose: see `inward_faults()`.
    std::optional<Faults> fault, in_fault, out_fault;
    std::optional<std::uint64_t> fault_seed;  // default: 1
    friend bool operator==(const EndpointOptions&, const EndpointOptions&) = default;
};

struct Endpoint {
    Scheme scheme = Scheme::udpin;
    HostPort address;  // udp*, tcp*, ws*
    // Serial device, tlog file, ring name; ws*: the path with its slash, or nothing for "/".
    std::string path;
    EndpointOptions options;

    [[nodiscard]] const SchemeRow& row() const noexcept { return row_of(scheme); }
    [[nodiscard]] bool has_address() const noexcept { return endpoint::has_address(row()); }
    [[nodiscard]] bool is_ring() const noexcept { return row().form == Form::ring; }
    [[nodiscard]] bool is_recording() const noexcept { return row().form == Form::recording; }
    // True if peers or clients contact the endpoint.
    [[nodiscard]] bool listens() const noexcept { return row().side == Side::listens; }
    // True if it contacts the far side at its address.
    [[nodiscard]] bool calls() const noexcept { return has_address() && row().side == Side::calls; }
    // True if each client of the endpoint has a connection of its own.
    [[nodiscard]] bool accepts_clients() const noexcept { return listens() && row().carrier != Carrier::udp; }

    // The name that messages and tables show: `options.name`, or else scheme://host:port or scheme://path.
    [[nodiscard]] std::string label() const;
    friend bool operator==(const Endpoint&, const Endpoint&) = default;
};

[[nodiscard]] std::string_view group_mode_name(GroupMode mode) noexcept;

// The schemes of one side, as in "udpin://, tcpin:// or wsin://".
[[nodiscard]] std::string schemes_text(Side side);
// "udpin://HOST:PORT", "serial:///dev/NAME", "shm://NAME".
[[nodiscard]] std::string form_of(const SchemeRow& row);

// True if the path ends like the name of a recording: FLIGHT.tlog, FLIGHT.TLOG, or a renamed FLIGHT.tlog.1.
[[nodiscard]] bool is_recording_path(std::string_view path) noexcept;

// The canonical path of a file, so that two spellings of it compare equal. The file need not exist.
[[nodiscard]] std::filesystem::path canonical_path(const std::filesystem::path& path);

// Parses "udpin://0.0.0.0:14550?idle=2" and the other forms of the grammar, including pymavlink's. Errors are
// `usage`; they quote the text, say what is wrong and suggest a spelling.
[[nodiscard]] SetupResult<Endpoint> parse_endpoint(std::string_view text);
// Parses all. The text of an error begins with `option`, unless that is empty.
[[nodiscard]] SetupResult<std::vector<Endpoint>> parse_endpoints(std::span<const std::string> texts,
                                                                 std::string_view option = {});

// Sets one option from a URL's query or a configuration key. `parse_endpoint` uses it too.
[[nodiscard]] SetupResult<void> set_endpoint_option(Endpoint& endpoint, std::string_view key, std::string_view value);
// The options of all schemes, in the order of the guide's table. `set_endpoint_option` checks that the scheme takes
// them.
[[nodiscard]] std::span<const std::string_view> endpoint_option_names() noexcept;
// Refuses options that contradict each other (`usage`).
[[nodiscard]] SetupResult<void> check_options(const Endpoint& endpoint);
// For an endpoint that a command reads: refuses options that only apply to writing (`usage`).
[[nodiscard]] SetupResult<void> check_source_options(const Endpoint& endpoint);

// Durations: "250ms", "2", "2s", "1m", "1h"; without a unit, seconds. Sizes: "64k", "1M", "32MiB"; without a unit,
// bytes.
[[nodiscard]] SetupResult<std::chrono::nanoseconds> parse_duration(std::string_view text);
[[nodiscard]] SetupResult<std::uint64_t> parse_size(std::string_view text);
// Permissions of a file: three octal digits, "640", "0640" or "0o640".
[[nodiscard]] SetupResult<std::uint16_t> parse_mode(std::string_view text);

}  // namespace mavloom::endpoint
