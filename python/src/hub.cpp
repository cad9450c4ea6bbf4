// SPDX-License-Identifier: MIT
#include "hub.hpp"

#include <pthread.h>

#include "gil.hpp"
#include "mavloom/base/thread.hpp"

namespace mavloom::python {
namespace {

using namespace std::chrono_literals;

constexpr auto longest_flush = 1s, required_limit = 5s;
constexpr std::size_t ring_frames_a_turn = 4096;  // in total, over all lossy rings

std::mutex registry_mutex;
std::vector<std::weak_ptr<Hub>>& registry() {
    // Never destroyed: the interpreter ends before static objects do.
    static auto& hubs = *new std::vector<std::weak_ptr<Hub>>;
    return hubs;
}

std::atomic<std::uint64_t> fork_count{0};

bool listens(endpoint::Scheme scheme) noexcept {
    return scheme == endpoint::Scheme::udpin || scheme == endpoint::Scheme::tcpin;
}

}  // namespace

void Hub::watch_forks() {
    static const int registered = ::pthread_atfork([] { registry_mutex.lock(); }, [] { registry_mutex.unlock(); },
                                                   [] {
                                                       registry().clear();  // leaves the parent's hubs untouched
                                                       registry_mutex.unlock();
                                                       fork_count.fetch_add(1, std::memory_order_relaxed);
                                                       WithoutGil::forked();
                                                   });
    static_cast<void>(registered);
}

std::uint64_t Hub::forks() noexcept { return fork_count.load(std::memory_order_relaxed); }

SetupResult<std::shared_ptr<Hub>> Hub::get() {
    const std::lock_guard lock(registry_mutex);
    std::erase_if(registry(), [](const auto& hub) { return hub.expired(); });
    for (const auto& known : registry())
        if (auto hub = known.lock(); hub && !hub->stopping_) return hub;
    auto sources = feed::Sources::create(dialect::default_dialect());
    if (!sources) return tl::unexpected(std::move(sources.error()));
    const std::shared_ptr<Hub> hub(new Hub(std::move(*sources)));
    registry().push_back(hub);
    return hub;
}

void Hub::stop_all() {
    std::vector<std::shared_ptr<Hub>> hubs;
    {
        const std::lock_guard lock(registry_mutex);
        for (const auto& known : registry())
            if (auto hub = known.lock()) hubs.push_back(std::move(hub));
    }
    for (const auto& hub : hubs) hub->stop();
}

Hub::Hub(feed::Sources sources) : sources_(std::move(sources)) {
    links().let_repeat();
    thread_ = thread_without_signals([this] { run(); });
}

Hub::~Hub() { stop(); }

void Hub::stop() {
    stopping_.store(true, std::memory_order_relaxed);
    sources_.wake();
    const std::lock_guard lock(joining_);
    if (thread_.joinable()) thread_.join();
}

// ---- the loop

void Hub::run() {
    while (!stopping_.load(std::memory_order_relaxed)) {
        std::vector<std::function<void()>> work;
        {
            const std::lock_guard lock(mutex_);
            work.swap(work_);
        }
        for (const auto& task : work) task();
        send_outgoing();
        end_waits();
        const auto first = std::ranges::min_element(waits_, {}, &Wait::limit);
        turn(first == waits_.end() ? MonoTime::max() : first->limit);
    }
    send_outgoing();
    turn(MonoTime{});
    for (const auto& [endpoint, served] : served_) served.channel->close();
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
}

void Hub::turn(MonoTime deadline) {
    for (const auto& [endpoint, served] : served_)
        if (served.is_lossless) sources_.hold_ring(endpoint, !served.channel->has_room());
    sources_.turn(*this, deadline, {0, Channel::frames_a_turn, ring_frames_a_turn});
    for (const auto& [endpoint, served] : served_) served.channel->publish();
}

void Hub::end_waits() {
    if (waits_.empty()) return;
    const MonoTime now = mono_now();
    const std::lock_guard lock(mutex_);
    std::erase_if(waits_, [&](const Wait& wait) { return *wait.ended = now >= wait.limit || wait.over(); });
    changed_.notify_all();
}

void Hub::send_outgoing() {
    std::vector<Outgoing> frames;
    {
        const std::lock_guard lock(mutex_);
        frames.swap(outgoing_);
    }
    if (frames.empty()) return;
    changed_.notify_all();
    for (const auto& frame : frames)
        links().send(frame.endpoint, wire::FrameView::unchecked({frame.bytes.data(), frame.size}));
}

Hub::Served* Hub::served_by(link::EndpointId endpoint) noexcept {
    const auto found = served_.find(endpoint);
    return found == served_.end() ? nullptr : &found->second;
}

void Hub::on_frame(const link::RxFrame& rx) {
    if (auto* served = served_by(rx.endpoint)) served->channel->on_frame(rx, links().now());
    else pass_answer(rx);
}
void Hub::on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) {
    auto* served = served_by(endpoint);
    if (served == nullptr) return;
    if (served->is_ring) served->channel->name_link(link, name);
    else served->channel->on_link_up(link, name);
}
void Hub::on_link_down(LinkId link, link::EndpointId endpoint, std::string_view) {
    auto* served = served_by(endpoint);
    if (served == nullptr) return;
    if (!served->is_ring) return served->channel->on_link_down(link, links().sources(link));
    const auto name = served->channel->origin()->link_name(link.value);
    served->channel->forget_link(link, sources_.ring_losses(endpoint, name));
}
void Hub::on_bad_checksum(LinkId, link::EndpointId endpoint, MessageId id) {
    if (auto* served = served_by(endpoint)) served->channel->on_bad_checksum(id);
}

