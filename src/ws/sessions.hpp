// SPDX-License-Identifier: MIT
// The WebSockets of one endpoint, between its mailbox and the http thread. Private to module ws.
//
// Thread-safe: Links' thread sends and closes, the http thread opens, receives and ends.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>

#include "mavloom/base/counter.hpp"
#include "mavloom/http/session.hpp"
#include "mavloom/link/transport.hpp"

namespace mavloom::ws {

// For both sides. Links hands over no more than this queue holds, so that it drops nothing.
[[nodiscard]] http::SessionOptions session_options();

class Sessions {
public:
    explicit Sessions(std::shared_ptr<link::Mailbox> mailbox) : mailbox_(std::move(mailbox)) {}

    // A WebSocket was opened. `address`: of a client.
    [[nodiscard]] http::SessionEvents add(const std::shared_ptr<http::Session>& session,
                                          const std::optional<net::Address>& address);
    std::size_t send(link::PeerNumber peer, std::span<const iovec> frames);
    void close(link::PeerNumber peer, std::string_view why);
    void resume();
    // WebSockets that ended because of a message that cannot be MAVLink.
    [[nodiscard]] std::uint64_t bad_messages() const noexcept { return bad_messages_.value(); }

private:
    [[nodiscard]] std::shared_ptr<http::Session> find(link::PeerNumber peer);
    void remove(link::PeerNumber peer);

    const std::shared_ptr<link::Mailbox> mailbox_;
    Counter bad_messages_;
    std::mutex mutex_;  // for the next two
    link::PeerNumber last_ = 0;
    std::unordered_map<link::PeerNumber, std::shared_ptr<http::Session>> all_;
};

}  // namespace mavloom::ws
