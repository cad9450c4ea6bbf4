// SPDX-License-Identifier: MIT
// What all endpoints of one Links share: the loop, buffers, the table of links, the way of a frame from parser to handler and from `send`
// to a queue. Private to module link; one owner thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "link/coalescing.hpp"
#include "link/message_class.hpp"
#include "link/signing/signature_state.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/net/block_queue.hpp"
#include "mavloom/net/event_loop.hpp"
#include "mavloom/net/resolver.hpp"
#include "mavloom/net/udp.hpp"
#include "mavloom/wire/parse_event.hpp"
#include "mavloom/wire/sequence.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::link::detail {

// Something with bytes to send at the end of a turn: a UDP socket with all its peers, or one TCP stream.
class Outlet {
public:
    virtual ~Outlet() = default;
    virtual void flush() = 0;
    // Something is still queued that the kernel would not take.
    [[nodiscard]] virtual bool blocked() const = 0;
    // Drops what has become too old while blocked.
    virtual void expire(MonoTime now) = 0;

    bool scheduled = false;  // stands in Core's list
};

class Signature;

// What the links of an endpoint speak: which frames they find, and how these queue.
struct Language {
    const wire::MessageTable& table;
    MessageClasses classes;
};

struct Link {
    Link(EndpointId owner, const net::BlockQueue::Limits& limits) : endpoint(owner), queue(limits) {}
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;
    virtual ~Link() = default;
    // Tells the outlet that `queue` has something new.
    virtual void schedule() = 0;

    LinkId id;  // this and the next: given by Core::add_link
    const Language* language = nullptr;
    EndpointId endpoint;
    std::string name;
    bool up = false;
    bool told_up = false;
    bool queued = false;         // waits in its outlet
    bool finds_in_ring = false;  // what goes to it is in the ring: counted, never queued
    Signature* signature = nullptr;
    LinkCounters counters;
    net::BlockQueue queue;
    wire::SequenceTracker tracker;
};

// sign= and verify= of one endpoint.
class Signature {
public:
    // The times of an earlier run come from `states`, which outlives the object; `notices` gets what is to be said of them.
    // `signs_as` gives its frames their link id.
    [[nodiscard]] static SetupResult<std::unique_ptr<Signature>> load(const endpoint::EndpointOptions& options,
                                                                      EndpointId signs_as, KeyStates& states,
                                                                      std::vector<std::string>& notices);
    explicit Signature(KeyStates& states) : states_(states) { states_.add(*this); }
    Signature(const Signature&) = delete;
    Signature& operator=(const Signature&) = delete;
    ~Signature();

    // Notes in the keys' files the times that were used so far.
    void keep_times() const;
    // Whether the files hold other keys now; not so while one of them cannot be read.
    [[nodiscard]] bool has_other_keys() const;
    [[nodiscard]] bool verifies() const noexcept { return judge_ != nullptr; }
    [[nodiscard]] bool signs() const noexcept { return signer_.has_value(); }
    [[nodiscard]] bool accepts(const wire::FrameView& frame, WallTime now) noexcept;
    // `accepts` ahead of the parser that will find the same bytes once more: that second look is not taken for a replay.
    [[nodiscard]] bool vouches(const wire::FrameView& frame, WallTime now) noexcept;
    // The bytes that were vouched for are about to go.
    void forget_vouched() noexcept { vouched_ = nullptr; }
    // The frame with our signature, in a buffer that lives until the next call. The frame itself where nothing is to be signed (MAVLink 1),
    // or where nobody knows how: its id has no definition and no CRC_EXTRA agrees with its checksum.
    [[nodiscard]] wire::FrameView sign(const wire::FrameView& frame, const wire::MessageTable& table,
                                       WallTime now) noexcept;

private:
    struct OpenKey {
        std::string path;
        wire::SigningKey key;
        std::shared_ptr<KeyFile> times;
        [[nodiscard]] bool is_current() const noexcept { return times->state.key == key.fingerprint(); }
    };
    [[nodiscard]] SetupResult<OpenKey> open(const std::string& path, std::vector<std::string>& notices);
    void judge(const OpenKey& with, bool in_group);
    [[nodiscard]] bool takes(const wire::FrameView& frame, wire::SigningTime now);

    KeyStates& states_;
    std::optional<OpenKey> verify_with_, sign_with_;
    std::shared_ptr<KeyJudge> judge_;    // null without verify=
    std::optional<wire::Verifier> own_;  // in a group
    std::optional<wire::Signer> signer_;
    const std::uint8_t* vouched_ = nullptr;  // where the frame begins that was verified ahead
    std::array<std::uint8_t, wire::max_frame_length> buffer_{};
};

