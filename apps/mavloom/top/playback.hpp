// SPDX-License-Identifier: MIT
// Playback: plays a recording into the model of `mavloom top`, on a thread of its own. All times are those of the
// recording. It seeks by bisection, so the size of the file does not matter.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "mavloom/dialect/filter.hpp"
#include "mavloom/record/tlog_reader.hpp"
#include "mavloom/view/state.hpp"
#include "mavloom/wire/sequence.hpp"
#include "top/model.hpp"

namespace mavloom::app {

class Playback {
public:
    // `dialect` and `model` must outlive the object. A file without a record is an error.
    [[nodiscard]] static SetupResult<std::unique_ptr<Playback>> open(const std::string& path,
                                                                     const dialect::Dialect& dialect,
                                                                     dialect::Filter filter, Model& model);
    ~Playback();
    Playback(const Playback&) = delete;
    Playback& operator=(const Playback&) = delete;

    // Reads all of it at once. Instead of `start`.
    void play_all();
    void start();
    void take(view::Effect effect);
    [[nodiscard]] view::Now now();
    [[nodiscard]] view::Playing playing();

private:
    static constexpr Nanoseconds step = std::chrono::seconds(10);
    // This much is read before the place of a seek, so that rates and latest values are there.
    static constexpr Nanoseconds lead = std::chrono::seconds(12);
    static constexpr Nanoseconds longest_gap = std::chrono::seconds(10);  // a longer one is passed over
    static constexpr std::uint64_t damage_at_once = 16u << 20;
    static constexpr int records_at_once = 2000;

    Playback(std::string name, dialect::Filter filter, Model& model, record::TlogReader reader)
        : name_(std::move(name)), filter_(std::move(filter)), model_(model), reader_(std::move(reader)) {}

    [[nodiscard]] SetupResult<void> find_limits();
    void run();
    // The rest is called with the mutex held.
    [[nodiscard]] WallTime clock() const;
    void set_clock(WallTime time);
    bool read_next();
    // Passes records up to the time; false: there may be more.
    bool deliver_until(WallTime time);
    void deliver(const record::Record& record);
    void seek(WallTime time);
    [[nodiscard]] std::uint64_t offset_before(WallTime time);
    void note_losses();

    const std::string name_;
    const dialect::Filter filter_;
    Model& model_;
    std::mutex mutex_;  // guards all that follows
    std::condition_variable changed_;
    record::TlogReader reader_;
    std::optional<record::Record> next_;
    std::optional<wire::SequenceTracker> sequence_ = std::optional<wire::SequenceTracker>(std::in_place);
    WallTime begin_{}, end_{}, clock_at_{}, latest_{}, losses_at_{};
    MonoTime clock_set_{};
    double speed_ = 1;
    bool is_halted_ = false, is_over_ = false, stops_ = false;
    std::optional<WallTime> seek_to_;
    std::thread thread_;
};

}  // namespace mavloom::app
