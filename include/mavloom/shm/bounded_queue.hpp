// SPDX-License-Identifier: MIT
// Hands objects from one thread of this process to another: bounded, first in, first out, without locks. moodycamel's circular buffer (Debian's
// libreaderwriterqueue-dev), whose header stays inside. One thread pushes, one pops; made and destroyed while neither does. Allocates at construction
// only; the objects are the users'.
#pragma once

#include <cstddef>
#include <memory>

#include "mavloom/base/clock.hpp"

namespace mavloom::shm {

namespace detail {
class PointerQueue {
public:
    explicit PointerQueue(std::size_t capacity);
    PointerQueue(const PointerQueue&) = delete;
    PointerQueue& operator=(const PointerQueue&) = delete;
    ~PointerQueue();

    [[nodiscard]] bool try_push(void* pointer) noexcept;
    [[nodiscard]] void* try_pop() noexcept;  // null: empty
    [[nodiscard]] void* pop(MonoTime deadline) noexcept;
    [[nodiscard]] std::size_t size() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}  // namespace detail

template <class T>
class BoundedQueue {
public:
    // `capacity` objects, at least one.
    explicit BoundedQueue(std::size_t capacity) : queue_(capacity) {}
    ~BoundedQueue() {
        while (try_pop()) continue;
    }

    // Takes `object` over; false, with `object` as it was, when the queue is full. `object` must not be null.
    [[nodiscard]] bool try_push(std::unique_ptr<T>& object) noexcept {
        if (!queue_.try_push(object.get())) return false;
        static_cast<void>(object.release());
        return true;
    }
    // Null when there is nothing.
    [[nodiscard]] std::unique_ptr<T> try_pop() noexcept {
        return std::unique_ptr<T>(static_cast<T*>(queue_.try_pop()));
    }
    // Waits for an object until `deadline`.
    [[nodiscard]] std::unique_ptr<T> pop(MonoTime deadline) noexcept {
        return std::unique_ptr<T>(static_cast<T*>(queue_.pop(deadline)));
    }
    // Exact for neither side while the other is at work.
    [[nodiscard]] std::size_t size() const noexcept { return queue_.size(); }

private:
    detail::PointerQueue queue_;
};

}  // namespace mavloom::shm
