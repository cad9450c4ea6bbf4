// SPDX-License-Identifier: MIT
// Support code for the generated message structs: reads and writes fields at fixed payload offsets. Not for direct use.
// Functions do no bounds checks at run time and allocate nothing.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <cstring>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/ids.hpp"

namespace mavloom::dialect {

// A payload extended to its full length. Bytes that the sender cut off (trailing zeros in MAVLink 2, extension fields
// in MAVLink 1) read as 0. If the given bytes have full length, they are not copied and must outlive this object.
template <std::size_t full_length>
class FullPayload {
public:
    explicit FullPayload(ByteView payload) noexcept : at_(payload.data()) {
        if (payload.size() >= full_length) [[likely]]
            return;
        if (!payload.empty()) std::memcpy(padded_.data(), payload.data(), payload.size());
        std::memset(padded_.data() + payload.size(), 0, full_length - payload.size());
        at_ = padded_.data();
    }
    FullPayload(const FullPayload&) = delete;
    FullPayload& operator=(const FullPayload&) = delete;

    template <std::size_t offset, class T>
    void get(T& value) const noexcept {
        static_assert(offset + sizeof(T) <= full_length);
        value = load_le<T>(at_ + offset);
    }
    template <std::size_t offset, class T, std::size_t n>
    void get(std::array<T, n>& values) const noexcept {
        static_assert(offset + sizeof(values) <= full_length);
        for (std::size_t i = 0; i < n; ++i) values[i] = load_le<T>(at_ + offset + i * sizeof(T));
    }

private:
    const std::uint8_t* at_;
    std::array<std::uint8_t, full_length> padded_;  // initialised only if `at_` points to it
};

template <std::size_t offset, class T>
void put(ByteSpan payload, const T& value) noexcept {
    store_le(payload.data() + offset, value);
}
template <std::size_t offset, class T, std::size_t n>
void put(ByteSpan payload, const std::array<T, n>& values) noexcept {
    for (std::size_t i = 0; i < n; ++i) store_le(payload.data() + offset + i * sizeof(T), values[i]);
}

}  // namespace mavloom::dialect
