// SPDX-License-Identifier: MIT
// The table of endpoint options: name, schemes that take it, default, and how to parse its text
// (docs/guide/endpoints.md).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "mavloom/base/name.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::endpoint {

namespace {

using Set = SetupResult<void> (*)(EndpointOptions&, std::string_view);

struct Option {
    std::string_view name;
    SchemeSet schemes;
    std::string_view default_text;  // as `check` shows it; empty: not set
    Set set;
};

template <bool EndpointOptions::*member>
SetupResult<void> set_flag(EndpointOptions& options, std::string_view text) {
    return put(parse_bool(text), options.*member);
}

template <FilterTerms EndpointOptions::*member>
SetupResult<void> set_filter(EndpointOptions& options, std::string_view text) {
    return put(parse_filter(text), options.*member);
}

template <std::string EndpointOptions::*member>
SetupResult<void> set_text(EndpointOptions& options, std::string_view text) {
    const bool control = printable(text) != text;
    if (text.empty() || control || text.size() > 4096)
        return usage("it is empty, too long or contains control characters");
    options.*member = std::string(text);
    return {};
}

SetupResult<std::chrono::nanoseconds> duration_of_at_least(std::string_view text, std::chrono::nanoseconds least,
                                                           std::string_view advice) {
    auto duration = parse_duration(text);
    if (duration && *duration < least) return usage(fmt::format("{} is too short; {}", in_quotes(text), advice));
    return duration;
}

SetupResult<std::uint64_t> size_within(std::string_view text, std::uint64_t least, std::uint64_t most) {
    auto size = parse_size(text);
    if (size && (*size < least || *size > most))
        return usage(fmt::format("{} is out of range ({} to {} bytes)", in_quotes(text), least, most));
    return size;
}

constexpr std::array<std::string_view, 3> modes{"all", "best", "primary"};

SetupResult<void> set_group_mode(EndpointOptions& options, std::string_view text) {
    const auto mode = std::find(modes.begin(), modes.end(), text);
    if (mode == modes.end()) return usage(fmt::format("{} is not one of all, best, primary", in_quotes(text)));
    options.group_mode = static_cast<GroupMode>(mode - modes.begin());
    options.has_group_mode = true;
    return {};
}

constexpr std::uint64_t longest_frame_bytes = 280;  // MAVLink 2, 255 payload bytes, signed
constexpr std::uint64_t longest_datagram_bytes = 65507;
constexpr std::uint64_t most_queue_bytes = std::uint64_t{1} << 40;
constexpr std::uint64_t most_rcvbuf_bytes = std::numeric_limits<std::int32_t>::max();  // SO_RCVBUF is an int

SetupResult<void> set_mtu(EndpointOptions& options, std::string_view text) {
    const auto size = parse_size(text);
    if (size && *size != 0 && (*size < longest_frame_bytes || *size > longest_datagram_bytes))
        return usage(fmt::format("{} is neither 0 (one frame a datagram) nor from 280 to 65507 bytes", in_quotes(text)));
    return put(size, options.mtu_bytes);
}

SetupResult<void> set_baud(EndpointOptions& options, std::string_view text) {
    if (text == "auto") {
        options.baud = 0;
        return {};
    }
    return put(parse_integer(text, 1, 30'000'000), options.baud);
}

SetupResult<void> set_flow(EndpointOptions& options, std::string_view text) {
    if (text == "xonxoff") return usage("'xonxoff' would remove bytes from MAVLink frames; type none or rtscts");
    if (text != "none" && text != "rtscts") return usage(fmt::format("{} is neither none nor rtscts", in_quotes(text)));
    options.flow = std::string(text);
    return {};
}

SetupResult<void> set_from(EndpointOptions& options, std::string_view text) {
    if (text != "oldest" && text != "newest")
        return usage(fmt::format("{} is neither oldest nor newest", in_quotes(text)));
    options.from_oldest = text == "oldest";
    return {};
}

SetupResult<void> set_speed(EndpointOptions& options, std::string_view text) {
    if (text == "max") {
        options.speed = std::numeric_limits<double>::infinity();
        return {};
    }
    auto speed = parse_positive(text);
    if (!speed) return usage(fmt::format("{} is neither max nor a number above 0", in_quotes(text)));
    return put(speed, options.speed);
}

SetupResult<void> set_group(EndpointOptions& options, std::string_view text) {
    if (!is_name(text))
        return usage(fmt::format("{} is not a group name (letters, digits, '_' and '-', at most 64)", in_quotes(text)));
    options.group = std::string(text);
    return {};
}

SetupResult<void> set_learn(EndpointOptions& options, std::string_view text) {
    if (text != "first" && text != "consistent")
        return usage(fmt::format("{} is neither first nor consistent", in_quotes(text)));
    options.learns_first = text == "first";
    return {};
}

SetupResult<void> set_heartbeat(EndpointOptions& options, std::string_view text) {
    if (text.find('/') != std::string_view::npos)
        return usage(
            fmt::format("{} is neither true nor false; the id of a router is heartbeat = \"SYS/COMP\" "
                        "in [router] of its configuration file",
                        in_quotes(text)));
    return put(parse_bool(text), options.heartbeat);
}

SetupResult<void> set_bind(EndpointOptions& options, std::string_view text) {
    return put(parse_host_port(text, {}), options.bind);
}

using O = EndpointOptions;

constexpr SchemeSet serial = set_of(Scheme::serial);
constexpr SchemeSet shm = set_of(Scheme::shm);
constexpr SchemeSet tlog = set_of(Scheme::tlog);
constexpr SchemeSet links = address_schemes | serial | shm;
constexpr SchemeSet all = links | tlog;

constexpr std::array options_table{
    Option{"name", all, "", set_text<&O::name>},
    Option{"group", links, "", set_group},
    Option{"group_mode", links, "all", set_group_mode},
    Option{"mtu", udp_schemes, "1280", set_mtu},
    Option{"idle", address_schemes, "",
           [](O& o, std::string_view t) {
               return put(
                   duration_of_at_least(t, std::chrono::milliseconds{1}, "type a long time, such as 1000h, for never"),
                   o.idle);
           }},
    Option{"queue_bytes", links, "1MiB",
           [](O& o, std::string_view t) {
               return put(size_within(t, longest_frame_bytes, most_queue_bytes), o.queue_bytes);
           }},
    Option{"queue_age", links, "1s for telemetry, 10s for the others",
           [](O& o, std::string_view t) {
               return put(duration_of_at_least(t, std::chrono::milliseconds{1}, "the minimum is 1 ms"), o.queue_age);
           }},
    Option{"max_rate", links, "", [](O& o, std::string_view t) { return put(parse_rates(t), o.max_rate); }},
    Option{"max_bytes", links, "",
           [](O& o, std::string_view t) {
               return put(size_within(t, longest_frame_bytes, most_queue_bytes), o.max_bytes_per_s);
           }},
    Option{"in_allow", links, "", set_filter<&O::in_allow>},
    Option{"in_block", links, "", set_filter<&O::in_block>},
    Option{"out_allow", links, "", set_filter<&O::out_allow>},
    Option{"out_block", links, "", set_filter<&O::out_block>},
    Option{"tap", links, "false", set_flag<&O::tap>},
    Option{"private", links, "false", set_flag<&O::is_private>},
    Option{"heartbeat", links, "", set_heartbeat},
    Option{"sign", links, "", set_text<&O::sign_key_file>},
    Option{"verify", links, "", set_text<&O::verify_key_file>},
    Option{"rcvbuf", udp_schemes, "32MiB",
           [](O& o, std::string_view t) { return put(size_within(t, 4096, most_rcvbuf_bytes), o.rcvbuf_bytes); }},
    Option{"max_peers",
           set_of(Scheme::udpin) | set_of(Scheme::udpbcast) | set_of(Scheme::udpmcast) | set_of(Scheme::tcpin), "256",
           [](O& o, std::string_view t) { return put(parse_integer(t, 1, 1'000'000), o.max_peers); }},
    Option{"iface", udp_schemes, "",
           [](O& o, std::string_view t) -> SetupResult<void> {
               if (t.size() > 15)
                   return usage(
                       fmt::format("{} is longer than the name of an interface can be (15 bytes)", in_quotes(t)));
               return set_text<&O::iface>(o, t);
           }},
    Option{"ttl", udp_schemes, "", [](O& o, std::string_view t) { return put(parse_integer(t, 0, 255), o.ttl); }},
    Option{"learn", links, "consistent", set_learn},
    Option{"trusted", set_of(Scheme::udpin) | set_of(Scheme::udpbcast), "false", set_flag<&O::trusted>},
    Option{"low_latency", address_schemes | serial, "false", set_flag<&O::low_latency>},
    Option{"required", links, "false", set_flag<&O::required>},
    Option{"reuse", set_of(Scheme::udpin), "false", set_flag<&O::reuse>},
    Option{"bind", set_of(Scheme::udpout) | set_of(Scheme::udpbcast) | set_of(Scheme::tcpout), "", set_bind},
    Option{"fixed", set_of(Scheme::udpbcast), "false", set_flag<&O::fixed>},
    Option{"baud", serial, "57600", set_baud},
    Option{"flow", serial, "none", set_flow},
    Option{"from", shm, "newest", set_from},
    Option{"lossless", shm, "", [](O& o, std::string_view t) { return put(parse_bool(t), o.lossless); }},
    Option{"foreign", shm, "false", set_flag<&O::foreign>},
    Option{"speed", tlog, "", set_speed},
    Option{"rotate_bytes", tlog, "", [](O& o, std::string_view t) { return put(parse_rotate_bytes(t), o.rotate_bytes); }},
    Option{"rotate_every", tlog, "", [](O& o, std::string_view t) { return put(parse_rotate_every(t), o.rotate_every); }},
};

constexpr auto option_names = [] {
    std::array<std::string_view, options_table.size()> names;
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = options_table[i].name;
    return names;
}();

const Option* find_option(std::string_view name) {
    const auto option = std::find_if(options_table.begin(), options_table.end(),
                                     [&](const Option& o) { return o.name == name; });
    return option == options_table.end() ? nullptr : &*option;
}

std::string schemes_text(SchemeSet schemes) {
    std::vector<std::string_view> names;
    for (std::size_t i = 0; i < scheme_names().size(); ++i)
        if ((schemes >> i & 1u) != 0) names.push_back(scheme_names()[i]);
    return fmt::format("{}", fmt::join(names, ", "));
}

// The option of `mavloom route` that sets a key of [router].
std::string option_of_key(std::string_view key) {
    std::string name = fmt::format("--{}", key);
    std::ranges::replace(name, '_', '-');
    return name;
}

// A hint for a key of [router] that was given as an endpoint option. It recognises the exact name, a near miss, and a
// unique prefix ("dedup").
std::string router_key_hint(std::string_view typed) {
    constexpr std::size_t least_beginning = 4;
    auto meant = nearest(typed, router_keys);
    if (meant.empty() && typed.size() >= least_beginning) {
        const auto begins = [&](std::string_view n) { return n.starts_with(typed); };
        if (std::ranges::count_if(router_keys, begins) == 1) meant = *std::ranges::find_if(router_keys, begins);
    }
    if (meant.empty()) return {};
    return fmt::format("; '{}' is a setting of the router: {}, or {} in [router]", meant, option_of_key(meant), meant);
}

}  // namespace

