// SPDX-License-Identifier: MIT
// A recorder writes frames to a tlog file (docs/formats/tlog.md) without ever blocking its caller. Frames wait in a
// bounded queue until the recorder's own thread writes them. The recorder counts the frames that the queue or the disk
// had no room for. When the disk accepts records again, recording continues.
//
// One thread calls `record`, `publish`, `end` and `stop`; any thread may read the counters. No frame costs an
// allocation or a lock.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/counter.hpp"
#include "mavloom/record/frame_queue.hpp"
#include "mavloom/record/rotating_writer.hpp"

namespace mavloom::record {

struct RecorderCounters {
    Counter frames, bytes;  // in the file, without records that are still buffered; `bytes` excludes the time stamps
    Counter queue_full;     // frames that did not fit into the queue, because the disk was slow, full or missing
    Counter write_error;    // frames lost to other errors of the disk, or still unwritten at the end
};
inline constexpr std::array<CounterRow<RecorderCounters>, 4> recorder_counters{{
    {"frames", "frames in the file", &RecorderCounters::frames},
    {"bytes", "bytes of the frames in the file", &RecorderCounters::bytes},
    {"queue_full", "frames that a recording lacks, because its buffer was full", &RecorderCounters::queue_full},
    {"write_error", "frames that a recording lacks, because the disk refused them", &RecorderCounters::write_error},
}};
static_assert(sizeof(RecorderCounters) == recorder_counters.size() * sizeof(Counter), "each counter needs a row");

class Recorder {
public:
    static constexpr std::size_t default_buffer_bytes = 16u << 20;
    // Called on the writing thread: once when writing fails, once when it resumes, when the file was removed, and at
    // the end if frames were lost.
    using Notice = std::function<void(std::string_view)>;

    // Opens the file and starts the writing thread. Fails if the file cannot be written.
    [[nodiscard]] static SetupResult<std::unique_ptr<Recorder>> create(std::string label,
                                                                       const std::filesystem::path& path,
                                                                       record::Rotation rotation, Notice notice,
                                                                       std::size_t buffer_bytes = default_buffer_bytes);
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    void record(WallTime time, LinkId link, const wire::FrameView& frame) noexcept {
        if (!queue_->push({time, link, frame})) counters_.queue_full.add();
    }
    // Wakes the writing thread if it sleeps. Call it after each batch of `record`.
    void publish() noexcept { queue_->publish(); }
    // Call about once a second. The writing thread then retries what the disk had no room for, and begins a new file if
    // another program removed or replaced the current one. It reports that through `Notice`.
    void maintain() noexcept { queue_->wake(); }
    // Ends the recording without waiting for the disk. The writing thread writes the queued frames, closes the file and
    // then sets `finished`.
    void end() noexcept {
        ending_.store(true, std::memory_order_relaxed);
        queue_->close();
    }
    [[nodiscard]] bool finished() const noexcept { return finished_.load(std::memory_order_acquire); }
    // Waits until it has. Any thread, any number of them, while the object lives.
    void wait() const noexcept { finished_.wait(false, std::memory_order_acquire); }
    // Calls `end` and waits until the writing thread has finished.
    void stop();

    [[nodiscard]] const std::string& label() const noexcept { return label_; }
    // The new name of a file that existed at this path; empty if there was none.
    [[nodiscard]] const std::filesystem::path& renamed_to() const noexcept { return renamed_to_; }
    [[nodiscard]] const RecorderCounters& counters() const noexcept { return counters_; }

private:
    Recorder(std::string label, record::RotatingWriter writer, std::unique_ptr<FrameQueue> queue, Notice notice);
    void run();
    [[nodiscard]] SetupResult<void> write(const FrameQueue::Entry& entry);
    [[nodiscard]] SetupResult<void> wait_for_room(const FrameQueue::Entry& entry);
    void count() noexcept;
    void report(const SetupResult<void>& result);
    [[nodiscard]] SetupResult<void> check_file() { return report_removed(writer_.maintain(mono_now())); }
    [[nodiscard]] SetupResult<void> report_removed(SetupResult<std::filesystem::path> removed);  // empty path: none

    std::string label_;
    std::filesystem::path renamed_to_;
    record::RotatingWriter writer_;  // used by the writing thread only, once it runs
    std::unique_ptr<FrameQueue> queue_;
    Notice notice_;
    RecorderCounters counters_;
    bool failing_ = false;
    std::optional<SetupError> gave_up_;  // why the frames that are left at the end cannot be written
    std::atomic<bool> ending_{false}, finished_{false};
    std::thread thread_;
};

}  // namespace mavloom::record