// ---- from other threads

bool Hub::on_loop(std::function<void()> work) {
    bool done = false;
    std::unique_lock lock(mutex_);
    if (ended_) return false;
    work_.push_back([&] {
        work();
        const std::lock_guard inner(mutex_);
        done = true;
        changed_.notify_all();
    });
    sources_.wake();
    changed_.wait(lock, [&] { return done || ended_; });
    return done;
}

void Hub::wait_on_loop(std::function<bool()> over, Nanoseconds limit) {
    bool ended = false;
    on_loop([&] { waits_.push_back({std::move(over), mono_now() + limit, &ended}); });
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return ended || ended_; });
}

SetupResult<Hub::Opened> Hub::open(const endpoint::Endpoint& endpoint, const std::shared_ptr<Channel>& channel,
                                   const Consumer& reader) {
    SetupResult<Opened> opened = setup_error(SetupCode::system, "the loop thread has ended");
    on_loop([&] { opened = open_now(endpoint, channel, reader); });
    if (!opened || !endpoint.options.required) return opened;
    if (auto failure = wait_for_far_side(*opened)) {
        on_loop([&] { remove(opened->endpoint); });
        return tl::unexpected(std::move(*failure).within(opened->name));
    }
    return opened;
}

SetupResult<Hub::Opened> Hub::open_now(const endpoint::Endpoint& endpoint, const std::shared_ptr<Channel>& channel,
                                       const Consumer& reader) {
    const bool is_ring = endpoint.scheme == endpoint::Scheme::shm;
    const auto* own = &channel->origin()->dialect();
    const auto added = is_ring ? sources_.add_ring(endpoint, own) : links().add(endpoint, own);
    if (!added) return tl::unexpected(added.error());
    const bool is_lossless = is_ring && endpoint.options.lossless.value_or(false);
    if (is_lossless) channel->hold_for(&reader, [this] { sources_.wake(); });
    served_.emplace(*added, Served{.channel = channel, .is_ring = is_ring, .is_lossless = is_lossless});
    turn(MonoTime{});
    Opened opened{*added, 0, endpoint.label(), is_ring};
    for (const auto& info : links().endpoints()) {
        if (info.id != *added) continue;
        opened.port = info.local_port;
        opened.name = info.label();
    }
    return opened;
}

bool Hub::is_up(link::EndpointId endpoint) {
    const auto links = sources_.links().links();
    return std::ranges::any_of(links, [&](const auto& link) { return link.endpoint == endpoint && link.up; });
}

// A required ring was already there when it was added.
std::optional<SetupError> Hub::wait_for_far_side(const Opened& opened) {
    std::optional<SetupError> failure;
    bool is_there = opened.is_ring;
    wait_on_loop(
        [&] {
            for (const auto& info : links().endpoints())
                if (info.id == opened.endpoint && listens(info.endpoint.scheme)) is_there = info.local_port != 0;
            is_there = is_there || is_up(opened.endpoint);
            if (const auto* error = links().failure(opened.endpoint); error != nullptr && !is_there) failure = *error;
            return is_there || failure;
        },
        required_limit);
    if (!is_there && !failure) failure = SetupError{SetupCode::unreachable, 0, "no answer within 5 s"};
    return failure;
}

SetupResult<link::EndpointId> Hub::inlet(link::EndpointId ring) {
    SetupResult<link::EndpointId> opened = setup_error(SetupCode::system, "the loop thread has ended");
    on_loop([&] {
        opened = open_way_out(ring);
        turn(MonoTime{});
    });
    return opened;
}

SetupResult<link::EndpointId> Hub::open_way_out(link::EndpointId ring) {
    const auto opened = sources_.inlet(ring);
    if (!opened || served_.contains(*opened)) return opened;
    auto& served = served_.at(ring);
    served.inlet = *opened;
    served_.emplace(*opened, Served{.channel = served.channel});
    return opened;
}

