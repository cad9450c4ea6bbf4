// SPDX-License-Identifier: MIT
#include "mavloom/net/block_queue.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

namespace mavloom::net {

BlockQueue::Pushed BlockQueue::push(ByteView block, std::uint8_t block_class, std::uint64_t key, MonoTime now) {
    assert(block_class < classes && !block.empty());
    if (block_class != classes - 1) key = 0;
    if (bytes_ + block.size() > limits_.max_bytes) [[unlikely]]
        return push_when_full(block, block_class, key, now);
    append(block, block_class, key, now);
    return {.queued = true};
}

// Not inlined: its locals would cost `push` a stack protector.
[[gnu::noinline]] BlockQueue::Pushed BlockQueue::push_when_full(ByteView block, std::uint8_t block_class,
                                                                std::uint64_t key, MonoTime now) {
    std::uint32_t dropped = 0;
    if (!make_room(block.size(), block_class, key, dropped)) return {.dropped = dropped + 1};
    append(block, block_class, key, now);
    return {.queued = true, .dropped = dropped};
}

void BlockQueue::append(ByteView block, std::uint8_t block_class, std::uint64_t key, MonoTime now) {
    if (tail_ + block.size() > capacity_ || entries_.size() == entries_.capacity()) reserve(block.size());
    std::memcpy(memory_.get() + tail_, block.data(), block.size());
    entries_.push_back(
        {key, now, static_cast<std::uint32_t>(tail_), static_cast<std::uint32_t>(block.size()), block_class, true});
    tail_ += block.size();
    bytes_ += block.size();
    class_bytes_[block_class] += block.size();
    ++blocks_;
    if (jammed_ && key != 0) note_key(key, entries_.size() - 1);
}

// First checks that enough bytes may be dropped. Otherwise it would drop blocks for a new block that does not fit
// anyway.
bool BlockQueue::make_room(std::size_t size, std::uint8_t block_class, std::uint64_t key, std::uint32_t& dropped) {
    if (bytes_ - droppable(block_class) + size > limits_.max_bytes) return false;
    if (!jammed_) {
        jammed_ = true;
        index_keys();
    }
    if (key != 0) {
        const Newest& newest = slot_of(key);
        if (newest.key == key) superseded_.push_back(newest.index);
    }
    while (bytes_ + size > limits_.max_bytes) {
        if (!drop_one(block_class)) return false;
        ++dropped;
    }
    return true;
}

bool BlockQueue::drop_one(std::uint8_t block_class) noexcept {
    if (drop_superseded()) return true;
    for (int c = classes - 1; c >= block_class; --c) {
        if (oldest(static_cast<std::uint8_t>(c))) {
            drop(oldest_[c]);
            return true;
        }
    }
    return false;
}

bool BlockQueue::drop_superseded() noexcept {
    while (next_superseded_ < superseded_.size()) {
        const std::size_t index = superseded_[next_superseded_++];
        if (index >= head_ && index < entries_.size() && entries_[index].live && !pinned(index)) {
            drop(index);
            return true;
        }
    }
    return false;
}

std::size_t BlockQueue::droppable(std::uint8_t block_class) const noexcept {
    std::size_t sum = 0;
    for (std::size_t c = block_class; c < classes; ++c) sum += class_bytes_[c];
    if (blocks_ != 0 && pinned(head_) && entries_[head_].block_class >= block_class) sum -= entries_[head_].size;
    return sum;
}

// Advances the class's search position to its oldest droppable block. Returns false if there is none.
bool BlockQueue::oldest(std::uint8_t block_class) noexcept {
    std::size_t i = std::max(oldest_[block_class], head_);
    while (i < entries_.size() && (!entries_[i].live || entries_[i].block_class != block_class || pinned(i))) ++i;
    oldest_[block_class] = i;
    return i < entries_.size();
}

void BlockQueue::drop(std::size_t index) noexcept {
    Entry& entry = entries_[index];
    entry.live = false;
    bytes_ -= entry.size;
    class_bytes_[entry.block_class] -= entry.size;
    --blocks_;
    if (blocks_ == 0) {
        reset();
    } else if (index == head_) {
        drop_from_head();
    }
}

void BlockQueue::drop_from_head() noexcept {
    while (head_ < entries_.size() && !entries_[head_].live) ++head_;
}

void BlockQueue::reset() noexcept {
    entries_.clear();
    head_ = tail_ = begun_ = bytes_ = blocks_ = 0;
    class_bytes_.fill(0);
    oldest_.fill(0);
    if (newest_.empty()) return;
    jammed_ = false;
    newest_ = {};
    superseded_ = {};
    keys_ = next_superseded_ = 0;
    if (capacity_ <= kept_capacity) return;
    memory_.reset();
    capacity_ = 0;
    entries_ = {};
}

std::uint32_t BlockQueue::expire(MonoTime now) noexcept {
    std::uint32_t dropped = 0;
    for (std::uint8_t c = 0; c < classes; ++c) {
        while (oldest(c) && now - entries_[oldest_[c]].queued > limits_.max_age[c]) {
            drop(oldest_[c]);
            ++dropped;
        }
    }
    return dropped;
}

std::uint32_t BlockQueue::clear() noexcept {
    const auto dropped = static_cast<std::uint32_t>(blocks_);
    reset();
    return dropped;
}

void BlockQueue::reserve(std::size_t size) {
    if (tail_ + size > capacity_) {
        std::size_t capacity = std::max(capacity_, first_capacity);
        while (capacity / 2 < bytes_ + size) capacity *= 2;
        compact(capacity);
    } else if (entries_.size() > 2 * blocks_ && !entries_.empty()) {
        compact(capacity_);
    }
    if (entries_.size() == entries_.capacity()) entries_.reserve(std::max<std::size_t>(64, entries_.size() * 2));
}

// Closes the gaps that dropped and sent blocks left. Moves to a new buffer if `capacity` (bytes) differs from the old
// one.
void BlockQueue::compact(std::size_t capacity) {
    std::unique_ptr<std::uint8_t[]> larger;
    if (capacity != capacity_) larger = std::make_unique_for_overwrite<std::uint8_t[]>(capacity);
    std::uint8_t* const to = larger ? larger.get() : memory_.get();
    std::size_t tail = 0, kept = 0;
    for (std::size_t i = head_; i < entries_.size(); ++i) {
        if (!entries_[i].live) continue;
        Entry entry = entries_[i];
        std::memmove(to + tail, memory_.get() + entry.offset, entry.size);
        entry.offset = static_cast<std::uint32_t>(tail);
        tail += entry.size;
        entries_[kept++] = entry;
    }
    entries_.resize(kept);
    if (larger) memory_ = std::move(larger);
    capacity_ = capacity;
    tail_ = tail;
    head_ = 0;
    oldest_.fill(0);
    if (jammed_) index_keys();
}

void BlockQueue::index_keys() {
    newest_.assign(std::bit_ceil(std::max<std::size_t>(64, 2 * entries_.size())), Newest{});
    keys_ = 0;
    superseded_.clear();
    next_superseded_ = 0;
    for (std::size_t i = head_; i < entries_.size(); ++i) {
        if (entries_[i].live && entries_[i].key != 0) note_key(entries_[i].key, i);
    }
}

void BlockQueue::note_key(std::uint64_t key, std::size_t index) {
    Newest& newest = slot_of(key);
    if (newest.key == key) {
        superseded_.push_back(newest.index);
        newest.index = static_cast<std::uint32_t>(index);
        return;
    }
    newest = {key, static_cast<std::uint32_t>(index)};
    if (++keys_ * 2 > newest_.size()) index_keys();
}

// Open addressing. The table is never more than half full.
BlockQueue::Newest& BlockQueue::slot_of(std::uint64_t key) noexcept {
    const std::size_t mask = newest_.size() - 1;
    std::size_t i = (key * 0x9e3779b97f4a7c15u >> 32) & mask;
    while (newest_[i].key != 0 && newest_[i].key != key) i = (i + 1) & mask;
    return newest_[i];
}

BlockQueue::Gathered BlockQueue::gather(Position& from, std::size_t max_bytes, std::span<iovec> room) const noexcept {
    Gathered sum;
    std::size_t i = from.index;
    for (; i < entries_.size(); ++i) {
        const Entry& entry = entries_[i];
        if (!entry.live) continue;
        if (sum.blocks != 0 && sum.bytes + entry.size > max_bytes) break;
        std::uint8_t* const base = memory_.get() + entry.offset;
        iovec* const last = sum.pieces == 0 ? nullptr : &room[sum.pieces - 1];
        if (last != nullptr && static_cast<std::uint8_t*>(last->iov_base) + last->iov_len == base) {
            last->iov_len += entry.size;
        } else {
            if (sum.pieces == room.size()) break;
            room[sum.pieces++] = {base, entry.size};
        }
        sum.bytes += entry.size;
        ++sum.blocks;
    }
    from.index = i;
    return sum;
}

void BlockQueue::pop(Position until) noexcept {
    assert(until.index <= entries_.size());
    if (until.index == entries_.size()) {
        reset();
        return;
    }
    for (; head_ < until.index; ++head_) {
        const Entry& entry = entries_[head_];
        if (!entry.live) continue;
        bytes_ -= entry.size;
        class_bytes_[entry.block_class] -= entry.size;
        --blocks_;
    }
    begun_ = 0;
    if (blocks_ == 0) {
        reset();
    } else {
        drop_from_head();
    }
}

std::size_t BlockQueue::pieces(std::span<iovec> room, std::size_t max_bytes) const noexcept {
    Position from = front();
    const std::size_t most = max_bytes < SIZE_MAX - begun_ ? max_bytes + begun_ : SIZE_MAX;
    const std::size_t count = gather(from, most, room).pieces;
    if (count != 0) room[0] = {static_cast<std::uint8_t*>(room[0].iov_base) + begun_, room[0].iov_len - begun_};
    return count;
}

std::size_t BlockQueue::consume(std::size_t bytes) noexcept {
    begun_ += bytes;
    std::size_t whole = 0, left = begun_;
    std::size_t index = head_;
    for (; index < entries_.size(); ++index) {
        if (!entries_[index].live) continue;
        if (left < entries_[index].size) break;
        left -= entries_[index].size;
        ++whole;
    }
    if (whole != 0) pop({index});
    if (blocks_ != 0) begun_ = left;
    return whole;
}

// The first block may be dropped again, but `oldest` and `drop_superseded` had already skipped it. Clearing `jammed_`
// makes the next jam index all blocks again.
void BlockQueue::rewind() noexcept {
    if (begun_ == 0) return;
    begun_ = 0;
    oldest_[entries_[head_].block_class] = head_;
    jammed_ = false;
}

}  // namespace mavloom::net
