// SPDX-License-Identifier: MIT
#include "mavloom/record/recorder.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

namespace mavloom::record {

Recorder::Recorder(std::string label, record::RotatingWriter writer, std::unique_ptr<FrameQueue> queue, Notice notice)
    : label_(std::move(label)),
      renamed_to_(writer.renamed_to()),
      writer_(std::move(writer)),
      queue_(std::move(queue)),
      notice_(std::move(notice)) {}

SetupResult<std::unique_ptr<Recorder>> Recorder::create(std::string label, const std::filesystem::path& path,
                                                        record::Rotation rotation, Notice notice,
                                                        std::size_t buffer_bytes) {
    auto queue = FrameQueue::create(buffer_bytes);
    if (!queue) return tl::unexpected(std::move(queue.error()));
    auto writer = record::RotatingWriter::create(path, rotation);
    if (!writer) return tl::unexpected(std::move(writer.error()));
    std::unique_ptr<Recorder> recorder(
        new Recorder(std::move(label), std::move(*writer), std::move(*queue), std::move(notice)));
    recorder->thread_ = std::thread([r = recorder.get()] { r->run(); });
    return recorder;
}

Recorder::~Recorder() { stop(); }

void Recorder::stop() {
    if (!thread_.joinable()) return;
    end();
    thread_.join();
}

// Flushes whenever the queue runs empty, so that other programs can follow the file.
void Recorder::run() {
    while (queue_->wait()) {
        SetupResult<void> worst = check_file();
        while (const auto entry = queue_->next())
            if (auto written = write(*entry); !written) worst = std::move(written);
        const auto flushed = writer_.flush();
        count();
        report(worst ? flushed : worst);
    }
    const auto closed = report_removed(writer_.close());
    count();
    if (!closed) report(closed);
    if (const auto lost = writer_.lost_records(); lost != 0)
        notice_(fmt::format("{}: {} {} not written", label_, lost, lost == 1 ? "frame" : "frames"));
    finished_.store(true, std::memory_order_release);
    finished_.notify_all();
}

SetupResult<void> Recorder::report_removed(SetupResult<std::filesystem::path> removed) {
    if (!removed) return tl::unexpected(std::move(removed.error()));
    if (!removed->empty()) notice_(fmt::format("{}: {}", label_, writer_.removal_notice(*removed)));
    return {};
}

SetupResult<void> Recorder::write(const FrameQueue::Entry& entry) {
    auto taken = wait_for_room(entry);
    if (taken) taken = writer_.write(entry.time, entry.frame);
    else writer_.give_up();
    count();
    return taken;
}

// While the disk is full, or there is no file because its folder is missing, frames wait in the queue. At the end, the
// first failure counts for all that are left.
SetupResult<void> Recorder::wait_for_room(const FrameQueue::Entry& entry) {
    constexpr std::chrono::milliseconds room_poll_interval{100};
    while (!gave_up_) {
        auto room = writer_.make_room(entry.time, entry.frame);
        if (room || !writer_.can_retry(room.error())) return room;
        count();
        report(room);
        if (ending_.load(std::memory_order_relaxed)) gave_up_ = std::move(room.error());
        else std::this_thread::sleep_for(room_poll_interval);
        if (const auto looked = check_file(); !looked) report(looked);
    }
    return tl::unexpected(*gave_up_);
}

void Recorder::count() noexcept {
    counters_.frames.set(writer_.written_records());
    counters_.bytes.set(writer_.written_bytes() - record::time_length * writer_.written_records());
    counters_.write_error.set(writer_.lost_records());
}

void Recorder::report(const SetupResult<void>& result) {
    if (failing_ == !result.has_value()) return;
    failing_ = !failing_;
    if (!failing_) return notice_(fmt::format("{}: records are written again", label_));
    const bool waits = !ending_.load(std::memory_order_relaxed) && writer_.can_retry(result.error());
    notice_(fmt::format("{}: {}; frames that do not fit into memory meanwhile are counted as {}", label_,
                        result.error().text, waits ? "queue_full" : "write_error"));
}

}  // namespace mavloom::record
