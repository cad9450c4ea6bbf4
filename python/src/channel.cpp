// SPDX-License-Identifier: MIT
#include "channel.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "mavloom/ring/frames.hpp"

namespace mavloom::python {
namespace {

using namespace std::chrono_literals;

constexpr auto longest_wait = 50ms;  // so that signals are handled

// MAV_TYPEs that are not vehicles, and the autopilot value of components without one (MAVLink, minimal.xml).
constexpr std::uint8_t no_vehicles[] = {6, 18, 26, 27, 30};  // GCS, onboard controller, gimbal, ADS-B, camera
constexpr std::uint8_t autopilot_invalid = 8;
constexpr std::size_t heartbeat_type = 4, heartbeat_autopilot = 5;  // payload offsets

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
    const auto* definition = rx.info == nullptr ? nullptr : origin_->dialect().find(rx.frame.id());
    const auto* field = definition == nullptr ? nullptr : instance_field(*definition);
    const Key key{rx.frame.id().value, rx.frame.source(),
                  field == nullptr ? Instance() : instance_of(*definition, *field, rx.frame)};
    const std::lock_guard lock(mutex_);
    ring_.push(head, rx.frame);
    ++frames_;
    news_ = true;
    remember(key, head, rx.frame, now);
    if (target_.system.value == 0) look_for_vehicle(rx.frame);
    for (auto* consumer : consumers_)
        if (consumer->armed_ && consumer->filter_.takes(rx.frame)) consumer->due_ = true;
}

void Channel::remember(const Key& key, const FrameRing::Head& head, const wire::FrameView& frame, MonoTime now) {
    auto found = latest_.find(key);
    if (found == latest_.end()) {
        if (latest_.size() == most_latest) {
            ++not_kept_;
            return;
        }
        found = latest_.emplace(key, Latest{}).first;
    }
    auto& kept = found->second;
    kept.head = head;
    kept.arrived = now;
    kept.number = frames_;
    const auto bytes = frame.bytes();
    kept.bytes.assign(bytes.begin(), bytes.end());
}

void Channel::look_for_vehicle(const wire::FrameView& frame) {
    if (frame.id() != MessageId{0}) return;
    const auto payload = frame.payload();
    const auto byte = [&](std::size_t at) { return at < payload.size() ? payload[at] : std::uint8_t{0}; };
    if (byte(heartbeat_autopilot) == autopilot_invalid ||
        std::ranges::find(no_vehicles, byte(heartbeat_type)) != std::end(no_vehicles))
        return;
    target_ = frame.source();
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
    const auto name = origin_->link_name(link.value);
    origin_->link_gone(link.value);
    const std::lock_guard lock(mutex_);
    for (const auto& stats : losses) add_to(losses_, losses_.size() < most_losses ? name : std::string(), stats);
}

void Channel::on_bad_checksum(MessageId id) {
    const std::lock_guard lock(mutex_);
    if (bad_ids_.size() < most_bad_ids || bad_ids_.contains(id)) ++bad_ids_[id];
}

bool Channel::has_room() {
    const std::lock_guard lock(mutex_);
    full_ = holder_ != nullptr && !ring_.has_room(holder_->at_, frames_a_turn);
    return !full_;
}

void Channel::hold_for(const Consumer* reader, std::function<void()> room_made) {
    const std::lock_guard lock(mutex_);
    holder_ = reader;
    room_made_ = std::move(room_made);
}

void Channel::publish() {
    const std::lock_guard lock(mutex_);
    if (!std::exchange(news_, false)) return;
    for (auto* consumer : consumers_)
        if (std::exchange(consumer->due_, false)) consumer->tell();
    changed_.notify_all();
}

void Channel::close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    holder_ = nullptr;
    room_made_ = {};
    peers_.store(0, std::memory_order_relaxed);
    for (auto* consumer : consumers_) consumer->tell();
    changed_.notify_all();
}

// ---- any thread

