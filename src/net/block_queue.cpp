// SPDX-License-Identifier: MIT
#include "mavloom/net/block_queue.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

#include "mavloom/base/secret_hash.hpp"

namespace mavloom::net {

BlockQueue::Pushed BlockQueue::push(ByteView block, std::uint8_t block_class, std::uint64_t key, MonoTime now) {
    assert(block_class < classes && !block.empty() && block.size() < 1u << 24);
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
    if (!make_room(block.size(), block_class, key, dropped)) {
        ++dropped_[block_class];
        return {.dropped = dropped + 1};
    }
    append(block, block_class, key, now);
    return {.queued = true, .dropped = dropped};
}

void BlockQueue::append(ByteView block, std::uint8_t block_class, std::uint64_t key, MonoTime now) {
    if (tail_ + block.size() > capacity_ || entries_.size() == entries_.capacity()) reserve(block.size());
    assert(tail_ + block.size() <= capacity_ && entries_.size() < entries_.capacity());
    assert(tail_ <= UINT32_MAX && "offsets have 32 bits");
    std::memcpy(memory_.get() + tail_, block.data(), block.size());
    entries_.push_back({.key = key,
                        .queued = now,
                        .offset = static_cast<std::uint32_t>(tail_),
                        .size = static_cast<std::uint32_t>(block.size()) & Entry::largest_size,
                        .block_class = block_class & Entry::largest_class,
                        .live = 1});
    tail_ += block.size();
    bytes_ += block.size();
    class_bytes_[block_class] += block.size();
    ++blocks_;
    assert(bytes_ <= limits_.max_bytes && bytes_ <= tail_ && blocks_ <= entries_.size());
    if (jammed_ && key != 0) note_key(key, entries_.size() - 1);
}

// First checks that enough bytes may be dropped. Otherwise it would drop blocks for a new block that does not fit
// anyway.
bool BlockQueue::make_room(std::size_t size, std::uint8_t block_class, std::uint64_t key, std::uint32_t& dropped) {
    if (bytes_ - droppable(block_class) + size > limits_.max_bytes) return false;
    if (!jammed_) {
        jammed_ = has_backlog_ = true;
        index_keys();
    }
    if (key != 0) {
        const std::uint32_t place = slot_of(key);
        if (place != 0) superseded_.push_back(place - 1);
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
    assert(sum <= bytes_);
    if (blocks_ != 0 && pinned(head_) && entries_[head_].block_class >= block_class) sum -= entries_[head_].size;
    return sum;
}

// Advances the class's search position to its oldest droppable block. Returns false if there is none.
bool BlockQueue::oldest(std::uint8_t block_class) noexcept {
    assert(block_class < classes);
    std::size_t i = std::max(oldest_[block_class], head_);
    while (i < entries_.size() && (!entries_[i].live || entries_[i].block_class != block_class || pinned(i))) ++i;
    oldest_[block_class] = i;
    return i < entries_.size();
}

void BlockQueue::drop(std::size_t index) noexcept {
    assert(index >= head_ && index < entries_.size() && !pinned(index));
    Entry& entry = entries_[index];
    assert(entry.live && entry.size <= class_bytes_[entry.block_class] && entry.size <= bytes_);
    entry.live = 0;
    bytes_ -= entry.size;
    class_bytes_[entry.block_class] -= entry.size;
    ++dropped_[entry.block_class];
    --blocks_;
    if (blocks_ == 0) {
        reset();
    } else if (index == head_) {
        drop_from_head();
    }
}

void BlockQueue::drop_from_head() noexcept {
    while (head_ < entries_.size() && !entries_[head_].live) ++head_;
    assert(head_ < entries_.size() && "there is a live block");
}

void BlockQueue::reset() noexcept {
    const bool is_large = capacity_ > kept_capacity || entries_.capacity() > kept_entries;
    if (has_backlog_ || is_large) [[unlikely]]
        end_backlog();
    entries_.clear();
    head_ = tail_ = begun_ = bytes_ = blocks_ = 0;
    class_bytes_.fill(0);
    oldest_.fill(0);
}

// `= {}` would keep it.
template <class T>
static void free_memory(std::vector<T>& all) noexcept {
    std::vector<T>().swap(all);
}

// Traffic that fills much memory in each turn keeps it.
void BlockQueue::end_backlog() noexcept {
    const bool is_small = tail_ <= kept_capacity && entries_.size() <= kept_entries;
    small_uses_ = is_small ? static_cast<std::uint8_t>(std::min(small_uses_ + 1, int{rests_after})) : 0;
    if (!has_backlog_ && small_uses_ < rests_after) return;
    has_backlog_ = jammed_ = false;
    free_memory(newest_);
    free_memory(superseded_);
    keys_ = next_superseded_ = 0;
    if (entries_.capacity() > kept_entries) free_memory(entries_);
    if (capacity_ <= kept_capacity) return;
    memory_.reset();
    capacity_ = 0;
}

std::uint32_t BlockQueue::expire(MonoTime now) noexcept {
    has_backlog_ = blocks_ != 0;
    std::uint32_t dropped = 0;
    for (std::uint8_t c = 0; c < classes; ++c) {
        while (oldest(c) && now - entries_[oldest_[c]].queued > limits_.max_age[c]) {
            drop(oldest_[c]);
            ++dropped;
        }
    }
    return dropped;
}

std::size_t BlockQueue::memory_bytes() const noexcept {
    return capacity_ + entries_.capacity() * sizeof(Entry) + (newest_.capacity() + superseded_.capacity()) * 4;
}

std::uint32_t BlockQueue::clear() noexcept {
    const auto dropped = static_cast<std::uint32_t>(blocks_);
    reset();
    return dropped;
}

// Blocks that were dropped or sent leave gaps. Returns how much of them makes closing them worthwhile, if `used` bytes
// or blocks must move. Large queues move eight times what they gain, small ones as much.
static std::size_t worth_moving(std::size_t used, std::size_t large) noexcept {
    return std::max<std::size_t>(used < large ? used : used / 8, 1);
}

void BlockQueue::reserve(std::size_t size) {
    if (entries_.size() == entries_.capacity()) reserve_entry();
    if (tail_ + size > capacity_) reserve_bytes(size);
}

void BlockQueue::reserve_entry() {
    if (entries_.size() - blocks_ >= worth_moving(blocks_, large_blocks)) return remove_dead_entries();
    const std::size_t added = blocks_ < large_blocks ? entries_.size() : blocks_ / 4;
    entries_.reserve(entries_.size() + std::max<std::size_t>(64, added));
}

void BlockQueue::reserve_bytes(std::size_t size) {
    const std::size_t needed = bytes_ + size;
    if (tail_ - bytes_ >= std::max(worth_moving(bytes_, large_bytes), size)) return move_blocks(capacity_);
    std::size_t capacity = std::max(capacity_, first_capacity);
    while (capacity < 2 * needed && capacity < 2 * large_bytes) capacity *= 2;
    if (capacity < 2 * needed)
        capacity = std::max(needed, std::min(needed + needed / 4, limits_.max_bytes + limits_.max_bytes / 8));
    move_blocks(capacity);
}

// Closes the gaps between blocks. Moves to a new buffer if `capacity` (bytes) differs from the old one.
void BlockQueue::move_blocks(std::size_t capacity) {
    assert(capacity >= bytes_);
    std::unique_ptr<std::uint8_t[]> other;
    if (capacity != capacity_) other = std::make_unique_for_overwrite<std::uint8_t[]>(capacity);
    std::uint8_t* const to = other ? other.get() : memory_.get();
    std::size_t tail = 0;
    for (std::size_t i = head_; i < entries_.size(); ++i) {
        Entry& entry = entries_[i];
        if (!entry.live) continue;
        std::memmove(to + tail, memory_.get() + entry.offset, entry.size);
        entry.offset = static_cast<std::uint32_t>(tail);
        tail += entry.size;
    }
    assert(tail == bytes_);
    if (other) memory_ = std::move(other);
    capacity_ = capacity;
    tail_ = tail;
}

void BlockQueue::remove_dead_entries() {
    const auto first = entries_.begin() + static_cast<std::ptrdiff_t>(head_);
    const auto end = std::copy_if(first, entries_.end(), entries_.begin(), [](const Entry& e) { return e.live != 0; });
    entries_.erase(end, entries_.end());
    assert(entries_.size() == blocks_);
    head_ = 0;
    oldest_.fill(0);
    if (jammed_) index_keys();
}

void BlockQueue::index_keys() {
    newest_.assign(std::bit_ceil(std::max<std::size_t>(64, 2 * keys_)), 0);
    keys_ = 0;
    superseded_.clear();
    next_superseded_ = 0;
    for (std::size_t i = head_; i < entries_.size(); ++i) {
        if (entries_[i].live && entries_[i].key != 0) note_key(entries_[i].key, i);
    }
}

void BlockQueue::note_key(std::uint64_t key, std::size_t index) {
    assert(key != 0 && index < entries_.size());
    std::uint32_t& place = slot_of(key);
    if (place != 0) superseded_.push_back(place - 1);
    else ++keys_;
    place = static_cast<std::uint32_t>(index + 1);
    if (keys_ * 2 > newest_.size()) grow_index();
}

void BlockQueue::grow_index() {
    std::vector<std::uint32_t> old(newest_.size() * 2);
    old.swap(newest_);
    for (const std::uint32_t place : old)
        if (place != 0) slot_of(entries_[place - 1].key) = place;
}

// Open addressing. The table is never more than half full. Returns the key's place, which is 0 if it has none yet.
std::uint32_t& BlockQueue::slot_of(std::uint64_t key) noexcept {
    assert(std::has_single_bit(newest_.size()) && keys_ * 2 <= newest_.size());
    const std::size_t mask = newest_.size() - 1;
    std::size_t i = secret_hash(key) & mask;
    while (newest_[i] != 0 && entries_[newest_[i] - 1].key != key) i = (i + 1) & mask;
    return newest_[i];
}

BlockQueue::Gathered BlockQueue::gather(Position& from, std::size_t max_bytes, std::span<iovec> room) const noexcept {
    assert(from.index >= head_ || !entries_[from.index].live);
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
        assert(entry.size <= class_bytes_[entry.block_class] && entry.size <= bytes_);
        bytes_ -= entry.size;
        class_bytes_[entry.block_class] -= entry.size;
        --blocks_;
    }
    begun_ = 0;
    assert((blocks_ == 0) == (bytes_ == 0));
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
    assert(count == 0 || begun_ < room[0].iov_len);
    if (count != 0) room[0] = {static_cast<std::uint8_t*>(room[0].iov_base) + begun_, room[0].iov_len - begun_};
    return count;
}

std::size_t BlockQueue::consume(std::size_t bytes) noexcept {
    assert(bytes <= bytes_ - begun_);
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
    assert(begun_ == 0 || begun_ < entries_[head_].size);
    return whole;
}

// The first block may be dropped again, but `oldest` and `drop_superseded` had already skipped it. Clearing `jammed_`
// makes the next jam index all blocks again.
void BlockQueue::rewind() noexcept {
    if (begun_ == 0) return;
    assert(entries_[head_].live);
    begun_ = 0;
    oldest_[entries_[head_].block_class] = head_;
    jammed_ = false;
}

}  // namespace mavloom::net
