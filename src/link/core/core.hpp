// SPDX-License-Identifier: MIT
// The core of a Links object: the parts that all endpoints share, and the turn that drives them. It passes frames from
// parsers to the handler, and from `send` to queues. docs/design/turn.md lists the steps of a turn. Private to module
// link; single owner thread.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "link/core/border.hpp"
#include "link/core/coalescing.hpp"
#include "link/core/link_dialect.hpp"
#include "link/core/link_events.hpp"
#include "link/core/link_table.hpp"
#include "link/core/look_ups.hpp"
#include "link/core/outlets.hpp"
#include "link/core/tickers.hpp"
#include "link/open_endpoint.hpp"
#include "link/signing/signing_ids.hpp"
#include "mavloom/net/event_loop.hpp"
#include "mavloom/net/interfaces.hpp"
#include "mavloom/net/udp.hpp"
#include "mavloom/wire/parse_event.hpp"

namespace mavloom::link::detail {

// A frame that is sent to one or more links. Computes the frame's class and key again only for a link with another
// dialect.
class OutgoingFrame {
public:
    explicit OutgoingFrame(wire::FrameView frame) noexcept : frame_(frame) {}
    [[nodiscard]] const wire::FrameView& frame() const noexcept { return frame_; }
    [[nodiscard]] std::uint8_t block_class(const LinkDialect& dialect) noexcept {
        use(dialect);
        return block_class_;
    }
    [[nodiscard]] std::uint64_t key(const LinkDialect& dialect) noexcept {
        use(dialect);
        return key_;
    }

private:
    [[gnu::always_inline]] void use(const LinkDialect& dialect) noexcept {
        if (&dialect == dialect_) [[likely]]
            return;
        dialect_ = &dialect;
        const QueueRules::Rule rule = dialect.queue_rules.of(frame_.id());
        block_class_ = rule.block_class;
        key_ = QueueRules::key(frame_, rule);
    }

    wire::FrameView frame_;
    const LinkDialect* dialect_ = nullptr;
    std::uint64_t key_ = 0;
    std::uint8_t block_class_ = 0;
};

class Core {
public:
    Core(const dialect::Dialect& usual, std::unique_ptr<net::EventLoop> loop, net::ReceiveBatch batch);

    [[nodiscard]] net::EventLoop& loop() noexcept { return *loop_; }

    // See Links::turn.
    std::size_t turn(LinkHandler& handler, MonoTime deadline);
    // The clock reading that this turn uses.
    [[nodiscard]] MonoTime now() const noexcept { return now_; }
    // Updates `now` for calls between turns.
    void refresh_now() { now_ = mono_now(); }
    // Number of turns so far.
    [[nodiscard]] std::uint64_t turns() const noexcept { return turns_; }
    [[nodiscard]] bool has_begun() const noexcept { return !look_ups.may_wait(); }
    // Notes that a read of this turn left input unread.
    void note_more_waits() noexcept { last_turn_.more_waits = true; }
    // Notes a datagram that was sent.
    void note_datagram(std::size_t frames) noexcept {
        last_turn_.sent_frames += frames;
        ++last_turn_.sent_datagrams;
    }

    // `add_link` makes `link.name` unique, and assigns its id, dialect and rank. `rank`: unless the link verifies.
    void add_link(Link& link, Rank rank = Rank::own);
    // The rank of a peer of an endpoint that listens.
    [[nodiscard]] Rank rank_of(const endpoint::EndpointOptions& options, const net::Address& peer);
    void remove_link(Link& link, std::string_view why);
    // Gives an endpoint's present and future links these stages; an empty function removes them. Not during a turn.
    void set_stages(EndpointId endpoint, CreateStages create);
    void set_stages(Link& link, const CreateStages& create);
    // For a border that has nothing left to do. Destroys it at the end of the turn.
    void remove_border(Link& link) {
        tickers.forget(*link.border);
        ended_borders.push_back(std::move(link.border));
    }
    // Destroys the link at the end of the turn, because the link may still be running a callback.
    void destroy_later(std::unique_ptr<Link> link) {
        assert(!link->up && links.find(link->id) == nullptr && "it must be removed first");
        ended_links.push_back(std::move(link));
    }