// Link ids rise and are never given twice, yet a look-up is one load: an id is skipped while its place in the table is taken.
class LinkTable {
public:
    LinkTable() : places_(64) {}
    // Gives the link its id.
    void add(Link& link);
    // Ids go on behind this one.
    void count_from(LinkId last) noexcept { last_ = std::max(last_, last.value); }
    void remove(LinkId id) noexcept;
    [[nodiscard]] Link* find(LinkId id) const noexcept {
        Link* link = places_[id.value & (places_.size() - 1)];
        return link != nullptr && link->id == id ? link : nullptr;
    }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    template <class F>
    void each(F&& f) const {
        for (Link* link : places_)
            if (link != nullptr) f(*link);
    }

private:
    std::vector<Link*> places_;  // a power of two, at most half taken
    std::size_t size_ = 0;
    std::uint32_t last_ = 0;
};

class Core;

// What an endpoint is made from.
struct Opening {
    Core& core;
    const endpoint::Endpoint& endpoint;
    EndpointId id;
    std::unique_ptr<Signature> signature;
};

// One endpoint of the grammar, opened.
class OpenEndpoint {
public:
    explicit OpenEndpoint(Opening& opening) : signature(std::move(opening.signature)) {
        info.id = opening.id;
        info.endpoint = opening.endpoint;
    }
    OpenEndpoint(const OpenEndpoint&) = delete;
    OpenEndpoint& operator=(const OpenEndpoint&) = delete;
    virtual ~OpenEndpoint() = default;
    virtual std::size_t send(const wire::FrameView& frame) = 0;
    [[nodiscard]] virtual std::size_t queued_bytes() const = 0;
    virtual void refresh_kernel_drops() {}
    // Counts what was sent and not yet known to have been refused.
    virtual void settle_sent() {}
    // Closes one of its peers or clients; false where the link is not one of several.
    virtual bool close_link(LinkId) { return false; }
    // The answer to a look-up that this endpoint asked for.
    virtual void on_resolved(net::Resolver::Answer&&) {}
    // Keeps the sums of a link that has been removed.
    void count_gone(const Link& link) noexcept;

    EndpointInfo info;
    EndpointCounters counters;
    std::unique_ptr<Signature> signature;
    std::optional<SetupError> failure;  // Links::failure
};

[[nodiscard]] net::BlockQueue::Limits queue_limits(const endpoint::EndpointOptions& options);

class Core {
public:
    Core(Language language, std::unique_ptr<net::EventLoop> loop, net::ReceiveBatch batch);

    std::size_t turn(LinkHandler& handler, MonoTime deadline);

    [[nodiscard]] net::EventLoop& loop() noexcept { return *loop_; }
    // An endpoint whose links speak another language than the rest; to be said before it is opened, until it is forgotten.
    void speaks(EndpointId endpoint, const dialect::Dialect& dialect);
    void forget_language(EndpointId endpoint) noexcept { languages_.erase(endpoint); }
    [[nodiscard]] const wire::MessageTable& table(EndpointId endpoint) const noexcept {
        return language(endpoint).table;
    }
    [[nodiscard]] net::ReceiveBatch& receive_batch() noexcept { return receive_; }
    [[nodiscard]] net::SendBatch& send_batch() noexcept { return send_; }
    [[nodiscard]] ByteSpan stream_buffer() noexcept { return stream_; }
    [[nodiscard]] net::Resolver& resolver() noexcept { return resolver_; }
    [[nodiscard]] KeyStates& key_states() noexcept { return key_states_; }
    [[nodiscard]] const LinkTable& links() const noexcept { return links_; }
    // The instant of this turn.
    [[nodiscard]] MonoTime now() const noexcept { return now_; }
    void count_links_from(LinkId last) noexcept { links_.count_from(last); }
    // How often events were looked at.
    [[nodiscard]] std::uint64_t turns() const noexcept { return turns_; }
    // For what is done between turns.
    void refresh_now() { now_ = mono_now(); }

    void leave_loss_to_owner() noexcept { owner_counts_loss_ = true; }
    static wire::SequenceTracker::Update count_loss(Link& link, const wire::FrameView& frame,
                                                    const wire::MessageInfo* info) {
        const auto update = link.tracker.update(frame, info);
        if (update.verdict != wire::SequenceTracker::Verdict::good) [[unlikely]]
            link.counters.add(update);
        return update;
    }

