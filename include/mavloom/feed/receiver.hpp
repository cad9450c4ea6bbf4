// SPDX-License-Identifier: MIT
// Receives frames on its own thread, so that a consumer that prints, writes or sleeps does not make the kernel drop
// datagrams. Frames wait in a bounded queue (`--buffer`). If a frame from a live link does not fit, the receiver drops
// it and counts it in `buffer_full`. Recordings and rings are read only while there is room.
//
// One consumer thread calls `next`, `wait` and `link_name`. Any thread, and a signal handler, may call `stop`. The
// results under "after stop" are complete once `wait` has returned false or `join` has returned.
#pragma once

#include <atomic>
#include <condition_variable>
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
#include <utility>
#include <vector>

#include "mavloom/feed/sources.hpp"
#include "mavloom/feed/totals.hpp"
#include "mavloom/link/silence_watch.hpp"
#include "mavloom/link/snapshot.hpp"
#include "mavloom/record/frame_queue.hpp"

namespace mavloom::feed {

class Outbox;

// Loss of one source on one link, from its sequence numbers.
struct ReceivedLoss {
    LinkId link;
    Source source;
    std::uint64_t received = 0, lost = 0, late = 0, duplicate = 0, resync = 0;
    bool is_over = false;  // the link is down
};

class Receiver : private link::LinkHandler {
public:
    static constexpr std::size_t default_buffer_bytes = 64u << 20;

    // Receives a log line about a single event. Called on the receiving thread.
    using Notice = std::function<void(std::string_view)>;

    [[nodiscard]] static SetupResult<std::unique_ptr<Receiver>> create(const dialect::Dialect& dialect,
                                                                       std::size_t buffer_bytes, Notice notice,
                                                                       Copies copies = Copies::kept);
    ~Receiver() override;

    // Returns the id that `endpoint_of` returns for the links of the endpoint.
    SetupResult<link::EndpointId> add(const endpoint::Endpoint& endpoint);
    // The opened endpoints with their actual ports. Call it before `start`.
    [[nodiscard]] std::vector<link::EndpointInfo> endpoints() const { return sources_.links().endpoints(); }
    // Starts the receiving thread, which stops by itself at `end` (`--for`). After a turn with few frames it rests, so
    // that frames which arrive close together cost one turn. Frames keep the times of their arrival.
    void start(MonoTime end = MonoTime::max(), Nanoseconds rest = {});

    // Stops receiving. Frames that the kernel already holds are still received, up to one full receive buffer.
    // Async-signal-safe.
    void stop() noexcept;
    void join();

    // Sends a frame to every live link, and to the inlet of every ring. Any thread; waits while 4096 frames are queued.
    void send(const wire::FrameView& frame);
    // Frames that no link and no inlet took. Any thread.
    [[nodiscard]] std::uint64_t untaken() const noexcept { return untaken_.value(); }

    [[nodiscard]] std::optional<record::FrameQueue::Entry> next() noexcept { return queue_->next(); }
    // Waits for a frame, for about a second at most, so that the consumer can look after its file. Returns false once
    // receiving has stopped and all frames are read.
    [[nodiscard]] bool wait() noexcept { return queue_->wait(); }
    // The name of a link, valid as long as the receiver exists. Consumer thread only.
    [[nodiscard]] std::string_view link_name(LinkId link);
    // The same for any thread. Slower.
    [[nodiscard]] std::string_view name_of(LinkId link);
    // The endpoint of the link, as `add` returned it. Consumer thread only.
    [[nodiscard]] link::EndpointId endpoint_of(LinkId link);

    // A link, a ring or a recording.
    struct OfSource {
        LinkId link{};  // that of its frames; not of a ring, which has many
        link::EndpointId endpoint{};
        std::string name;
        bool is_up = true;       // a ring is if it is there; a recording until its end
        bool has_ended = false;  // a recording
        std::vector<link::NamedCount> counts{};
    };
    static constexpr std::size_t max_sources = 256;  // in counts: the busiest links

    // A live endpoint.
    struct OfEndpoint {
        link::EndpointId endpoint;
        std::uint64_t rcvbuf_bytes = 0;          // as granted by the kernel; 0: it has none
        std::vector<link::NamedCount> counts{};  // of the endpoint, then of its links, present and gone
        std::string failure{};                   // why it is not connected; empty if it is
        std::string silence{};                   // what to check if nothing was heard
    };
    // Frames of one message with a wrong checksum: damaged, or encoded with another definition.
    struct BadChecksum {
        LinkId link{};
        MessageId id{};
        std::uint64_t count = 0;
    };

    // All that was counted at one moment, between two turns.
    struct Counts {
        Totals totals{};
        std::uint64_t lost = 0;              // of the totals, without what was lost before it came into a ring
        std::vector<ReceivedLoss> losses{};  // as of `losses`, without links that are down
        std::vector<OfSource> sources{};
        std::vector<OfEndpoint> endpoints{};
        std::vector<BadChecksum> bad_checksums{};  // at most 1,024
    };
    // The counts of now. Waits at most 200 ms for the receiving thread. After a timeout, returns the previous counts.
    // Any thread. Call it after `start`.
    [[nodiscard]] Counts counts();

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
    void on_bad_checksum(LinkId link, link::EndpointId endpoint, MessageId id) override;

    void run();
    void maintain(MonoTime now);
    void send_queued();
    [[nodiscard]] std::size_t frames_that_fit() const noexcept;
    void count_loss(const link::RxFrame& rx);
    void answer_counts();
    void publish_counts(std::uint64_t answers);
    [[nodiscard]] std::vector<OfSource> snapshot() const;
    [[nodiscard]] std::vector<OfEndpoint> endpoints_snapshot() const;
    struct Named {
        std::string name;
        link::EndpointId endpoint;
    };
    // The name of a link that had no room for one is a fixed text.
    const Named& find_name(LinkId link);
    const Named& cached_name(LinkId link);

    Sources sources_;
    link::SilenceWatch silence_;  // used by the receiving thread only, once it runs
    std::unique_ptr<record::FrameQueue> queue_;
    Notice notice_;
    std::thread thread_;
    std::atomic<bool> stopping_{false};
    MonoTime end_ = MonoTime::max();
    Nanoseconds rest_{};

    std::unique_ptr<Outbox> outbox_;
    std::atomic<bool> has_outgoing_{false};
    Counter untaken_;

    Totals totals_;  // used by the receiving thread only, until it closes the queue
    std::map<std::tuple<LinkId, Source>, ReceivedLoss> losses_;
    ReceivedLoss* last_loss_ = nullptr;  // most frames come from the same source as the one before
    std::map<std::pair<LinkId, MessageId>, std::uint64_t> bad_checksums_;

    std::atomic<std::uint64_t> asked_{0};  // calls of `counts`
    std::mutex counts_mutex_;
    std::condition_variable counted_;
    Counts counts_;               // guarded by counts_mutex_, as the next
    std::uint64_t answered_ = 0;  // calls of `counts`; also read by the receiving thread, which changes it

    // The receiving thread adds a name when a link comes up. The consumer caches the last name that it looked up, so it
    // rarely takes the lock.
    std::mutex names_mutex_;
    std::unordered_map<LinkId, Named> names_;  // guarded by names_mutex_; never erased: views stay valid
    LinkId last_named_;                        // used by the consumer only
    const Named* last_name_ = nullptr;
};

}  // namespace mavloom::feed
