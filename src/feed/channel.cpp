// SPDX-License-Identifier: MIT
#include "mavloom/feed/channel.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "mavloom/feed/sliced_mutex.hpp"
#include "mavloom/feed/vehicle.hpp"
#include "mavloom/ring/frames.hpp"

namespace mavloom::feed {
namespace {

std::uint8_t verdict_of(const link::RxFrame& rx, bool verifies) noexcept {
    using ring::FrameSignature;
    if (rx.ring_verdict != 0) return rx.ring_verdict;
    if (!rx.frame.is_signed()) return ring::ring_verdict(FrameSignature::none);
    return ring::ring_verdict(verifies ? FrameSignature::good : FrameSignature::unchecked);
}

}  // namespace

void add_to(Losses& losses, std::string link, const wire::SequenceStats& stats) {
    auto& sum = losses[{std::move(link), stats.source}];
    sum.received += stats.received;
    sum.lost += stats.lost;
    sum.late += stats.late;
    sum.duplicate += stats.duplicate;
    sum.resync += stats.resync;
}

// ---- loop thread

void Channel::on_frame(const link::RxFrame& rx, MonoTime now) {
    const FrameRing::Head head{
        .time_ns = rx.time.time_since_epoch().count(), .link = rx.link.value, .verdict = verdict_of(rx, verifies_)};
    const auto key = NewestFrames::key_of(rx.frame, rx.info == nullptr ? nullptr : dialect_->find(rx.frame.id()));
    const std::lock_guard lock(mutex_);
    ring_.push(head, rx.frame);
    has_new_frames_ = true;
    newest_.put(key, head, rx.frame, now);
    if (target_.system.value == 0 && is_vehicle_heartbeat(rx.frame)) target_ = rx.frame.source();
    for (auto* reader : readers_)
        if (reader->armed_ && reader->filter_.admits(rx.frame)) reader->due_ = true;
    for (const auto& recorder : recorders_) recorder->record(rx.time, rx.link, rx.frame);
}

void Channel::on_link_up(LinkId link, std::string_view name) {
    name_link(link, name);
    peers_.fetch_add(1, std::memory_order_relaxed);
}

void Channel::on_link_down(LinkId link, std::span<const wire::SequenceStats> losses) {
    peers_.fetch_sub(1, std::memory_order_relaxed);
    forget_link(link, losses);
}

void Channel::forget_link(LinkId link, std::span<const wire::SequenceStats> losses) {
    const auto name = names_->find(link);
    names_->gone(link);
    const std::lock_guard lock(mutex_);
    for (const auto& stats : losses) add_to(losses_, losses_.size() < max_losses ? name : std::string(), stats);
}

void Channel::on_bad_checksum(MessageId id) {
    const std::lock_guard lock(mutex_);
    if (bad_ids_.size() < max_bad_ids || bad_ids_.contains(id)) ++bad_ids_[id];
}

void Channel::publish() {
    const std::lock_guard lock(mutex_);
    if (!std::exchange(has_new_frames_, false)) return;
    for (auto* reader : readers_)
        if (std::exchange(reader->due_, false)) reader->signal();
    for (const auto& recorder : recorders_) recorder->publish();
    changed_.notify_all();
}

void Channel::maintain_recorders() {
    const std::lock_guard lock(mutex_);
    for (const auto& recorder : recorders_) recorder->maintain();
}

void Channel::close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    holder_ = nullptr;
    room_made_ = {};
    peers_.store(0, std::memory_order_relaxed);
    for (auto* reader : readers_) reader->signal();
    for (const auto& recorder : recorders_) recorder->end();
    recorders_.clear();
    changed_.notify_all();
}

void Channel::record_with(std::shared_ptr<record::Recorder> recorder) {
    const std::lock_guard lock(mutex_);
    if (closed_) recorder->end();
    else recorders_.push_back(std::move(recorder));
}

void Channel::end_recording(const std::shared_ptr<record::Recorder>& recorder) {
    const std::lock_guard lock(mutex_);
    if (std::erase(recorders_, recorder) != 0) recorder->end();
}

void Channel::hold_for(const ChannelReader* reader, std::function<void()> room_made) {
    const std::lock_guard lock(mutex_);
    holder_ = reader;
    room_made_ = std::move(room_made);
}

bool Channel::has_room() {
    const std::lock_guard lock(mutex_);
    full_ = holder_ != nullptr && !ring_.has_room(holder_->at_, frames_a_turn);
    return !full_;
}

