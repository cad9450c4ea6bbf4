// SPDX-License-Identifier: MIT
#include "mavloom/feed/receiver.hpp"

#include <algorithm>

namespace mavloom::feed {

namespace {

using namespace std::chrono_literals;

constexpr std::size_t most_names = 65'536;        // bounds memory if very many links come and go
constexpr std::size_t most_sources = 65'536;      // bounds memory if system and component ids are forged
constexpr std::size_t largest_entry_bytes = 304;  // in the queue: 16 bytes of header and the longest frame, rounded up
constexpr std::size_t frames_a_turn = 4096;       // from recordings and rings, so that live links get their turn
constexpr auto look_every = 1s;                   // how often to ask for drop counts, and to wake the consumer

}  // namespace

SetupResult<std::unique_ptr<Receiver>> Receiver::create(const dialect::Dialect& dialect, std::size_t buffer_bytes,
                                                        Notice notice) {
    auto sources = Sources::create(dialect);
    if (!sources) return tl::unexpected(std::move(sources.error()));
    auto queue = record::FrameQueue::create(buffer_bytes);
    if (!queue) return tl::unexpected(std::move(queue.error()));
    return std::unique_ptr<Receiver>(new Receiver(std::move(*sources), std::move(*queue), std::move(notice)));
}

Receiver::Receiver(Sources sources, std::unique_ptr<record::FrameQueue> queue, Notice notice)
    : sources_(std::move(sources)), queue_(std::move(queue)), notice_(std::move(notice)) {}

Receiver::~Receiver() {
    stop();
    join();
}

SetupResult<void> Receiver::add(const endpoint::Endpoint& endpoint) {
    const MonoTime now = mono_now();
    auto added = sources_.add(endpoint, now);
    if (added) silence_.add(*added, endpoint, now);
    if (added && endpoint.scheme == endpoint::Scheme::tlog) {
        const auto& recording = *sources_.recordings().back();
        names_.emplace(recording.link, recording.name);
    }
    if (!added) return tl::unexpected(std::move(added.error()));
    return {};
}

void Receiver::start(MonoTime end) {
    end_ = end;
    thread_ = std::thread([this] { run(); });
}

void Receiver::stop() noexcept {
    stopping_.store(true, std::memory_order_relaxed);
    sources_.wake();
}

void Receiver::join() {
    if (thread_.joinable()) thread_.join();
}

std::size_t Receiver::frames_that_fit() const noexcept {
    const std::size_t room = queue_->capacity() -
                             std::min(queue_->capacity(), queue_->used_bytes() + largest_entry_bytes);
    return std::min(frames_a_turn, room / largest_entry_bytes);
}

void Receiver::run() {
    auto ask_kernel = mono_now() + look_every;
    for (auto now = mono_now(); !stopping_.load(std::memory_order_relaxed) && now < end_ && !sources_.finished();
         now = mono_now()) {
        if (now >= ask_kernel) {
            look_after(now);
            ask_kernel = now + look_every;
        }
        const std::size_t room = frames_that_fit();
        sources_.turn(*this, room == 0 ? now + 1ms : std::min(ask_kernel, end_), Room(room));
        queue_->publish();
    }
    sources_.drain(*this, [this] {
        queue_->publish();
        return Room(frames_that_fit());
    });
    sources_.add_to(totals_);
    queue_->close();
}

void Receiver::look_after(MonoTime now) {
    sources_.links().refresh_kernel_drops();
    queue_->wake();
    for (const auto& text : link::look_for_silence(silence_, sources_.links(), now))
        if (notice_) notice_(text);
}

void Receiver::on_frame(const link::RxFrame& rx) {
    ++totals_.frames;
    totals_.bytes += rx.frame.size();
    count_loss(rx);
    if (!queue_->push({rx.time, rx.link, rx.frame})) ++totals_.buffer_full;
}

void Receiver::count_loss(const link::RxFrame& rx) {
    const auto source = rx.frame.source();
    if (last_loss_ == nullptr || last_loss_->link != rx.link || last_loss_->source != source) {
        const std::tuple key{rx.link, source};
        auto it = losses_.find(key);
        if (it == losses_.end()) {
            if (losses_.size() == most_sources) return;
            it = losses_.emplace(key, ReceivedLoss{rx.link, source}).first;
        }
        last_loss_ = &it->second;
    }
    auto& loss = *last_loss_;
    ++loss.received;
    loss.lost += static_cast<std::uint64_t>(std::int64_t{rx.sequence->lost});
    loss.late += static_cast<std::uint64_t>(std::int64_t{rx.sequence->late});
    loss.duplicate += static_cast<std::uint64_t>(std::int64_t{rx.sequence->duplicate});
    loss.resync += static_cast<std::uint64_t>(std::int64_t{rx.sequence->resync});
}

void Receiver::on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) {
    silence_.on_link_up(link, endpoint, mono_now());
    {
        const std::lock_guard lock(names_mutex_);
        if (names_.size() < most_names) names_.emplace(link, name);
    }
}

void Receiver::on_link_down(LinkId link, link::EndpointId, std::string_view) {
    silence_.on_link_down(link, sources_.links().counters(link));
}

void Receiver::on_notice(link::EndpointId, std::string_view text) {
    if (notice_) notice_(text);
}

std::string_view Receiver::link_name(LinkId link) {
    if (link != last_named_ || last_name_.empty()) {
        const std::lock_guard lock(names_mutex_);
        const auto known = names_.find(link);
        last_name_ = known == names_.end() ? "(one of very many links)" : std::string_view(known->second);
        last_named_ = link;
    }
    return last_name_;
}

std::vector<ReceivedLoss> Receiver::losses() const {
    std::vector<ReceivedLoss> all;
    all.reserve(losses_.size());
    for (const auto& [key, loss] : losses_) all.push_back(loss);
    return all;
}

}  // namespace mavloom::feed
