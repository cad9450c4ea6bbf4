// SPDX-License-Identifier: MIT
#include "ring_reader.hpp"

#include <algorithm>

namespace mavloom::python {
namespace {

constexpr std::size_t most_copied_bytes = 1 << 20;  // in one batch, and one record more

RingSource::State state_of(shm::ReadError error) noexcept {
    using State = RingSource::State;
    switch (error) {
        case shm::ReadError::empty: return State::nothing;
        case shm::ReadError::no_writer: return State::no_writer;
        case shm::ReadError::retired: return State::removed;
        case shm::ReadError::damaged: return State::damaged;
        case shm::ReadError::forked: break;
    }
    return State::forked;
}

// Where the copies lie, once they do not move any more.
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

bool Lease::look() noexcept {
    int lookers = lookers_.load(std::memory_order_relaxed);
    do
        if (lookers == released) return false;
    while (!lookers_.compare_exchange_weak(lookers, lookers + 1, std::memory_order_acquire));
    return true;
}

void Lease::look_away() noexcept {
    if (lookers_.fetch_sub(1, std::memory_order_acq_rel) == 1 && source_) source_->nobody_looks();
}

bool Lease::release() noexcept {
    int nobody = 0;
    return lookers_.compare_exchange_strong(nobody, released, std::memory_order_acq_rel) || nobody == released;
}

// ---- RingSource

RingSource::State RingSource::read(std::size_t most, MonoTime deadline, std::shared_ptr<Lease>& out) {
    const MonoTime end = end_of_slice(deadline);
    const auto lock = turns_.take_until(end);
    return lock.owns_lock() ? read_locked(most, end, out) : State::nothing;
}

RingSource::State RingSource::poll(std::size_t most, std::shared_ptr<Lease>& out) {
    const auto lock = turns_.try_take();
    return lock.owns_lock() ? read_locked(most, MonoTime{}, out) : State::nothing;
}

RingSource::State RingSource::read_locked(std::size_t most, MonoTime deadline, std::shared_ptr<Lease>& out) {
    if (is_closed()) return State::closed;
    if (lossless_ && !release_current()) return State::looked_at;
    const State state = lossless_ ? view(most, deadline, out) : copy(most, deadline, out);
    missed_.store(reader_.missed(), std::memory_order_relaxed);
    return state;
}

shm::ReadResult<shm::RingRecord> RingSource::next(MonoTime deadline) {
    return deadline == MonoTime{} ? reader_.try_read() : reader_.read(deadline);
}

RingSource::State RingSource::view(std::size_t most, MonoTime deadline, std::shared_ptr<Lease>& out) {
    if (scratch_.size() < most) scratch_.resize(most);
    auto count = reader_.try_read_batch({scratch_.data(), most});
    if (!count && count.error() == shm::ReadError::empty && deadline != MonoTime{}) {
        const auto first = reader_.read(deadline);
        if (!first) return state_of(first.error());
        scratch_.front() = *first;
        count = 1;
    }
    if (!count) return state_of(count.error());
    const auto end = scratch_.begin() + static_cast<std::ptrdiff_t>(*count);
    out = std::make_shared<Lease>(shared_from_this(), std::vector<shm::RingRecord>(scratch_.begin(), end));
    current_ = out;
    return State::found;
}

RingSource::State RingSource::copy(std::size_t most, MonoTime deadline, std::shared_ptr<Lease>& out) {
    std::vector<shm::RingRecord> records;
    std::vector<std::uint64_t> copies;
    while (records.size() < most && copies.size() * sizeof copies[0] < most_copied_bytes) {
        const auto record = next(records.empty() ? deadline : MonoTime{});
        if (!record && records.empty()) return state_of(record.error());
        if (!record) break;
        records.push_back(*record);
        append(copies, record->data);
    }
    point_to(records, copies);
    out = std::make_shared<Lease>(std::move(records), std::move(copies));
    return State::found;
}

bool RingSource::release_current() {
    const auto lease = current_.lock();
    return !lease || lease->release();
}

bool RingSource::release(Lease& lease) {
    if (!lease.release()) return false;
    const auto lock = turns_.take();
    if (current_.lock().get() != &lease) return true;
    current_.reset();
    if (!is_closed()) reader_.release();
    return true;
}

bool RingSource::close() {
    const auto lock = turns_.take();
    return close_locked();
}

bool RingSource::close_locked() {
    if (is_closed()) return true;
    if (!release_current()) return false;
    closed_.store(true, std::memory_order_relaxed);
    reader_.detach();
    return true;
}

void RingSource::abandon() {
    abandoned_.store(true);
    nobody_looks();
}

void RingSource::nobody_looks() {
    if (abandoned_.load() && fork_.is_here()) static_cast<void>(close());
}

}  // namespace mavloom::python
