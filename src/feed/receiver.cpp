// SPDX-License-Identifier: MIT
#include "mavloom/feed/receiver.hpp"

#include <algorithm>
#include <iterator>

#include "feed/outbox.hpp"
#include "mavloom/ring/page.hpp"

namespace mavloom::feed {

namespace {

using namespace std::chrono_literals;

constexpr std::size_t max_names = 65'536;   // bounds memory if very many links come and go
constexpr std::size_t max_losses = 65'536;  // bounds memory if system and component ids are forged
constexpr std::size_t max_bad_checksums = 1024;
constexpr std::size_t largest_entry_bytes = 304;  // in the queue: 16 bytes of header and the longest frame, rounded up
constexpr std::size_t frames_a_turn = 4096;       // from recordings and rings, so that live links get their turn
constexpr std::size_t few_frames = 32;            // a turn that delivers more may have left some
constexpr auto refresh_interval = 1s;             // how often to ask for drop counts, and to wake the consumer
constexpr auto counts_patience = 200ms;

}  // namespace

SetupResult<std::unique_ptr<Receiver>> Receiver::create(const dialect::Dialect& dialect, std::size_t buffer_bytes,
                                                        Notice notice, Copies copies) {
    auto sources = Sources::create(dialect, copies);
    if (!sources) return tl::unexpected(std::move(sources.error()));
    auto queue = record::FrameQueue::create(buffer_bytes);
    if (!queue) return tl::unexpected(std::move(queue.error()));
    return std::unique_ptr<Receiver>(new Receiver(std::move(*sources), std::move(*queue), std::move(notice)));
}

Receiver::Receiver(Sources sources, std::unique_ptr<record::FrameQueue> queue, Notice notice)
    : sources_(std::move(sources)),
      queue_(std::move(queue)),
      notice_(std::move(notice)),
      outbox_(std::make_unique<Outbox>()) {}

Receiver::~Receiver() {
    stop();
    join();
}

SetupResult<link::EndpointId> Receiver::add(const endpoint::Endpoint& endpoint) {
    const MonoTime now = mono_now();
    auto added = sources_.add(endpoint, now);
    if (added) silence_.add(*added, endpoint, now);
    if (added && endpoint.is_recording()) {
        const auto& recording = *sources_.recordings().back();
        names_.emplace(recording.link, Named{recording.name, recording.endpoint});
    }
    return added;
}

void Receiver::start(MonoTime end, Nanoseconds rest) {
    end_ = end;
    rest_ = rest;
    thread_ = std::thread([this] { run(); });
}

void Receiver::stop() noexcept {
    stopping_.store(true, std::memory_order_relaxed);
    sources_.wake();
}

void Receiver::send(const wire::FrameView& frame) {
    if (outbox_->put({}, frame) != Outbox::Put::first) return;
    has_outgoing_.store(true, std::memory_order_release);
    sources_.wake();
}

void Receiver::send_queued() {
    if (!has_outgoing_.exchange(false, std::memory_order_acquire)) return;
    for (const auto& entry : outbox_->take())
        if (sources_.send(entry.frame()) == 0) untaken_.add();
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
    auto ask_kernel = mono_now() + refresh_interval;
    for (auto now = mono_now(); !stopping_.load(std::memory_order_relaxed) && now < end_ && !sources_.finished();
         now = mono_now()) {
        if (now >= ask_kernel) {
            maintain(now);
            ask_kernel = now + refresh_interval;
        }
        send_queued();
        const std::size_t room = frames_that_fit();
        const std::size_t frames = sources_.turn(*this, room == 0 ? now + 1ms : std::min(ask_kernel, end_), Room(room));
        queue_->publish();
        answer_counts();
        if (rest_ > Nanoseconds{} && frames != 0 && frames < few_frames) std::this_thread::sleep_for(rest_);
    }
    (void)outbox_->close();
    sources_.drain(*this, [this] {
        queue_->publish();
        return Room(frames_that_fit());
    });
    publish_counts(UINT64_MAX);
    sources_.add_to(totals_);
    queue_->close();
}

void Receiver::answer_counts() {
    if (const auto asked = asked_.load(std::memory_order_acquire); asked != answered_) publish_counts(asked);
}

void Receiver::publish_counts(std::uint64_t answers) {
    Counts counts{.totals = totals_, .sources = snapshot(), .endpoints = endpoints_snapshot()};
    for (const auto& [key, count] : bad_checksums_) counts.bad_checksums.push_back({key.first, key.second, count});
    for (const auto& [key, loss] : losses_)
        if (!loss.is_over) counts.losses.push_back(loss);
    sources_.add_to(counts.totals);
    counts.lost = counts.totals.lost - sources_.lost_before_rings();
    {
        const std::lock_guard lock(counts_mutex_);
        counts_ = std::move(counts);
        answered_ = answers;
    }
    counted_.notify_all();
}

std::vector<Receiver::OfSource> Receiver::snapshot() const {
    std::vector<OfSource> all;
    const auto links = sources_.links().links();
    for (const auto* const link : ring::busiest_links(links, max_sources))
        all.push_back({link->id, link->endpoint, link->name, link->up, false, link::counts_of(*link->counters)});
    for (const auto& ring : sources_.rings()) {
        auto counts = link::counts_of(ring->counters());
        const auto losses = ring->losses();
        counts.insert(counts.end(), {{"lapped", losses.lapped}, {"bad_records", losses.bad_records}});
        all.push_back({{}, ring->id(), ring->endpoint().label(), ring->is_there(), false, std::move(counts)});
    }
    for (const auto& recording : sources_.recordings()) {
        const auto& counters = recording->reader.counters();
        all.push_back({recording->link,
                       recording->endpoint,
                       recording->name,
                       !recording->ended,
                       recording->ended,
                       {{"frames_in", counters.records.value()},
                        {"bytes_in", counters.record_bytes.value()},
                        {"damaged_places", counters.damaged_places.value()}}});
    }
    return all;
}

std::vector<Receiver::OfEndpoint> Receiver::endpoints_snapshot() const {
    const auto& links = sources_.links();
    const auto all_links = links.links();
    std::vector<OfEndpoint> all;
    for (const auto& info : links.endpoints()) {
        link::LinkCounters sum;
        sum.add(info.counters->gone);
        const link::LinkInfo* newest = nullptr;
        for (const auto& one : all_links) {
            if (one.endpoint != info.id) continue;
            sum.add(*one.counters);
            if (one.up) newest = &one;
        }
        const auto* const failure = newest == nullptr ? links.failure(info.id) : nullptr;
        all.push_back({info.id, info.rcvbuf_bytes, link::counts_of(*info.counters),
                       failure == nullptr ? std::string() : failure->text,
                       link::silence_reason(info, newest == nullptr ? nullptr : newest->counters)});
        std::ranges::copy(link::counts_of(sum), std::back_inserter(all.back().counts));
    }
    return all;
}

Receiver::Counts Receiver::counts() {
    std::unique_lock lock(counts_mutex_);
    const auto own = asked_.fetch_add(1, std::memory_order_release) + 1;
    sources_.wake();
    counted_.wait_for(lock, counts_patience, [&] { return answered_ >= own; });
    return counts_;
}

void Receiver::maintain(MonoTime now) {
    sources_.links().refresh_counters();
    queue_->wake();
    for (const auto& text : link::poll_silence(silence_, sources_.links(), now))
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
            if (losses_.size() == max_losses) return;
            it = losses_.emplace(key, ReceivedLoss{rx.link, source}).first;
        }
        last_loss_ = &it->second;
    }
    auto& loss = *last_loss_;
    loss.is_over = false;
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
        if (names_.size() < max_names) names_.emplace(link, Named{std::string(name), endpoint});
    }
}

