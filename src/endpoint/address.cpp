// SPDX-License-Identifier: MIT
// Hosts, ports, paths and percent escapes of endpoints. Checks syntax only: it resolves no names and opens no paths.
#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "mavloom/base/name.hpp"
#include "mavloom/endpoint/grammar.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::endpoint {

namespace {

bool is_ipv4(std::string_view text) {
    in_addr address;
    return text.size() < INET_ADDRSTRLEN && inet_pton(AF_INET, std::string(text).c_str(), &address) == 1;
}

// Accepts a zone, as in "fe80::1%eth0".
bool is_ipv6(std::string_view text) {
    const auto zone = text.find('%');
    if (zone != std::string_view::npos && zone + 1 == text.size()) return false;
    const std::string bare(text.substr(0, zone));
    in6_addr address;
    return bare.size() < INET6_ADDRSTRLEN && inet_pton(AF_INET6, bare.c_str(), &address) == 1;
}

bool is_digits_and_dots(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return (c >= '0' && c <= '9') || c == '.'; });
}

bool is_host_name(std::string_view text) {
    return !text.empty() && text.size() <= 253 && text.front() != '-' && text.front() != '.' &&
           std::all_of(text.begin(), text.end(), [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
                      c == '.' || c == '_';
           });
}

enum class AddressKind : std::uint8_t { other, any, multicast, limited_broadcast };

AddressKind kind_of(const std::string& host) {
    in_addr v4;
    if (inet_pton(AF_INET, host.c_str(), &v4) == 1) {
        const std::uint32_t value = ntohl(v4.s_addr);
        if (value == INADDR_ANY) return AddressKind::any;
        if (value == INADDR_BROADCAST) return AddressKind::limited_broadcast;
        return IN_MULTICAST(value) ? AddressKind::multicast : AddressKind::other;
    }
    in6_addr v6;
    if (inet_pton(AF_INET6, host.substr(0, host.find('%')).c_str(), &v6) != 1) return AddressKind::other;
    if (IN6_IS_ADDR_UNSPECIFIED(&v6)) return AddressKind::any;
    return IN6_IS_ADDR_MULTICAST(&v6) ? AddressKind::multicast : AddressKind::other;
}

std::string_view port_or_example(std::string_view port) { return port.empty() ? "14550" : port; }

tl::unexpected<SetupError> missing_host(std::string_view scheme, std::string_view port) {
    if (const SchemeRow* const row = find_scheme(scheme); row != nullptr && row->side == Side::listens)
        return usage(fmt::format(
            "the address to listen on is missing; type {0}://127.0.0.1:{1} (this machine only) or {0}://0.0.0.0:{1} "
            "(every interface)",
            scheme, port_or_example(port)));
    if (scheme.empty())
        return usage(fmt::format("the host is missing; for example, type 0.0.0.0:{}", port_or_example(port)));
    return usage(fmt::format("the host is missing; type {}://HOST:{}", scheme, port_or_example(port)));
}

std::string with_scheme(std::string_view scheme, std::string_view rest) {
    return scheme.empty() ? shown(rest) : fmt::format("{}://{}", scheme, shown(rest));
}

// The error for text without a port, or for an IPv6 address without brackets.
tl::unexpected<SetupError> no_port(std::string_view text, std::string_view scheme) {
    if (is_ipv6(text))
        return usage(fmt::format("an IPv6 address needs brackets and a port; type {}",
                                 with_scheme(scheme, fmt::format("[{}]:14550", text))));
    const bool only_port = !text.empty() &&
                           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (only_port) return missing_host(scheme, text);
    return usage(fmt::format("the port is missing; type {}",
                             with_scheme(scheme, fmt::format("{}:14550", text.empty() ? "HOST" : text))));
}

// The position of the colon before the port; npos if there is none outside brackets.
std::size_t port_colon(std::string_view text) {
    const auto bracket = text.rfind(']');
    const auto colon = text.rfind(':');
    return colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket)
               ? colon
               : std::string_view::npos;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

}  // namespace

SetupResult<std::string> percent_decoded(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            result += text[i];
            continue;
        }
        const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
        const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
        if (low < 0)
            return usage(
                fmt::format("{} is not a percent escape; type %25 for a percent sign", in_quotes(text.substr(i, 3))));
        if (high == 0 && low == 0) return usage("'%00' is not allowed here");
        result += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return result;
}

