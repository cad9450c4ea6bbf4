// SPDX-License-Identifier: MIT
#include "mavloom/shm/ring_writer.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include "mavloom/shm/counter_page.hpp"
#include "mavloom/shm/ring_info.hpp"
#include "shm/counter_page_layout.hpp"
#include "shm/ring_file.hpp"

namespace mavloom::shm {

// The longest time for which the hold of a killed reader can block a waiting writer.
static constexpr Nanoseconds dead_check_sleep = std::chrono::milliseconds(10);
// Minimum time between two checks for dead readers, however often a full ring is written to. Each check makes a system
// call per blocking reader.
static constexpr Nanoseconds dead_check_interval = std::chrono::milliseconds(1);

RingWriter::RingWriter(std::string name, const RingOptions& options, std::unique_ptr<Segment> segment)
    : name_(std::move(name)),
      options_(options),
      segment_(std::move(segment)),
      forked_(&segment_->forked_flag()),
      producer_(memory_of(*segment_)) {}

RingWriter::RingWriter(RingWriter&&) noexcept = default;
RingWriter::~RingWriter() { end(); }

RingWriter& RingWriter::operator=(RingWriter&& other) noexcept {
    if (this == &other) return *this;
    end();
    name_ = std::move(other.name_);
    set_aside_ = std::move(other.set_aside_);
    options_ = other.options_;
    segment_ = std::move(other.segment_);
    forked_ = other.forked_;
    producer_ = other.producer_;
    dead_checked_ = other.dead_checked_;
    created_ = other.created_;
    return *this;
}

SetupResult<RingWriter> RingWriter::open(std::string_view name, const RingOptions& options) {
    std::string set_aside;
    for (;;) {
        auto segment = writer_segment(name, options, &set_aside);
        if (!segment) return tl::unexpected(std::move(segment.error()));
        RingWriter writer(std::string(name), options, std::make_unique<Segment>(std::move(*segment)));
        auto begun = writer.begin();
        if (begun) {
            writer.set_aside_ = std::move(set_aside);
            return writer;
        }
        // Leaves the ring unchanged.
        const bool is_aside = options.sets_aside && writer.segment_->is_named() && rename_aside(path_of(name));
        writer.segment_.reset();
        if (!is_aside) return tl::unexpected(std::move(begun.error()));
        set_aside = std::move(begun.error().text);
    }
}

SetupResult<void> RingWriter::begin() {
    assert(segment_->writable());
    segment_->populate();
    if (!producer_.recover())
        return setup_error(SetupCode::bad_input,
                           fmt::format("{}: is a damaged ring: the data before its end does not consist of records; "
                                       "remove it with `mavloom shm remove {}`",
                                       segment_->path(), name_));
    // The old page's names do not match this writer's link numbers. Remove the page before `writers` makes readers look
    // for names.
    remove_left_page(name_);
    auto& control = *memory_of(*segment_).control;
    control.writer_pid.store(static_cast<std::uint32_t>(::getpid()), std::memory_order_relaxed);
    control.when_full.store(static_cast<std::uint32_t>(options_.when_full), std::memory_order_relaxed);
    control.writer_opened_ns.store(static_cast<std::uint64_t>(unix_time().time_since_epoch().count()),
                                   std::memory_order_relaxed);
    created_ = control.writers.fetch_add(1, std::memory_order_relaxed) == 0;
    control.room_wanted.store(0, std::memory_order_relaxed);
    producer_.wake_readers_now();
    return {};
}

// The fast path: claims the record if nothing prevents it. On failure, make_room() finds the reason.
[[gnu::always_inline]] inline bool RingWriter::has_room(std::size_t length) noexcept {
    return segment_ && !forked_->load(std::memory_order_relaxed) && length <= longest() &&
           producer_.claim(length) == detail::Producer<SharedWords>::Room::there;
}

WriteResult<void> RingWriter::write(ByteView data, const RecordInfo& info, MonoTime deadline) noexcept {
    if (!has_room(data.size()))
        if (auto room = make_room(data.size(), deadline); !room) return room;
    producer_.store_payload(data);
    producer_.commit(info, data.size());
    return {};
}

WriteResult<ByteSpan> RingWriter::claim(std::size_t length, MonoTime deadline) noexcept {
    if (!has_room(length))
        if (auto room = make_room(length, deadline); !room) return tl::unexpected(room.error());
    return ByteSpan(producer_.payload(), length);
}

WriteResult<void> RingWriter::make_room(std::size_t length, MonoTime deadline) noexcept {
    using Room = detail::Producer<SharedWords>::Room;
    if (!segment_) return tl::unexpected(WriteError::removed);
    if (forked_->load(std::memory_order_relaxed)) return tl::unexpected(WriteError::forked);
    if (length > longest()) return tl::unexpected(WriteError::too_long);
    for (;;) {
        const Room room = producer_.claim(length);
        if (room == Room::there) return {};
        if (room == Room::removed) return tl::unexpected(WriteError::removed);
        if (auto waited = wait_for_room(length, deadline); !waited) return waited;
    }
}

// Returns success if another attempt to claim is worthwhile.
WriteResult<void> RingWriter::wait_for_room(std::size_t length, MonoTime deadline) noexcept {
    assert(segment_ && length <= longest());
    const std::uint64_t blockers = producer_.blockers(length);
    if (blockers == 0) return {};
    if (options_.when_full == WhenFull::evict) {
        producer_.drop_holds(blockers);
        memory_of(*segment_).control->evictions.fetch_add(static_cast<std::uint64_t>(std::popcount(blockers)),
                                                          std::memory_order_relaxed);
        return {};
    }
    const MonoTime now = mono_now();
    if (now >= dead_checked_ + dead_check_interval) {
        dead_checked_ = now;
        drop_dead(blockers);
        if (producer_.blockers(length) == 0) return {};
    }
    if (options_.when_full == WhenFull::drop_newest) {
        count_dropped();
        return tl::unexpected(WriteError::full);
    }
    if (now >= deadline) return tl::unexpected(WriteError::full);
    producer_.wake_readers_now();  // a sleeping or napping reader may be the one that holds
    producer_.sleep_for_room(length, std::min(dead_checked_ + dead_check_sleep, deadline) - now);
    return {};
}

// Takes the slot's lock before it drops the hold, so that no new reader can take the slot in between.
void RingWriter::drop_dead(std::uint64_t slots) noexcept {
    for (; slots != 0; slots &= slots - 1) {
        const auto slot = static_cast<unsigned>(std::countr_zero(slots));
        // If only a lock for reading is in the way, no reader owns the slot, and none can take it.
        if (!segment_->try_lock(slot_byte(slot)) && segment_->is_locked(slot_byte(slot))) continue;
        auto& control = *memory_of(*segment_).control;
        producer_.drop_holds(std::uint64_t{1} << slot);
        control.attached.fetch_and(~(std::uint64_t{1} << slot), std::memory_order_relaxed);
        control.evictions.fetch_add(1, std::memory_order_relaxed);
        segment_->unlock(slot_byte(slot));
    }
}

void RingWriter::count_dropped() noexcept {
    if (segment_) memory_of(*segment_).control->dropped.fetch_add(1, std::memory_order_relaxed);
}

LinkId RingWriter::last_link() const noexcept {
    assert(segment_);
    const auto ring = memory_of(*segment_);
    const std::uint64_t tail = producer_.tail();
    std::uint32_t last = 0;
    auto at = detail::find_mark(ring, 0).value_or(detail::Mark{tail, 0}).position;
    while (at < tail) {
        const auto header = detail::load_header(ring, at);
        const std::uint64_t size = detail::size_of(ring, at, header, tail - at);
        if (size == 0) break;  // damage; readers stop here too
        if (!header.is_padding() && LinkId{header.link} < end_of_link_numbers) last = std::max(last, header.link);
        at += size;
    }
    return LinkId{last};
}

void RingWriter::flush() noexcept {
    if (segment_ && !segment_->forked()) producer_.wake_readers_now();
}

std::uint64_t RingWriter::dropped() const noexcept {
    return segment_ ? memory_of(*segment_).control->dropped.load(std::memory_order_relaxed) : 0;
}

bool RingWriter::is_removed() const noexcept {
    return !segment_ || memory_of(*segment_).control->retired.load(std::memory_order_acquire) != 0 ||
           !segment_->is_named();
}

SetupResult<void> RingWriter::reopen() {
    end();
    auto created = open(name_, options_);
    if (!created) return tl::unexpected(std::move(created.error()));
    *this = std::move(*created);
    return {};
}

// After fork(), the child changes nothing: the ring belongs to the parent.
void RingWriter::end() noexcept {
    if (segment_ && !segment_->forked()) {
        memory_of(*segment_).control->writer_pid.store(0, std::memory_order_release);
        segment_->unlock(writer_byte);
        producer_.wake_readers_now();
    }
    segment_.reset();
}

// Returns whether the page belongs to another live process, which may use it for more than this ring, or to another
// user.
static bool page_is_of_another(const std::string& name) {
    const auto page = read_counters(name);
    if (!page) return page.error().code == SetupCode::permission;
    return page->owner_alive && page->owner_pid != static_cast<std::uint32_t>(::getpid());
}

SetupResult<void> RingWriter::close(Leave leave) {
    SetupResult<void> removed;
    if (leave == Leave::nothing && segment_ && !segment_->forked()) {
        // Without the name, the counter page belongs to the ring that has the name now.
        const bool named = segment_->is_named();
        removed = segment_->unlink();
        if (removed) retire(*segment_);
        if (removed && named && !page_is_of_another(name_)) removed = remove_counter_page(name_);
    }
    end();
    return removed;
}

}  // namespace mavloom::shm