SetupResult<void> Hub::serve_inlet(link::EndpointId endpoint, const std::string& ring, unsigned mode) {
    SetupResult<void> opened = setup_error(SetupCode::system, "the loop thread has ended");
    on_loop([&] { opened = serve_now(endpoint, ring, mode); });
    return opened;
}

SetupResult<void> Hub::serve_now(link::EndpointId endpoint, const std::string& ring, unsigned mode) {
    auto& served = served_.at(endpoint);
    if (served.served_inlet) return setup_error(SetupCode::usage, "this link serves a ring's inlet already");
    const auto path = link::Links::inlet_path(ring);
    if (!path) return tl::unexpected(path.error());
    const auto opened = links().add_inlet(ring, *path, mode);
    if (!opened) return tl::unexpected(opened.error());
    served.served_inlet = *opened;
    filled_from_.emplace(*opened, endpoint);
    return {};
}

// Does not route: a program that fills a ring has vehicles of one kind behind it, and all of them get each answer.
void Hub::pass_answer(const link::RxFrame& rx) {
    const auto filled = filled_from_.find(rx.endpoint);
    if (filled == filled_from_.end()) return;
    auto& served = served_.at(filled->second);
    const auto to = served.is_ring ? open_way_out(filled->second).value_or(filled->second) : filled->second;
    if (links().send(to, rx.frame) == 0) ++served.unheard_answers;
}

// The endpoint that carries what is sent: the inlet of a ring, else the endpoint itself.
link::EndpointId Hub::way_out(link::EndpointId endpoint) { return served_.at(endpoint).inlet.value_or(endpoint); }

LinkStats Hub::stats_now(link::EndpointId endpoint) {
    links().refresh_kernel_drops();
    const auto& served = served_.at(endpoint);
    const auto out = way_out(endpoint);
    LinkStats stats;
    for (const auto& link : links().links()) {
        if (link.endpoint != out) continue;
        stats.links.add(*link.counters);
        stats.peers += link.up;
    }
    for (const auto& info : links().endpoints()) {
        if (info.id != out) continue;
        stats.endpoint = *info.counters;
        stats.links.add(info.counters->gone);
    }
    if (served.is_ring) {
        stats.links.add(sources_.ring_counters(endpoint));
        sources_.add_ring_to(endpoint, stats.ring);
    }
    stats.losses = served.channel->losses();
    for (const auto& loss : sources_.losses(endpoint))
        add_to(stats.losses, served.channel->origin()->link_name(loss.link.value), loss.stats);
    stats.crc_errors = served.channel->crc_errors();
    if (served.served_inlet) stats.answers = frames_in(*served.served_inlet);
    stats.unheard_answers = served.unheard_answers;
    return stats;
}

// Sums over the senders that are there and those that are gone.
std::uint64_t Hub::frames_in(link::EndpointId endpoint) {
    std::uint64_t sum = 0;
    for (const auto& link : links().links())
        if (link.endpoint == endpoint) sum += link.counters->frames_in.value();
    for (const auto& info : links().endpoints())
        if (info.id == endpoint) sum += info.counters->gone.frames_in.value();
    return sum;
}

LinkStats Hub::stats(link::EndpointId endpoint) {
    LinkStats stats;
    on_loop([&] { stats = stats_now(endpoint); });
    return stats;
}

bool Hub::is_flushed(link::EndpointId endpoint) {
    return links().queued_bytes(way_out(endpoint)) == 0 || served_.at(endpoint).channel->peers() == 0;
}

void Hub::remove(link::EndpointId endpoint) {
    auto served = std::move(served_.at(endpoint));
    served_.erase(endpoint);
    if (served.inlet) served_.erase(*served.inlet);
    if (served.served_inlet) {
        filled_from_.erase(*served.served_inlet);
        links().remove(*served.served_inlet);
    }
    if (served.is_ring) sources_.remove_ring(endpoint);
    else links().remove(endpoint);
    served.channel->close();
}

LinkStats Hub::close(link::EndpointId endpoint) {
    LinkStats stats;
    on_loop([&] {
        send_outgoing();
        turn(MonoTime{});
    });
    wait_on_loop([&] { return is_flushed(endpoint); }, longest_flush);
    on_loop([&] {
        stats = stats_now(endpoint);
        remove(endpoint);
    });
    return stats;
}

void Hub::send(link::EndpointId endpoint, const wire::FrameView& frame) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return outgoing_.size() < most_outgoing || ended_; });
    if (ended_) return;
    const bool first = outgoing_.empty();
    auto& outgoing = outgoing_.emplace_back();
    outgoing.endpoint = endpoint;
    outgoing.size = static_cast<std::uint16_t>(frame.size());
    std::ranges::copy(frame.bytes(), outgoing.bytes.begin());
    lock.unlock();
    if (first) sources_.wake();
}

}  // namespace mavloom::python
