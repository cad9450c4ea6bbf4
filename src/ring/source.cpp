// SPDX-License-Identifier: MIT
#include "mavloom/ring/source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "mavloom/ring/frames.hpp"
#include "mavloom/route/engine.hpp"
#include "mavloom/shm/counter_page.hpp"
#include "mavloom/shm/layout.hpp"

namespace mavloom::ring {

namespace {

// Limit for records without a frame that one turn reads.
constexpr std::size_t max_empty_records = 4096;
// Limits the memory for a writer's link numbers. Twice the link limit of a router, so that no live link is evicted.
constexpr std::size_t max_links = 2 * route::Engine::max_links;
constexpr Nanoseconds names_interval = std::chrono::seconds(1);  // between two reads of the page for missing names
constexpr Nanoseconds poll_interval = shm::RingFollower::poll_interval;

shm::Trust trust_of(const endpoint::EndpointOptions& options) {
    return {.foreign = options.foreign, .user = link::Links::owner_of_inlets()};
}

shm::ReaderOptions reader_options(const endpoint::EndpointOptions& options) {
    using From = shm::ReaderOptions::From;
    return {.lossless = options.lossless.value_or(false),
            .from = options.from_oldest ? From::oldest : From::newest,
            .trust = trust_of(options)};
}

bool is_echo(std::uint8_t ring_verdict) noexcept { return verdict_of(ring_verdict) == route::Verdict::echo; }

bool is_copy(const shm::RecordInfo& info) noexcept {
    const auto verdict = verdict_of(info.verdict);
    return verdict == route::Verdict::duplicate || verdict == route::Verdict::echo;
}

}  // namespace

RingSource::RingSource(const endpoint::Endpoint& endpoint, const wire::MessageTable& table, link::Links& links,
                       Copies copies, const dialect::Dialect* dialect)
    : endpoint_(endpoint),
      id_(links.take_endpoint_id()),
      table_(table),
      links_(links),
      wanted_copies_(copies),
      dialect_(dialect),
      follower_(endpoint.path, reader_options(endpoint.options)) {
    copy_.reserve(shm::max_record_bytes);
    found_.reserve(shm::max_record_bytes / wire::min_frame_length + 1);
}

RingSource::~RingSource() {
    if (inlet_) links_.remove(*inlet_);
}

SetupResult<void> RingSource::open() {
    if (follower_.try_open() || !endpoint_.options.required) return {};
    return tl::unexpected(SetupError(*follower_.error()).within(endpoint_.label()));
}

std::size_t RingSource::play(link::LinkHandler& handler, std::size_t most) {
    if (no_inlet_ && !std::exchange(reported_no_inlet_, true)) handler.on_notice(id_, no_inlet_->text);
    if (held_) return 0;
    poll_names();
    std::size_t played = 0, empty_records = 0;
    for (more_ = true; played < most && empty_records < max_empty_records;) {
        if (next_found_ < found_.size()) {
            hand_over(handler, found_[next_found_++]);
            ++played;
        } else if (more_ = read(handler); !more_) {
            break;
        } else {
            empty_records += found_.empty();
        }
    }
    return played;
}

bool RingSource::read(link::LinkHandler& handler) {
    found_.clear();
    next_found_ = 0;
    if (at_end_ || (next_poll_ != MonoTime{} && mono_now() < next_poll_)) return false;
    const auto record = follower_.poll();
    at_end_ = end_ && (!record || record->position >= *end_);
    if (!record) on_no_record(record.error(), handler);
    if (!record || at_end_) return false;
    take(*record, handler);
    return true;
}

void RingSource::take(const shm::RingRecord& record, link::LinkHandler& handler) {
    notice_other_writer(record);
    last_notice_ = Notice::nothing;
    if (record.missed != 0) forget_sequences();
    if (record.info.kind > ring_kind_frame) {
        ++other_kinds_;
        return;
    }
    if (last_ == nullptr || last_number_ != record.info.link) {
        last_ = &link_of(record.info.link, handler);
        last_number_ = record.info.link;
        last_->heard = ++heard_;
    }
    if (last_->own) {
        ++echo_;
        return;
    }
    if (wanted_copies_ == Copies::left_out && is_copy(record.info)) {
        ++copies_;
        return;
    }
    time_ = record.info.time == WallTime{} ? wall_now() : record.info.time;
    verdict_ = record.info.verdict;
    parse_record(record.data, handler);
}

// Link numbers and sequences belong to one writer of the ring.
void RingSource::notice_other_writer(const shm::RingRecord& record) {
    const bool is_new = std::exchange(opened_, follower_.opened()) != follower_.opened();
    if (is_new && (awaited_ || follower_.opened() > 1)) overwritten_ += record.sequence - record.missed;
    const auto writers = follower_.reader()->writers();
    if (std::exchange(writers_, writers) == writers && !is_new) return;
    by_number_.clear();
    names_.clear();
    last_ = nullptr;
    forget_sequences();
}

// An evicting writer may overwrite the record at any time, so a lossless reader parses a copy.
void RingSource::parse_record(ByteView bytes, link::LinkHandler& handler) {
    if (!lossless()) return parse(bytes, handler);
    copy_.assign(bytes.begin(), bytes.end());
    if (follower_.reader()->holds()) return parse(copy_, handler);
    ++overwritten_;
    forget_sequences();
}

void RingSource::parse(ByteView bytes, link::LinkHandler& handler) {
    using Kind = wire::ParseEvent::Kind;
    last_->parser.parse(bytes, [&](const wire::ParseEvent& event) {
        if (event.kind == Kind::frame) found_.push_back({event.frame, event.info});
        if (event.kind == Kind::bad_checksum) {
            counters_.crc_error.add();
            handler.on_bad_checksum(last_->id, id_, event.frame.id());
        }
        if (event.kind == Kind::junk) counters_.junk_bytes.add(event.bytes);
        if (event.kind == Kind::unknown_flags) counters_.unknown_flags.add();
    });
    bad_records_ += found_.empty();
}

void RingSource::hand_over(link::LinkHandler& handler, const Found& found) {
    const auto& update = is_echo(verdict_) ? wire::no_loss : last_->tracker.update(found.frame, found.info);
    counters_.add(update);
    counters_.frames_in.add();
    counters_.bytes_in.add(found.frame.size());
    if (found.info == nullptr) counters_.unknown_ids.add();
    handler.on_frame({found.frame, found.info, last_->id, id_, time_, &update, verdict_});
}

void RingSource::on_no_record(shm::ReadError why, link::LinkHandler& handler) {
    next_poll_ = {};
    if (why == shm::ReadError::empty) {
        // Notice::unwritten stays until the new writer has written a record; take() resets it.
        if (last_notice_ != Notice::unwritten) last_notice_ = Notice::nothing;
        return;
    }
    if (why == shm::ReadError::damaged || why == shm::ReadError::forked) {
        next_poll_ = mono_now() + poll_interval;
        return report(handler, Notice::damaged, "the ring is damaged; waiting for another ring of that name");
    }
    if (follower_.is_open()) return report(handler, Notice::unwritten, "it has no writer; waiting for one");
    next_poll_ = mono_now() + poll_interval;
    const auto* const error = follower_.error();
    if (error == nullptr) return;
    const bool absent = error->code == SetupCode::not_found;
    awaited_ = awaited_ || absent;
    report(handler, absent ? Notice::absent : Notice::unreadable,
           error->text + (absent ? "; waiting for it" : "; trying again"));
}

void RingSource::report(link::LinkHandler& handler, Notice what, std::string_view text) {
    if (std::exchange(last_notice_, what) == what) return;
    handler.on_notice(id_, fmt::format("{}: {}", endpoint_.label(), text));
}

MonoTime RingSource::due(bool has_room, MonoTime now) {
    if (held_) return MonoTime::max();
    if (more_ || next_found_ < found_.size()) return has_room ? MonoTime{} : MonoTime::max();
    if (at_end_) return MonoTime::max();
    auto* const reader = follower_.reader();
    if (reader == nullptr || next_poll_ != MonoTime{}) return std::max(next_poll_, now);
    const Nanoseconds nap = reader->arm();
    // arm() also returns 0 for a removed ring. If it has no writer either, there is nothing to read.
    if (nap == Nanoseconds{} && last_notice_ == Notice::unwritten) return now + poll_interval;
    return now + nap;
}

void RingSource::stop_at_current_end() noexcept {
    const auto* const reader = follower_.reader();
    end_ = reader == nullptr ? 0 : reader->end_position();
    at_end_ = reader == nullptr || next_poll_ != MonoTime{};
}

void RingSource::forget_sequences() {
    for (auto& [name, link] : by_name_) link->tracker.restart();
}

RingSource::RingLink& RingSource::link_of(LinkId in_ring, link::LinkHandler& handler) {
    if (const auto known = by_number_.find(in_ring); known != by_number_.end()) return *known->second;
    if (by_number_.size() == max_links) by_number_.clear();
    auto& link = link_called(name_of(in_ring), handler);
    by_number_.emplace(in_ring, &link);
    return link;
}

RingSource::RingLink& RingSource::link_called(const std::string& name, link::LinkHandler& handler) {
    auto known = by_name_.find(name);
    if (known == by_name_.end()) {
        if (by_name_.size() == max_links) forget_longest_silent(handler);
        known = by_name_.emplace(name, std::make_unique<RingLink>(links_.take_link_id(), table_)).first;
        handler.on_link_up(known->second->id, id_, name);
    }
    known->second->own = is_own(name);
    return *known->second;
}

// Evicts half of the links at once, so that eviction is rare. A link that returns gets a new entry.
void RingSource::forget_longest_silent(link::LinkHandler& handler) {
    std::vector<std::uint64_t> heard;
    heard.reserve(by_name_.size());
    for (const auto& [name, link] : by_name_) heard.push_back(link->heard);
    const auto middle = heard.begin() + static_cast<std::ptrdiff_t>(heard.size() / 2);
    std::ranges::nth_element(heard, middle);
    by_number_.clear();
    last_ = nullptr;
    std::erase_if(by_name_, [&](const auto& entry) {
        if (entry.second->heard >= *middle) return false;
        handler.on_link_down(entry.second->id, id_, "silent for too long");
        return true;
    });
}

std::string RingSource::name_of(LinkId in_ring) {
    if (!names_.contains(in_ring)) static_cast<void>(read_names());
    if (const auto named = names_.find(in_ring); named != names_.end()) return named->second;
    any_unnamed_ = true;
    return fmt::format("{}/{}", endpoint_.label(), in_ring.value);
}

// Reads the counter page. Returns whether its names have changed.
bool RingSource::read_names() {
    next_names_ = mono_now() + names_interval;
    auto page = shm::read_counters(follower_.name(), trust_of(endpoint_.options));
    if (!page || page->links == names_) return false;
    names_ = std::move(page->links);
    return true;
}

// The page may have been missing when a link was first seen, because its router was recreating it after a removal. Such
// a link has a number instead of a name, so is_own() could not recognise this process's own link.
void RingSource::poll_names() {
    if (!any_unnamed_ || next_found_ < found_.size() || mono_now() < next_names_ || !read_names()) return;
    any_unnamed_ = false;
    by_number_.clear();
    last_ = nullptr;
}

// The router names this process's link after the address of its socket.
bool RingSource::is_own(const std::string& name) const {
    if (!inlet_) return false;
    const auto links = links_.links();
    return std::ranges::any_of(links, [&](const auto& l) { return l.endpoint == *inlet_ && l.name == name; });
}

SetupResult<link::EndpointId> RingSource::inlet() {
    if (!inlet_ && !no_inlet_) {
        endpoint::Endpoint inlet = endpoint_;
        inlet.options.from_oldest = false;
        inlet.options.lossless.reset();
        inlet.options.required = false;
        auto added = links_.add(inlet, dialect_);
        if (added) inlet_ = *added;
        else no_inlet_ = std::move(added.error());
    }
    if (!inlet_) return tl::unexpected(*no_inlet_);
    return *inlet_;
}

bool RingSource::send(const wire::FrameView& frame) {
    const auto to = inlet();
    return to && links_.send(*to, frame) != 0;
}

RingLosses RingSource::losses() const noexcept {
    return {follower_.missed() + overwritten_, bad_records_, other_kinds_, copies_, echo_};
}

}  // namespace mavloom::ring
