// SPDX-License-Identifier: MIT
// The binary layout of a counter page, as specified in docs/formats/ring.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "mavloom/shm/layout.hpp"

namespace mavloom::shm {

inline constexpr std::array<char, 8> page_magic{'M', 'V', 'L', 'S', 'T', 'A', 'T', '\0'};
inline constexpr std::uint16_t page_major = 1;
inline constexpr std::uint16_t page_minor = 1;
inline constexpr std::size_t page_header_bytes = 128;
inline constexpr std::uint32_t max_page_slots = 1 << 20;
inline constexpr std::uint32_t no_link = 0xffffffff;

struct PageHeader {
    std::array<char, 8> magic = page_magic;
    std::uint16_t major = page_major;
    std::uint16_t minor = page_minor;
    std::uint32_t byte_order = byte_order_mark;
    std::uint32_t counters = 0;
    std::uint32_t links = 0;
    std::int64_t started_ns = 0;  // Unix time
    std::uint32_t pid = 0;
    std::array<std::uint32_t, 23> reserved{};
};
static_assert(sizeof(PageHeader) == page_header_bytes);
static_assert(offsetof(PageHeader, major) == 8 && offsetof(PageHeader, byte_order) == 12 &&
              offsetof(PageHeader, counters) == 16 && offsetof(PageHeader, links) == 20 &&
              offsetof(PageHeader, started_ns) == 24 && offsetof(PageHeader, pid) == 32);

// One counter. `version` only increases. It is odd while anything but the value changes. Readers compare it before and
// after a read to detect such a change.
struct CounterSlot {
    SharedWords::Word64 version;  // 0: never used
    SharedWords::Word64 value;
    SharedWords::Word32 type;  // CounterType; 0: free
    SharedWords::Word32 link;  // a link id or no_link
    SharedWords::Word64 reserved;
    std::array<SharedWords::Word64, 12> label;  // padded with NULs
};
static_assert(sizeof(CounterSlot) == 128 && offsetof(CounterSlot, value) == 8 && offsetof(CounterSlot, type) == 16 &&
              offsetof(CounterSlot, link) == 20 && offsetof(CounterSlot, label) == 32);

struct LinkSlot {
    SharedWords::Word64 version;
    SharedWords::Word32 link;
    SharedWords::Word32 used;  // 0: free
    SharedWords::Word64 reserved;
    std::array<SharedWords::Word64, 13> name;  // since 1.1, after its NUL: the URL that the link sends to
};
static_assert(sizeof(LinkSlot) == 128 && offsetof(LinkSlot, link) == 8 && offsetof(LinkSlot, used) == 12 &&
              offsetof(LinkSlot, name) == 24);

// Removes a ring's counter page if the page's owner is gone.
void remove_left_page(std::string_view ring);

}  // namespace mavloom::shm
