// SPDX-License-Identifier: MIT
#include "mavloom/shm/ring_reader.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <utility>

#include "shm/ring_file.hpp"

namespace mavloom::shm {

static constexpr Nanoseconds writer_check_interval = std::chrono::milliseconds(100);
static constexpr Nanoseconds poll_interval = std::chrono::milliseconds(1);
static constexpr unsigned spins_per_check = 256;

static void relax() noexcept {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    asm volatile("yield");
#endif
}

RingReader::RingReader(std::string name, const ReaderOptions& options, std::shared_ptr<Segment> segment)
    : name_(std::move(name)), options_(options), segment_(std::move(segment)), forked_(&segment_->forked_flag()) {}

RingReader::RingReader(RingReader&& other) noexcept = default;
RingReader::~RingReader() { end(); }

RingReader& RingReader::operator=(RingReader&& other) noexcept {
    if (this == &other) return *this;
    end();
    name_ = std::move(other.name_);
    options_ = other.options_;
    segment_ = std::move(other.segment_);
    forked_ = other.forked_;
    slot_ = std::exchange(other.slot_, std::nullopt);
    consumer_ = std::move(other.consumer_);
    next_writer_check_ = other.next_writer_check_;
    waiting_since_ = other.waiting_since_;
    armed_ = other.armed_;
    return *this;
}

SetupResult<RingReader> RingReader::open(std::string_view name, const ReaderOptions& options) {
    using Access = Segment::Access;
    if (options.lossless && options.read_only)
        return setup_error(SetupCode::usage,
                           "a lossless reader writes its position to the ring, so it cannot be read-only");
    const auto check = [&](const Segment& file) {
        return check_trusted(file, fmt::format("ring {}", name), options.trust);
    };
    auto segment = open_ring(name, options.read_only ? Access::read_only : Access::read_write, check);
    if (!segment && segment.error().code == SetupCode::permission && !options.lossless && !options.read_only)
        segment = open_ring(name, Access::read_only, check);
    if (!segment) return tl::unexpected(std::move(segment.error()));
    RingReader reader(std::string(name), options, std::make_shared<Segment>(std::move(*segment)));
    if (auto begun = reader.begin(); !begun) return tl::unexpected(std::move(begun.error()));
    return reader;
}

SetupResult<void> RingReader::begin() {
    using Start = detail::Consumer<SharedWords>::Start;
    if (segment_->writable()) slot_ = take_slot();
    if (!slot_ && options_.lossless)
        return setup_error(SetupCode::in_use,
                           fmt::format("ring {} already has {} readers, which is the maximum", name_, reader_slots));
    if (options_.spin) segment_->populate();  // other readers take the page faults during their first lap
    consumer_ = detail::Consumer<SharedWords>(memory_of(*segment_), slot_, options_.lossless);
    if (consumer_.start(options_.from == ReaderOptions::From::oldest ? Start::oldest : Start::newest)) {
        // Release: pairs with the acquire in ring_status().
        if (slot_)
            memory_of(*segment_).control->attached.fetch_or(std::uint64_t{1} << *slot_, std::memory_order_release);
        return {};
    }
    return setup_error(
        SetupCode::bad_input,
        fmt::format("{}: is a damaged ring: the data before its end does not consist of records", segment_->path()));
}

// Returns this program's name in two words, for display by ring_status().
static std::array<std::uint64_t, 2> program_name() noexcept {
    std::array<char, 16> name{};
    const char* const mine = program_invocation_short_name;
    std::memcpy(name.data(), mine, std::min(name.size(), std::strlen(mine)));
    std::array<std::uint64_t, 2> words;
    std::memcpy(words.data(), name.data(), sizeof words);
    return words;
}

// Holding the lock claims the slot. Inspectors list it only after begin() sets its bit in `attached`, when its position
// is valid. The slot's previous owner may have been killed, so its bits are cleared before any field is set.
std::optional<unsigned> RingReader::take_slot() noexcept {
    assert(segment_->writable() && !slot_);
    const auto ring = memory_of(*segment_);
    for (unsigned index = 0; index < reader_slots; ++index) {
        if (!segment_->try_lock(slot_byte(index))) continue;
        const std::uint64_t bit = std::uint64_t{1} << index;
        ring.control->attached.fetch_and(~bit, std::memory_order_relaxed);
        ring.control->holders.fetch_and(~bit, std::memory_order_seq_cst);
        auto& slot = ring.slots[index];
        slot.pid.store(static_cast<std::uint32_t>(::getpid()), std::memory_order_relaxed);
        slot.lossless.store(options_.lossless ? 1 : 0, std::memory_order_relaxed);
        slot.opened_ns.store(static_cast<std::uint64_t>(unix_time().time_since_epoch().count()),
                             std::memory_order_relaxed);
        const auto program = program_name();
        for (std::size_t i = 0; i < program.size(); ++i) slot.program[i].store(program[i], std::memory_order_relaxed);
        slot.missed.store(0, std::memory_order_relaxed);
        return index;
    }
    return std::nullopt;
}

ReadResult<RingRecord> RingReader::read(MonoTime deadline) noexcept {
    auto record = wait(deadline);
    if (!forked()) woke();
    return record;
}

ReadResult<RingRecord> RingReader::wait(MonoTime deadline) noexcept {
    MonoTime waiting_since{};
    for (unsigned spins = 0;; ++spins) {
        auto record = try_read();
        if (record || record.error() != ReadError::empty) return record;
        if (options_.spin && spins % spins_per_check != 0) {
            relax();
            continue;
        }
        const MonoTime now = mono_now();
        if (waiting_since == MonoTime{}) waiting_since = now;
        if (const auto why = why_no_record(now)) {
            record = try_read();  // a record written just before the writer closed
            if (!record && record.error() == ReadError::empty) return tl::unexpected(*why);
            return record;
        }
        if (now >= deadline) return record;
        if (!options_.spin) consumer_.sleep(nap(waiting_since, now, deadline));
    }
}

// The first naps are short, because the writer wakes readers at most once per millisecond. Later naps last until the
// next check that the writer is alive.
Nanoseconds RingReader::nap(MonoTime waiting_since, MonoTime now, MonoTime deadline) const noexcept {
    assert(waiting_since <= now && now < deadline);
    const bool is_short = !slot_ || now < waiting_since + poll_interval;
    return std::min<Nanoseconds>(is_short ? poll_interval : writer_check_interval, deadline - now);
}

std::optional<ReadError> RingReader::why_no_record(MonoTime now) noexcept {
    if (consumer_.retired()) return ReadError::retired;
    const bool closed = memory_of(*segment_).control->writer_pid.load(std::memory_order_acquire) == 0;
    if (!closed && now < next_writer_check_) return std::nullopt;
    next_writer_check_ = now + writer_check_interval;
    if (writer_alive()) return std::nullopt;
    return ReadError::no_writer;
}

ReadResult<RingRecord> RingReader::poll() noexcept {
    auto record = try_read();
    if (!record && record.error() == ReadError::empty) {
        const auto why = why_no_record(mono_now());
        if (!why) return record;
        record = try_read();  // a record written just before the writer closed
        if (!record && record.error() == ReadError::empty) return tl::unexpected(*why);
    }
    if (record) woke();
    return record;
}

Nanoseconds RingReader::arm() noexcept {
    if (forked()) return poll_interval;
    if (!slot_) return consumer_.more_waits() ? Nanoseconds{} : poll_interval;
    const MonoTime now = mono_now();
    if (waiting_since_ == MonoTime{}) waiting_since_ = now;
    const bool asks = now >= waiting_since_ + detail::wake_interval;  // see Consumer::sleep()
    if (asks && !consumer_.fall_asleep()) armed_ = now;
    if (consumer_.more_waits()) return {};
    return !asks || now < armed_ + detail::wake_interval ? detail::wake_interval : writer_check_interval;
}

std::shared_ptr<const SharedWords::Word32> RingReader::wake_word() const {
    return {segment_, &memory_of(*segment_).control->wakes};
}

void RingReader::release() noexcept {
    if (forked()) return;
    consumer_.release();
    consumer_.publish();
}

std::uint64_t RingReader::end_position() const noexcept {
    return memory_of(*segment_).control->tail.load(std::memory_order_acquire);
}
std::uint64_t RingReader::writers() const noexcept {
    return memory_of(*segment_).control->writers.load(std::memory_order_acquire);
}
bool RingReader::writer_alive() const noexcept { return segment_->is_locked(writer_byte); }
bool RingReader::is_named() const noexcept { return segment_->is_named(); }

// After fork(), the child changes nothing: the slot belongs to the parent.
void RingReader::detach() noexcept {
    if (!slot_ || segment_->forked()) return;
    auto& control = *memory_of(*segment_).control;
    const std::uint64_t bit = std::uint64_t{1} << *slot_;
    control.holders.fetch_and(~bit, std::memory_order_release);
    control.attached.fetch_and(~bit, std::memory_order_relaxed);
    control.sleepers.fetch_and(~bit, std::memory_order_relaxed);
    control.rooms.fetch_add(1, std::memory_order_release);
    if (control.room_wanted.load(std::memory_order_seq_cst) != 0) SharedWords::wake(control.rooms);
    segment_->unlock(slot_byte(*slot_));
    slot_.reset();
}

void RingReader::end() noexcept {
    if (segment_) detach();
    segment_.reset();
}

}  // namespace mavloom::shm
