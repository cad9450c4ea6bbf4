// SPDX-License-Identifier: MIT
// What all endpoints of one Links object share: event loop, buffers and link table. It passes frames from parsers to
// the handler and from `send` to queues. Private to module link; single owner thread.
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

// Sends queued bytes at the end of a turn: a UDP socket with all its peers, or one stream.
class Outlet {
public:
    virtual ~Outlet() = default;
    virtual void flush() = 0;
    // True while something is queued that the kernel does not accept.
    [[nodiscard]] virtual bool blocked() const = 0;
    // Drops what became too old while blocked.
    virtual void expire(MonoTime now) = 0;

    bool scheduled = false;  // is in Core's list
};

class Signature;

// The dialect of an endpoint's links: which frames they find, and how these frames queue.
struct Language {
    const wire::MessageTable& table;
    MessageClasses classes;
};

struct Link {
    Link(EndpointId owner, const net::BlockQueue::Limits& limits) : endpoint(owner), queue(limits) {}
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;
    virtual ~Link() = default;
    // Tells the outlet that `queue` has new frames.
    virtual void schedule() = 0;

    LinkId id;  // Core::add_link sets this and `language`
    const Language* language = nullptr;
    EndpointId endpoint;
    std::string name;
    bool up = false;
    bool told_up = false;
    // Its outlet knows that the queue is not empty.
    bool queued = false;
    // The far side reads outgoing frames from the ring: count them, never queue them.
    bool finds_in_ring = false;
    Signature* signature = nullptr;
    LinkCounters counters;
    net::BlockQueue queue;
    wire::SequenceTracker tracker;
};

// Signing (sign=) and verification (verify=) for one endpoint.
class Signature {
public:
    // Loads the keys. Timestamps of earlier runs come from `states`, which must outlive the object; problems with
    // them go to `notices`. `signs_as` supplies the link id of signed frames. Returns null if neither option is set.
    [[nodiscard]] static SetupResult<std::unique_ptr<Signature>> load(const endpoint::EndpointOptions& options,
                                                                      EndpointId signs_as, KeyStates& states,
                                                                      std::vector<std::string>& notices);
    explicit Signature(KeyStates& states) : states_(states) { states_.add(*this); }
    Signature(const Signature&) = delete;
    Signature& operator=(const Signature&) = delete;
    ~Signature();

    // Copies the timestamps used so far into the key files' states.
    void keep_times() const;
    // True if the key files now hold other keys. False while one of them cannot be read.
    [[nodiscard]] bool has_other_keys() const;
    [[nodiscard]] bool verifies() const noexcept { return judge_ != nullptr; }
    [[nodiscard]] bool signs() const noexcept { return signer_.has_value(); }
    [[nodiscard]] bool accepts(const wire::FrameView& frame, WallTime now) noexcept;
    // Like `accepts`, but called before the parser finds the same bytes again. The second check then does not treat
    // the frame as a replay.
    [[nodiscard]] bool vouches(const wire::FrameView& frame, WallTime now) noexcept;
    // The buffer with the vouched-for bytes is about to be reused.
    void forget_vouched() noexcept { vouched_ = nullptr; }
    // Returns the signed frame, in a buffer that is valid until the next call. Returns the original frame if it
    // cannot be signed: MAVLink 1, or an unknown id whose checksum matches no CRC_EXTRA.
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
    std::optional<wire::Verifier> own_;  // in a group: per endpoint
    std::optional<wire::Signer> signer_;
    // Start of the frame that `vouches` has already verified.
    const std::uint8_t* vouched_ = nullptr;
    std::array<std::uint8_t, wire::max_frame_length> buffer_{};
};

// Looks up links by id with one load. Ids increase and are never reused. `add` skips an id whose slot is still taken.
class LinkTable {
public:
    LinkTable() : places_(64) {}
    // Assigns the link's id.
    void add(Link& link);
    // The next id is greater than `last`.
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
    std::vector<Link*> places_;  // size: a power of two; at most half used
    std::size_t size_ = 0;
    std::uint32_t last_ = 0;
};

class Core;

// The arguments for opening an endpoint.
struct Opening {
    Core& core;
    const endpoint::Endpoint& endpoint;
    EndpointId id;
    std::unique_ptr<Signature> signature;
};

// An open endpoint of any scheme.
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
    // Counts frames that were sent and not refused so far.
    virtual void settle_sent() {}
    // Closes one peer or client. Returns false if the endpoint cannot have several links.
    virtual bool close_link(LinkId) { return false; }
    // Receives the answer to a look-up of this endpoint.
    virtual void on_resolved(net::Resolver::Answer&&) {}
    // Adds the counters of a removed link to the endpoint's sums.
    void count_gone(const Link& link) noexcept;

    EndpointInfo info;
    EndpointCounters counters;
    std::unique_ptr<Signature> signature;
    std::optional<SetupError> failure;  // see Links::failure
};

