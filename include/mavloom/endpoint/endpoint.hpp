// SPDX-License-Identifier: MIT
// Endpoints as users write them: one grammar for every command, configuration file and Python (DESIGN.md section 4, docs/guide/endpoints.md).
// Parsing opens nothing and resolves no name. Immutable values.
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
#include "mavloom/dialect/terms.hpp"
#include "mavloom/route/choices.hpp"

namespace mavloom::endpoint {

enum class Scheme : std::uint8_t { udpin, udpout, udpbcast, udpmcast, tcpin, tcpout, serial, shm, tlog };

[[nodiscard]] std::string_view scheme_name(Scheme scheme) noexcept;
// Whether an endpoint of this scheme speaks first, to a far side that it names: not one whose peers or clients come by themselves.
[[nodiscard]] bool calls_somebody(Scheme scheme) noexcept;

struct HostPort {
    std::string host;  // a name, IPv4, or IPv6 without brackets
    std::uint16_t port = 0;
    friend bool operator==(const HostPort&, const HostPort&) = default;
};

// Terms of in_allow=, in_block=, out_allow=, out_block=: message names or ids (names are resolved against a dialect later), sys:N, comp:N.
struct FilterTerms {
    std::vector<std::string> messages;
    std::vector<std::uint8_t> systems;
    std::vector<std::uint8_t> components;
    [[nodiscard]] bool empty() const noexcept { return messages.empty() && systems.empty() && components.empty(); }
    friend bool operator==(const FilterTerms&, const FilterTerms&) = default;
};

using dialect::RateTerm;

using route::GroupMode;

struct EndpointOptions {
    std::string name;  // default: the URL without its query
    std::string group;
    GroupMode group_mode = GroupMode::all;
    bool names_group_mode = false;                 // else another endpoint of the group may
    std::uint32_t mtu_bytes = 1280;                // 0: one frame a datagram
    std::optional<std::chrono::nanoseconds> idle;  // default: 60 s for UDP peers, none for others
    std::uint64_t queue_bytes = 1 << 20;
    std::optional<std::chrono::nanoseconds> queue_age;  // default: 1 s for class 2, 10 s for the others
    std::vector<RateTerm> max_rate;
    std::optional<std::uint64_t> max_bytes_per_s;
    FilterTerms in_allow, in_block, out_allow, out_block;
    bool tap = false;
    bool is_private = false;
    std::optional<bool> heartbeat;  // of the router; default: where the endpoint calls somebody
    std::string sign_key_file, verify_key_file;
    std::uint64_t rcvbuf_bytes = 32u << 20;
    std::uint32_t max_peers = 256;
    std::string iface;
    std::optional<std::uint8_t> ttl;
    bool low_latency = false;
    bool required = false;
    std::optional<HostPort> bind;
    bool fixed = false;              // udpbcast
    std::optional<double> speed;     // tlog source: 1 = recorded pace, infinity = speed=max
    std::uint64_t rotate_bytes = 0;  // tlog destination; 0: no rotation
    std::chrono::nanoseconds rotate_every{};
    std::uint32_t baud = 57600;  // serial; 0: auto
    std::string flow = "none";
    bool from_oldest = false;      // shm
    std::optional<bool> lossless;  // shm; default: as the command has it
    friend bool operator==(const EndpointOptions&, const EndpointOptions&) = default;
};

struct Endpoint {
    Scheme scheme = Scheme::udpin;
    HostPort address;  // udp*, tcp*
    std::string path;  // serial device, tlog file, ring name
    EndpointOptions options;

    // The link name of messages and tables: options.name, else scheme://host:port or scheme://path.
    [[nodiscard]] std::string label() const;
    friend bool operator==(const Endpoint&, const Endpoint&) = default;
};

[[nodiscard]] std::string_view group_mode_name(GroupMode mode) noexcept;

// Why a router refuses shm://NAME, with what to type instead.
[[nodiscard]] std::string ring_is_no_endpoint(const Endpoint& endpoint);

// Whether a path is a recording's by its name: FLIGHT.tlog, FLIGHT.TLOG, or FLIGHT.tlog.1 as an older one is renamed.
[[nodiscard]] bool names_recording(std::string_view path) noexcept;

// The path by which a file is known however it is spelt; it need not exist.
[[nodiscard]] std::filesystem::path same_file(const std::filesystem::path& path);

// "udpin://0.0.0.0:14550?idle=2" and the other forms of the grammar, pymavlink's among them. Errors are `usage`, name what is wrong with this
// text and the spelling to type.
[[nodiscard]] SetupResult<Endpoint> parse_endpoint(std::string_view text);

// One option as a URL's query or a file's key has it; `parse_endpoint` is built on this.
[[nodiscard]] SetupResult<void> set_endpoint_option(Endpoint& endpoint, std::string_view key, std::string_view value);
// The options of all schemes, in the order of the guide's table; `set_endpoint_option` says which scheme takes which.
[[nodiscard]] std::span<const std::string_view> endpoint_option_names() noexcept;
// Refuses (`usage`) options that contradict each other.
[[nodiscard]] SetupResult<void> check_options(const Endpoint& endpoint);
// Refuses (`usage`) what makes sense only where the endpoint is written to, for commands that read it.
[[nodiscard]] SetupResult<void> check_source_options(const Endpoint& endpoint);

// "250ms", "2", "2s", "1m", "1h": seconds unless a unit follows. "64k", "1M", "32MiB": bytes.
[[nodiscard]] SetupResult<std::chrono::nanoseconds> parse_duration(std::string_view text);
[[nodiscard]] SetupResult<std::uint64_t> parse_size(std::string_view text);

}  // namespace mavloom::endpoint
