// SPDX-License-Identifier: MIT
// Receives on a thread of its own, so that whoever prints, writes or sleeps never makes the kernel drop a datagram: frames wait in a bounded
// queue (`--buffer`), and what does not fit there is counted as `buffer_full`. Recordings wait for room instead.
//
// One consumer thread: `next` and `wait`. `stop` may be called from any thread and from a signal handler. Everything under "after stop" is
// complete once the consumer has seen the end (`wait` returned false) or `join` has returned.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "mavloom/feed/sources.hpp"
#include "mavloom/feed/totals.hpp"
#include "mavloom/record/frame_queue.hpp"

namespace mavloom::feed {

// The link's own loss, of one source.
struct SourceLoss {
    LinkId link;
    Source source;
    std::uint64_t received = 0, lost = 0, late = 0, duplicate = 0, resync = 0;
};

class Receiver : private link::LinkHandler {
public:
    static constexpr std::size_t default_buffer_bytes = 64u << 20;

    // Called on the receiving thread, for people: a line that says something happened once.
    using Notice = std::function<void(std::string_view)>;

    [[nodiscard]] static SetupResult<std::unique_ptr<Receiver>> create(const dialect::Dialect& dialect,
                                                                       std::size_t buffer_bytes, Notice notice);
    ~Receiver() override;

    [[nodiscard]] SetupResult<void> add(const endpoint::Endpoint& endpoint);
    // What was opened, with the ports that were given: before `start`.
    [[nodiscard]] std::vector<link::EndpointInfo> endpoints() const { return sources_.links().endpoints(); }
    // Stops by itself at `end` (`--for`).
    void start(MonoTime end = MonoTime::max());

    // What the kernel holds already is still received (at most what a full receive buffer holds). Async-signal-safe.
    void stop() noexcept;
    void join();

    [[nodiscard]] std::optional<record::FrameQueue::Entry> next() noexcept { return queue_->next(); }
    [[nodiscard]] bool wait() noexcept { return queue_->wait(); }
    // Stays valid until the receiver goes. Consumer thread.
    [[nodiscard]] std::string_view link_name(LinkId link);

    // After stop:
    [[nodiscard]] const Totals& totals() const noexcept { return totals_; }
    [[nodiscard]] std::vector<SourceLoss> losses() const;  // by link, then source; the first 65,536
    // The first recording that could not be read to its end.
    [[nodiscard]] const SetupError* error() const noexcept { return sources_.error(); }

private:
    Receiver(Sources sources, std::unique_ptr<record::FrameQueue> queue, Notice notice);

    void on_frame(const link::RxFrame& rx) override;
    void on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) override;
    void on_notice(link::EndpointId endpoint, std::string_view text) override;

    void run();
    [[nodiscard]] std::size_t frames_that_fit() const noexcept;
    void count_loss(const link::RxFrame& rx);

    Sources sources_;
    std::unique_ptr<record::FrameQueue> queue_;
    Notice notice_;
    std::thread thread_;
    std::atomic<bool> stopping_{false};
    MonoTime end_ = MonoTime::max();

    Totals totals_;  // the receiving thread's until the queue is closed
    std::map<std::tuple<LinkId, Source>, SourceLoss> losses_;
    SourceLoss* last_loss_ = nullptr;  // most frames come from the same source as the one before

    // Written when a link comes up, read on its first frame: the consumer keeps the last one it asked for.
    std::mutex names_mutex_;
    std::unordered_map<LinkId, std::string> names_;  // guarded by names_mutex_; never removed, so that views stay valid
    LinkId last_named_;                              // the consumer's
    std::string_view last_name_;
};

}  // namespace mavloom::feed
