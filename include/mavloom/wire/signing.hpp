// SPDX-License-Identifier: MIT
// MAVLink 2 message signing: a 48-bit SHA-256 over key and frame, with a timestamp that only grows per (link id, system, component).
// Single owner thread each; time is a parameter. Nothing allocates per frame. A SigningKey wipes itself.
// Source: MAVLink guide, "Message Signing"; the timestamps are 10 µs ticks since 2015-01-01 00:00 UTC.
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

// A clock of its own: 10 µs ticks since 2015-01-01, 48 bits on the wire.
struct SigningTime {
    std::uint64_t ticks = 0;
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

    // A file of 64 hexadecimal digits (white space around them is fine), mode 0600 or stricter; a regular file.
    [[nodiscard]] static SetupResult<SigningKey> load(const std::filesystem::path& file);

    // From the system's random numbers.
    [[nodiscard]] static SetupResult<SigningKey> random();
    // Writes a new file of mode 0600 in the form that `load` reads. An existing file is never replaced: `in_use`.
    [[nodiscard]] SetupResult<void> create_file(const std::filesystem::path& file) const;

    friend bool operator==(const SigningKey&, const SigningKey&) = default;

    [[nodiscard]] const std::array<std::uint8_t, length>& bytes() const noexcept { return bytes_; }
    // Tells keys apart without telling the key: the first 64 bits of a SHA-256.
    [[nodiscard]] std::uint64_t fingerprint() const noexcept;

private:
    std::array<std::uint8_t, length> bytes_;
};

// Signs frames on the way out with one link id. Its time follows the clock given and never repeats.
class Signer {
public:
    Signer(const SigningKey& key, std::uint8_t link_id, SigningTime start = {}) noexcept
        : key_(key), link_id_(link_id), last_(start) {}

    // `frame` is a whole MAVLink 2 frame whose flag incompat_signed is set and whose checksum is in place; the 13 bytes behind `size` are
    // written. Returns the new size.
    std::size_t sign(ByteSpan frame, std::size_t size, SigningTime now) noexcept;

    [[nodiscard]] SigningTime last() const noexcept {
        return last_;
    }  // to be stored, so that a restart does not go back

private:
    SigningKey key_;
    std::uint8_t link_id_;
    SigningTime last_;
};

class Verifier {
public:
    static constexpr std::size_t max_streams = 1024;
    // A stream heard for the first time may be this much behind our clock.
    static constexpr std::uint64_t first_tolerance_ticks = 60 * 100'000;

    enum class Verdict : std::uint8_t {
        good,
        unsigned_frame,    // no signature (or MAVLink 1): the caller's policy decides
        bad_signature,     // the hash does not agree: another key, or damaged
        replay,            // not newer than the last of this (link id, system, component)
        too_old,           // a new stream more than a minute behind
        too_many_streams,  // the table is full; nothing was changed
    };

    // One sender that was heard, and the last time that was taken from it.
    struct Stream {
        std::uint32_t key;  // link id, system, component: 8 bits each, from the top
        SigningTime last;
    };

    // `newest` is the last time known from an earlier run.
    explicit Verifier(const SigningKey& key, SigningTime newest = {});

    // State changes only when the answer is `good`: a frame that nobody with the key made changes nothing, whatever time it claims.
    [[nodiscard]] Verdict verify(const FrameView& frame, SigningTime now) noexcept;

    [[nodiscard]] SigningTime newest() const noexcept { return newest_; }

    // To be stored, so that what was taken before a restart is a replay after it. Sorted by key.
    [[nodiscard]] std::span<const Stream> streams() const noexcept { return streams_; }
    // A stream of an earlier run. Never goes back; a stream too many is left out.
    void restore(const Stream& stream) noexcept;

private:
    SigningKey key_;
    std::vector<Stream> streams_;  // sorted by key
    SigningTime newest_;
};

}  // namespace mavloom::wire
