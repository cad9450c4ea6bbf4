// SPDX-License-Identifier: MIT
// A fixed array of zero bits from calloc that begins on a cache line: large tables of which most is never used cost no memory until it is
// (on huge pages, 2 MiB of it at a time).
// Private to module route.
#pragma once

#include <sys/mman.h>

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
    explicit ZeroedArray(std::size_t size = 0) : ZeroedArray(size, cache_line) {}

    // For one that is read all over: where the system has huge pages to give (2 MiB), a place is found without walking the page tables.
    [[nodiscard]] static ZeroedArray on_huge_pages(std::size_t size) {
        const bool large = size * sizeof(T) >= huge_page;
        ZeroedArray array(size, large ? huge_page : cache_line);
        if (large) ::madvise(array.at_, size * sizeof(T), MADV_HUGEPAGE);  // advice: may fail
        return array;
    }

    [[nodiscard]] T& operator[](std::size_t i) noexcept { return at_[i]; }
    [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return at_[i]; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }

private:
    static constexpr std::size_t cache_line = 64, huge_page = 2u << 20;

    ZeroedArray(std::size_t size, std::size_t alignment) : size_(size) {
        if (size == 0) return;
        std::size_t room = size * sizeof(T) + alignment;
        block_.reset(std::calloc(room, 1));
        if (block_ == nullptr) throw std::bad_alloc();
        void* begin = block_.get();
        at_ = static_cast<T*>(std::align(alignment, size * sizeof(T), begin, room));
    }

    struct Free {
        void operator()(void* p) const noexcept { std::free(p); }
    };
    std::unique_ptr<void, Free> block_;
    T* at_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace mavloom::route
