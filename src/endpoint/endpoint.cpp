// SPDX-License-Identifier: MIT
#include "mavloom/endpoint/endpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "mavloom/base/name.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/endpoint/checks.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::endpoint {

namespace {

constexpr auto spellings = [] {
    std::array<std::string_view, scheme_rows.size()> names;
    std::ranges::transform(scheme_rows, names.begin(), &SchemeRow::name);
    return names;
}();

// Schemes of other programs, and what to use instead. `udp:` is ambiguous: it listens in pymavlink, but sends in
// other programs.
struct Foreign {
    std::string_view scheme;
    std::string_view advice;
};

constexpr std::array foreign_schemes{
    Foreign{"udp", "does not state which side listens; type udpin://{0} to listen, udpout://{1} to send"},
    Foreign{"tcp", "does not state which side listens; type tcpout://{1} to connect, tcpin://{0} to listen"},
    Foreign{"udpserver", "is written udpin://{0}"},
    Foreign{"udps", "is written udpin://{0}"},
    Foreign{"udpclient", "is written udpout://{1}"},
    Foreign{"udpc", "is written udpout://{1}"},
    Foreign{"tcpserver", "is written tcpin://{0}"},
    Foreign{"tcps", "is written tcpin://{0}"},
    Foreign{"tcpclient", "is written tcpout://{1}"},
    Foreign{"tcpc", "is written tcpout://{1}"},
    Foreign{"ws", "does not state which side listens; type wsout://{1} to connect, wsin://{0} to listen"},
    Foreign{"wsserver", "is written wsin://{0}"},
    Foreign{
        "wss",
        "needs TLS, which Mavloom leaves to a proxy: let nginx or stunnel forward to wsin://127.0.0.1:PORT, or call "
        "one from wsout:// (docs/guide/endpoints.md#websocket)"},
    Foreign{"udpb", "is written udpbcast://{1}"},
    Foreign{"mcast", "is written udpmcast://239.255.145.50:14550"},
    Foreign{"uart", "is written serial:///dev/ttyACM0?baud=57600"},
    Foreign{"file", "is written tlog://PATH for a recording"},
};

// pymavlink's addresses without slashes. Its `tcp:` connects.
struct Short {
    std::string_view prefix;
    Scheme scheme;
};

constexpr std::array short_forms{Short{"udpin:", Scheme::udpin}, Short{"udpout:", Scheme::udpout},
                                 Short{"tcpin:", Scheme::tcpin}, Short{"tcp:", Scheme::tcpout}};

struct Split {
    Scheme scheme = Scheme::udpin;
    std::string_view rest;   // address or path
    std::string_view query;  // after the '?'
    bool has_query = false;
    // A path from the shell: percent signs are not escapes.
    bool plain_path = false;
    // The "57600" of "/dev/ttyACM0,57600".
    std::string_view comma_baud;
};

// Fills in the advice for "udp://:14540", with the host and port that the user typed, if any.
std::string advice_for(std::string_view advice, std::string_view rest) {
    while (!rest.empty() && rest.front() == '/') rest.remove_prefix(1);
    const auto path = rest.substr(std::min(rest.find('/'), rest.size()));  // of ws://HOST:PORT/PATH
    rest.remove_suffix(path.size());
    const auto colon = rest.rfind(':');
    const auto host = colon == std::string_view::npos ? std::string_view{} : rest.substr(0, colon);
    const auto tail = colon == std::string_view::npos ? rest : rest.substr(colon + 1);
    const bool has_port = parse_integer(tail, 0, 65535).has_value();
    const auto port = has_port ? tail : std::string_view("14550");
    const auto given = !host.empty() ? host : has_port ? std::string_view{} : rest;
    const bool anywhere = given.empty() || given == "0.0.0.0" || given == "[::]";
    const std::string listening = fmt::format("{}:{}{}", given.empty() ? "0.0.0.0" : shown(given), port, shown(path));
    const std::string calling = fmt::format("{}:{}{}", anywhere ? "HOST" : shown(given), port, shown(path));
    return fmt::format(fmt::runtime(advice), listening, calling);
}

tl::unexpected<SetupError> unknown_scheme(std::string_view scheme, std::string_view rest) {
    for (const Foreign& foreign : foreign_schemes)
        if (foreign.scheme == scheme) return usage(fmt::format("'{}' {}", scheme, advice_for(foreign.advice, rest)));
    return tl::unexpected(std::move(parse_scheme(scheme).error()));
}

// True if `text` begins with SCHEME://, known or not.
bool names_scheme(std::string_view text) {
    const auto slashes = text.find("://");
    return slashes != std::string_view::npos && text.substr(0, slashes).find('?') == std::string_view::npos &&
           text.front() != '/' && text.front() != '.';
}

bool is_short_form(std::string_view text) {
    return std::any_of(short_forms.begin(), short_forms.end(),
                       [&](const Short& form) { return text.starts_with(form.prefix); });
}

// The error for a path such as /tmp/ttyV0, which may be a device although it is not in /dev.
tl::unexpected<SetupError> path_without_scheme(std::string_view path, std::string_view query) {
    const auto options = query.empty() ? std::string() : fmt::format("?{}", shown(query));
    if (query.starts_with("baud=") || query.starts_with("flow="))
        return usage(fmt::format("it has no scheme; type serial://{}{}", shown(path), options));
    return usage(
        fmt::format("it has no scheme; type serial://{0}{1} if it is a device, tlog://{0}{1} if it is a recording",
                    shown(path), options));
}

// The error for "127.0.0.1:14550" and all other text without a scheme.
tl::unexpected<SetupError> no_scheme(std::string_view text, std::string_view query) {
    const auto first = text.substr(0, text.find(':'));  // of udp:14550, which also looks like a host with a port
    if (first != text && std::ranges::find(foreign_schemes, first, &Foreign::scheme) != foreign_schemes.end())
        return unknown_scheme(first, text.substr(first.size() + 1));
    const auto address = parse_host_port(text, {});
    if (address && check_address(Scheme::udpout, *address))
        return usage(
            fmt::format("it has no scheme; type udpout://{0} to send, udpin://{0} to listen, or "
                        "tcpout://{0} to connect",
                        text));
    if (address) return usage(fmt::format("it has no scheme; type udpin://{} to listen", text));
    const bool port = text.size() > 1 && text.front() == ':' && parse_port(text.substr(1)).has_value();
    if (port || (parse_integer(text, 1, 65535).has_value()))
        return usage(fmt::format("it has no scheme; type udpin://0.0.0.0:{} to listen", port ? text.substr(1) : text));
    const auto colon = text.find(':');
    if (colon != std::string_view::npos && colon != 0) {
        const auto prefix = text.substr(0, colon);
        if (find_scheme(prefix) != nullptr)
            return usage(fmt::format("the slashes are missing; type {}://{}", prefix, shown(text.substr(colon + 1))));
        return unknown_scheme(prefix, text.substr(colon + 1));
    }
    if (auto good = check_recording_name(text); !good) return tl::unexpected(std::move(good.error()));
    if (text.starts_with('/')) return path_without_scheme(text, query);
    if (text.find('/') != std::string_view::npos || text.find('.') != std::string_view::npos)
        return usage(fmt::format(
            "it has no scheme; type tlog://{0} if it is a recording, udpout://{0}:14550 if it is a host", shown(text)));
    return usage(fmt::format("it has no scheme; for example, type udpin://0.0.0.0:14550 or shm://{}",
                             is_name(text) ? shown(text) : "NAME"));
}

SetupResult<Split> split_url(Split result, std::string_view text) {
    const auto slashes = text.find("://");
    const auto scheme = text.substr(0, slashes);
    const SchemeRow* const found = find_scheme(scheme);
    result.rest.remove_prefix(slashes + 3);
    if (found == nullptr) return unknown_scheme(scheme, result.rest);
    result.scheme = found->scheme;
    return result;
}

// "/dev/ttyUSB0", or a path with a baud rate behind a comma.
SetupResult<Split> split_device(Split result) {
    result.scheme = Scheme::serial;
    result.plain_path = true;
    const auto comma = result.rest.rfind(',');
    if (comma == std::string_view::npos) return result;
    result.comma_baud = result.rest.substr(comma + 1);
    if (result.comma_baud.empty())
        return usage(fmt::format("the baud rate after the comma is missing; type {}57600", shown(result.rest)));
    result.rest = result.rest.substr(0, comma);
    return result;
}

SetupResult<Split> split(std::string_view text) {
    Split result;
    const auto query = query_of(text);
    result.has_query = query.has_value();
    result.query = query.value_or(std::string_view{});
    result.rest = query ? text.substr(0, text.size() - query->size() - 1) : text;
    if (names_scheme(text)) return split_url(result, text);
    if (!is_short_form(text) && is_recording_path(result.rest)) {
        result.scheme = Scheme::tlog;
        result.plain_path = true;
        return result;
    }
    const bool has_comma = result.rest.find(',') != std::string_view::npos;
    if (result.rest.starts_with("/dev/") || (result.rest.starts_with('/') && has_comma)) return split_device(result);
    const auto form = std::ranges::find_if(short_forms,
                                           [&](const Short& f) { return result.rest.starts_with(f.prefix); });
    if (form == std::end(short_forms)) return no_scheme(result.rest, result.query);
    result.scheme = form->scheme;
    result.rest.remove_prefix(form->prefix.size());
    return result;
}

SetupResult<void> set_place(Endpoint& endpoint, const Split& parts) {
    if (endpoint.has_address()) {
        auto rest = parts.rest;
        if (endpoint.row().form == Form::address_and_path) {
            const auto slash = std::min(rest.find('/'), rest.size());
            endpoint.path = std::string(rest.substr(slash));
            rest = rest.substr(0, slash);
            if (auto good = check_path(endpoint.scheme, endpoint.path); !good) return good;
        }
        auto address = parse_host_port(rest, scheme_name(endpoint.scheme));
        if (!address) return tl::unexpected(std::move(address.error()));
        endpoint.address = std::move(*address);
        return check_address(endpoint.scheme, endpoint.address);
    }
    auto path = parts.plain_path ? SetupResult<std::string>(std::string(parts.rest)) : percent_decoded(parts.rest);
    if (!path) return tl::unexpected(std::move(path.error()));
    endpoint.path = std::move(*path);
    return check_path(endpoint.scheme, endpoint.path);
}

SetupResult<void> set_options(Endpoint& endpoint, const Split& parts) {
    std::vector<OptionText> options;
    if (parts.has_query) {
        auto query = split_query(parts.query);
        if (!query) return tl::unexpected(std::move(query.error()));
        options = std::move(*query);
    }
    if (!parts.comma_baud.empty()) {
        const auto is_baud = [](const OptionText& option) { return option.key == "baud"; };
        if (std::any_of(options.begin(), options.end(), is_baud)) return usage("the baud rate is given twice");
        options.push_back({"baud", std::string(parts.comma_baud)});
    }
    for (const OptionText& option : options)
        if (auto done = set_endpoint_option(endpoint, option.key, option.value); !done) return done;
    return {};
}

SetupResult<Endpoint> parse(std::string_view text) {
    constexpr std::size_t longest = 8192;
    if (text.empty()) return usage("it is empty; for example, type udpin://0.0.0.0:14550");
    if (text.size() > longest) return usage(fmt::format("it is longer than {} bytes", longest));
    const auto parts = split(text);
    if (!parts) return tl::unexpected(parts.error());
    Endpoint endpoint;
    endpoint.scheme = parts->scheme;
    if (auto done = set_place(endpoint, *parts); !done) return tl::unexpected(std::move(done.error()));
    if (auto done = set_options(endpoint, *parts); !done) return tl::unexpected(std::move(done.error()));
    if (auto good = check_options(endpoint); !good) return tl::unexpected(std::move(good.error()));
    return endpoint;
}

}  // namespace

