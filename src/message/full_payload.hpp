// SPDX-License-Identifier: MIT
// A payload extended to its full length: bytes that the sender cut off are 0. The given bytes must outlive it.
// Allocates nothing.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "mavloom/base/bytes.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::message {

class FullPayload {
public:
    FullPayload(ByteView payload, std::size_t full_length) noexcept {
        if (payload.size() >= full_length) {
            data_ = payload.data();
            return;
        }
        if (!payload.empty()) std::memcpy(copy_.data(), payload.data(), payload.size());
        std::memset(copy_.data() + payload.size(), 0, full_length - payload.size());
    }
    FullPayload(const FullPayload&) = delete;
    FullPayload& operator=(const FullPayload&) = delete;

    [[nodiscard]] const std::uint8_t* data() const noexcept { return data_; }

private:
    std::array<std::uint8_t, wire::max_payload_length> copy_;  // NOLINT: initialised only as far as needed
    const std::uint8_t* data_ = copy_.data();
};

}  // namespace mavloom::message
