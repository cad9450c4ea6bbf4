// SPDX-License-Identifier: MIT
// A write position in a TextBuffer, with one bounds check per field instead of one per character.
// The destructor sets the size of the buffer to the written end. Single owner; allocates only when the buffer must
// grow.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "mavloom/message/format.hpp"
#include "message/number.hpp"

namespace mavloom::message {

class Cursor {
public:
    explicit Cursor(TextBuffer& out) noexcept : out_(out) { attach(); }
    ~Cursor() { out_.resize(static_cast<std::size_t>(at_ - out_.data())); }
    Cursor(const Cursor&) = delete;
    Cursor& operator=(const Cursor&) = delete;

    // Makes room for `bytes` more bytes. The `_unchecked` functions and `set` write into this room without checking it.
    void reserve(std::size_t bytes) {
        if (static_cast<std::size_t>(end_ - at_) < bytes) [[unlikely]]
            grow(bytes);
    }

    [[nodiscard]] char* at() const noexcept { return at_; }
    void set(char* end) noexcept {
        assert(end <= end_);
        at_ = end;
    }

    void put_unchecked(char c) noexcept { *at_++ = c; }
    void put_unchecked(std::string_view text) noexcept {
        copy_short(at_, text);
        at_ += text.size();
    }

    void put(char c) {
        reserve(1);
        put_unchecked(c);
    }
    void put(std::string_view text) {
        reserve(text.size());
        put_unchecked(text);
    }
    void put_unsigned(std::uint64_t value) {
        reserve(number_room);
        at_ = write_unsigned(at_, value);
    }
    void put_integer(std::int64_t value) {
        reserve(number_room);
        at_ = write_integer(at_, value);
    }
    void put_hex_byte(std::uint8_t byte) {
        constexpr std::string_view hex = "0123456789abcdef";
        reserve(2);
        put_unchecked(hex[byte >> 4]);
        put_unchecked(hex[byte & 0xf]);
    }

private:
    void attach() noexcept {
        at_ = out_.data() + out_.size();
        end_ = out_.data() + out_.capacity();
    }
    void grow(std::size_t bytes) {
        out_.resize(static_cast<std::size_t>(at_ - out_.data()));
        out_.reserve(out_.size() + bytes);
        attach();
    }

    // Names are 4 to 30 bytes long. Up to 16 bytes, two overlapping copies of fixed size are faster than a call of
    // memcpy.
    static void copy_short(char* to, std::string_view text) noexcept {
        const auto size = text.size();
        const char* from = text.data();
        if (size > 16) {
            std::memcpy(to, from, size);
        } else if (size >= 8) {
            std::memcpy(to, from, 8);
            std::memcpy(to + size - 8, from + size - 8, 8);
        } else if (size >= 4) {
            std::memcpy(to, from, 4);
            std::memcpy(to + size - 4, from + size - 4, 4);
        } else {
            for (std::size_t i = 0; i < size; ++i) to[i] = from[i];
        }
    }

    TextBuffer& out_;
    char* at_ = nullptr;
    char* end_ = nullptr;
};

}  // namespace mavloom::message
