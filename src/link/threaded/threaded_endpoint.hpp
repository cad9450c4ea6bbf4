// SPDX-License-Identifier: MIT
// An endpoint whose transport has threads of its own (mavloom/link/transport.hpp). Private to module link; Links'
// thread owns it.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "link/core/read_budget.hpp"
#include "link/peer_list.hpp"
#include "link/retry.hpp"
#include "link/threaded/threaded_peer.hpp"

namespace mavloom::link::detail {

// The functions that both sides share: they read the mailbox.
class ThreadedEndpoint : public OpenEndpoint, public NameUser, public net::TimerHandler {
public:
    ~ThreadedEndpoint() override;
    void on_wake() override;
    void refresh_counters() override { transport_->refresh(counters); }

protected:
    explicit ThreadedEndpoint(Opening& opening);

    virtual void on_join(const NewPeer& peer) = 0;
    virtual void on_leave(PeerNumber peer, std::string_view why) = 0;
    virtual void on_fail(const SetupError&) {}
    [[nodiscard]] virtual ThreadedPeer* find(PeerNumber peer) = 0;
    bool await_event(MonoTime end);

    Core& core_;
    std::shared_ptr<Mailbox> mailbox_;
    std::unique_ptr<Transport> transport_;
    Retry retry_;

private:
    [[nodiscard]] bool fetch();
    void handle_next() { handle(batch_.events[next_++]); }
    void handle(const Mailbox::Event& event);

    Mailbox::Batch batch_;
    std::size_t next_ = 0;  // of batch_.events
    // In bytes, as for a stream. A message is handled whole.
    ReadBudget budget_{4096, Core::stream_buffer_bytes};
};

[[nodiscard]] bool has_transport(endpoint::Scheme scheme) noexcept;

}  // namespace mavloom::link::detail
