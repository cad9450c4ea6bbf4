// SPDX-License-Identifier: MIT
// A fixed-size, zero-initialized array that starts on a cache line. It comes from calloc, so unused parts of a large
// table take no memory. Private to module route.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

namespace mavloom::route {

template <class T>
class ZeroedArray {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

public:
    explicit ZeroedArray(std::size_t size = 0) : size_(size) {
        if (size == 0) return;
        std::size_t room = size * sizeof(T) + cache_line;
        block_.reset(std::calloc(room, 1));
        if (block_ == nullptr) throw std::bad_alloc();
        void* begin = block_.get();
        at_ = static_cast<T*>(std::align(cache_line, size * sizeof(T), begin, room));
    }

    [[nodiscard]] T& operator[](std::size_t i) noexcept {
        assert(i < size_);
        return at_[i];
    }
    [[nodiscard]] const T& operator[](std::size_t i) const noexcept {
        assert(i < size_);
        return at_[i];
    }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }

private:
    static constexpr std::size_t cache_line = 64;
    struct Free {
        void operator()(void* p) const noexcept { std::free(p); }
    };
    std::unique_ptr<void, Free> block_;
    T* at_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace mavloom::route
