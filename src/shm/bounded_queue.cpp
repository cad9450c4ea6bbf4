// SPDX-License-Identifier: MIT
#include "mavloom/shm/bounded_queue.hpp"

#include <readerwriterqueue/readerwritercircularbuffer.h>

#include <algorithm>
#include <atomic>
#include <chrono>

namespace mavloom::shm::detail {

namespace {

// A pointer, stored with release and loaded with acquire. The queue orders its elements by itself, but uses operations
// that the thread sanitizer cannot see.
class Element {
public:
    explicit Element(void* pointer = nullptr) noexcept { store(pointer); }  // NOLINT(*-member-init): store() writes it
    Element(const Element& other) noexcept { store(other.load()); }
    Element& operator=(const Element& other) noexcept {
        if (this != &other) store(other.load());
        return *this;
    }
    [[nodiscard]] void* load() const noexcept {
        return std::atomic_ref<void*>(pointer_).load(std::memory_order_acquire);
    }

private:
    void store(void* pointer) noexcept { std::atomic_ref<void*>(pointer_).store(pointer, std::memory_order_release); }
    mutable void* pointer_;  // std::atomic_ref<const T> comes with C++26
};

}  // namespace

struct PointerQueue::Impl {
    explicit Impl(std::size_t capacity) : queue(std::max<std::size_t>(capacity, 1)) {}
    moodycamel::BlockingReaderWriterCircularBuffer<Element> queue;
};

PointerQueue::PointerQueue(std::size_t capacity) : impl_(std::make_unique<Impl>(capacity)) {}
PointerQueue::~PointerQueue() = default;

bool PointerQueue::try_push(void* pointer) noexcept { return impl_->queue.try_enqueue(Element(pointer)); }

void* PointerQueue::try_pop() noexcept {
    Element element;
    return impl_->queue.try_dequeue(element) ? element.load() : nullptr;
}

void* PointerQueue::pop(MonoTime deadline) noexcept {
    // Waits in slices, because a distant deadline in microseconds would overflow the queue's timeout.
    constexpr Nanoseconds longest_slice = std::chrono::seconds(10);
    for (;;) {
        if (void* const pointer = try_pop()) return pointer;
        const MonoTime now = mono_now();
        if (now >= deadline) return nullptr;
        Element element;
        const auto slice = std::chrono::ceil<std::chrono::microseconds>(
            std::min<Nanoseconds>(longest_slice, deadline - now));
        if (impl_->queue.wait_dequeue_timed(element, slice.count())) return element.load();
    }
}

std::size_t PointerQueue::size() const noexcept { return impl_->queue.size_approx(); }

}  // namespace mavloom::shm::detail
