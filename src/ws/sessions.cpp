// SPDX-License-Identifier: MIT
#include "ws/sessions.hpp"

#include <vector>

namespace mavloom::ws {

static constexpr std::uint16_t normal_closure = 1000;  // RFC 6455, section 7.4.1

http::SessionOptions session_options() {
    http::SessionOptions options;
    options.pack_bytes = 8192;
    options.writes_at_once = true;
    options.queue.max_bytes = link::Transport::max_unsent_bytes;
    options.queue.max_age.fill(std::chrono::hours(24));  // Links' queue drops what is too old
    return options;
}

static std::string reason_of(const http::Closed& closed) {
    switch (closed.why) {
        case http::Ended::by_us: return "closed";
        case http::Ended::by_peer:
            return closed.text.empty() ? "closed by the far side" : "closed by the far side: " + closed.text;
        default: return closed.text;
    }
}

static bool is_bad_message(http::Ended why) noexcept {
    using enum http::Ended;
    return why == protocol || why == size || why == fragments || why == kind;
}

http::SessionEvents Sessions::add(const std::shared_ptr<http::Session>& session,
                                  const std::optional<net::Address>& address) {
    link::PeerNumber number = 0;
    {
        const std::lock_guard lock(mutex_);
        number = ++last_;
        all_.emplace(number, session);
    }
    mailbox_->join({.number = number, .address = address, .is_foreign = !session->peer().origin.empty()});
    return {.on_message = [mailbox = mailbox_, number](
                              ByteView message, http::Kind) { return mailbox->deliver(number, message, wall_now()); },
            .on_sent = [mailbox = mailbox_, number](std::size_t bytes) { mailbox->note_sent(number, bytes); },
            .on_closed =
                [this, number](const http::Closed& closed) {
                    remove(number);
                    if (is_bad_message(closed.why)) bad_messages_.add();
                    mailbox_->leave(number, reason_of(closed));
                }};
}

std::size_t Sessions::send(link::PeerNumber peer, std::span<const iovec> frames) {
    const auto session = find(peer);
    if (!session) return 0;
    for (const iovec& piece : frames)
        session->push({static_cast<const std::uint8_t*>(piece.iov_base), piece.iov_len}, 0, 0, mono_now());
    return session->flush();
}

void Sessions::close(link::PeerNumber peer, std::string_view why) {
    if (const auto session = find(peer)) session->close(normal_closure, std::string(why));
    remove(peer);
}

void Sessions::resume() {
    std::vector<std::shared_ptr<http::Session>> all;
    {
        const std::lock_guard lock(mutex_);
        for (const auto& [number, session] : all_) all.push_back(session);
    }
    for (const auto& session : all) session->resume();
}

std::shared_ptr<http::Session> Sessions::find(link::PeerNumber peer) {
    const std::lock_guard lock(mutex_);
    const auto found = all_.find(peer);
    return found == all_.end() ? nullptr : found->second;
}

void Sessions::remove(link::PeerNumber peer) {
    const std::lock_guard lock(mutex_);
    all_.erase(peer);
}

}  // namespace mavloom::ws