SetupResult<std::uint16_t> parse_port(std::string_view text) {
    const auto port = parse_integer(text, 0, 65535);
    if (!port) return usage(fmt::format("port {} is not a number from 1 to 65535", in_quotes(text)));
    return static_cast<std::uint16_t>(*port);
}

SetupResult<std::string> parse_host(std::string_view text, std::string_view scheme, std::string_view port) {
    if (text.empty()) return missing_host(scheme, port);
    const auto suffix = fmt::format(":{}", port_or_example(port));
    if (text.front() == '[') {
        if (text.back() != ']') return usage(fmt::format("the bracket of {} is not closed", in_quotes(text)));
        const auto inner = percent_decoded(text.substr(1, text.size() - 2));
        if (inner && is_ipv6(*inner)) return *inner;
        const auto raw = text.substr(1, text.size() - 2);
        // An unescaped zone: [fe80::1%eth0].
        if (is_ipv6(raw)) return std::string(raw);
        if (is_ipv4(raw) || is_host_name(raw))
            return usage(
                fmt::format("brackets are for IPv6 only; type {}", with_scheme(scheme, std::string(raw) + suffix)));
        return usage(fmt::format("{} is not an IPv6 address", in_quotes(text)));
    }
    if (is_ipv4(text)) return std::string(text);
    if (text.find(':') != std::string_view::npos) {
        if (is_ipv6(text))
            return usage(fmt::format("an IPv6 address needs brackets; type {}",
                                     with_scheme(scheme, fmt::format("[{}]{}", text, suffix))));
        return usage(fmt::format("{} is not a host", in_quotes(text)));
    }
    if (is_digits_and_dots(text))
        return usage(fmt::format("{} is not an IPv4 address; it has four numbers from 0 to 255", in_quotes(text)));
    if (is_host_name(text)) return std::string(text);
    return usage(fmt::format("{} is not a host name or address", in_quotes(text)));
}

SetupResult<HostPort> parse_host_port(std::string_view text, std::string_view scheme) {
    const auto colon = port_colon(text);
    if (colon == std::string_view::npos) return no_port(text, scheme);
    const auto port_text = text.substr(colon + 1);
    const auto slash = port_text.find('/');
    if (slash != std::string_view::npos)
        return usage(fmt::format("{} follows the port; type {}", in_quotes(port_text.substr(slash)),
                                 with_scheme(scheme, text.substr(0, colon + 1 + slash))));
    if (port_text.empty()) return no_port(text.substr(0, colon), scheme);
    // In "::1" the "1" is no port. In "::1:5760" the "5760" is meant as one, although the whole is also a valid
    // address.
    if (text.front() != '[' && is_ipv6(text) && !is_ipv6(text.substr(0, colon))) return no_port(text, scheme);
    const auto port = parse_port(port_text);
    if (!port) return tl::unexpected(port.error());
    auto host = parse_host(text.substr(0, colon), scheme, port_text);
    if (!host) return tl::unexpected(host.error());
    return HostPort{std::move(*host), *port};
}

SetupResult<void> check_address(Scheme scheme, const HostPort& address) {
    const SchemeRow& row = row_of(scheme);
    const auto kind = kind_of(address.host);
    if (address.port == 0 && row.side != Side::listens)
        return usage(fmt::format("port 0 is not a destination; {} needs a port from 1 to 65535", row.name));
    if (row.cast == Cast::group) {
        if (kind == AddressKind::multicast) return {};
        return usage(fmt::format("{} is not a multicast group; for example, type udpmcast://239.255.145.50:{}",
                                 in_quotes(address.host), address.port));
    }
    const bool udp = row.carrier == Carrier::udp;
    if (kind == AddressKind::multicast)
        return usage(
            udp ? fmt::format("{} is a multicast group; type udpmcast://{}", in_quotes(address.host), to_text(address))
                : fmt::format("{} is a multicast group; TCP needs the address of one machine", in_quotes(address.host)));
    if (row.side == Side::listens) {
        if (kind != AddressKind::limited_broadcast) return {};
        return usage(fmt::format("nothing can listen on 255.255.255.255; type {}://0.0.0.0:{}", row.name, address.port));
    }
    if (kind == AddressKind::any)
        return usage(
            fmt::format("{} is an address to listen on, not a destination; type {}://127.0.0.1:{} for this machine, "
                        "{}://{} to listen",
                        to_text(address), row.name, address.port, row.counterpart, to_text(address)));
    if (row.cast == Cast::broadcast) {
        if (address.host.find(':') == std::string::npos) return {};
        return usage(fmt::format("IPv6 has no broadcast; type udpmcast://[ff02::1]:{}", address.port));
    }
    if (kind == AddressKind::limited_broadcast)
        return usage(udp ? fmt::format("255.255.255.255 is for broadcast; type udpbcast://{}", to_text(address))
                         : "255.255.255.255 is for broadcast; TCP needs the address of one machine");
    return {};
}