    // From now on the owner counts loss, with `RxFrame::loss`.
    void leave_loss_to_owner() noexcept { owner_counts_loss_ = true; }
    // Handles what a link's parser found.
    void on_event(Link& link, const wire::ParseEvent& event, WallTime time) {
        if (event.kind == wire::ParseEvent::Kind::frame) [[likely]] {
            on_frame(link, event, time);
        } else {
            on_bad_bytes(link, event);
        }
    }

    // Signs the frame if the endpoint has sign=, and queues it in the first lane. Returns true if it was queued.
    static bool send(Link& link, OutgoingFrame& outgoing, MonoTime now) {
        return queue(link, link.queue.lane(net::Lane::first), outgoing, signed_for(link, outgoing.frame()), now);
    }
    bool send(Link& link, const wire::FrameView& frame) const {
        OutgoingFrame outgoing(frame);
        return send(link, outgoing, now_);
    }
    // Queues the frame unchanged: one of a stranger in the second lane, others in the first.
    static bool send_unsigned(Link& link, OutgoingFrame& outgoing, Rank from, MonoTime now) {
        const auto lane = from == Rank::stranger ? net::Lane::second : net::Lane::first;
        return queue(link, link.queue.lane(lane), outgoing, outgoing.frame(), now);
    }

    // Queues bytes that have passed the stages.
    static void push_staged(Link& link, const Piece& piece, MonoTime now);

private:
    void create_stages(Link& link);
    void put_stages(Link& link, Stages made, const CreateStages& by);
    [[nodiscard]] static wire::FrameView signed_for(Link& link, const wire::FrameView& frame);
    static bool queue(Link& link, net::BlockQueue& lane, OutgoingFrame& outgoing, const wire::FrameView& frame,
                      MonoTime now);
    void on_frame(Link& link, const wire::ParseEvent& event, WallTime time);
    void on_bad_bytes(Link& link, const wire::ParseEvent& event);
    void run_tickers();
    void save_signing_times();
    [[nodiscard]] MonoTime wait_limit(MonoTime deadline) const;

    const std::unique_ptr<net::EventLoop> loop_;
    MonoTime now_ = mono_now();
    std::uint64_t turns_ = 0;
    bool owner_counts_loss_ = false;
    Coalescing::Turn last_turn_{};  // the current one, during a turn

public:
    // The parts, for the endpoints to use.
    wire::SourceBudget source_budget{16'384};  // of all links together: about 12 MiB at most
    LinkDialects dialects;
    net::OwnAddresses own_addresses;
    LookUps look_ups;
    std::map<EndpointId, CreateStages> stages;
    std::map<EndpointId, std::uint64_t> links_added;  // since the endpoint was added
    LinkTable links;
    LinkEvents events;
    Outlets outlets;
    Tickers tickers;
    Coalescing coalescing;
    KeyStore key_store;
    SigningIds signing_ids;
    // Scratch memory for calls that read or write a socket.
    net::ReceiveBatch receive_batch;
    net::SendBatch send_batch;
    bool reads_all = false;  // see Links::read_all
    // Large enough that one read takes everything that a fast sender writes during a turn. Small enough for the L2
    // cache.
    static constexpr std::size_t stream_buffer_bytes = 128 * 1024;
    std::vector<std::uint8_t> stream_buffer;
    std::vector<std::unique_ptr<Border>> ended_borders;
    std::vector<std::unique_ptr<Link>> ended_links;
    OpenEndpoints endpoints;  // declared last and so destroyed first, because endpoints use the other parts
};

}  // namespace mavloom::link::detail
