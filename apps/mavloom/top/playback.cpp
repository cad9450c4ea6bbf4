// SPDX-License-Identifier: MIT
#include "top/playback.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mavloom/base/thread.hpp"

namespace mavloom::app {

namespace {

constexpr LinkId the_link{1};
constexpr auto turn = std::chrono::milliseconds(10), loss_period = std::chrono::milliseconds(500);
constexpr double slowest = 0.125, fastest = 64;

MonoTime mono_of(WallTime time) { return MonoTime{time.time_since_epoch()}; }

}  // namespace

SetupResult<std::unique_ptr<Playback>> Playback::open(const std::string& path, const dialect::Dialect& dialect,
                                                      dialect::Filter filter, Model& model) {
    auto reader = record::TlogReader::open(path, dialect.wire_table());
    if (!reader) return tl::unexpected(std::move(reader.error()));
    std::unique_ptr<Playback> its(new Playback(path, std::move(filter), model, std::move(*reader)));
    if (auto found = its->find_limits(); !found) return tl::unexpected(std::move(found.error()));
    return its;
}

Playback::~Playback() {
    {
        const std::lock_guard lock(mutex_);
        stops_ = true;
    }
    changed_.notify_one();
    if (thread_.joinable()) thread_.join();
}

// The times of the first record and of the last ones, in the end of the file.
SetupResult<void> Playback::find_limits() {
    constexpr std::uint64_t tail = 256u << 10;
    const auto first = reader_.next(damage_at_once);
    if (!first && first.error() == record::TlogReader::Stop::failed) return tl::unexpected(reader_.error());
    if (!first && reader_.found_no_record()) return tl::unexpected(reader_.no_record_error());
    if (!first) return setup_error(SetupCode::bad_input, fmt::format("{} holds no record: is it a .tlog?", name_));
    begin_ = end_ = first->time;
    const auto offset = first->offset;
    if (reader_.is_file()) {
        if (reader_.size() > tail)
            if (auto sought = reader_.seek(reader_.size() - tail); !sought) return sought;
        while (const auto record = reader_.next(damage_at_once)) end_ = std::max(end_, record->time);
        if (auto sought = reader_.seek(offset); !sought) return sought;
        set_clock(begin_);
    }
    return {};
}

void Playback::play_all() {
    const std::lock_guard lock(mutex_);
    while (read_next()) {
        deliver(*next_);
        next_.reset();
    }
    clock_at_ = end_ = latest_;
    note_losses();
}

void Playback::start() {
    set_clock(begin_);
    thread_ = thread_without_signals([this] { run(); });
}

void Playback::run() {
    std::unique_lock lock(mutex_);
    while (!stops_) {
        if (seek_to_) seek(*std::exchange(seek_to_, std::nullopt));
        if (!is_halted_ && !deliver_until(clock())) {
            lock.unlock();  // others may want it
            lock.lock();
            continue;
        }
        changed_.wait_for(lock, turn);
    }
}

WallTime Playback::clock() const {
    if (is_halted_ || is_over_) return clock_at_;
    const auto passed = std::chrono::duration_cast<Nanoseconds>(
        speed_ * std::chrono::duration<double, std::nano>(mono_now() - clock_set_));
    return clock_at_ + passed;
}

void Playback::set_clock(WallTime time) {
    clock_at_ = time;
    clock_set_ = mono_now();
}

bool Playback::read_next() {
    using Stop = record::TlogReader::Stop;
    while (!next_) {
        auto record = reader_.next(damage_at_once);
        if (record) next_ = *record;
        else if (record.error() == Stop::failed) model_.add_notice(reader_.error().text);
        if (!record && (record.error() == Stop::end || record.error() == Stop::failed)) return false;
    }
    return true;
}

bool Playback::deliver_until(WallTime time) {
    for (int i = 0; i < records_at_once; ++i) {
        if (is_over_ || !read_next()) {
            if (!is_over_) set_clock(std::max(latest_, std::min(time, end_)));
            is_over_ = true;
            note_losses();
            return true;
        }
        if (next_->time > time + longest_gap) {
            set_clock(next_->time);
            time = next_->time;
        }
        if (next_->time > time) return true;
        deliver(*next_);
        next_.reset();
    }
    return false;
}

// Time never goes back for the model, also where the recording's does.
void Playback::deliver(const record::Record& record) {
    sequence_->update(record.frame, record.info);
    latest_ = std::max(latest_, record.time);
    if (filter_.admits(record.frame)) model_.take({record.frame, the_link, name_, record.time, mono_of(latest_)});
    if (latest_ - losses_at_ >= loss_period) note_losses();
}

void Playback::note_losses() {
    losses_at_ = latest_;
    observe::OwnCounts counts;
    counts.on_links.reserve(sequence_->sources().size());
    for (const auto& its : sequence_->sources()) {
        counts.frames += its.received;
        counts.on_links.push_back(
            {the_link, name_, its.source, its.received, its.lost, its.late, its.duplicate, its.resync});
    }
    model_.note_counts(std::move(counts));
}

// Records are about in the order of their times.
std::uint64_t Playback::offset_before(WallTime time) {
    constexpr std::uint64_t near = 64u << 10;
    std::uint64_t low = 0, high = reader_.size();
    while (high - low > near) {
        const auto middle = low + (high - low) / 2;
        if (!reader_.seek(middle)) break;
        const auto record = reader_.next(damage_at_once);
        if (record && record->time < time) low = middle;
        else high = middle;
    }
    return low;
}

void Playback::seek(WallTime time) {
    if (!reader_.is_file()) return;
    time = std::clamp(time, begin_, end_);
    const auto offset = offset_before(time - lead);
    if (!reader_.seek(offset)) return;
    next_.reset();
    model_.restart();
    sequence_.emplace();
    latest_ = losses_at_ = {};
    is_over_ = false;
    while (read_next() && next_->time <= time) {
        if (next_->time >= time - lead) deliver(*next_);
        next_.reset();
    }
    note_losses();
    set_clock(time);
}

void Playback::take(view::Effect effect) {
    using view::Effect;
    const std::lock_guard lock(mutex_);
    const auto at = seek_to_.value_or(clock());
    switch (effect) {
        case Effect::none:
        case Effect::quit:
        case Effect::ask_rate: return;
        case Effect::halt:
            clock_at_ = clock();
            clock_set_ = mono_now();
            is_halted_ = !is_halted_;
            break;
        case Effect::back: seek_to_ = at - step; break;
        case Effect::forward: seek_to_ = at + step; break;
        case Effect::to_begin: seek_to_ = begin_; break;
        case Effect::to_end: seek_to_ = end_; break;
        case Effect::slower:
        case Effect::faster:
            set_clock(clock());
            speed_ = std::clamp(effect == Effect::faster ? speed_ * 2 : speed_ / 2, slowest, fastest);
            break;
    }
    if (seek_to_) seek_to_ = std::clamp(*seek_to_, begin_, end_);
    changed_.notify_one();
}

view::Now Playback::now() {
    const std::lock_guard lock(mutex_);
    const auto at = std::max(clock(), latest_);
    return {at, mono_of(at)};
}

view::Playing Playback::playing() {
    const std::lock_guard lock(mutex_);
    return {begin_, end_, speed_, is_halted_, is_over_};
}

}  // namespace mavloom::app
