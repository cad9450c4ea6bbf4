// SPDX-License-Identifier: MIT
// Finds endpoints that would send to a port of this program.
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <climits>

#include "mavloom/endpoint/checks.hpp"
#include "mavloom/net/interfaces.hpp"

namespace mavloom::endpoint {

namespace {

// Returns true if `host` is a name of this machine, as far as that is known without a lookup.
bool is_own_name(const std::string& host) {
    std::array<char, HOST_NAME_MAX + 1> own{};
    return ::gethostname(own.data(), own.size() - 1) == 0 && host == own.data();
}

// Returns true if a socket bound to `bound` receives datagrams for `host`. A socket on 0.0.0.0 receives only IPv4; one
// on :: receives both.
bool hears(const std::string& bound, const std::string& host, bool broadcast) {
    const auto here = net::Address::parse(bound == "localhost" ? "127.0.0.1" : bound, 0);
    const auto there = net::Address::parse(host == "localhost" ? "127.0.0.1" : host, 0);
    if (!here) return bound == host;                         // only a look-up finds the address of a name
    if (!there) return here->is_any() && is_own_name(host);  // Debian's look-up of its own name finds 127.0.1.1
    if (!here->is_any()) return *here == *there;
    if (here->is_v4() && !there->is_v4()) return false;
    return broadcast || there->is_loopback() || net::OwnAddresses().contains(*there, mono_now());
}

}  // namespace

bool leads_back(const Endpoint& source, std::uint16_t port, const Endpoint& to) {
    if (source.is_ring()) return to.is_ring() && to.path == source.path;
    const bool broadcast = to.row().cast == Cast::broadcast;
    return source.listens() && to.row().counterpart == source.row().name && port == to.address.port &&
           hears(source.address.host, to.address.host, broadcast);
}

static bool calls(const Endpoint& from, const Endpoint& source) {
    return from.row().cast == Cast::one && leads_back(source, source.address.port, from);
}

SetupResult<void> check_not_called(const Endpoint& a, const Endpoint& b) {
    const bool a_calls_b = calls(a, b);
    if (!a_calls_b && !calls(b, a)) return {};
    const Endpoint &caller = a_calls_b ? a : b, &listener = a_calls_b ? b : a;
    return setup_error(SetupCode::usage,
                       fmt::format("{} is where {} listens: the router would send to itself; choose another port",
                                   caller.label(), listener.label()));
}

}  // namespace mavloom::endpoint
