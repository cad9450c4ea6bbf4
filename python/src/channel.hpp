// SPDX-License-Identifier: MIT
// Channel: the frames that one connect() receives, shared between the loop thread and the Python threads that read
// them.
// It does not depend on Python and never waits for the GIL. Every member function may be called from any thread, except
// those under "loop thread".
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "filter.hpp"
#include "frame_batch.hpp"
#include "frame_ring.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/wire/sequence.hpp"
#include "message.hpp"

namespace mavloom::python {

class Consumer;

// The loss of each source on each link. The key holds the name of the link.
using Losses = std::map<std::tuple<std::string, Source>, wire::SequenceStats>;
void add_to(Losses& losses, std::string link, const wire::SequenceStats& stats);

class Channel {
public:
    // The newest message of one source, id and instance.
    struct Latest {
        FrameRing::Head head;
        MonoTime arrived{};
        std::uint64_t number = 0;  // counts all frames: the highest number is the newest
        std::vector<std::uint8_t> bytes;
    };

    // Frames of one message id with a wrong checksum: damaged, or encoded with another definition.
    struct CrcErrors {
        std::uint64_t count = 0;
        bool always = false;  // no good frame of this id was ever received
    };

    Channel(std::shared_ptr<Origin> origin, std::size_t buffer_bytes, const endpoint::Endpoint& endpoint)
        : origin_(std::move(origin)),
          verifies_(!endpoint.options.verify_key_file.empty()),
          ring_name_(endpoint.scheme == endpoint::Scheme::shm ? endpoint.path : std::string()),
          ring_(buffer_bytes) {}

    [[nodiscard]] const std::shared_ptr<Origin>& origin() const noexcept { return origin_; }
    // The shared-memory ring that is read; empty for other links.
    [[nodiscard]] const std::string& ring_name() const noexcept { return ring_name_; }
    [[nodiscard]] std::size_t peers() const noexcept { return peers_.load(std::memory_order_relaxed); }

    // Returns the newest message that matches the filter and `instance` and arrived at `not_before` or later.
    [[nodiscard]] std::optional<Latest> latest(const Filter& filter, const std::optional<Instance>& instance,
                                               MonoTime not_before) const;
    // Source of the first heartbeat from a vehicle; zeros before it.
    [[nodiscard]] Source target() const;
    // Frames that `latest` does not cover because its table was full.
    [[nodiscard]] std::uint64_t not_kept() const;
    [[nodiscard]] std::map<MessageId, CrcErrors> crc_errors() const;
    // Losses of links that are gone.
    [[nodiscard]] Losses losses() const;

    // ---- loop thread
    void on_frame(const link::RxFrame& rx, MonoTime now);
    void on_link_up(LinkId link, std::string_view name);
    void on_link_down(LinkId link, std::span<const wire::SequenceStats> losses);
    void on_bad_checksum(MessageId id);
    // Names a link of a ring. Such a link is not a peer: nothing can be sent to it.
    void name_link(LinkId link, std::string_view name) { origin_->name_link(link.value, std::string(name)); }
    void forget_link(LinkId link, std::span<const wire::SequenceStats> losses);
    // Whether the frames of a turn fit without overwriting what the reader set by `hold_for` has not read. If not,
    // `room_made` is called once they fit.
    [[nodiscard]] bool has_room();
    static constexpr std::size_t frames_a_turn = 128;  // of a lossless ring
    // Selects the reader whose unread frames `has_room` protects. `room_made` is called with the mutex held.
    void hold_for(const Consumer* reader, std::function<void()> room_made);
    // Wakes readers that wait for frames that arrived since the last call.
    void publish();
    // Ends the channel: no frames follow, and readers get none of those that are left.
    void close();

private:
    friend class Consumer;

    struct Key {
        std::uint32_t id;
        Source source;
        Instance instance;
        friend auto operator<=>(const Key&, const Key&) = default;
    };
    // These limits bound the memory that forged sources, instances and ids can take.
    static constexpr std::size_t most_latest = 16'384;
    static constexpr std::size_t most_losses = 4096, most_bad_ids = 1024;

    void remember(const Key& key, const FrameRing::Head& head, const wire::FrameView& frame, MonoTime now);
    void look_for_vehicle(const wire::FrameView& frame);

    const std::shared_ptr<Origin> origin_;
    const bool verifies_;
    const std::string ring_name_;
    std::atomic<std::size_t> peers_{0};
    std::atomic<bool> closed_{false};  // set with mutex_ held

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    // Guarded by mutex_:
    FrameRing ring_;
    std::map<Key, Latest> latest_;
    std::uint64_t frames_ = 0, not_kept_ = 0;
    Source target_;
    std::map<MessageId, std::uint64_t> bad_ids_;
    Losses losses_;
    std::vector<Consumer*> consumers_;
    const Consumer* holder_ = nullptr;
    std::function<void()> room_made_;
    bool full_ = false;
    bool news_ = false;
};

// One reader of a channel, with its own position.
class Consumer {
public:
    // Reads what arrives from now on. A link creates its own reader before any frame can arrive.
    Consumer(std::shared_ptr<Channel> channel, Filter filter);
    ~Consumer();
    Consumer(const Consumer&) = delete;
    Consumer& operator=(const Consumer&) = delete;

    // Adds up to `most` matching frames to the batch. Returns false if closed. If it adds none, use `wait` or the
    // descriptor to learn when to call again. Both report at once if frames remain: one call looks at a limited number
    // of frames.
    bool take(FrameBatch& batch, std::size_t most);
    // Waits until a frame arrives, the channel or the reader is closed, or the deadline passes. Returns after one slice
    // at the latest, so that signals are handled.
    void wait(MonoTime deadline);
    // Returns a descriptor. After a `take` that added no frame, it becomes readable when another call is worthwhile.
    // Created at the first call; the reader closes it.
    [[nodiscard]] SetupResult<int> event_fd();
    // Frames that were overwritten before this reader read them.
    [[nodiscard]] std::uint64_t missed() const;
    // Frame numbers: one past the newest frame of the channel, and one past the last frame that `take` looked at.
    [[nodiscard]] std::uint64_t newest() const;
    [[nodiscard]] std::uint64_t seen() const;
    // Whether the reader or its channel is closed.
    [[nodiscard]] bool closed() const noexcept { return closed_ || channel_->closed_; }
    void close();

    [[nodiscard]] const std::shared_ptr<Channel>& channel() const noexcept { return channel_; }

private:
    friend class Channel;
    void tell() noexcept;
    static constexpr std::size_t most_looked_at = 4096;  // frames in one call, with the mutex held

    const std::shared_ptr<Channel> channel_;
    const Filter filter_;
    // Guarded by the channel's mutex.
    FrameRing::Position at_;
    std::uint64_t missed_ = 0;
    std::uint64_t seen_ = 0;  // one past the last frame that `take` looked at
    int event_fd_ = -1;
    // `armed_`: the next matching frame makes the descriptor readable. `due_`: that frame has arrived.
    bool armed_ = false, due_ = false;
    std::atomic<bool> closed_{false};  // set with the mutex held
};

}  // namespace mavloom::python