    // `link.name` is made unique. The handler is told at once inside a turn, else when the next begins.
    void add_link(Link& link);
    void set_up(Link& link);
    void set_down(Link& link, std::string_view why);
    void remove_link(Link& link, std::string_view why);
    void notice(EndpointId endpoint, std::string text);

    // What a link's parser found.
    void on_event(Link& link, const wire::ParseEvent& event, WallTime time) {
        if (event.kind == wire::ParseEvent::Kind::frame) [[likely]] {
            on_frame(link, event, time);
        } else {
            on_bad_bytes(link, event);
        }
    }
    // True when the frame was queued.
    bool send(Link& link, const wire::FrameView& frame) {
        return queue(link,
                     link.signature == nullptr ? frame : link.signature->sign(frame, link.language->table, wall_now()));
    }
    // As it is.
    bool queue(Link& link, const wire::FrameView& frame);

    void schedule(Outlet& outlet) {
        if (std::exchange(outlet.scheduled, true)) return;
        outlets_.push_back(&outlet);
    }
    void forget(Outlet& outlet) noexcept;
    // This turn's reading left something behind.
    void note_more_waits() noexcept { more_waits_ = true; }
    // Whether turns of a rush may begin later than they could.
    void allow_coalescing(bool allowed) noexcept { coalescing_.allow(allowed); }

    // Asks for `endpoint`'s host; the answer comes to on_resolved within a turn, or is waited for: but when the turns have begun there are
    // frames to be passed on, and nobody waits.
    void resolve(OpenEndpoint& endpoint, const endpoint::HostPort& host);
    [[nodiscard]] bool running() const noexcept { return turns_ != 0; }
    [[nodiscard]] std::optional<net::Resolver::Answer> resolve_now(const endpoint::HostPort& host,
                                                                   std::chrono::milliseconds limit,
                                                                   OpenEndpoint& endpoint);
    void forget(const OpenEndpoint& endpoint) noexcept;

    // A stream parser that holds bytes back gives its deadline here; `tick` is called once when it has passed.
    class Ticker {
    public:
        virtual ~Ticker() = default;
        [[nodiscard]] virtual std::optional<MonoTime> tick_due() const = 0;
        virtual void tick(MonoTime now) = 0;
        bool ticking = false;  // stands in Core's list
    };
    void keep_ticking(Ticker& ticker) {
        if (!std::exchange(ticker.ticking, true)) tickers_.push_back(&ticker);
    }
    void forget(Ticker& ticker) noexcept;
    // Destroyed when the turn is over: objects may end themselves inside their own callbacks.
    void bury(std::unique_ptr<Link> link) { graveyard_.push_back(std::move(link)); }
    [[nodiscard]] bool pending() const;

private:
    void on_frame(Link& link, const wire::ParseEvent& event, WallTime time);
    void on_bad_bytes(Link& link, const wire::ParseEvent& event);
    void tell_backlog();
    void flush();
    void expire_blocked();
    [[nodiscard]] MonoTime wait_limit(MonoTime deadline) const;
    void run_tickers();
    void collect_answers();
    void save_signing_times();
    [[nodiscard]] const Language& language(EndpointId endpoint) const noexcept {
        const auto own = languages_.find(endpoint);
        return own == languages_.end() ? language_ : own->second;
    }
    [[nodiscard]] bool name_taken(const std::string& name) const;

    const Language language_;
    std::map<EndpointId, Language> languages_;  // where it is another
    std::unique_ptr<net::EventLoop> loop_;
    net::Resolver resolver_;
    net::ReceiveBatch receive_;
    net::SendBatch send_;
    std::vector<std::uint8_t> stream_;
    LinkTable links_;
    LinkHandler* handler_ = nullptr;  // inside a turn only
    MonoTime now_ = mono_now();
    std::uint64_t turns_ = 0;
    bool owner_counts_loss_ = false;
    std::size_t frames_this_turn_ = 0;
    bool more_waits_ = false;
    MonoTime turn_began_{};
    Coalescing coalescing_;
    std::vector<Outlet*> outlets_, flushing_;
    std::vector<Ticker*> tickers_;
    std::vector<std::pair<std::uint64_t, OpenEndpoint*>> questions_;
    std::vector<std::pair<EndpointId, std::string>> notices_;
    KeyStates key_states_;
    std::vector<LinkId> to_tell_up_;
    std::vector<std::unique_ptr<Link>> graveyard_;
};

}  // namespace mavloom::link::detail