void Receiver::on_link_down(LinkId link, link::EndpointId, std::string_view) {
    silence_.on_link_down(link, sources_.links().counters(link));
    const std::tuple first{link, Source{}};
    for (auto at = losses_.lower_bound(first); at != losses_.end() && at->second.link == link; ++at)
        at->second.is_over = true;
}

void Receiver::on_notice(link::EndpointId, std::string_view text) {
    if (notice_) notice_(text);
}

void Receiver::on_bad_checksum(LinkId link, link::EndpointId, MessageId id) {
    const auto at = bad_checksums_.find({link, id});
    if (at != bad_checksums_.end()) ++at->second;
    else if (bad_checksums_.size() < max_bad_checksums) bad_checksums_.emplace(std::pair{link, id}, 1);
}

const Receiver::Named& Receiver::find_name(LinkId link) {
    static const Named unknown{"(one of very many links)", {}};
    const std::lock_guard lock(names_mutex_);
    const auto known = names_.find(link);
    return known == names_.end() ? unknown : known->second;
}

std::string_view Receiver::link_name(LinkId link) { return cached_name(link).name; }

link::EndpointId Receiver::endpoint_of(LinkId link) { return cached_name(link).endpoint; }

const Receiver::Named& Receiver::cached_name(LinkId link) {
    if (link != last_named_ || last_name_ == nullptr) {
        last_name_ = &find_name(link);
        last_named_ = link;
    }
    return *last_name_;
}

std::string_view Receiver::name_of(LinkId link) { return find_name(link).name; }

std::vector<ReceivedLoss> Receiver::losses() const {
    std::vector<ReceivedLoss> all;
    all.reserve(losses_.size());
    for (const auto& [key, loss] : losses_) all.push_back(loss);
    return all;
}

}  // namespace mavloom::feed