void Channel::notify_of_room() {
    if (!full_ || (holder_ != nullptr && !ring_.has_room(holder_->at_, frames_a_turn))) return;
    full_ = false;
    if (room_made_) room_made_();
}

void Channel::end_hold(const ChannelReader* reader) {
    if (holder_ != reader) return;
    holder_ = nullptr;
    notify_of_room();
}

// ---- any thread

std::optional<NewestFrames::Entry> Channel::latest(const dialect::Filter& filter,
                                                   const std::optional<message::Instance>& instance,
                                                   MonoTime not_before) const {
    const std::lock_guard lock(mutex_);
    const auto* const newest = newest_.find(filter, instance, not_before);
    return newest == nullptr ? std::nullopt : std::optional(*newest);
}

std::uint64_t Channel::not_kept() const {
    const std::lock_guard lock(mutex_);
    return newest_.not_kept();
}

std::map<MessageId, Channel::CrcErrors> Channel::crc_errors() const {
    const std::lock_guard lock(mutex_);
    std::map<MessageId, CrcErrors> errors;
    for (const auto& [id, count] : bad_ids_) errors[id] = {count, !newest_.has(id) && newest_.not_kept() == 0};
    return errors;
}

Losses Channel::losses() const {
    const std::lock_guard lock(mutex_);
    return losses_;
}

Source Channel::target() const {
    const std::lock_guard lock(mutex_);
    return target_;
}

// ---- ChannelReader

ChannelReader::ChannelReader(std::shared_ptr<Channel> channel, dialect::Filter filter)
    : channel_(std::move(channel)), filter_(std::move(filter)) {
    const std::lock_guard lock(channel_->mutex_);
    at_ = channel_->ring_.newest();
    seen_ = at_.frame;
    channel_->readers_.push_back(this);
}

ChannelReader::~ChannelReader() {
    {
        const std::lock_guard lock(channel_->mutex_);
        std::erase(channel_->readers_, this);
        channel_->end_hold(this);
    }
    if (event_fd_ >= 0) ::close(event_fd_);
}

bool ChannelReader::take(FrameBatch& batch, std::size_t most) {
    const std::lock_guard lock(channel_->mutex_);
    if (closed()) return false;
    FrameRing::Head head;
    wire::FrameView frame;
    std::size_t examined = 0;
    while (batch.size() < most && examined < max_examined && channel_->ring_.next(at_, missed_, head, frame)) {
        ++examined;
        if (filter_.admits(frame))
            batch.add({.time_ns = head.time_ns,
                       .definition = channel_->dialect().find(frame.id()),
                       .link = head.link,
                       .verdict = head.verdict},
                      frame);
    }
    seen_ = at_.frame;
    if (channel_->holder_ == this) channel_->notify_of_room();
    if (batch.size() != 0) return true;
    armed_ = true;
    if (seen_ != channel_->ring_.newest().frame) signal();
    return true;
}

void ChannelReader::wait(MonoTime deadline) {
    std::unique_lock lock(channel_->mutex_);
    channel_->changed_.wait_until(lock, end_of_slice(deadline),
                                  [&] { return closed() || channel_->ring_.newest().frame != seen_; });
}

void ChannelReader::signal() noexcept {
    armed_ = false;
    if (event_fd_ < 0) return;
    const std::uint64_t one = 1;
    // If the counter is full, the write fails and the descriptor is readable already.
    [[maybe_unused]] const auto written = ::write(event_fd_, &one, sizeof one);
}

SetupResult<int> ChannelReader::event_fd() {
    const std::lock_guard lock(channel_->mutex_);
    if (event_fd_ < 0) event_fd_ = ::eventfd(1, EFD_NONBLOCK | EFD_CLOEXEC);
    if (event_fd_ < 0) return system_error("eventfd", errno);
    return event_fd_;
}

std::uint64_t ChannelReader::missed() const {
    const std::lock_guard lock(channel_->mutex_);
    return missed_ + channel_->ring_.overwritten(at_);
}

std::uint64_t ChannelReader::newest() const {
    const std::lock_guard lock(channel_->mutex_);
    return channel_->ring_.newest().frame;
}

std::uint64_t ChannelReader::seen() const {
    const std::lock_guard lock(channel_->mutex_);
    return seen_;
}

void ChannelReader::close() {
    const std::lock_guard lock(channel_->mutex_);
    closed_ = true;
    channel_->end_hold(this);
    signal();
    channel_->changed_.notify_all();
}

}  // namespace mavloom::feed
