// SPDX-License-Identifier: MIT
#include "shm/mappings.hpp"

#include <sys/mman.h>

#include <array>
#include <bit>
#include <cassert>
#include <cerrno>

#include "mavloom/shm/lost_mapping.hpp"

namespace mavloom::shm {

static constexpr std::size_t max_mappings = 256;
static std::array<Mapping, max_mappings> mappings;

Mapping* add_mapping(std::uint8_t* begin, std::size_t size) noexcept {
    assert(begin != nullptr && size != 0);
    for (Mapping& mapping : mappings) {
        if (mapping.used.exchange(true, std::memory_order_acquire)) continue;
        mapping.lost.store(false, std::memory_order_relaxed);
        mapping.retired_word.store(0, std::memory_order_relaxed);
        mapping.size.store(size, std::memory_order_relaxed);
        mapping.begin.store(begin, std::memory_order_release);
        return &mapping;
    }
    return nullptr;
}

void remove_mapping(Mapping* mapping) noexcept {
    if (mapping == nullptr) return;
    assert(mapping->used.load(std::memory_order_relaxed));
    mapping->begin.store(nullptr, std::memory_order_release);
    mapping->used.store(false, std::memory_order_release);
}

// Other threads may access the same mapping at the same time. They see either the old pages, and end up here too, or
// the new ones.
static bool replace(Mapping& mapping, std::uint8_t* begin) noexcept {
    const int saved_errno = errno;
    void* const memory = ::mmap(begin, mapping.size.load(std::memory_order_relaxed), PROT_READ | PROT_WRITE,
                                MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED | MAP_NORESERVE, -1, 0);
    errno = saved_errno;
    if (memory == MAP_FAILED) return false;
    if (const auto word = mapping.retired_word.load(std::memory_order_relaxed); word != 0)
        std::atomic_ref(*reinterpret_cast<std::uint32_t*>(begin + word)).store(1, std::memory_order_release);
    mapping.lost.store(true, std::memory_order_release);
    return true;
}

static std::atomic<bool> survives_loss{false};
void survives_lost_mappings() noexcept { survives_loss.store(true, std::memory_order_relaxed); }
bool has_lost_mapping_handler() noexcept { return survives_loss.load(std::memory_order_relaxed); }

bool replace_lost_mapping(void* address) noexcept {
    const auto* const at = static_cast<const std::uint8_t*>(address);
    for (Mapping& mapping : mappings) {
        std::uint8_t* const begin = mapping.begin.load(std::memory_order_acquire);
        if (begin != nullptr && at >= begin && at < begin + mapping.size.load(std::memory_order_relaxed))
            return mapping.lost.load(std::memory_order_acquire) || replace(mapping, begin);
    }
    return false;
}

}  // namespace mavloom::shm