std::string schemes_text(Side side) {
    std::vector<std::string> names;
    for (const SchemeRow& row : scheme_rows)
        if (row.side == side) names.push_back(fmt::format("{}://", row.name));
    const std::string last = std::move(names.back());
    names.pop_back();
    return names.empty() ? last : fmt::format("{} or {}", fmt::join(names, ", "), last);
}

std::string form_of(const SchemeRow& row) {
    constexpr std::array<std::string_view, 5> forms{"HOST:PORT", "HOST:PORT[/PATH]", "/dev/NAME", "NAME", "PATH"};
    return fmt::format("{}://{}", row.name, forms[static_cast<std::size_t>(row.form)]);
}

SetupResult<Scheme> parse_scheme(std::string_view name) {
    if (const SchemeRow* const row = find_scheme(name)) return row->scheme;
    auto hint = did_you_mean(name, spellings);
    if (hint.empty()) hint = fmt::format("; there are {}", fmt::join(spellings, ", "));
    return usage(fmt::format("there is no scheme {}{}", in_quotes(name), hint));
}

std::optional<std::string_view> query_of(std::string_view endpoint) {
    const auto question = endpoint.find('?');
    if (question == std::string_view::npos) return std::nullopt;
    const bool is_path = !names_scheme(endpoint) && !is_short_form(endpoint) && !endpoint.starts_with("/dev/");
    if (is_path && is_recording_path(endpoint) && !is_recording_path(endpoint.substr(0, question))) return std::nullopt;
    return endpoint.substr(question + 1);
}