[[nodiscard]] net::BlockQueue::Limits queue_limits(const endpoint::EndpointOptions& options);

class Core {
public:
    Core(Language language, std::unique_ptr<net::EventLoop> loop, net::ReceiveBatch batch);

    std::size_t turn(LinkHandler& handler, MonoTime deadline);

    [[nodiscard]] net::EventLoop& loop() noexcept { return *loop_; }
    // Gives an endpoint its own dialect. Call it before the endpoint is opened; `forget_language` ends it.
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
    // The clock reading that this turn uses.
    [[nodiscard]] MonoTime now() const noexcept { return now_; }
    void count_links_from(LinkId last) noexcept { links_.count_from(last); }
    // Number of turns so far.
    [[nodiscard]] std::uint64_t turns() const noexcept { return turns_; }
    // Updates `now` for calls between turns.
    void refresh_now() { now_ = mono_now(); }

    void leave_loss_to_owner() noexcept { owner_counts_loss_ = true; }
    static wire::SequenceTracker::Update count_loss(Link& link, const wire::FrameView& frame,
                                                    const wire::MessageInfo* info) {
        const auto update = link.tracker.update(frame, info);
        if (update.verdict != wire::SequenceTracker::Verdict::good) [[unlikely]]
            link.counters.add(update);
        return update;
    }

    // `add_link` makes `link.name` unique and assigns the id. Inside a turn the handler hears of a change at once.
    // Outside a turn, `set_up` and `notice` reach it at the start of the next turn, and a link that goes down is not
    // reported.
    void add_link(Link& link);
    void set_up(Link& link);
    void set_down(Link& link, std::string_view why);
    void remove_link(Link& link, std::string_view why);
    void notice(EndpointId endpoint, std::string text);

    // Handles what a link's parser found.
    void on_event(Link& link, const wire::ParseEvent& event, WallTime time) {
        if (event.kind == wire::ParseEvent::Kind::frame) [[likely]] {
            on_frame(link, event, time);
        } else {
            on_bad_bytes(link, event);
        }
    }
    // Signs the frame if the endpoint has sign=, and queues it. Returns true if it was queued.
    bool send(Link& link, const wire::FrameView& frame) {
        return queue(link,
                     link.signature == nullptr ? frame : link.signature->sign(frame, link.language->table, wall_now()));
    }
    // Queues the frame unchanged.
    bool queue(Link& link, const wire::FrameView& frame);

    void schedule(Outlet& outlet) {
        if (std::exchange(outlet.scheduled, true)) return;
        outlets_.push_back(&outlet);
    }
    void forget(Outlet& outlet) noexcept;
    // This turn's reading left input behind.
    void note_more_waits() noexcept { more_waits_ = true; }
    // Whether turns may be delayed under heavy load.
    void allow_coalescing(bool allowed) noexcept { coalescing_.allow(allowed); }

    // Looks up a host for `endpoint`. `resolve` returns at once and delivers the answer to on_resolved in a later
    // turn. Before the first turn, `resolve_now` waits up to `limit` for the answer. After it, the call must not
    // delay frames: only a numeric host is answered at once, and other answers go to on_resolved.
    void resolve(OpenEndpoint& endpoint, const endpoint::HostPort& host);
    [[nodiscard]] bool running() const noexcept { return turns_ != 0; }
    [[nodiscard]] std::optional<net::Resolver::Answer> resolve_now(const endpoint::HostPort& host,
                                                                   std::chrono::milliseconds limit,
                                                                   OpenEndpoint& endpoint);
    void forget(const OpenEndpoint& endpoint) noexcept;

    // A stream parser that holds bytes back. `tick` is called once its deadline has passed.
    class Ticker {
    public:
        virtual ~Ticker() = default;
        [[nodiscard]] virtual std::optional<MonoTime> tick_due() const = 0;
        virtual void tick(MonoTime now) = 0;
        bool ticking = false;  // is in Core's list
    };
    void keep_ticking(Ticker& ticker) {
        if (!std::exchange(ticker.ticking, true)) tickers_.push_back(&ticker);
    }
    void forget(Ticker& ticker) noexcept;
    // Destroys the link at the end of the turn, because an object may end inside its own callback.
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
    // Endpoints with a dialect of their own.
    std::map<EndpointId, Language> languages_;
    std::unique_ptr<net::EventLoop> loop_;
    net::Resolver resolver_;
    net::ReceiveBatch receive_;
    net::SendBatch send_;
    std::vector<std::uint8_t> stream_;
    LinkTable links_;
    LinkHandler* handler_ = nullptr;  // null outside a turn
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
