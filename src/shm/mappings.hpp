// SPDX-License-Identifier: MIT
// The process's list of mapped files, for replace_lost_mapping(), which runs in a signal handler. So the list is an
// array of atomics, and nothing here locks or allocates. Private to module shm. Any thread may call everything.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace mavloom::shm {

struct Mapping {
    std::atomic<bool> used{false};
    std::atomic<std::uint8_t*> begin{nullptr};  // null while the entry is being filled or emptied
    std::atomic<std::size_t> size{0};
    std::atomic<std::size_t> retired_word{0};  // offset of the word that retires the ring; 0: there is none
    std::atomic<bool> lost{false};
};

// Null if the list is full. The mapping then has no protection.
[[nodiscard]] Mapping* add_mapping(std::uint8_t* begin, std::size_t size) noexcept;
// Call before the memory is unmapped. Accepts null.
void remove_mapping(Mapping* mapping) noexcept;
// Whether the program called survives_lost_mappings().
[[nodiscard]] bool has_lost_mapping_handler() noexcept;

}  // namespace mavloom::shm
