// SPDX-License-Identifier: MIT
// The table of endpoint options: name, schemes that take it, default, and how to parse its text
// (docs/guide/endpoints.md).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "mavloom/base/name.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/dialect/terms.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::endpoint {

namespace {

using Set = SetupResult<void> (*)(EndpointOptions&, std::string_view);

struct Option {
    std::string_view name;
    OptionKinds kind;
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
constexpr std::uint64_t highest_bytes_per_s = std::uint64_t{1} << 40;
constexpr std::uint64_t max_rcvbuf_bytes = std::numeric_limits<std::int32_t>::max();  // SO_RCVBUF is an int

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
            fmt::format("{0} is neither true nor false; for the id of the router, type --heartbeat {1}, or heartbeat = "
                        "\"{1}\" in [router]",
                        in_quotes(text), shown(text)));
    return put(parse_bool(text), options.heartbeat);
}

SetupResult<void> set_bind(EndpointOptions& options, std::string_view text) {
    return put(parse_host_port(text, {}), options.bind);
}

// An origin as a browser sends it: scheme, host and port, without a path.
bool is_origin(std::string_view text) {
    const auto slashes = text.find("://");
    return text == "*" || ((text.starts_with("http://") || text.starts_with("https://")) && text.size() > slashes + 3 &&
                           text.find('/', slashes + 3) == std::string_view::npos);
}

SetupResult<void> set_origin(EndpointOptions& options, std::string_view text) {
    return put(parse_origins(text), options.origins);
}

template <std::optional<Faults> EndpointOptions::*member>
SetupResult<void> set_faults(EndpointOptions& options, std::string_view text) {
    return put(parse_faults(text), options.*member);
}

using O = EndpointOptions;

