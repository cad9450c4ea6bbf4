// SPDX-License-Identifier: MIT
// The loop thread behind all links of one dialect: it receives, sends and reconnects without ever touching Python. It runs while a link is open.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <unordered_map>
#include <vector>

#include "channel.hpp"
#include "mavloom/runtime/links.hpp"
#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::python {

// Sums over the peers of one endpoint, those that went included.
struct LinkStats {
    runtime::LinkCounters links;
    runtime::EndpointCounters endpoint;
    std::uint64_t missed = 0, not_kept = 0, no_peer = 0, peers = 0;
};

class Hub : private runtime::LinkHandler {
public:
    // The one that is running for these definitions, or a new one.
    [[nodiscard]] static SetupResult<std::shared_ptr<Hub>> get(const std::shared_ptr<const Definitions>& definitions);
    // Ends every loop thread and closes their channels: at the interpreter's exit.
    static void stop_all();
    // Once, before anything else: a forked child begins with nothing open.
    static void watch_forks();
    // How often this process was forked off: what was opened before must not be used.
    [[nodiscard]] static std::uint64_t forks() noexcept;

    ~Hub() override;

    struct Opened {
        runtime::EndpointId endpoint;
        std::uint16_t port = 0;
        std::string name;
    };
    // `channel` gets what arrives from the first frame on. What can be opened at once is open when this returns.
    [[nodiscard]] SetupResult<Opened> open(const runtime::Endpoint& endpoint, const std::shared_ptr<Channel>& channel);
    // What was sent goes out first, for at most a second. Returns the last counters.
    LinkStats close(runtime::EndpointId endpoint);
    [[nodiscard]] LinkStats stats(runtime::EndpointId endpoint);
    // Queues a frame for every peer of the endpoint. Waits while too much is queued already.
    void send(runtime::EndpointId endpoint, const wire::FrameView& frame);

private:
    struct Outgoing {
        runtime::EndpointId endpoint;
        std::uint16_t size = 0;
        wire::FrameBuffer bytes;
    };
    static constexpr std::size_t most_outgoing = 4096;

    explicit Hub(std::unique_ptr<runtime::Links> links, std::shared_ptr<const Definitions> definitions);

    void on_frame(const runtime::RxFrame& rx) override;
    void on_link_up(LinkId link, runtime::EndpointId endpoint, std::string_view name) override;
    void on_link_down(LinkId link, runtime::EndpointId endpoint, std::string_view why) override;

    void run();
    void turn(MonoTime deadline);
    void send_outgoing();
    void stop();
    [[nodiscard]] Channel* channel_of(runtime::EndpointId endpoint) noexcept;
    [[nodiscard]] LinkStats stats_now(runtime::EndpointId endpoint);
    // Runs `work` on the loop thread and waits for it; false when that has ended.
    bool on_loop(std::function<void()> work);

    const std::shared_ptr<const Definitions> definitions_;
    std::unique_ptr<runtime::Links> links_;                                       // the loop thread's
    std::unordered_map<runtime::EndpointId, std::shared_ptr<Channel>> channels_;  // the loop thread's

    std::mutex mutex_;
    std::condition_variable changed_;
    // Guarded by mutex_.
    std::vector<std::function<void()>> work_;
    std::vector<Outgoing> outgoing_;
    bool ended_ = false;

    std::atomic<bool> stopping_{false};
    std::mutex joining_;  // two threads may stop one hub
    std::thread thread_;
};

}  // namespace mavloom::python
