// SPDX-License-Identifier: MIT
// A fixed array of zero bits from calloc: large tables of which most is never used cost no memory until it is. Private to module route.
#pragma once

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
        at_.reset(static_cast<T*>(std::calloc(size, sizeof(T))));
        if (at_ == nullptr) throw std::bad_alloc();
    }

    [[nodiscard]] T& operator[](std::size_t i) noexcept { return at_.get()[i]; }
    [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return at_.get()[i]; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }

private:
    struct Free {
        void operator()(T* p) const noexcept { std::free(p); }
    };
    std::unique_ptr<T, Free> at_;
    std::size_t size_ = 0;
};

}  // namespace mavloom::route
