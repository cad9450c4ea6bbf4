// SPDX-License-Identifier: MIT
#include "hub.hpp"

#include <pthread.h>

#include <csignal>

#include "gil.hpp"

namespace mavloom::python {
namespace {

using namespace std::chrono_literals;

constexpr auto longest_flush = 1s;

std::mutex registry_mutex;
std::vector<std::weak_ptr<Hub>>& registry() {
    static auto& hubs = *new std::vector<std::weak_ptr<Hub>>;  // never destroyed: the interpreter ends before static objects do
    return hubs;
}

std::atomic<std::uint64_t> fork_count{0};

// Signals are for the threads of the interpreter: this one blocks them all.
template <class Run>
std::thread start_without_signals(Run run) {
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    std::thread thread(std::move(run));
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return thread;
}

}  // namespace

void Hub::watch_forks() {
    static const int registered = ::pthread_atfork([] { registry_mutex.lock(); }, [] { registry_mutex.unlock(); },
                                                   [] {
                                                       registry().clear();  // the parent's hubs are left alone
                                                       registry_mutex.unlock();
                                                       fork_count.fetch_add(1, std::memory_order_relaxed);
                                                       WithoutGil::forked();
                                                   });
    static_cast<void>(registered);
}

std::uint64_t Hub::forks() noexcept { return fork_count.load(std::memory_order_relaxed); }

SetupResult<std::shared_ptr<Hub>> Hub::get(const std::shared_ptr<const Definitions>& definitions) {
    const std::lock_guard lock(registry_mutex);
    std::erase_if(registry(), [](const auto& hub) { return hub.expired(); });
    for (const auto& known : registry())
        if (auto hub = known.lock(); hub && hub->definitions_ == definitions && !hub->stopping_) return hub;
    auto links = runtime::Links::create(definitions->dialect());
    if (!links) return tl::unexpected(std::move(links.error()));
    const std::shared_ptr<Hub> hub(new Hub(std::move(*links), definitions));
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

Hub::Hub(std::unique_ptr<runtime::Links> links, std::shared_ptr<const Definitions> definitions)
    : definitions_(std::move(definitions)), links_(std::move(links)) {
    thread_ = start_without_signals([this] { run(); });
}

Hub::~Hub() { stop(); }

void Hub::stop() {
    stopping_.store(true, std::memory_order_relaxed);
    links_->wake();
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
        turn(MonoTime::max());
    }
    send_outgoing();
    turn(MonoTime{});
    for (const auto& [endpoint, channel] : channels_) channel->close();
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
}

void Hub::turn(MonoTime deadline) {
    links_->turn(*this, deadline);
    for (const auto& [endpoint, channel] : channels_) channel->publish();
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
        links_->send(frame.endpoint, wire::FrameView::unchecked({frame.bytes.data(), frame.size}));
}

Channel* Hub::channel_of(runtime::EndpointId endpoint) noexcept {
    const auto found = channels_.find(endpoint);
    return found == channels_.end() ? nullptr : found->second.get();
}

void Hub::on_frame(const runtime::RxFrame& rx) {
    if (auto* channel = channel_of(rx.endpoint)) channel->on_frame(rx, links_->now());
}
void Hub::on_link_up(LinkId link, runtime::EndpointId endpoint, std::string_view name) {
    if (auto* channel = channel_of(endpoint)) channel->on_link_up(link, name);
}
void Hub::on_link_down(LinkId, runtime::EndpointId endpoint, std::string_view) {
    if (auto* channel = channel_of(endpoint)) channel->on_link_down();
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
    links_->wake();
    changed_.wait(lock, [&] { return done || ended_; });
    return done;
}

SetupResult<Hub::Opened> Hub::open(const runtime::Endpoint& endpoint, const std::shared_ptr<Channel>& channel) {
    SetupResult<Opened> opened = setup_error(SetupCode::system, "the loop thread has ended");
    on_loop([&] {
        const auto added = links_->add(endpoint);
        if (!added) {
            opened = tl::unexpected(added.error());
            return;
        }
        channels_.emplace(*added, channel);
        turn(MonoTime{});
        for (const auto& info : links_->endpoints())
            if (info.id == *added) opened = Opened{*added, info.local_port, info.label()};
    });
    return opened;
}

LinkStats Hub::stats_now(runtime::EndpointId endpoint) {
    links_->refresh_kernel_drops();
    LinkStats stats;
    for (const auto& link : links_->links()) {
        if (link.endpoint != endpoint) continue;
        stats.links.add(*link.counters);
        stats.peers += link.up;
    }
    for (const auto& info : links_->endpoints()) {
        if (info.id != endpoint) continue;
        stats.endpoint = *info.counters;
        stats.links.add(info.counters->gone);
    }
    return stats;
}

LinkStats Hub::stats(runtime::EndpointId endpoint) {
    LinkStats stats;
    on_loop([&] { stats = stats_now(endpoint); });
    return stats;
}

LinkStats Hub::close(runtime::EndpointId endpoint) {
    LinkStats stats;
    on_loop([&] {
        send_outgoing();
        const auto limit = mono_now() + longest_flush;
        do turn(MonoTime{});
        while (links_->queued_bytes(endpoint) != 0 && channel_of(endpoint)->peers() != 0 && mono_now() < limit);
        stats = stats_now(endpoint);
        links_->remove(endpoint);
        channels_.at(endpoint)->close();
        channels_.erase(endpoint);
    });
    return stats;
}

void Hub::send(runtime::EndpointId endpoint, const wire::FrameView& frame) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return outgoing_.size() < most_outgoing || ended_; });
    if (ended_) return;
    const bool first = outgoing_.empty();
    auto& outgoing = outgoing_.emplace_back();
    outgoing.endpoint = endpoint;
    outgoing.size = static_cast<std::uint16_t>(frame.size());
    std::ranges::copy(frame.bytes(), outgoing.bytes.begin());
    lock.unlock();
    if (first) links_->wake();
}

}  // namespace mavloom::python
