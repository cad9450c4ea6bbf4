// SPDX-License-Identifier: MIT
// Which Host and Origin headers are allowed, and which path a request has. Pure, except that `Allowed` reads the names
// and addresses of this machine.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/http/server.hpp"
#include "mavloom/net/address.hpp"
#include "mavloom/net/interfaces.hpp"

namespace mavloom::http {

// Returns the name in a Host header: without port, brackets and the dot that may end a full name.
[[nodiscard]] std::string_view host_name_in(std::string_view host);
// Returns what follows "http://" or "https://" in an Origin header. Nothing for "null" and other schemes.
[[nodiscard]] std::optional<std::string_view> host_of_origin(std::string_view origin);
// Splits a request's target into path and query. The path is empty if the target does not begin with '/'.
[[nodiscard]] std::pair<std::string_view, std::string_view> split_target(std::string_view target);

// One thread.
class Allowed {
public:
    explicit Allowed(Access access);

    // `local`: the address that the client is connected to.
    [[nodiscard]] bool has_host(std::string_view host, const net::Address& local, MonoTime now);
    // An empty `origin` or `host`: there is no such header.
    [[nodiscard]] bool has_origin(std::string_view origin, std::string_view host) const;
    // Whether `Access::origins` allows it.
    [[nodiscard]] bool is_listed(std::string_view origin) const;
    // Whether there may be such an origin.
    [[nodiscard]] bool has_list() const noexcept { return !access_.origins.empty(); }

private:
    [[nodiscard]] bool is_own_address(std::string_view name, const net::Address& local, MonoTime now);

    Access access_;
    std::vector<std::string> names_;
    net::OwnAddresses own_;
};

}  // namespace mavloom::http
