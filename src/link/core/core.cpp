// SPDX-License-Identifier: MIT
#include "link/core/core.hpp"

#include <algorithm>
#include <cassert>

namespace mavloom::link::detail {

// While an outlet is blocked, frames that are too old are dropped at least this often.
static constexpr std::chrono::milliseconds expire_interval{100};

Core::Core(const dialect::Dialect& usual, std::unique_ptr<net::EventLoop> loop, net::ReceiveBatch batch)
    : loop_(std::move(loop)),
      dialects(usual),
      look_ups([wake = loop_->wake_handle()] { net::EventLoop::wake(*wake); }),
      receive_batch(std::move(batch)),
      stream_buffer(stream_buffer_bytes) {}

std::size_t Core::turn(LinkHandler& handler, MonoTime deadline) {
    assert(events.handler() == nullptr && "turn must not be called inside a callback");
    now_ = mono_now();
    coalescing.count(std::exchange(last_turn_, {}), now_);
    events.begin_turn(handler, links);
    outlets.flush();
    if (const auto until = coalescing.rest_until(); until && deadline > now_)
        net::EventLoop::sleep_until(std::min(*until, deadline));
    loop_->wait(wait_limit(deadline));
    now_ = last_turn_.began = mono_now();
    ++turns_;
    look_ups.stop_waiting();
    if (loop_->dispatch(now_)) {
        look_ups.deliver();
        endpoints.each([](OpenEndpoint& endpoint) { endpoint.on_wake(); });
    }
    run_tickers();
    outlets.expire_blocked(now_);
    if (now_ >= key_store.due()) save_signing_times();
    outlets.flush();
    ended_borders.clear();
    ended_links.clear();
    events.end_turn();
    return last_turn_.frames;
}

MonoTime Core::wait_limit(MonoTime deadline) const {
    deadline = std::min({deadline, tickers.due(), key_store.due()});
    return outlets.empty() ? deadline : std::min(deadline, now_ + expire_interval);
}

void Core::save_signing_times() {
    std::vector<std::string> notices;
    key_store.save(now_, notices);
    for (auto& text : notices) events.notice({}, std::move(text));
}

void Core::run_tickers() {
    if (tickers.empty()) return;
    now_ = mono_now();
    tickers.run(now_);
}

void Core::add_link(Link& link, Rank rank) {
    const bool verifies = link.signature != nullptr && link.signature->verifies();
    link.rank = verifies ? Rank::verified : rank;
    link.dialect = &dialects.of(link.endpoint);
    link.loss.tracker.limit_by(source_budget);
    link.ordinal = links_added[link.endpoint]++;
    links.add(link);
    create_stages(link);
}

void Core::create_stages(Link& link) {
    const auto found = stages.find(link.endpoint);
    if (found != stages.end()) set_stages(link, found->second);
}

void Core::set_stages(Link& link, const CreateStages& create) {
    const bool is_stream = endpoints.find(link.endpoint)->info.endpoint.row().is_stream;
    const StageSite site{link.id, link.name, is_stream, link.ordinal, link.counters, link.dialect->table};
    put_stages(link, create(site), create);
}

void Core::put_stages(Link& link, Stages made, const CreateStages& by) {
    const bool is_empty = made.in.empty() && made.out.empty();
    if (!link.border && is_empty) return;
    if (!link.border) link.border = std::make_unique<Border>(*this, link);
    link.border->replace(std::move(made), by);
}

void Core::set_stages(EndpointId endpoint, CreateStages create) {
    const bool removes = !create;
    if (removes) stages.erase(endpoint);
    else stages.insert_or_assign(endpoint, std::move(create));
    links.each([&](Link& link) {
        if (link.endpoint != endpoint) return;
        if (removes) put_stages(link, {}, nullptr);
        else create_stages(link);
    });
}

Rank Core::rank_of(const endpoint::EndpointOptions& options, const net::Address& peer) {
    const net::Address address = peer.unmapped();
    // The kernel drops datagrams that come from outside with one of its own IPv4 addresses, but not such IPv6 ones.
    const bool is_near = address.is_loopback() || (address.is_v4() && own_addresses.contains(address, now_));
    return options.trusted.value_or(is_near) ? Rank::own : Rank::stranger;
}

void Core::remove_link(Link& link, std::string_view why) {
    events.mark_down(link, why);
    links.remove(link.id);
    if (!link.border) return;
    link.border->drop(Way::in);
    link.border->drop(Way::out);
}

void Core::on_frame(Link& link, const wire::ParseEvent& event, WallTime time) {
    assert(link.up && links.find(link.id) == &link && events.handler() != nullptr && "frames are heard in turns only");
    LinkCounters& counters = link.counters;
    bool is_repeated = false;
    if (link.signature != nullptr && link.signature->verifies()) [[unlikely]] {
        if (!link.signature->accepts(event.frame, time, now_)) return counters.bad_signature.add();
        is_repeated = link.signature->is_repeated();
        link.frames_repeated += is_repeated ? 1 : 0;
    } else if (key_store.compares_heard) [[unlikely]] {
        key_store.note_heard(event.frame, time, now_);
    }
    counters.frames_in.add();
    counters.bytes_in.add(event.frame.size());
    if (event.info == nullptr) [[unlikely]]
        counters.unknown_ids.add();
    const auto* const update = owner_counts_loss_ ? &wire::no_loss : &link.loss.count(event.frame, event.info);
    ++last_turn_.frames;
    events.handler()->on_frame({.frame = event.frame,
                                .info = event.info,
                                .link = link.id,
                                .endpoint = link.endpoint,
                                .time = time,
                                .sequence = update,
                                .is_repeated = is_repeated,
                                .rank = link.rank,
                                .loss = &link.loss});
}

void Core::on_bad_bytes(Link& link, const wire::ParseEvent& event) {
    using Kind = wire::ParseEvent::Kind;
    if (event.kind == Kind::bad_checksum) {
        link.counters.crc_error.add();
        if (events.handler() != nullptr) events.handler()->on_bad_checksum(link.id, link.endpoint, event.frame.id());
    }
    if (event.kind == Kind::junk) link.counters.junk_bytes.add(event.bytes);
    if (event.kind == Kind::unknown_flags) link.counters.unknown_flags.add();
}

wire::FrameView Core::signed_for(Link& link, const wire::FrameView& frame) {
    return link.signature == nullptr ? frame : link.signature->sign(frame, link.dialect->table, wall_now());
}

static bool count_found(Link& link, const wire::FrameView& frame) noexcept {
    link.counters.frames_out.add();
    link.counters.bytes_out.add(frame.size());
    return true;
}

static bool count_unconfirmed(Link& link) noexcept {
    link.counters.unconfirmed.add();
    return false;
}

// The frame counts as sent to the link, as those do that the network refuses later.
static bool count_refused(Link& link) noexcept {
    link.counters.refused.add();
    return true;
}

[[gnu::always_inline]] static inline bool push(Link& link, net::BlockQueue& lane, ByteView bytes,
                                               std::uint8_t block_class, std::uint64_t key, MonoTime now) {
    const auto pushed = lane.push(bytes, block_class, key, now);
    if (pushed.dropped != 0) [[unlikely]]
        link.counters.queue_bytes.add(pushed.dropped);
    if (pushed.queued && !std::exchange(link.is_scheduled, true)) link.schedule();
    return pushed.queued;
}

void Core::push_staged(Link& link, const Piece& piece, MonoTime now) {
    const auto lane = piece.is_strangers ? net::Lane::second : net::Lane::first;
    push(link, link.queue.lane(lane), piece.bytes, piece.block_class, piece.key, now);
}

// A frame that a stage drops counts as sent to the link, as those do that the network loses.
[[gnu::noinline]] static bool pass_stages(Link& link, const net::BlockQueue& lane, OutgoingFrame& outgoing,
                                          const wire::FrameView& frame) {
    link.border->take(Way::out, {.bytes = frame.bytes(),
                                 .block_class = outgoing.block_class(*link.dialect),
                                 .is_strangers = &lane == &link.queue.lane(net::Lane::second),
                                 .key = outgoing.key(*link.dialect)});
    return true;
}

bool Core::queue(Link& link, net::BlockQueue& lane, OutgoingFrame& outgoing, const wire::FrameView& frame, MonoTime now) {
    if (link.sending != Link::Sending::queued) [[unlikely]] {
        if (link.sending == Link::Sending::found_in_ring) return count_found(link, frame);
        if (link.is_paused(now)) return count_refused(link);
        if (link.has_allowance() && !link.spend(frame.size())) return count_unconfirmed(link);
    }
    assert(link.dialect != nullptr && "add_link comes first");
    if (link.border) [[unlikely]]
        return pass_stages(link, lane, outgoing, frame);
    const LinkDialect& dialect = *link.dialect;
    return push(link, lane, frame.bytes(), outgoing.block_class(dialect), outgoing.key(dialect), now);
}

}  // namespace mavloom::link::detail
