// SPDX-License-Identifier: MIT
// Channel: passes the frames of one endpoint from the loop thread to any number of readers. ChannelReader: one reader.
// The loop thread never waits for a reader. It writes frames into a bounded buffer, which overwrites the oldest frames.
// Each reader counts the frames that it missed. Any thread may call both, except for the functions under "loop thread".
// Each reader keeps its channel alive through a shared pointer.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "mavloom/dialect/filter.hpp"
#include "mavloom/feed/frame_batch.hpp"
#include "mavloom/feed/frame_ring.hpp"
#include "mavloom/feed/link_names.hpp"
#include "mavloom/feed/newest_frames.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/record/recorder.hpp"
#include "mavloom/wire/sequence.hpp"

namespace mavloom::feed {

class ChannelReader;

// The loss of each source on each link. The key holds the name of the link.
using Losses = std::map<std::tuple<std::string, Source>, wire::SequenceStats>;
void add_to(Losses& losses, std::string link, const wire::SequenceStats& stats);

class Channel {
public:
    // Frames of one message id with a wrong checksum: damaged, or encoded with another definition.
    struct CrcErrors {
        std::uint64_t count = 0;
        bool always = false;  // no good frame of this id was ever received
    };

    // `buffer_bytes` is the size of the FrameRing. `verifies`: the endpoint passes only frames with a valid signature.
    Channel(std::shared_ptr<const dialect::Dialect> dialect, std::shared_ptr<LinkNames> names, std::size_t buffer_bytes,
            bool verifies)
        : dialect_(std::move(dialect)), names_(std::move(names)), verifies_(verifies), ring_(buffer_bytes) {}

    [[nodiscard]] const dialect::Dialect& dialect() const noexcept { return *dialect_; }
    [[nodiscard]] const LinkNames& names() const noexcept { return *names_; }
    // The number of current peers.
    [[nodiscard]] std::size_t peers() const noexcept { return peers_.load(std::memory_order_relaxed); }

    // Returns a copy of the newest frame that matches: see NewestFrames.
    [[nodiscard]] std::optional<NewestFrames::Entry> latest(const dialect::Filter& filter,
                                                            const std::optional<message::Instance>& instance,
                                                            MonoTime not_before) const;
    // The number of frames that `latest` cannot return, because NewestFrames was full.
    [[nodiscard]] std::uint64_t not_kept() const;
    // The source of the first heartbeat from a vehicle. Both ids are 0 until one arrives.
    [[nodiscard]] Source target() const;
    [[nodiscard]] std::map<MessageId, CrcErrors> crc_errors() const;
    // Losses of links that are gone.
    [[nodiscard]] Losses losses() const;

    // From now on, the recorder also gets every frame, until `end_recording`. Recording never delays the loop thread.
    void record_with(std::shared_ptr<record::Recorder> recorder);
    // Ends the recording without waiting for the disk; the recorder's `stop` waits.
    void end_recording(const std::shared_ptr<record::Recorder>& recorder);

    // ---- loop thread
    void on_frame(const link::RxFrame& rx, MonoTime now);
    void on_link_up(LinkId link, std::string_view name);
    void on_link_down(LinkId link, std::span<const wire::SequenceStats> losses);
    void on_bad_checksum(MessageId id);
    // Sets the name of a ring's link. Such a link is not a peer: nothing can be sent to it.
    void name_link(LinkId link, std::string_view name) { names_->add(link, std::string(name)); }
    void forget_link(LinkId link, std::span<const wire::SequenceStats> losses);
    // Calls Recorder::maintain of each recorder. Call it once a second.
    void maintain_recorders();
    // Wakes readers that wait for frames that arrived since the last call.
    void publish();
    // Ends the channel. Readers get no more frames, not even those that are still in the buffer.
    void close();

