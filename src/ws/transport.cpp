// SPDX-License-Identifier: MIT
#include "mavloom/ws/transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "mavloom/endpoint/checks.hpp"
#include "mavloom/endpoint/grammar.hpp"
#include "mavloom/http/client.hpp"
#include "mavloom/http/server.hpp"
#include "ws/sessions.hpp"

namespace mavloom::ws {

namespace {

std::string path_of(const endpoint::Endpoint& endpoint) { return endpoint.path.empty() ? "/" : endpoint.path; }

// Both sides share this.
class WebSockets : public link::Transport {
public:
    WebSockets(const endpoint::Endpoint& endpoint, std::shared_ptr<link::Mailbox> mailbox)
        : endpoint_(endpoint), mailbox_(mailbox), sessions_(std::make_shared<Sessions>(std::move(mailbox))) {}
    std::size_t send(link::PeerNumber peer, std::span<const iovec> frames) override {
        return sessions_->send(peer, frames);
    }
    void close(link::PeerNumber peer, std::string_view why) override { sessions_->close(peer, why); }
    void resume() override { sessions_->resume(); }

protected:
    // Starts the thread at the first call.
    SetupResult<void> start() {
        if (thread_) return {};
        auto thread = http::Thread::start();
        if (!thread) return tl::unexpected(std::move(thread.error()));
        thread_.emplace(std::move(*thread));
        return {};
    }

    const endpoint::Endpoint endpoint_;
    const std::shared_ptr<link::Mailbox> mailbox_;
    const std::shared_ptr<Sessions> sessions_;
    std::optional<http::Thread> thread_;
};

class WebSocketServer final : public WebSockets {
public:
    using WebSockets::WebSockets;

    SetupResult<void> open(const std::vector<net::Address>& addresses) override {
        if (auto done = start(); !done) return done;
        auto server = http::Server::listen(*thread_, options(addresses));
        if (!server) return tl::unexpected(std::move(server.error()));
        server_.emplace(std::move(*server));
        return {};
    }
    [[nodiscard]] std::uint16_t local_port() const override {
        return server_ ? server_->addresses().front().port() : std::uint16_t{0};
    }
    void refresh(link::EndpointCounters& counters) override {
        if (!server_) return;
        const auto sum = [&](std::initializer_list<http::Count> of) {
            std::uint64_t all = 0;
            for (const auto one : of) all += server_->counters().value(one);
            return all;
        };
        using http::Count;
        const auto turned_away = sum({Count::turned_away});
        counters.peers_refused.add(turned_away - std::exchange(turned_away_, turned_away));
        counters.wrong_origin.set(sum({Count::wrong_origin}));
        counters.bad_handshake.set(sum({Count::displaced, Count::timed_out, Count::bad_request, Count::header_size,
                                        Count::body_size, Count::wrong_path, Count::wrong_method, Count::bad_handshake}));
        counters.bad_message.set(sessions_->bad_messages());
    }

private:
    [[nodiscard]] http::ServerOptions options(const std::vector<net::Address>& addresses) {
        http::ServerOptions options{.addresses = addresses, .v6_only = addresses.size() > 1};
        // A page's own name may lead here, but then its origin is foreign.
        options.access = {.any_host = true, .origins = endpoint_.options.origins};
        // More than fit, so that Links can choose: it evicts a silent client for a newcomer, or closes the newcomer.
        constexpr std::size_t at_the_door = 16;
        options.limits.web_sockets = endpoint_.options.max_peers + at_the_door;
        options.web_sockets.push_back({.path = path_of(endpoint_),
                                       .session = session_options(),
                                       .on_open = [sessions = sessions_](const std::shared_ptr<http::Session>& session) {
                                           return sessions->add(session, session->peer().address);
                                       }});
        options.on_refused = [this](const http::Refused& refused) { report(refused); };
        return options;
    }
    // The first of each kind. On the http thread.
    void report(const http::Refused& refused) {
        using enum http::Count;
        const bool is_full = refused.counter == turned_away;
        if (std::exchange(reported_[static_cast<std::size_t>(refused.counter)], true)) return;
        const auto advice = refused.counter == wrong_origin  ? "; origin= lists the pages that may"
                            : refused.counter == bad_request ? "; it is wsout that calls here, not tcpout"
                            : is_full                        ? "; max_peers= limits them"
                                                             : "";
        const auto counter = is_full                           ? "peers_refused"
                             : refused.counter == wrong_origin ? "wrong_origin"
                                                               : "bad_handshake";
        mailbox_->notice(fmt::format("{} was refused: {}{}; further such clients are counted ({})",
                                     refused.remote.text(), refused.reason, advice, counter));
    }

    std::array<bool, http::Counters::size> reported_{};
    std::optional<http::Server> server_;
    std::uint64_t turned_away_ = 0;  // already counted
};

class WebSocketClient final : public WebSockets {
public:
    using WebSockets::WebSockets;

    SetupResult<void> open(const std::vector<net::Address>& addresses) override {
        if (auto done = start(); !done) return done;
        const auto local = *endpoint::local_address(endpoint_);
        auto reachable = addresses;
        std::erase_if(reachable, [&](const auto& one) { return local && one.family() != local->family(); });
        client_.reset();
        client_.emplace(http::Client::connect(*thread_,
                                              {.addresses = std::move(reachable),
                                               .host = endpoint::to_text(endpoint_.address),
                                               .path = path_of(endpoint_),
                                               .bind = local,
                                               .session = session_options()},
                                              {.on_open =
                                                   [sessions = sessions_](const std::shared_ptr<http::Session>& session) {
                                                       return sessions->add(session, std::nullopt);
                                                   },
                                               .on_failed =
                                                   [this](const SetupError& error) {
                                                       if (error.code == SetupCode::bad_input) bad_handshakes_.add();
                                                       mailbox_->fail(error);
                                                   }}));
        return {};
    }
    void refresh(link::EndpointCounters& counters) override {
        counters.bad_handshake.set(bad_handshakes_.value());
        counters.bad_message.set(sessions_->bad_messages());
    }

private:
    Counter bad_handshakes_;
    std::optional<http::Client> client_;
};

template <class T>
std::unique_ptr<link::Transport> create(const endpoint::Endpoint& endpoint, std::shared_ptr<link::Mailbox> mailbox) {
    return std::make_unique<T>(endpoint, std::move(mailbox));
}

}  // namespace

void register_transports() noexcept {
    link::register_transport(endpoint::Scheme::wsin, create<WebSocketServer>);
    link::register_transport(endpoint::Scheme::wsout, create<WebSocketClient>);
}

}  // namespace mavloom::ws
