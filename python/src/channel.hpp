// SPDX-License-Identifier: MIT
// What one connect() opened, between the loop thread that fills it and the Python threads that read it. Knows nothing of Python and never waits for the GIL.
// Every member function may be called from any thread, but those under "loop thread".
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

// What each source lost on each link, by the link's name.
using Losses = std::map<std::tuple<std::string, Source>, wire::SequenceStats>;
void add_to(Losses& losses, std::string link, const wire::SequenceStats& stats);

class Channel {
public:
    // A message that was kept because it is the newest of its source, id and instance.
    struct Latest {
        FrameRing::Head head;
        MonoTime arrived{};
        std::uint64_t number = 0;  // counts all frames: the greatest is the newest
        std::vector<std::uint8_t> bytes;
    };

    // Frames of one message that were damaged, or made with another definition.
    struct CrcErrors {
        std::uint64_t count = 0;
        bool always = false;  // no good one was ever heard
    };

    Channel(std::shared_ptr<Origin> origin, std::size_t buffer_bytes, const endpoint::Endpoint& endpoint)
        : origin_(std::move(origin)),
          verifies_(!endpoint.options.verify_key_file.empty()),
          ring_name_(endpoint.scheme == endpoint::Scheme::shm ? endpoint.path : std::string()),
          ring_(buffer_bytes) {}

    [[nodiscard]] const std::shared_ptr<Origin>& origin() const noexcept { return origin_; }
    // The ring in shared memory that is read; empty for other links.
    [[nodiscard]] const std::string& ring_name() const noexcept { return ring_name_; }
    [[nodiscard]] std::size_t peers() const noexcept { return peers_.load(std::memory_order_relaxed); }

    // The newest message that the filter and `instance` take and that is not older than `not_before`.
    [[nodiscard]] std::optional<Latest> latest(const Filter& filter, const std::optional<Instance>& instance,
                                               MonoTime not_before) const;
    // Source of the first heartbeat of a vehicle; zeros before it.
    [[nodiscard]] Source target() const;
    // Frames that `latest` does not know: its table was full.
    [[nodiscard]] std::uint64_t not_kept() const;
    [[nodiscard]] std::map<MessageId, CrcErrors> crc_errors() const;
    // Of links that are gone.
    [[nodiscard]] Losses losses() const;

    // ---- loop thread
    void on_frame(const link::RxFrame& rx, MonoTime now);
    void on_link_up(LinkId link, std::string_view name);
    void on_link_down(LinkId link, std::span<const wire::SequenceStats> losses);
    void on_bad_checksum(MessageId id);
    // A link of a ring: it has a name, but nobody to send to.
    void name_link(LinkId link, std::string_view name) { origin_->name_link(link.value, std::string(name)); }
    void forget_link(LinkId link, std::span<const wire::SequenceStats> losses);
    // Whether the frames of a turn fit behind what `reader` has not read; where not, `room_made` is called when they do.
    [[nodiscard]] bool has_room();
    static constexpr std::size_t frames_a_turn = 128;  // of a ring that is held for a reader
    void hold_for(const Consumer* reader, std::function<void()> room_made);
    // Wakes who waits for what came since.
    void publish();
    // Nothing follows, and nothing more is read.
    void close();

private:
    friend class Consumer;

    struct Key {
        std::uint32_t id;
        Source source;
        Instance instance;
        friend auto operator<=>(const Key&, const Key&) = default;
    };
    // These bound what forged sources, instances and ids can make us remember.
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
    // All of these are guarded by mutex_.
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
    // Reads what arrives from now on; a link's own reader is made before anything can.
    Consumer(std::shared_ptr<Channel> channel, Filter filter);
    ~Consumer();
    Consumer(const Consumer&) = delete;
    Consumer& operator=(const Consumer&) = delete;

    // Puts up to `most` frames that it takes into the batch; false: closed. Where none was added, `wait` and the descriptor tell when to ask again: at once
    // where there were so many others that more may follow.
    bool take(FrameBatch& batch, std::size_t most);
    // Waits until something came, the channel or the reader is closed, or the deadline; no longer than a slice, so that signals get their turn.
    void wait(MonoTime deadline);
    // A descriptor that becomes readable when there is something to take after `none`; made at the first call.
    [[nodiscard]] SetupResult<int> event_fd();
    [[nodiscard]] std::uint64_t missed() const;
    // Numbers of the frames behind the newest there is, and behind the last that `take` had looked at.
    [[nodiscard]] std::uint64_t newest() const;
    [[nodiscard]] std::uint64_t seen() const;
    // It, or its channel.
    [[nodiscard]] bool closed() const noexcept { return closed_ || channel_->closed_; }
    void close();

    [[nodiscard]] const std::shared_ptr<Channel>& channel() const noexcept { return channel_; }

private:
    friend class Channel;
    void tell() noexcept;
    static constexpr std::size_t most_looked_at = 4096;  // frames, with the mutex held

    const std::shared_ptr<Channel> channel_;
    const Filter filter_;
    // Guarded by the channel's mutex.
    FrameRing::Position at_;
    std::uint64_t missed_ = 0;
    std::uint64_t seen_ = 0;  // frames of the channel that `take` had looked at
    int event_fd_ = -1;
    bool armed_ = false, due_ = false;  // the descriptor is to tell; something came for it
    std::atomic<bool> closed_{false};   // set with the mutex held
};

}  // namespace mavloom::python
