// SPDX-License-Identifier: MIT
#include "ring/reader.hpp"

#include <algorithm>

namespace mavloom::python {
namespace {

constexpr std::size_t max_copied_bytes = 1 << 20;  // in one batch, plus one record

SharedRingReader::State state_of(shm::ReadError error) noexcept {
    using State = SharedRingReader::State;
    switch (error) {
        case shm::ReadError::empty: return State::nothing;
        case shm::ReadError::no_writer: return State::no_writer;
        case shm::ReadError::retired: return State::removed;
        case shm::ReadError::damaged: return State::damaged;
        case shm::ReadError::forked: break;
    }
    return State::forked;
}

// Points the records at their copies, once the copies no longer move.
void point_to(std::vector<shm::RingRecord>& records, const std::vector<std::uint64_t>& copies) {
    const auto* at = reinterpret_cast<const std::uint8_t*>(copies.data());
    for (auto& record : records) {
        record.data = {at, record.data.size()};
        at += (record.data.size() + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t) * sizeof(std::uint64_t);
    }
}

void append(std::vector<std::uint64_t>& copies, ByteView bytes) {
    const std::size_t begin = copies.size();
    copies.resize(begin + (bytes.size() + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t));
    std::ranges::copy(bytes, reinterpret_cast<std::uint8_t*>(copies.data() + begin));
}

}  // namespace

// ---- Lease

const std::vector<shm::RingRecord>& Lease::records() const noexcept {
    return kept_.load() == Kept::copies ? kept_records_ : records_;
}

Lease::Pin Lease::pin() noexcept {
    if (pins_.pin()) {
        std::uint64_t first = 0;
        if (const auto here = feed::this_thread(); !pinned_by_.compare_exchange_strong(first, here) && first != here)
            is_pinned_by_several_.store(true);
        return Pin::counted;
    }
    while (kept_.load() == Kept::soon) std::this_thread::yield();
    return kept_.load() == Kept::copies ? Pin::free : Pin::refused;
}

void Lease::unpin() noexcept {
    if (pins_.unpin() && ring_reader_) ring_reader_->on_unpinned();
}

bool Lease::is_another_threads() const noexcept {
    return !is_pinned_by_several_.load() && pinned_by_.load() != feed::this_thread();
}

bool Lease::keep() {
    kept_records_ = records_;
    kept_.store(Kept::soon);
    const bool finished = pins_.finish();
    if (finished) {
        for (const auto& record : records_) append(copies_, record.data);
        point_to(kept_records_, copies_);
    }
    kept_.store(finished && ring_reader_->holds() ? Kept::copies : Kept::nothing);
    return finished;
}

// ---- SharedRingReader

SharedRingReader::State SharedRingReader::fetch(std::size_t most, MonoTime deadline) {
    const bool waits = deadline != MonoTime{};
    const MonoTime end = waits ? feed::end_of_slice(deadline) : MonoTime{};
    const auto lock = waits ? mutex_.take_until(end) : mutex_.try_take();
    return lock.owns_lock() ? fill(most, end) : State::nothing;
}

SharedRingReader::State SharedRingReader::take(std::size_t most, Portion& out) {
    const auto lock = mutex_.try_take();
    if (!lock.owns_lock() || !pending_.lease) return State::nothing;
    if (const auto here = lossless_ ? feed::this_thread() : 0; here != 0)
        taker_ = pending_.first == 0 || taker_ == here ? here : 0;
    if (most != 1 || pending_.first + 1 == pending_.lease->records().size()) out = std::exchange(pending_, {});
    else out = {pending_.lease, pending_.first++};
    return State::found;
}

SharedRingReader::State SharedRingReader::fill(std::size_t most, MonoTime deadline) {
    if (is_closed()) return State::closed;
    if (pending_.lease) return State::found;
    if (lossless_ && !release_current()) {
        const auto lease = current_.lock();  // null if another thread released it meanwhile
        return lease && !lease->is_another_threads() ? State::pinned : State::used_elsewhere;
    }
    const State state = lossless_ ? view(most, deadline) : copy(most, deadline);
    missed_.store(reader_.missed(), std::memory_order_relaxed);
    return state;
}

shm::ReadResult<shm::RingRecord> SharedRingReader::next(MonoTime deadline) {
    return deadline == MonoTime{} ? reader_.poll() : reader_.read(deadline);
}

SharedRingReader::State SharedRingReader::view(std::size_t most, MonoTime deadline) {
    if (scratch_.size() < most) scratch_.resize(most);
    auto count = reader_.try_read_batch({scratch_.data(), most});
    if (!count && count.error() == shm::ReadError::empty) {
        const auto first = next(deadline);
        if (!first) return state_of(first.error());
        scratch_.front() = *first;
        count = 1;
    }
    if (!count) return state_of(count.error());
    const auto end = scratch_.begin() + static_cast<std::ptrdiff_t>(*count);
    pending_ = {std::make_shared<Lease>(shared_from_this(), std::vector<shm::RingRecord>(scratch_.begin(), end))};
    current_ = pending_.lease;
    return State::found;
}

SharedRingReader::State SharedRingReader::copy(std::size_t most, MonoTime deadline) {
    std::vector<shm::RingRecord> records;
    std::vector<std::uint64_t> copies;
    while (records.size() < most && copies.size() * sizeof copies[0] < max_copied_bytes) {
        const auto record = records.empty() ? next(deadline) : reader_.try_read();
        if (!record && records.empty()) return state_of(record.error());
        if (!record) break;
        records.push_back(*record);
        append(copies, record->data);
    }
    point_to(records, copies);
    pending_ = {std::make_shared<Lease>(std::move(records), std::move(copies))};
    return State::found;
}

bool SharedRingReader::release_current() {
    const auto lease = current_.lock();
    if (lease && !(taker_ == feed::this_thread() ? lease->release() : lease->keep())) return false;
    current_.reset();
    return true;
}

bool SharedRingReader::release(Lease& lease) {
    const auto lock = mutex_.take();
    if (!lease.release()) return false;
    if (current_.lock().get() != &lease) return true;
    current_.reset();
    if (!is_closed()) reader_.release();
    return true;
}

bool SharedRingReader::close() {
    const auto lock = mutex_.take();
    return close_locked();
}

bool SharedRingReader::close_locked() {
    if (is_closed()) return true;
    if (const auto lease = current_.lock(); lease && !lease->release()) return false;
    closed_.store(true, std::memory_order_relaxed);
    pending_ = {};
    reader_.detach();
    if (auto* const alarm = this->alarm()) alarm->signal();
    return true;
}

void SharedRingReader::abandon() {
    abandoned_.store(true);
    on_unpinned();
}

void SharedRingReader::on_unpinned() {
    if (abandoned_.load() && fork_.is_own_process()) static_cast<void>(close());
}

// ---- for loops

SetupResult<int> SharedRingReader::event_fd() {
    const std::lock_guard lock(making_alarm_);
    if (!alarm_) {
        auto made = feed::RingAlarm::make(reader_.wake_word(), [this] { return sleep_time(); });
        if (!made) return tl::unexpected(std::move(made.error()));
        alarm_ = std::move(*made);
    }
    return alarm_->fd();
}

feed::RingAlarm* SharedRingReader::alarm() {
    const std::lock_guard lock(making_alarm_);
    return alarm_.get();
}

void SharedRingReader::arm() {
    if (auto* const alarm = this->alarm()) alarm->arm();
}

Nanoseconds SharedRingReader::sleep_time() {
    return mutex_.peek([this](bool nobody_reads) -> Nanoseconds {
        constexpr auto poll_interval = std::chrono::milliseconds{1};
        if (!nobody_reads) return poll_interval;
        if (is_closed() || pending_.lease) return {};
        return reader_.arm();
    });
}

}  // namespace mavloom::python