constexpr std::array options_table{
    Option{"name", takes::any, "", set_text<&O::name>},
    Option{"group", takes::link, "", set_group},
    Option{"group_mode", takes::link, "all", set_group_mode},
    Option{"mtu", takes::datagrams, "1280", set_mtu},
    Option{"idle", takes::address, "",
           [](O& o, std::string_view t) {
               return put(
                   duration_of_at_least(t, std::chrono::milliseconds{1}, "type a long time, such as 1000h, for never"),
                   o.idle);
           }},
    Option{"queue_bytes", takes::link, "1MiB",
           [](O& o, std::string_view t) {
               return put(size_within(t, longest_frame_bytes, O::max_queue_bytes), o.queue_bytes);
           }},
    Option{"queue_age", takes::link, "1s for telemetry, 10s for the others",
           [](O& o, std::string_view t) {
               return put(duration_of_at_least(t, std::chrono::milliseconds{1}, "the minimum is 1 ms"), o.queue_age);
           }},
    Option{"max_rate", takes::link, "", [](O& o, std::string_view t) { return put(parse_rates(t), o.max_rate); }},
    Option{"max_bytes", takes::link, "",
           [](O& o, std::string_view t) {
               return put(size_within(t, longest_frame_bytes, highest_bytes_per_s), o.max_bytes_per_s);
           }},
    Option{"in_allow", takes::link, "", set_filter<&O::in_allow>},
    Option{"in_block", takes::link, "", set_filter<&O::in_block>},
    Option{"out_allow", takes::link, "", set_filter<&O::out_allow>},
    Option{"out_block", takes::link, "", set_filter<&O::out_block>},
    Option{"tap", takes::link, "false", set_flag<&O::tap>},
    Option{"private", takes::link, "false", set_flag<&O::is_private>},
    Option{"heartbeat", takes::link, "", set_heartbeat},
    Option{"sign", takes::link, "", set_text<&O::sign_key_file>},
    Option{"sign_all", takes::link, "false", set_flag<&O::signs_own>},
    Option{"verify", takes::link, "", set_text<&O::verify_key_file>},
    Option{"rcvbuf", takes::datagrams, "32MiB",
           [](O& o, std::string_view t) { return put(size_within(t, 4096, max_rcvbuf_bytes), o.rcvbuf_bytes); }},
    Option{"max_peers", takes::peers, "256",
           [](O& o, std::string_view t) { return put(parse_integer(t, 1, 1'000'000), o.max_peers); }},
    Option{"iface", takes::datagrams, "",
           [](O& o, std::string_view t) -> SetupResult<void> {
               if (t.size() > 15)
                   return usage(
                       fmt::format("{} is longer than the name of an interface can be (15 bytes)", in_quotes(t)));
               return set_text<&O::iface>(o, t);
           }},
    Option{"ttl", takes::datagrams, "", [](O& o, std::string_view t) { return put(parse_integer(t, 0, 255), o.ttl); }},
    Option{"learn", takes::link, "consistent", set_learn},
    Option{"trusted", takes::peers, "", [](O& o, std::string_view t) { return put(parse_bool(t), o.trusted); }},
    Option{"low_latency", takes::low_latency, "false", set_flag<&O::low_latency>},
    Option{"required", takes::link, "false", set_flag<&O::required>},
    Option{"reuse", takes::reuse, "false", set_flag<&O::reuse>},
    Option{"bind", takes::bind, "", set_bind},
    Option{"fixed", takes::fixed, "false", set_flag<&O::fixed>},
    Option{"origin", takes::origin, "", set_origin},
    Option{"baud", takes::device, "57600", set_baud},
    Option{"flow", takes::device, "none", set_flow},
    Option{"from", takes::ring, "newest", set_from},
    Option{"lossless", takes::ring, "", [](O& o, std::string_view t) { return put(parse_bool(t), o.lossless); }},
    Option{"foreign", takes::ring, "false", set_flag<&O::foreign>},
    Option{"fault", takes::fault, "", set_faults<&O::fault>},
    Option{"in_fault", takes::fault, "", set_faults<&O::in_fault>},
    Option{"out_fault", takes::fault, "", set_faults<&O::out_fault>},
    Option{"fault_seed", takes::fault, "1",
           [](O& o, std::string_view t) { return put(parse_fault_seed(t), o.fault_seed); }},
    Option{"speed", takes::recording, "", set_speed},
    Option{"rotate_bytes", takes::recording, "",
           [](O& o, std::string_view t) { return put(parse_rotate_bytes(t), o.rotate_bytes); }},
    Option{"rotate_every", takes::recording, "",
           [](O& o, std::string_view t) { return put(parse_rotate_every(t), o.rotate_every); }},
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

bool takes_option(Scheme scheme, const Option& option) noexcept { return (row_of(scheme).options & option.kind) != 0; }

std::string schemes_with(const Option& option) {
    std::vector<std::string_view> names;
    for (const SchemeRow& row : scheme_rows)
        if ((row.options & option.kind) != 0) names.push_back(row.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

// A hint for an unknown option: the nearest one, even if the scheme does not take it. Of two that are as near, one that
// the scheme takes.
std::string option_hint(Scheme scheme, std::string_view typed) {
    auto names = option_names_for(scheme);
    names.insert(names.end(), option_names.begin(), option_names.end());
    const auto meant = nearest(typed, names);
    if (meant.empty()) return {};
    const Option& option = *find_option(meant);
    if (takes_option(scheme, option)) return fmt::format(", did you mean '{}'?", meant);
    return fmt::format("; '{}' belongs to {}, not to {}", meant, schemes_with(option), scheme_name(scheme));
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
    constexpr std::size_t min_beginning = 4;
    auto meant = nearest(typed, router_keys);
    if (meant.empty() && typed.size() >= min_beginning) {
        const auto begins = [&](std::string_view n) { return n.starts_with(typed); };
        if (std::ranges::count_if(router_keys, begins) == 1) meant = *std::ranges::find_if(router_keys, begins);
    }
    if (meant.empty()) return {};
    return fmt::format("; '{}' is a setting of the router: {}, or {} in [router]", meant, option_of_key(meant), meant);
}

}  // namespace

SetupResult<std::vector<std::string>> parse_origins(std::string_view text) {
    std::vector<std::string> origins;
    auto parsed = dialect::for_each_term(text, [&](std::string_view term) -> SetupResult<void> {
        if (term.ends_with('/')) term.remove_suffix(1);  // as browsers show it
        if (!is_origin(term) || printable(term) != term)
            return usage(fmt::format(
                "{} is not the origin of a web page, such as https://app.example.com; * allows all", in_quotes(term)));
        origins.emplace_back(term);
        return {};
    });
    if (!parsed) return tl::unexpected(std::move(parsed.error()));
    return origins;
}

std::vector<std::string_view> option_names_for(Scheme scheme) {
    std::vector<std::string_view> names;
    for (const Option& option : options_table)
        if (takes_option(scheme, option)) names.push_back(option.name);
    return names;
}

std::string_view default_option_text(Scheme scheme, std::string_view name) noexcept {
    // TCP clients have no default.
    if (name == "idle" && row_of(scheme).carrier == Carrier::udp) return "60";
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
        auto hint = option_hint(endpoint.scheme, key);
        if (hint.empty()) hint = router_key_hint(key);
        if (hint.empty())
            hint = fmt::format("; {} takes {}", scheme_name(endpoint.scheme),
                               fmt::join(option_names_for(endpoint.scheme), ", "));
        return usage(fmt::format("there is no option {}{}", in_quotes(key), hint));
    }
    if (!takes_option(endpoint.scheme, *option))
        return usage(fmt::format("{} does not take the option '{}' ({})", scheme_name(endpoint.scheme), key,
                                 "it belongs to " + schemes_with(*option)));
    auto done = option->set(endpoint.options, value);
    if (!done) return tl::unexpected(std::move(done.error()).within(fmt::format("option '{}'", key)));
    return {};
}

SetupResult<void> check_options(const Endpoint& endpoint) {
    const EndpointOptions& o = endpoint.options;
    if (o.has_group_mode && o.group.empty())
        return usage("group_mode= has no effect without group=NAME, the name of a group of redundant links");
    if (o.signs_own && o.sign_key_file.empty())
        return usage("sign_all= has no effect without sign=KEYFILE, the key to sign with");
    if (o.tap && o.heartbeat)
        return usage(
            "heartbeat= and tap=true exclude each other: a tap gets the frames of other links, and the router sends it "
            "none of its own");
    if (o.fault_seed && !o.fault && !o.in_fault && !o.out_fault)
        return usage("fault_seed= has no effect without fault=, in_fault= or out_fault=");
    for (const Faults* const faults : {&inward_faults(o), &outward_faults(o)})
        if (auto good = check_faults(*faults, endpoint.row()); !good) return good;
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
