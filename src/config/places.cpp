// SPDX-License-Identifier: MIT
#include "config/places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "mavloom/endpoint/grammar.hpp"
#include "mavloom/net/address.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::config {

using namespace detail;

namespace {

// A port that an endpoint stays bound to for its lifetime.
struct Bound {
    // `shared`: other sharing endpoints may bind the same port.
    bool tcp, shared;
    endpoint::HostPort address;
    // `iface`: empty if the port is bound on all interfaces.
    std::string_view iface, label;
    std::uint32_t line;
};

std::optional<Bound> bound_by(const endpoint::Endpoint& endpoint, const Section& section) {
    static constexpr std::array<std::string_view, 2> own{"port", "url"};
    static constexpr std::array<std::string_view, 1> bind{"bind"};
    const endpoint::SchemeRow& row = endpoint.row();
    const bool is_tcp = row.carrier == endpoint::Carrier::tcp;
    const auto& o = endpoint.options;
    if (row.cast == endpoint::Cast::group)  // joins its group on iface, but binds to no interface
        return Bound{false, true, endpoint.address, {}, section.label, line_of(section, own)};
    if (endpoint.listens())
        return Bound{is_tcp, false, endpoint.address, o.iface, section.label, line_of(section, own)};
    if (!is_tcp && o.bind && o.bind->port != 0)
        return Bound{false, false, *o.bind, o.iface, section.label, line_of(section, bind)};
    return std::nullopt;
}

// A socket on :: also takes the IPv4 port.
bool takes_all_of(const net::Address& any, const std::optional<net::Address>& other) {
    return any.is_any() && (any.is_v6() || !other || other->is_v4());
}

bool overlap(const std::string& a, const std::string& b) {
    const auto first = net::Address::parse(a == "localhost" ? "127.0.0.1" : a, 0);
    const auto second = net::Address::parse(b == "localhost" ? "127.0.0.1" : b, 0);
    if (first && takes_all_of(*first, second)) return true;
    if (second && takes_all_of(*second, first)) return true;
    return first && second ? *first == *second : a == b;
}

bool meet(const Bound& a, const Bound& b) {
    const bool other_interface = !a.iface.empty() && !b.iface.empty() && a.iface != b.iface;
    return a.tcp == b.tcp && a.address.port == b.address.port && !(a.shared && b.shared) && !other_interface &&
           overlap(a.address.host, b.address.host);
}

}  // namespace

std::uint32_t detail::line_of(const Section& section, std::span<const std::string_view> keys) {
    for (const auto key : keys) {
        const auto setting = std::ranges::find(section.settings, key, &Setting::key);
        if (setting != section.settings.end() && setting->origin == Origin::file) return setting->line;
    }
    return 0;
}

SetupResult<void> detail::check_recordings(const Config& config, std::string_view file_name) {
    std::set<std::filesystem::path> paths;
    const auto is_new = [&paths](const std::string& path) {
        return paths.insert(endpoint::canonical_path(path)).second;
    };
    if (!config.record.path.empty()) (void)is_new(config.record.path);
    return each_endpoint(config, [&](const endpoint::Endpoint& endpoint, const Section& section) -> SetupResult<void> {
        static constexpr std::array<std::string_view, 2> own{"path", "url"};
        if (!endpoint.is_recording() || is_new(endpoint.path)) return {};
        return setup_error(SetupCode::bad_input, fmt::format("{}:{}: another recording already writes to {}", file_name,
                                                             line_of(section, own), in_quotes(endpoint.path)));
    });
}

SetupResult<void> check_ports(const Config& config, std::string_view file_name) {
    std::vector<Bound> all;
    return each_endpoint(config, [&](const endpoint::Endpoint& endpoint, const Section& section) -> SetupResult<void> {
        const auto bound = bound_by(endpoint, section);
        if (!bound) return {};
        const auto other = std::ranges::find_if(all, [&](const Bound& b) { return meet(b, *bound); });
        if (other != all.end())
            return setup_error(SetupCode::bad_input,
                               fmt::format("{}:{}: {} binds {} port {}, which {} in line {} already uses", file_name,
                                           bound->line, in_quotes(bound->label), bound->tcp ? "TCP" : "UDP",
                                           bound->address.port, in_quotes(other->label), other->line));
        all.push_back(*bound);
        return {};
    });
}

SetupResult<void> check_key_files(const Config& config, std::string_view file_name) {
    return each_endpoint(config, [&](const endpoint::Endpoint& endpoint, const Section& section) -> SetupResult<void> {
        const std::array<std::pair<std::string_view, const std::string*>, 2> files{
            {{"sign", &endpoint.options.sign_key_file}, {"verify", &endpoint.options.verify_key_file}}};
        for (const auto& [key, file] : files) {
            if (file->empty()) continue;
            if (const auto loaded = wire::SigningKey::load(*file); !loaded)
                return setup_error(SetupCode::bad_input,
                                   fmt::format("{}:{}: {}: {}", file_name, line_of(section, std::array{key}), key,
                                               loaded.error().text));
        }
        return {};
    });
}

}  // namespace mavloom::config