    // For a source that can pause, such as a lossless ring:
    static constexpr std::size_t frames_a_turn = 128;
    // Protects the frames that `reader` has not read yet. In return, the caller must push frames only while `has_room`
    // is true. The protection ends when the reader is closed or destroyed. `room_made` is called with the mutex held.
    void hold_for(const ChannelReader* reader, std::function<void()> room_made);
    // Whether `frames_a_turn` frames fit without overwriting protected frames. If not, `room_made` is called as soon as
    // they fit.
    [[nodiscard]] bool has_room();

private:
    friend class ChannelReader;

    // These limits bound the memory that forged sources and ids can use.
    static constexpr std::size_t max_losses = 4096, max_bad_ids = 1024;

    // Call these with mutex_ held.
    void notify_of_room();
    void end_hold(const ChannelReader* reader);

    const std::shared_ptr<const dialect::Dialect> dialect_;
    const std::shared_ptr<LinkNames> names_;
    const bool verifies_;
    std::atomic<std::size_t> peers_{0};
    std::atomic<bool> closed_{false};  // set with mutex_ held

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    // Guarded by mutex_:
    FrameRing ring_;
    NewestFrames newest_;
    Source target_;
    std::map<MessageId, std::uint64_t> bad_ids_;
    Losses losses_;
    std::vector<ChannelReader*> readers_;
    std::vector<std::shared_ptr<record::Recorder>> recorders_;
    const ChannelReader* holder_ = nullptr;
    std::function<void()> room_made_;
    bool full_ = false;
    bool has_new_frames_ = false;
};

// One reader of a channel, with its own position. Any thread may call it. If several threads share a reader, each frame
// goes to only one of them.
class ChannelReader {
public:
    // The reader starts at the next frame that arrives.
    ChannelReader(std::shared_ptr<Channel> channel, dialect::Filter filter);
    ~ChannelReader();
    ChannelReader(const ChannelReader&) = delete;
    ChannelReader& operator=(const ChannelReader&) = delete;

    // Adds matching frames to the batch until it holds `most`. Returns false if the reader or its channel is closed. If
    // a call adds none, use `wait` or the descriptor of `event_fd` to learn when to call again. One call examines a
    // limited number of frames. If more remain, `wait` returns at once and the descriptor is readable at once.
    bool take(FrameBatch& batch, std::size_t most);
    // Waits until a frame arrives, the channel or the reader is closed, or the deadline passes. Returns after one slice
    // (sliced_mutex.hpp) at the latest, so that the caller can handle signals.
    void wait(MonoTime deadline);
    // Returns a descriptor. After a `take` that added no frame, it becomes readable when another `take` may add some.
    // The first call creates the descriptor; the reader closes it.
    [[nodiscard]] SetupResult<int> event_fd();
    // Frames that were overwritten before this reader read them.
    [[nodiscard]] std::uint64_t missed() const;
    // Frames of a channel are numbered. Returns the number after the channel's newest frame.
    [[nodiscard]] std::uint64_t newest() const;
    // Returns the number after the last frame that `take` examined.
    [[nodiscard]] std::uint64_t seen() const;
    // Whether the reader or its channel is closed.
    [[nodiscard]] bool closed() const noexcept { return closed_ || channel_->closed_; }
    // Closes the reader and wakes the threads that wait on it. May be called again.
    void close();

    [[nodiscard]] const std::shared_ptr<Channel>& channel() const noexcept { return channel_; }

private:
    friend class Channel;
    void signal() noexcept;
    static constexpr std::size_t max_examined = 4096;  // frames in one call, with the mutex held

    const std::shared_ptr<Channel> channel_;
    const dialect::Filter filter_;
    // Guarded by the channel's mutex:
    FrameRing::Position at_;
    std::uint64_t missed_ = 0;
    std::uint64_t seen_ = 0;  // one past the last frame that `take` looked at
    int event_fd_ = -1;
    // `armed_`: the next matching frame makes the descriptor readable. `due_`: that frame has arrived.
    bool armed_ = false, due_ = false;
    std::atomic<bool> closed_{false};  // set with the mutex held
};

}  // namespace mavloom::feed
