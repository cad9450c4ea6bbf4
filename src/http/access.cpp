// SPDX-License-Identifier: MIT
#include "http/access.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>

#include "mavloom/base/text.hpp"

namespace mavloom::http {

std::string_view host_name_in(std::string_view host) {
    const auto bracket = host.find(']');
    if (host.starts_with('[')) return host.substr(1, bracket == std::string_view::npos ? 0 : bracket - 1);
    host = host.substr(0, host.find(':'));
    return host.ends_with('.') ? host.substr(0, host.size() - 1) : host;
}

std::optional<std::string_view> host_of_origin(std::string_view origin) {
    for (const std::string_view scheme : {"http://", "https://"})
        if (same_letters(origin.substr(0, scheme.size()), scheme)) return origin.substr(scheme.size());
    return std::nullopt;
}

std::pair<std::string_view, std::string_view> split_target(std::string_view target) {
    if (!target.starts_with('/')) return {};
    const auto end = target.find('?');
    return {target.substr(0, end), end == std::string_view::npos ? std::string_view() : target.substr(end + 1)};
}

static std::string name_of_this_machine() {
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

Allowed::Allowed(Access access) : access_(std::move(access)), names_(access_.hosts) {
    names_.emplace_back("localhost");
    const auto own = access_.own_names ? name_of_this_machine() : "";
    if (!own.empty()) names_.insert(names_.end(), {own, own + ".local"});
}

bool Allowed::has_host(std::string_view host, const net::Address& local, MonoTime now) {
    if (access_.any_host || host.empty()) return true;
    const auto name = host_name_in(host);
    const auto is_name = [&](const std::string& known) { return same_letters(name, known); };
    return std::ranges::any_of(names_, is_name) || is_own_address(name, local, now);
}

bool Allowed::is_own_address(std::string_view name, const net::Address& local, MonoTime now) {
    const auto address = net::Address::parse(name, 0);
    if (!address) return false;
    if (address->is_loopback() || address->unmapped() == local.unmapped().with_port(0)) return true;
    return access_.own_names && own_.contains(*address, now);
}

bool Allowed::is_listed(std::string_view origin) const {
    const auto is_this = [&](const std::string& listed) { return listed == "*" || same_letters(listed, origin); };
    return std::ranges::any_of(access_.origins, is_this);
}

// A page of this server has the origin http://HOST, or https://HOST behind a proxy. Only if the Host header is checked,
// HOST is not the name of somebody else's page.
bool Allowed::has_origin(std::string_view origin, std::string_view host) const {
    if (origin.empty() || is_listed(origin)) return true;
    const auto own = access_.any_host || host.empty() ? std::nullopt : host_of_origin(origin);
    return own && same_letters(*own, host);
}

}  // namespace mavloom::http