std::vector<std::string_view> option_names_for(Scheme scheme) {
    std::vector<std::string_view> names;
    for (const Option& option : options_table)
        if ((option.schemes & set_of(scheme)) != 0) names.push_back(option.name);
    return names;
}

std::string_view default_option_text(Scheme scheme, std::string_view name) noexcept {
    // TCP clients have no default.
    if (name == "idle" && (set_of(scheme) & udp_schemes) != 0) return "60";
    const Option* const option = find_option(name);
    return option == nullptr ? std::string_view{} : option->default_text;
}

SetupResult<std::uint64_t> parse_rotate_bytes(std::string_view text) {
    constexpr std::uint64_t least = 4096, most = std::uint64_t{1} << 40;
    return size_within(text, least, most);
}

SetupResult<std::chrono::nanoseconds> parse_rotate_every(std::string_view text) {
    return duration_of_at_least(text, std::chrono::seconds{1}, "segments are named by the second, so the minimum is 1s");
}

std::string_view group_mode_name(GroupMode mode) noexcept { return modes[static_cast<std::size_t>(mode)]; }

std::span<const std::string_view> endpoint_option_names() noexcept { return option_names; }

SetupResult<void> set_endpoint_option(Endpoint& endpoint, std::string_view key, std::string_view value) {
    const Option* const option = find_option(key);
    if (option == nullptr) {
        const auto names = option_names_for(endpoint.scheme);
        auto hint = did_you_mean(key, names);
        if (hint.empty()) hint = router_key_hint(key);
        if (hint.empty()) hint = fmt::format("; {} takes {}", scheme_name(endpoint.scheme), fmt::join(names, ", "));
        return usage(fmt::format("there is no option {}{}", in_quotes(key), hint));
    }
    if ((option->schemes & set_of(endpoint.scheme)) == 0)
        return usage(fmt::format("{} does not take the option '{}' ({})", scheme_name(endpoint.scheme), key,
                                 "it belongs to " + schemes_text(option->schemes)));
    auto done = option->set(endpoint.options, value);
    if (!done) return tl::unexpected(std::move(done.error()).within(fmt::format("option '{}'", key)));
    return {};
}

SetupResult<void> check_options(const Endpoint& endpoint) {
    const EndpointOptions& o = endpoint.options;
    if (o.has_group_mode && o.group.empty())
        return usage("group_mode= has no effect without group=NAME, the name of a group of redundant links");
    if (o.tap && o.heartbeat)
        return usage(
            "heartbeat= and tap=true exclude each other: a tap gets the frames of other links, and the router sends it "
            "none of its own");
    return {};
}

SetupResult<void> check_source_options(const Endpoint& endpoint) {
    const auto refused = [&](std::string_view key) {
        return usage(fmt::format("{}: '{}' applies to a recording that is written; this one is read",
                                 in_quotes(endpoint.label()), key));
    };
    if (endpoint.options.rotate_bytes != 0) return refused("rotate_bytes");
    if (endpoint.options.rotate_every != std::chrono::nanoseconds{}) return refused("rotate_every");
    return {};
}

}  // namespace mavloom::endpoint
