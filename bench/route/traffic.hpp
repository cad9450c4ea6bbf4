// SPDX-License-Identifier: MIT
// The frames of `bench route`: frames of the recorded flight whose first 16 payload bytes are replaced by a number and
// the send time, with a valid checksum. A program with the same recording can check that a frame arrived whole and
// unchanged. Immutable after load(), safe from any thread; allocates in load() only.
#pragma once

#include <time.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "mavloom/base/bytes.hpp"

namespace mavloom::bench {

inline constexpr std::size_t max_frame_bytes = 64;

struct Received {
    enum class Kind : std::uint8_t { whole, damaged, foreign };
    Kind kind = Kind::damaged;
    std::size_t size = 0;  // bytes of the frame; all remaining bytes if it is not recognised
    std::uint64_t number = 0;
    std::uint64_t sent_ns = 0;
};

class Traffic {
public:
    // The frames come from `systems` times `components` sources in turn; 1 times 1 is the recorded vehicle alone.
    // System s sends on link s modulo `links`.
    [[nodiscard]] static std::optional<Traffic> load(const char* flight, unsigned systems, unsigned components,
                                                     unsigned links);

    // Writes frame `number` and returns its size.
    std::size_t write(std::span<std::uint8_t, max_frame_bytes> out, std::uint64_t number,
                      std::uint64_t time_ns) const noexcept;
    // Returns the frame at the start of `bytes`, the unread rest of a datagram.
    [[nodiscard]] Received check(ByteView bytes) const noexcept;
    [[nodiscard]] unsigned link_of(std::uint64_t number) const noexcept {
        return static_cast<unsigned>(number % sources() % systems_ % links_);
    }
    [[nodiscard]] unsigned links() const noexcept { return links_; }

private:
    struct Pattern {
        std::array<std::uint8_t, max_frame_bytes> bytes{};
        std::size_t size = 0;
        std::uint8_t crc_extra = 0;
    };

    [[nodiscard]] unsigned sources() const noexcept { return systems_ * components_; }
    std::size_t fill(std::span<std::uint8_t, max_frame_bytes> out, std::uint64_t number,
                     std::uint64_t time_ns) const noexcept;

    std::vector<Pattern> patterns_;
    unsigned systems_ = 1, components_ = 1, links_ = 1;
};

// Returns CLOCK_MONOTONIC, which is the same for all processes.
[[nodiscard]] inline std::uint64_t now_ns() noexcept {
    timespec t{};
    ::clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<std::uint64_t>(t.tv_sec) * 1'000'000'000u + static_cast<std::uint64_t>(t.tv_nsec);
}

// Parses a list such as "3,4,5": descriptors of sockets that bench/route.py opened, or ports.
[[nodiscard]] std::vector<int> numbers_in(std::string_view list);

}  // namespace mavloom::bench