SetupResult<void> check_path(Scheme scheme, std::string_view path) {
    if (printable(path) != path) return usage("a path must not contain control characters");
    const Form form = row_of(scheme).form;
    if (form == Form::address_and_path) {
        if (!path.empty() && path.front() != '/')
            return usage(fmt::format("the path {0} needs its slash; type /{0}", shown(path)));
        if (path.find_first_of(" ?#%") == std::string_view::npos) return {};
        return usage(fmt::format("the path {} has characters that a path here cannot have: blanks, ?, # and %",
                                 in_quotes(path)));
    }
    if (form == Form::ring) {
        if (is_name(path)) return {};
        return usage(fmt::format(
            "{} is not a ring name (letters, digits, '_' and '-', at most 64); for example, type shm://main",
            in_quotes(path)));
    }
    if (form == Form::recording) {
        if (path.empty())
            return usage("the path is missing; for example, type tlog://flight.tlog or tlog:///tmp/flight.tlog");
        if (path.back() == '/') return usage(fmt::format("{} is a folder; a recording is a file", in_quotes(path)));
        return {};
    }
    if (path.empty()) return usage("the device is missing; for example, type serial:///dev/ttyACM0?baud=57600");
    if (path.front() != '/')
        return usage(
            fmt::format("the device {} needs its full path; for example, type serial:///dev/ttyACM0", in_quotes(path)));
    const auto colon = path.rfind(':');
    const auto tail = colon == std::string_view::npos ? std::string_view{} : path.substr(colon + 1);
    if (const auto baud = parse_integer(tail, 1200, 30'000'000))  // by-path names end in short numbers
        return usage(
            fmt::format("the baud rate is an option; type serial://{}?baud={}", shown(path.substr(0, colon)), *baud));
    return {};
}

std::string to_text(const HostPort& address) {
    return address.host.find(':') == std::string::npos ? fmt::format("{}:{}", address.host, address.port)
                                                       : fmt::format("[{}]:{}", address.host, address.port);
}

SetupResult<std::vector<OptionText>> split_query(std::string_view query) {
    std::vector<OptionText> options;
    while (true) {
        const auto end = query.find('&');
        const auto item = query.substr(0, end);
        const auto equals = item.find('=');
        const auto key = item.substr(0, equals);
        if (key.empty()) return usage("an option is missing; options are written ?name=value&name=value");
        if (equals == std::string_view::npos)
            return usage(fmt::format("option {} has no value; type {}=VALUE", in_quotes(key), shown(key)));
        auto value = percent_decoded(item.substr(equals + 1));
        if (!value) return tl::unexpected(std::move(value.error()).within(fmt::format("option {}", in_quotes(key))));
        const auto same = [&](const OptionText& other) { return other.key == key; };
        if (std::any_of(options.begin(), options.end(), same))
            return usage(fmt::format("option {} is given twice", in_quotes(key)));
        options.push_back({std::string(key), std::move(*value)});
        if (end == std::string_view::npos) return options;
        query.remove_prefix(end + 1);
    }
}

SetupResult<HostPort> parse_server_address(std::string_view text) {
    auto address = parse_host_port(text, {});
    if (!address) return usage(fmt::format("{} is not HOST:PORT, as in 127.0.0.1:9090", in_quotes(text)));
    if (auto good = check_server_address(*address); !good) return tl::unexpected(std::move(good.error()));
    return address;
}

SetupResult<void> check_server_address(const HostPort& address) {
    if (auto good = check_address(Scheme::tcpin, address); !good) return good;
    if (net::Address::parse(address.host, address.port)) return {};
    return usage(fmt::format("{} is not a numeric address of this machine; for example, type 127.0.0.1:{}",
                             in_quotes(address.host), address.port));
}

}  // namespace mavloom::endpoint