std::optional<Channel::Latest> Channel::latest(const Filter& filter, const std::optional<Instance>& instance,
                                               MonoTime not_before) const {
    const std::lock_guard lock(mutex_);
    const Latest* newest = nullptr;
    for (const auto& [key, kept] : latest_) {
        if (instance && key.instance != *instance) continue;
        if (kept.arrived < not_before || (newest != nullptr && kept.number < newest->number)) continue;
        if (filter.takes(wire::FrameView::unchecked(kept.bytes))) newest = &kept;
    }
    return newest == nullptr ? std::nullopt : std::optional(*newest);
}

std::uint64_t Channel::not_kept() const {
    const std::lock_guard lock(mutex_);
    return not_kept_;
}

std::map<MessageId, Channel::CrcErrors> Channel::crc_errors() const {
    const std::lock_guard lock(mutex_);
    std::map<MessageId, CrcErrors> errors;
    for (const auto& [id, count] : bad_ids_) {
        const auto heard = latest_.lower_bound(Key{id.value, {}, {}});
        const bool is_heard = heard != latest_.end() && heard->first.id == id.value;
        errors[id] = {count, !is_heard && not_kept_ == 0};
    }
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

Consumer::Consumer(std::shared_ptr<Channel> channel, Filter filter)
    : channel_(std::move(channel)), filter_(std::move(filter)) {
    const std::lock_guard lock(channel_->mutex_);
    at_ = channel_->ring_.newest();
    channel_->consumers_.push_back(this);
}

Consumer::~Consumer() {
    {
        const std::lock_guard lock(channel_->mutex_);
        std::erase(channel_->consumers_, this);
        if (channel_->holder_ == this) channel_->holder_ = nullptr;
    }
    if (event_fd_ >= 0) ::close(event_fd_);
}

bool Consumer::take(FrameBatch& batch, std::size_t most) {
    const std::lock_guard lock(channel_->mutex_);
    if (closed()) return false;
    FrameRing::Head head;
    wire::FrameView frame;
    std::size_t looked_at = 0;
    while (batch.size() < most && looked_at < most_looked_at && channel_->ring_.next(at_, missed_, head, frame)) {
        ++looked_at;
        if (filter_.takes(frame))
            batch.add({.time_ns = head.time_ns,
                       .definition = channel_->origin_->dialect().find(frame.id()),
                       .link = head.link,
                       .verdict = head.verdict},
                      frame);
    }
    seen_ = at_.frame;
    if (channel_->holder_ == this && channel_->full_ && channel_->ring_.has_room(at_, Channel::frames_a_turn)) {
        channel_->full_ = false;
        channel_->room_made_();
    }
    if (batch.size() != 0) return true;
    armed_ = true;
    if (seen_ != channel_->ring_.newest().frame) tell();
    return true;
}

void Consumer::wait(MonoTime deadline) {
    std::unique_lock lock(channel_->mutex_);
    const auto slice = std::min(deadline, mono_now() + longest_wait);
    channel_->changed_.wait_until(lock, slice, [&] { return closed() || channel_->ring_.newest().frame != seen_; });
}

void Consumer::tell() noexcept {
    armed_ = false;
    if (event_fd_ < 0) return;
    const std::uint64_t one = 1;
    // If the counter is full, the write fails and the descriptor is readable already.
    [[maybe_unused]] const auto written = ::write(event_fd_, &one, sizeof one);
}

SetupResult<int> Consumer::event_fd() {
    const std::lock_guard lock(channel_->mutex_);
    if (event_fd_ < 0) event_fd_ = ::eventfd(1, EFD_NONBLOCK | EFD_CLOEXEC);
    if (event_fd_ < 0) return system_error("eventfd", errno);
    return event_fd_;
}

std::uint64_t Consumer::missed() const {
    const std::lock_guard lock(channel_->mutex_);
    return missed_ + channel_->ring_.overwritten(at_);
}

std::uint64_t Consumer::newest() const {
    const std::lock_guard lock(channel_->mutex_);
    return channel_->ring_.newest().frame;
}

std::uint64_t Consumer::seen() const {
    const std::lock_guard lock(channel_->mutex_);
    return seen_;
}

void Consumer::close() {
    const std::lock_guard lock(channel_->mutex_);
    closed_ = true;
    tell();
    channel_->changed_.notify_all();
}

}  // namespace mavloom::python
