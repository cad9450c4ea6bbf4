// SPDX-License-Identifier: MIT
#include "places.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <random>
#include <vector>

#include "mavloom/net/port_holder.hpp"
#include "mavloom/net/udp.hpp"

namespace mavloom::app::demo_parts {

namespace {

// Below the ports that the kernel chooses for others (32768 and up), so that nobody takes them until they are bound.
constexpr std::uint16_t first_port = 10'240, last_port = 32'767;

net::Address loopback(std::uint16_t port) { return *net::Address::parse("127.0.0.1", port); }

// Binds a port that is free.
SetupResult<net::UdpSocket> open_somewhere(std::random_device& random) {
    constexpr int max_tries = 100;
    std::uniform_int_distribution<std::uint16_t> ports(first_port, last_port);
    auto socket = net::UdpSocket::open(loopback(ports(random)), {});
    for (int i = 1; !socket && i < max_tries; ++i) socket = net::UdpSocket::open(loopback(ports(random)), {});
    return socket;
}

}  // namespace

// All sockets stay open until each port is chosen, so that no two are the same.
SetupResult<Places> free_places() {
    Places places;
    std::random_device random;
    std::vector<net::UdpSocket> open;
    for (auto* const port : {&places.vehicle, &places.router, &places.listener, &places.station, &places.relay}) {
        auto socket = open_somewhere(random);
        if (!socket) return tl::unexpected(std::move(socket.error()));
        *port = socket->local().port();
        open.push_back(std::move(*socket));
    }
    places.name = fmt::format("demo-{}", ::getpid());
    return places;
}

SetupResult<Places> usual_places() {
    Places places;
    std::random_device random;
    const auto socket = open_somewhere(random);
    if (!socket) return tl::unexpected(SetupError(socket.error()));
    places.relay = socket->local().port();
    return places;
}

SetupResult<void> check_free(std::uint16_t port) {
    auto socket = net::UdpSocket::open(loopback(port), {});
    if (socket) return {};
    return net::BindErrors(net::Transport::udp).complete(std::move(socket.error()), loopback(port));
}

}  // namespace mavloom::app::demo_parts
