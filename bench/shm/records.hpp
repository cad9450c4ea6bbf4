// SPDX-License-Identifier: MIT
// The records of `bench shm`, and the check that a reader received them unchanged.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "mavloom/base/bytes.hpp"

namespace mavloom::bench {

// Records of 64 bytes, with their number in the first word and its complement in the last.
class NumberedRecords {
public:
    static constexpr std::size_t bytes = 64;

    [[nodiscard]] ByteView operator[](std::uint64_t number) const noexcept {
        record_.front() = number;
        record_.back() = ~number;
        return {reinterpret_cast<const std::uint8_t*>(record_.data()), bytes};
    }
    [[nodiscard]] bool matches(std::uint64_t number, ByteView record) const noexcept {
        std::uint64_t first, last;
        std::memcpy(&first, record.data(), sizeof first);
        std::memcpy(&last, record.data() + bytes - sizeof last, sizeof last);
        return record.size() == bytes && first == number && last == ~number;
    }

private:
    mutable std::array<std::uint64_t, bytes / sizeof(std::uint64_t)> record_{};  // used only by the writer
};

// The frames of a recording, repeated. The reader copies each record, as the transport that it is compared with does.
// With `verify` it compares all bytes instead.
class RecordedFrames {
public:
    RecordedFrames(std::vector<ByteView> frames, bool verify) : frames_(std::move(frames)), verify_(verify) {}

    [[nodiscard]] ByteView operator[](std::uint64_t number) const noexcept { return frames_[number % frames_.size()]; }
    [[nodiscard]] bool matches(std::uint64_t number, ByteView record) const noexcept {
        if (verify_) {
            const ByteView expected = (*this)[number];
            return record.size() == expected.size() && std::memcmp(record.data(), expected.data(), record.size()) == 0;
        }
        static thread_local std::array<std::uint8_t, 512> mine;
        if (record.size() > mine.size()) return false;
        std::memcpy(mine.data(), record.data(), record.size());
        asm volatile("" : : "r"(mine.data()) : "memory");  // the optimiser must not remove the copy
        return true;
    }

private:
    std::vector<ByteView> frames_;
    bool verify_;
};

}  // namespace mavloom::bench
