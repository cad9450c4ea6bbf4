// SPDX-License-Identifier: MIT
// A recording that never holds up who records: frames wait in a bounded queue for a thread that writes them. What does not fit into the
// queue, or not onto the disk, is counted; when the disk takes records again, the recording goes on.
//
// One thread records, `stop` from the same; counters may be read from any. No allocation and no lock per frame. docs/formats/tlog.md.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "mavloom/base/counter.hpp"
#include "mavloom/record/frame_queue.hpp"
#include "mavloom/record/rotating_writer.hpp"

namespace mavloom::record {

struct RecorderCounters {
    Counter frames, bytes;  // in the file; what the writer still buffers is not among them
    Counter queue_full;     // frames: the writer was too slow
    Counter write_error;    // frames: the disk did not take them
};

class Recorder {
public:
    static constexpr std::size_t default_buffer_bytes = 16u << 20;
    // Said once when writing fails and once when it goes on. Called on the writing thread.
    using Notice = std::function<void(std::string_view)>;

    // Opens the file. An error where it cannot be written.
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
    // After a batch: wakes the writer if it sleeps.
    void publish() noexcept { queue_->publish(); }
    // Begins to end: the writing thread writes what is queued, closes the file, and is then `finished`. Does not wait for the disk.
    void end() noexcept { queue_->close(); }
    [[nodiscard]] bool finished() const noexcept { return finished_.load(std::memory_order_acquire); }
    // Ends, and waits for it.
    void stop();

    [[nodiscard]] const std::string& label() const noexcept { return label_; }
    // Where an existing file went; empty if there was none.
    [[nodiscard]] const std::filesystem::path& renamed_to() const noexcept { return renamed_to_; }
    [[nodiscard]] const RecorderCounters& counters() const noexcept { return counters_; }

private:
    Recorder(std::string label, record::RotatingWriter writer, std::unique_ptr<FrameQueue> queue, Notice notice);
    void run();
    [[nodiscard]] SetupResult<void> write(const FrameQueue::Entry& entry);
    void count() noexcept;
    void tell(const SetupResult<void>& result);

    std::string label_;
    std::filesystem::path renamed_to_;
    record::RotatingWriter writer_;  // the thread's, once it runs
    std::unique_ptr<FrameQueue> queue_;
    Notice notice_;
    RecorderCounters counters_;
    bool failing_ = false;
    std::atomic<bool> finished_{false};
    std::thread thread_;
};

}  // namespace mavloom::record
