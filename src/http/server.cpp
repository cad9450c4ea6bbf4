// SPDX-License-Identifier: MIT
#include "mavloom/http/server.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "http/connection.hpp"
#include "mavloom/net/fd.hpp"
#include "mavloom/net/port_holder.hpp"
#include "mavloom/net/tcp.hpp"

namespace mavloom::http {

namespace {

constexpr std::size_t max_with_few_descriptors = 4;

using StatePointer = std::shared_ptr<ServerState>;

std::shared_ptr<Connection> find_idlest(const ServerState& server) {
    std::shared_ptr<Connection> idlest;
    for (const auto& weak : server.connections)
        if (auto one = weak.lock(); idlest == nullptr || one->idle_since() < idlest->idle_since())
            idlest = std::move(one);
    return idlest;
}

void displace(ServerState& server, const std::shared_ptr<Connection>& one) {
    one->hang_up();
    std::erase_if(server.connections, [&](const auto& other) { return other.lock() == one; });
    server.counters.add(Count::displaced);
}

// Disconnects the clients that have been idle longest, if there are too many. Returns false if all others await
// answers.
bool make_room(ServerState& server, int any_descriptor) {
    const auto& limits = server.options.limits;
    const bool has_few = net::few_descriptors_left(any_descriptor);
    const auto most = has_few ? std::min(max_with_few_descriptors, limits.clients) : limits.clients;
    const auto max_in_grace = has_few ? most : limits.clients + limits.web_sockets;
    std::erase_if(server.connections, [](const auto& one) { return one.expired(); });
    while (server.connections.size() >= most) {
        const auto idlest = find_idlest(server);
        if (idlest == nullptr || idlest->is_busy()) return false;
        const bool is_in_grace = std::chrono::steady_clock::now() - idlest->idle_since() < limits.grace;
        if (is_in_grace && server.connections.size() < max_in_grace) return true;
        displace(server, idlest);
    }
    return true;
}

void take(const StatePointer& server, Tcp::socket socket) {
    server->counters.add(Count::connections);
    if (!make_room(*server, socket.native_handle())) {
        server->counters.add(Count::turned_away);
        return Connection::turn_away(socket);
    }
    const auto connection = std::make_shared<Connection>(std::move(socket), server);
    server->connections.push_back(connection);
    connection->read();
}

void accept(const StatePointer& server, Listener& listener);

void accept_later(const StatePointer& server, Listener& listener) {
    listener.retry.expires_after(std::chrono::seconds(1));
    listener.retry.async_wait([server, &listener](error_code error) {
        if (!error) accept(server, listener);
    });
}

void accept(const StatePointer& server, Listener& listener) {
    if (!listener.acceptor.is_open()) return;  // the server has ended
    listener.acceptor.async_accept([server, &listener](error_code error, Tcp::socket socket) {
        if (!listener.acceptor.is_open()) return;
        if (error) return accept_later(server, listener);  // for example, no free descriptors
        take(server, std::move(socket));
        accept(server, listener);
    });
}

void shut(ServerState& server) {
    error_code ignored;
    for (const auto& listener : server.listeners) {
        listener->acceptor.close(ignored);
        listener->retry.cancel();
    }
    for (const auto& weak : server.connections)
        if (const auto one = weak.lock()) one->hang_up();
    for (const auto& weak : server.open)
        if (const auto one = weak.lock()) one->abandon();
    server.waiting.clear();
    server.options.routes.clear();
    server.options.on_refused = {};
    server.options.streams.clear();
    server.options.web_sockets.clear();
}

// The kernel's errors, with the holder of a port that is in use.
SetupResult<net::Address> open(ServerState& server, asio::io_context& context, const net::Address& address) {
    auto opened = net::TcpListener::open(address, server.options.v6_only);
    if (!opened) return net::BindErrors(net::Transport::tcp).complete(std::move(opened.error()), address);
    const int copy = ::fcntl(opened->fd(), F_DUPFD_CLOEXEC, 0);
    if (copy < 0) return system_error(fmt::format("cannot listen on TCP {}", address.text()), errno);
    auto& listener = *server.listeners.emplace_back(std::make_unique<Listener>(context));
    listener.acceptor.assign(address.is_v4() ? Tcp::v4() : Tcp::v6(), copy);
    return opened->local();
}

}  // namespace

SetupResult<Server> Server::listen(const Thread& thread, ServerOptions options) {
    const auto& core = thread.core();
    std::vector<net::Address> addresses;
    try {
        const auto state = std::make_shared<ServerState>(core, std::move(options));
        for (const auto& wanted : state->options.addresses) {
            const bool shares_port = wanted.port() == 0 && !addresses.empty();
            const auto address = shares_port ? wanted.with_port(addresses.front().port()) : wanted;
            auto opened = open(*state, core->context(), address);
            if (!opened) return tl::unexpected(std::move(opened.error()));
            addresses.push_back(*opened);
        }
        asio::post(core->context(), [state] {
            for (const auto& listener : state->listeners) accept(state, *listener);
        });
        return Server(core, state, std::move(addresses));
    } catch (const boost::system::system_error& error) {
        return system_error("http server", error.code().value());
    }
}

Server::Server(std::shared_ptr<Core> core, std::shared_ptr<ServerState> state,
               std::vector<net::Address> addresses) noexcept
    : core_(std::move(core)), state_(std::move(state)), addresses_(std::move(addresses)) {}
Server::Server(Server&&) noexcept = default;
Server::~Server() {
    if (state_) core_->run_and_wait([this] { shut(*state_); });
}

const Counters& Server::counters() const noexcept { return state_->counters; }

}  // namespace mavloom::http