bool is_recording_path(std::string_view path) noexcept {
    const auto end = path.find_last_not_of("0123456789");  // of .tlog.12
    if (end != std::string_view::npos && end + 1 < path.size() && path[end] == '.') path = path.substr(0, end);
    constexpr std::string_view suffix = ".tlog";
    if (path.size() <= suffix.size()) return false;
    return std::ranges::equal(path.substr(path.size() - suffix.size()), suffix, {},
                              [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
}

std::filesystem::path canonical_path(const std::filesystem::path& path) {
    std::error_code unknown;
    const auto whole = std::filesystem::absolute(path, unknown);
    const auto real = std::filesystem::weakly_canonical(whole, unknown);
    return unknown ? path : real;
}

std::string Endpoint::label() const {
    if (!options.name.empty()) return options.name;
    return fmt::format("{}://{}{}", row().name, has_address() ? to_text(address) : "", path);
}

SetupResult<Endpoint> parse_endpoint(std::string_view text) {
    auto endpoint = parse(text);
    if (!endpoint)
        return tl::unexpected(std::move(endpoint.error()).within(fmt::format("endpoint {}", in_quotes(text))));
    return endpoint;
}

SetupResult<std::vector<Endpoint>> parse_endpoints(std::span<const std::string> texts, std::string_view option) {
    std::vector<Endpoint> endpoints;
    for (const auto& text : texts) {
        auto endpoint = parse_endpoint(text);
        if (!endpoint && option.empty()) return tl::unexpected(std::move(endpoint.error()));
        if (!endpoint) return tl::unexpected(std::move(endpoint.error()).within(option));
        endpoints.push_back(std::move(*endpoint));
    }
    return endpoints;
}

}  // namespace mavloom::endpoint
