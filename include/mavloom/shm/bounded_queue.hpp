// SPDX-License-Identifier: MIT
// A bounded, lock-free queue that hands objects from one thread of this process to another, first in, first out.
//
// Exactly one thread pushes and exactly one pops. Construct and destroy the queue while neither is active. Memory is
// allocated only at construction. The queue owns the objects that it holds. It wraps moodycamel's circular buffer
// (Debian package libreaderwriterqueue-dev), whose header is not exposed here.
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
    [[nodiscard]] void* try_pop() noexcept;  // null if empty
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
    // Holds up to `capacity` objects, at least one.
    explicit BoundedQueue(std::size_t capacity) : queue_(capacity) {}
    ~BoundedQueue() {
        while (try_pop()) continue;
    }

    // Takes ownership of `object`. If the queue is full, returns false and leaves `object` unchanged. `object` must not
    // be null.
    [[nodiscard]] bool try_push(std::unique_ptr<T>& object) noexcept {
        if (!queue_.try_push(object.get())) return false;
        static_cast<void>(object.release());
        return true;
    }
    // Returns null if the queue is empty.
    [[nodiscard]] std::unique_ptr<T> try_pop() noexcept {
        return std::unique_ptr<T>(static_cast<T*>(queue_.try_pop()));
    }
    // Waits for an object until `deadline`. Returns null on timeout.
    [[nodiscard]] std::unique_ptr<T> pop(MonoTime deadline) noexcept {
        return std::unique_ptr<T>(static_cast<T*>(queue_.pop(deadline)));
    }
    // Approximate while the other thread is pushing or popping.
    [[nodiscard]] std::size_t size() const noexcept { return queue_.size(); }

private:
    detail::PointerQueue queue_;
};

}  // namespace mavloom::shm
