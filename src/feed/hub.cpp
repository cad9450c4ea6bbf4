// SPDX-License-Identifier: MIT
#include "mavloom/feed/hub.hpp"

#include <pthread.h>

#include <system_error>
#include <type_traits>
#include <vector>

#include "feed/hub_links.hpp"
#include "feed/loop_calls.hpp"
#include "feed/outbox.hpp"
#include "mavloom/base/thread.hpp"

namespace mavloom::feed {
namespace {

using namespace std::chrono_literals;

constexpr auto longest_flush = 1s, required_limit = 5s;

std::mutex registry_mutex;
std::vector<std::weak_ptr<Hub>>& registry() {
    // Never destroyed: other threads may still use it when static objects are destroyed.
    static auto& hubs = *new std::vector<std::weak_ptr<Hub>>;
    return hubs;
}
[[maybe_unused]] const int guards_registry = ::pthread_atfork(
    [] { registry_mutex.lock(); }, [] { registry_mutex.unlock(); },
    [] {
        registry().clear();  // leaves the parent's hubs untouched
        registry_mutex.unlock();
    });

}  // namespace

// ---- the hub of the process

SetupResult<std::shared_ptr<Hub>> Hub::get() {
    const std::lock_guard lock(registry_mutex);
    std::erase_if(registry(), [](const auto& hub) { return hub.expired(); });
    for (const auto& known : registry())
        if (auto hub = known.lock(); hub && !hub->stopping_) return hub;
    auto sources = Sources::create(dialect::default_dialect());
    if (!sources) return tl::unexpected(std::move(sources.error()));
    try {
        const std::shared_ptr<Hub> hub(new Hub(std::move(*sources)));
        registry().push_back(hub);
        return hub;
    } catch (const std::system_error& error) {
        return system_error("cannot start the thread for links", error.code().value());
    }
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

Hub::Hub(Sources sources)
    : links_(std::make_unique<HubLinks>(std::move(sources))),
      calls_(std::make_unique<LoopCalls>([this] { links_->wake(); })),
      outbox_(std::make_unique<Outbox>()),
      thread_(thread_without_signals([this] { run(); })) {}

Hub::~Hub() { stop(); }

void Hub::stop() {
    stopping_.store(true, std::memory_order_relaxed);
    links_->wake();
    const std::lock_guard lock(joining_);
    if (thread_.joinable()) thread_.join();
}

// ---- loop thread

void Hub::run() {
    while (!stopping_.load(std::memory_order_relaxed)) {
        calls_->run();
        send_queued();
        calls_->end_waits();
        links_->turn(calls_->first_limit());
    }
    for (const auto& entry : outbox_->close()) links_->send(entry.to(), entry.frame());
    links_->turn(MonoTime{});
    links_->close_channels();
    calls_->end();
}

void Hub::send_queued() {
    for (const auto& entry : outbox_->take()) links_->send(entry.to(), entry.frame());
}

// ---- any other thread

template <class Work>
std::invoke_result_t<Work> Hub::on_loop(Work work) {
    std::invoke_result_t<Work> result = setup_error(SetupCode::system, "the loop thread has ended");
    calls_->call([&] { result = work(); });
    return result;
}

SetupResult<Hub::Opened> Hub::open(const endpoint::Endpoint& endpoint, const std::shared_ptr<Channel>& channel,
                                   const ChannelReader& reader) {
    auto opened = on_loop([&] { return links_->open(endpoint, channel, reader); });
    if (!opened || !endpoint.options.required) return opened;
    if (auto reached = wait_for_far_side(*opened); !reached) {
        calls_->call([&] { links_->remove(opened->endpoint); });
        return tl::unexpected(std::move(reached.error()).within(opened->name));
    }
    return opened;
}

SetupResult<void> Hub::wait_for_far_side(const Opened& opened) {
    SetupResult<void> reached = setup_error(SetupCode::unreachable, "no answer within 5 s");
    calls_->wait(
        [&] {
            auto outcome = links_->far_side(opened);
            if (outcome) reached = std::move(*outcome);
            return outcome.has_value();
        },
        required_limit);
    return reached;
}

SetupResult<link::EndpointId> Hub::inlet(link::EndpointId ring) {
    return on_loop([&] { return links_->inlet(ring); });
}

SetupResult<void> Hub::serve_inlet(link::EndpointId endpoint, const std::string& ring, unsigned mode) {
    return on_loop([&] { return links_->serve_inlet(endpoint, ring, mode); });
}

EndpointStats Hub::stats(link::EndpointId endpoint) {
    EndpointStats stats;
    calls_->call([&] { stats = links_->stats(endpoint); });
    return stats;
}

std::string Hub::silence_reason(link::EndpointId endpoint) {
    std::string reason;
    calls_->call([&] { reason = links_->silence_reason(endpoint); });
    return reason;
}

EndpointStats Hub::close(link::EndpointId endpoint) {
    calls_->call([&] {
        send_queued();
        links_->turn(MonoTime{});
    });
    calls_->wait([&] { return links_->is_flushed(endpoint); }, longest_flush);
    EndpointStats stats;
    calls_->call([&] {
        stats = links_->stats(endpoint);
        links_->remove(endpoint);
    });
    return stats;
}

std::size_t Hub::queued_bytes(link::EndpointId endpoint) {
    std::size_t bytes = 0;
    calls_->call([&] {
        send_queued();
        bytes = links_->queued_bytes(endpoint);
    });
    return bytes;
}

bool Hub::send(link::EndpointId endpoint, const wire::FrameView& frame) {
    const auto put = outbox_->put(endpoint, frame);
    if (put == Outbox::Put::first) links_->wake();
    return put != Outbox::Put::closed;
}

}  // namespace mavloom::feed
