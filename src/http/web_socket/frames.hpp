// SPDX-License-Identifier: MIT
// The frames of WebSockets (RFC 6455, section 5): a reader that turns bytes into whole messages, and a writer.
//
// No sockets and no clock; docs/design/http.md has the reason why Beast's stream is not used. One thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/http/session.hpp"

namespace mavloom::http {

enum class Opcode : std::uint8_t { continuation = 0, text = 1, binary = 2, close = 8, ping = 9, pong = 10 };

// Close codes, RFC 6455, section 7.4.
namespace close_code {
inline constexpr std::uint16_t none = 0, normal = 1000, going_away = 1001, protocol = 1002, wrong_kind = 1003,
                               bad_text = 1007, policy = 1008, too_big = 1009;
}

// The reader calls these. The views are valid until the call returns.
class FrameEvents {
public:
    FrameEvents() = default;
    FrameEvents(const FrameEvents&) = delete;
    FrameEvents& operator=(const FrameEvents&) = delete;
    virtual ~FrameEvents() = default;
    virtual void take_message(ByteView message, Kind kind) = 0;
    virtual void take_ping(ByteView payload) = 0;
    // The peer closes; nothing is read after it. `code`: 0 if it gave none.
    virtual void take_close(std::uint16_t code, std::string_view reason) = 0;
    // The peer broke the protocol or a limit; nothing is read after it. `code` is for our close frame.
    virtual void take_fault(Ended why, std::uint16_t code) = 0;
};

// From the kernel: masks and keys must not be guessed.
void fill_randomly(ByteSpan bytes);

class FrameReader {
public:
    FrameReader(const SessionOptions& options, bool is_client, FrameEvents& events) noexcept
        : options_(options), is_client_(is_client), events_(events) {}

    // Takes the next bytes of the connection, and unmasks them in place.
    void feed(ByteSpan bytes);

private:
    [[nodiscard]] std::size_t header_size() const noexcept;
    [[nodiscard]] std::uint64_t length() const noexcept;
    [[nodiscard]] bool is_control() const noexcept { return (header_[0] & 0x08) != 0; }
    [[nodiscard]] bool is_final() const noexcept { return (header_[0] & 0x80) != 0; }
    [[nodiscard]] Opcode opcode() const noexcept { return static_cast<Opcode>(header_[0] & 0x0f); }

    [[nodiscard]] std::size_t take_header(ByteView bytes);
    void begin_frame();
    [[nodiscard]] bool has_valid_header() const noexcept;
    [[nodiscard]] bool begin_data();
    [[nodiscard]] std::size_t take_payload(ByteSpan bytes);
    void end_frame(ByteView last_part);
    void end_control(ByteView last_part);
    void end_message(ByteView message);
    void end_close(ByteView payload);
    void fail(Ended why, std::uint16_t code);

    const SessionOptions& options_;
    const bool is_client_;
    FrameEvents& events_;
    bool is_over_ = false;

    std::array<std::uint8_t, 14> header_{};
    std::size_t header_have_ = 0;
    bool is_in_payload_ = false;
    std::uint64_t left_ = 0;  // bytes of the payload that are still to come
    std::array<std::uint8_t, 4> mask_{};
    std::size_t mask_at_ = 0;

    bool is_in_message_ = false;
    Kind kind_ = Kind::binary;
    std::size_t fragments_ = 0;
    std::vector<std::uint8_t> message_;  // what arrived of it, if it did not arrive at once
    std::vector<std::uint8_t> control_;  // likewise
};

// Appends frames to a buffer. A client masks its frames.
class FrameWriter {
public:
    explicit FrameWriter(bool is_client) noexcept : is_client_(is_client) {}

    void append(std::vector<std::uint8_t>& to, Opcode opcode, ByteView payload);
    // In two steps: the caller appends `size` bytes in between.
    void begin(std::vector<std::uint8_t>& to, Opcode opcode, std::size_t size);
    void end(std::vector<std::uint8_t>& to);

private:
    void append_mask(std::vector<std::uint8_t>& to);

    bool is_client_;
    std::size_t payload_at_ = 0;
    // Masks must be unpredictable (section 10.3). 64 of them are taken from the kernel at a time.
    std::array<std::uint8_t, 256> random_{};
    std::size_t random_used_ = random_.size();
};

}  // namespace mavloom::http
