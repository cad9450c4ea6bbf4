// SPDX-License-Identifier: MIT
// MAVLink 2 message signing: keys, signing outgoing frames, and verifying received ones. A signature is the first 48
// bits of a SHA-256 over key and frame, with a timestamp that must rise per (link id, system, component). Signer and
// Verifier have a single owner thread each and take the time as a parameter. Nothing allocates per frame. A SigningKey
// wipes its memory when destroyed. Source: MAVLink guide, "Message Signing". Timestamps count 10 µs ticks since
// 2015-01-01 00:00 UTC.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <ratio>
#include <span>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::wire {

// A signature timestamp: 10 µs ticks since 2015-01-01 00:00 UTC; 48 bits on the wire.
struct SigningTime {
    std::uint64_t ticks = 0;
    static constexpr std::uint64_t limit = std::uint64_t{1} << 48;  // ticks on the wire are below this
    friend constexpr auto operator<=>(SigningTime, SigningTime) = default;

    [[nodiscard]] static constexpr SigningTime from(WallTime t) noexcept {
        constexpr std::int64_t epoch_s = 1420070400;  // 2015-01-01 00:00:00 UTC in Unix time
        const auto since = t.time_since_epoch() - std::chrono::seconds{epoch_s};
        const auto ticks = std::chrono::duration_cast<std::chrono::duration<std::int64_t, std::ratio<1, 100'000>>>(since)
                               .count();
        return {ticks < 0 ? 0 : static_cast<std::uint64_t>(ticks)};
    }
};

class SigningKey {
public:
    static constexpr std::size_t length = 32;

    explicit SigningKey(const std::array<std::uint8_t, length>& bytes) noexcept : bytes_(bytes) {}
    SigningKey(const SigningKey&) = default;
    SigningKey& operator=(const SigningKey&) = default;
    ~SigningKey();

    // Reads a regular file of 64 hexadecimal digits, with optional white space around them. Its mode must be 0600 or
    // stricter. Errors are `bad_input`.
    [[nodiscard]] static SetupResult<SigningKey> load(const std::filesystem::path& file);

    // Creates a key from the system's random number generator.
    [[nodiscard]] static SetupResult<SigningKey> random();
    // Writes a new file of mode 0600 in the form that `load` reads. Never replaces an existing file: that is the error
    // `in_use`.
    [[nodiscard]] SetupResult<void> create_file(const std::filesystem::path& file) const;

    friend bool operator==(const SigningKey&, const SigningKey&) = default;

    [[nodiscard]] const std::array<std::uint8_t, length>& bytes() const noexcept { return bytes_; }
    // The first 64 bits of a SHA-256. Identifies a key without revealing it.
    [[nodiscard]] std::uint64_t fingerprint() const noexcept;

private:
    std::array<std::uint8_t, length> bytes_;
};

// Signs outgoing frames with one link id. Timestamps follow the time given to `sign` and never repeat or go back. In
// 2104 they reach the largest 48-bit value and stop rising; receivers then refuse the frames.
class Signer {
public:
    Signer(const SigningKey& key, std::uint8_t link_id, SigningTime start = {}) noexcept
        : key_(key), link_id_(link_id), last_(start) {}

    // `frame` holds a complete MAVLink 2 frame of `size` bytes, with incompat_signed set and a valid checksum.
    // Writes the signature into the 13 bytes after it and returns the new size.
    std::size_t sign(ByteSpan frame, std::size_t size, SigningTime now) noexcept;

    // The last timestamp used. Store it and pass it as `start` after a restart, so that timestamps do not go back.
    [[nodiscard]] SigningTime last() const noexcept { return last_; }

private:
    SigningKey key_;
    std::uint8_t link_id_;
    SigningTime last_;
};

class Verifier {
public:
    static constexpr std::size_t max_streams = 1024;
    // The first frame of a stream is refused if it is more than this behind the current time, or behind the newest
    // accepted timestamp.
    static constexpr std::uint64_t first_tolerance_ticks = 60 * 100'000;

    enum class Verdict : std::uint8_t {
        good,
        unsigned_frame,    // no signature, or MAVLink 1; the caller's policy decides
        bad_signature,     // the hash differs: another key, or a damaged frame
        replay,            // not newer than the last accepted frame of this (link id, system, component)
        too_old,           // a new stream whose timestamp is more than a minute behind
        too_many_streams,  // the table of streams is full, and each was heard within the last minute
    };

    // A sender, and the timestamp of its last accepted frame.
    struct Stream {
        std::uint32_t key;  // link id, system, component: 8 bits each, from the top
        SigningTime last;
    };

    // `newest` is the newest timestamp accepted in an earlier run.
    explicit Verifier(const SigningKey& key, SigningTime newest = {});

    // Changes state only if it returns `good`. A frame forged without the key has no effect, whatever timestamp it has.
    [[nodiscard]] Verdict verify(const FrameView& frame, SigningTime now) noexcept;

    // True if the frame is signed with the key, whatever its timestamp.
    [[nodiscard]] bool is_of_key(const FrameView& frame) const noexcept;

    [[nodiscard]] SigningTime newest() const noexcept { return newest_; }

    // The stream and the timestamp of a signed frame. The signature is not verified.
    [[nodiscard]] static Stream stream_of(const FrameView& frame) noexcept;
    // The timestamp of the sender's last accepted frame; 0 if there is none. `key` is as in Stream.
    [[nodiscard]] SigningTime last(std::uint32_t key) const noexcept;
    // The newest timestamp with which `verify` refuses a frame of this sender at the time `now`.
    [[nodiscard]] SigningTime refused_until(std::uint32_t key, SigningTime now) const noexcept;

    // All streams, sorted by key. Store them and call `restore` after a restart, so that old frames count as replays.
    [[nodiscard]] std::span<const Stream> streams() const noexcept { return streams_; }
    // Restores a stream of an earlier run. A timestamp never goes back. A full table forgets its oldest stream, or
    // ignores the new one if that is older still.
    void restore(const Stream& stream) noexcept;

private:
    void insert(const Stream& stream) noexcept;
    // Removes the stream with the oldest timestamp if that is before `before`.
    bool forget_oldest(SigningTime before) noexcept;

    SigningKey key_;
    std::vector<Stream> streams_;  // sorted by key
    SigningTime newest_;
};

}  // namespace mavloom::wire
