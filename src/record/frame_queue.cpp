// SPDX-License-Identifier: MIT
#include "mavloom/record/frame_queue.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cerrno>
#include <cstring>

namespace mavloom::record {

// Each record in the ring is a header and a frame, padded to a multiple of eight bytes. A header without a frame marks
// the rest of the ring as padding.
struct FrameQueue::Header {
    std::int64_t time_ns;
    std::uint32_t link;
    std::uint32_t frame_bytes;  // 0 means padding up to the end of the ring
};

namespace {

constexpr std::size_t header_bytes = 16;
constexpr std::size_t smallest_capacity = 64 * 1024;
// Past this many bytes, an empty queue returns to the start of the ring, which is still in the cache.
constexpr std::size_t warm_bytes = 256 * 1024;

constexpr std::size_t rounded(std::size_t bytes) noexcept { return (bytes + 7) & ~std::size_t{7}; }

}  // namespace

SetupResult<std::unique_ptr<FrameQueue>> FrameQueue::create(std::size_t capacity_bytes) {
    static_assert(sizeof(Header) == header_bytes);
    const std::size_t capacity = std::bit_ceil(std::max(capacity_bytes, smallest_capacity));
    void* memory = ::mmap(nullptr, capacity, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) return system_error("cannot allocate memory for the receive buffer (--buffer)", errno);
    return std::unique_ptr<FrameQueue>(new FrameQueue(static_cast<std::uint8_t*>(memory), capacity));
}

FrameQueue::~FrameQueue() { ::munmap(memory_, capacity_); }

void FrameQueue::load_head() noexcept {
    tail_.head_seen = std::max(head_.position.load(std::memory_order_acquire),
                               tail_.restarted_to);  // pairs with the release in next()
}

bool FrameQueue::push(const Entry& entry) noexcept {
    const std::size_t size = header_bytes + rounded(entry.frame.size());
    assert(size <= capacity_);
    std::uint64_t tail = tail_.position.load(std::memory_order_relaxed);
    const bool warm_end = capacity_ - to_end(tail) > warm_bytes;
    if (warm_end) load_head();
    if (warm_end && tail_.head_seen == tail) {  // empty: returns to the memory that is still in the cache
        tail_.restart_at.store(tail, std::memory_order_relaxed);  // visible to the reader with the new tail
        tail += to_end(tail);
        tail_.restarted_to = tail_.head_seen = tail;
    }
    const std::size_t rest = to_end(tail);
    const std::size_t needed = rest < size ? rest + size : size;
    if (tail + needed - tail_.head_seen > capacity_) load_head();
    if (tail + needed - tail_.head_seen > capacity_) return false;
    if (rest < size) {
        const Header padding{0, 0, 0};
        if (rest >= header_bytes) std::memcpy(at(tail), &padding, header_bytes);
        tail += rest;
    }
    assert(to_end(tail) >= size && tail + size - tail_.head_seen <= capacity_);
    const Header header{entry.time.time_since_epoch().count(), entry.link.value,
                        static_cast<std::uint32_t>(entry.frame.size())};
    std::memcpy(at(tail), &header, header_bytes);
    std::memcpy(at(tail) + header_bytes, entry.frame.bytes().data(), entry.frame.size());
    tail_.position.store(tail + size, std::memory_order_release);  // pairs with the acquire in next()
    return true;
}

// The reader sets sleeping_, then checks the position again. The writer stores the position, then checks sleeping_.
// Each side does a store and a load; because all four are sequentially consistent, at least one side sees the other.
void FrameQueue::publish() noexcept {
    tail_.position.store(tail_.position.load(std::memory_order_relaxed), std::memory_order_seq_cst);
    if (!sleeping_.load(std::memory_order_seq_cst)) return;
    signal_.fetch_add(1, std::memory_order_release);
    signal_.notify_one();
}

void FrameQueue::wake() noexcept {
    woken_.store(true, std::memory_order_seq_cst);
    signal_.fetch_add(1, std::memory_order_release);
    signal_.notify_one();
}

void FrameQueue::close() noexcept {
    closed_.store(true, std::memory_order_seq_cst);
    signal_.fetch_add(1, std::memory_order_release);
    signal_.notify_one();
}

std::optional<FrameQueue::Entry> FrameQueue::next() noexcept {
    std::uint64_t head = head_.release_to;
    // Releases the room of the last entry; pairs with the acquire in load_head().
    head_.position.store(head, std::memory_order_release);
    for (;;) {
        if (head == head_.tail_seen) {
            head_.tail_seen = tail_.position.load(std::memory_order_acquire);  // pairs with the release in push()
            if (head == head_.tail_seen) return std::nullopt;
        }
        Header header{};
        if (head != tail_.restart_at.load(std::memory_order_relaxed) && to_end(head) >= header_bytes)
            std::memcpy(&header, at(head), header_bytes);
        if (header.frame_bytes != 0) {
            head_.release_to = head + header_bytes + rounded(header.frame_bytes);
            return Entry{WallTime{Nanoseconds{header.time_ns}}, LinkId{header.link},
                         wire::FrameView::unchecked({at(head) + header_bytes, header.frame_bytes})};
        }
        head += to_end(head);
        head_.release_to = head;
        head_.position.store(head, std::memory_order_release);
    }
}

bool FrameQueue::wait() noexcept {
    for (;;) {
        const auto seen = signal_.load(std::memory_order_acquire);
        sleeping_.store(true, std::memory_order_seq_cst);
        const bool closed = closed_.load(std::memory_order_seq_cst);
        const bool ready = tail_.position.load(std::memory_order_seq_cst) != head_.release_to;
        const bool woken = woken_.exchange(false, std::memory_order_seq_cst);
        if (!ready && !closed && !woken) signal_.wait(seen, std::memory_order_acquire);
        sleeping_.store(false, std::memory_order_relaxed);
        if (ready || (woken && !closed)) return true;
        if (closed) return false;
    }
}

std::size_t FrameQueue::used_bytes() const noexcept {
    const auto head = std::max(head_.position.load(std::memory_order_relaxed), tail_.restarted_to);
    return static_cast<std::size_t>(tail_.position.load(std::memory_order_relaxed) - head);
}

}  // namespace mavloom::record
