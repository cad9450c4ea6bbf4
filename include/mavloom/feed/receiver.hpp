// SPDX-License-Identifier: MIT
// Receives frames on its own thread, so that a consumer that prints, writes or sleeps does not make the kernel drop
// datagrams. Frames wait in a bounded queue (`--buffer`). If a frame from a live link does not fit, the receiver drops
// it and counts it in `buffer_full`. Recordings and rings are read only while there is room.
//
// One consumer thread calls `next`, `wait` and `link_name`. Any thread, and a signal handler, may call `stop`. The
// results under "after stop" are complete once `wait` has returned false or `join` has returned.
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
#include "mavloom/link/silence_watch.hpp"
#include "mavloom/record/frame_queue.hpp"

namespace mavloom::feed {

// Loss of one source on one link, from its sequence numbers.
struct ReceivedLoss {
    LinkId link;
    Source source;
    std::uint64_t received = 0, lost = 0, late = 0, duplicate = 0, resync = 0;
};

class Receiver : private link::LinkHandler {
public:
    static constexpr std::size_t default_buffer_bytes = 64u << 20;

    // Receives a log line about a single event. Called on the receiving thread.
    using Notice = std::function<void(std::string_view)>;

    [[nodiscard]] static SetupResult<std::unique_ptr<Receiver>> create(const dialect::Dialect& dialect,
                                                                       std::size_t buffer_bytes, Notice notice);
    ~Receiver() override;

    [[nodiscard]] SetupResult<void> add(const endpoint::Endpoint& endpoint);
    // The opened endpoints with their actual ports. Call it before `start`.
    [[nodiscard]] std::vector<link::EndpointInfo> endpoints() const { return sources_.links().endpoints(); }
    // Starts the receiving thread, which stops by itself at `end` (`--for`).
    void start(MonoTime end = MonoTime::max());

    // Stops receiving. Frames that the kernel already holds are still received, up to one full receive buffer.
    // Async-signal-safe.
    void stop() noexcept;
    void join();

    [[nodiscard]] std::optional<record::FrameQueue::Entry> next() noexcept { return queue_->next(); }
    // Waits for a frame, for about a second at most, so that the consumer can look after its file. Returns false once
    // receiving has stopped and all frames are read.
    [[nodiscard]] bool wait() noexcept { return queue_->wait(); }
    // The name of a link, valid as long as the receiver exists. Consumer thread only.
    [[nodiscard]] std::string_view link_name(LinkId link);

    // After stop:
    [[nodiscard]] const Totals& totals() const noexcept { return totals_; }
    [[nodiscard]] std::vector<ReceivedLoss> losses() const;  // sorted by link, then source; at most 65,536
    // The error of the first recording that failed before its end; null if none failed.
    [[nodiscard]] const SetupError* error() const noexcept { return sources_.error(); }

private:
    Receiver(Sources sources, std::unique_ptr<record::FrameQueue> queue, Notice notice);

    void on_frame(const link::RxFrame& rx) override;
    void on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) override;
    void on_link_down(LinkId link, link::EndpointId endpoint, std::string_view why) override;
    void on_notice(link::EndpointId endpoint, std::string_view text) override;

    void run();
    void look_after(MonoTime now);
    [[nodiscard]] std::size_t frames_that_fit() const noexcept;
    void count_loss(const link::RxFrame& rx);

    Sources sources_;
    link::SilenceWatch silence_;  // used by the receiving thread only, once it runs
    std::unique_ptr<record::FrameQueue> queue_;
    Notice notice_;
    std::thread thread_;
    std::atomic<bool> stopping_{false};
    MonoTime end_ = MonoTime::max();

    Totals totals_;  // used by the receiving thread only, until it closes the queue
    std::map<std::tuple<LinkId, Source>, ReceivedLoss> losses_;
    ReceivedLoss* last_loss_ = nullptr;  // most frames come from the same source as the one before

    // The receiving thread adds a name when a link comes up. The consumer caches the last name that it looked up, so it
    // rarely takes the lock.
    std::mutex names_mutex_;
    std::unordered_map<LinkId, std::string> names_;  // guarded by names_mutex_; never erased: views stay valid
    LinkId last_named_;                              // used by the consumer only
    std::string_view last_name_;
};

}  // namespace mavloom::feed
