// SPDX-License-Identifier: MIT
#include "mavloom/wire/signing.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string_view>

#include "mavloom/base/secret_file.hpp"
#include "mavloom/base/text.hpp"

namespace mavloom::wire {

namespace {

constexpr std::size_t time_length = 6;
constexpr std::size_t hash_length = 6;
constexpr std::uint64_t time_mask = (std::uint64_t{1} << 48) - 1;

std::uint64_t load_time(const std::uint8_t* p) noexcept {
    return load_le<std::uint32_t>(p) | std::uint64_t{load_le<std::uint16_t>(p + 4)} << 32;
}

void store_time(std::uint8_t* p, std::uint64_t ticks) noexcept {
    store_le(p, static_cast<std::uint32_t>(ticks));
    store_le(p + 4, static_cast<std::uint16_t>(ticks >> 32));
}

// The first 48 bits of SHA-256 over the key and the frame up to and including the timestamp.
std::array<std::uint8_t, hash_length> hash_of(const SigningKey& key, ByteView up_to_time) noexcept {
    crypto_hash_sha256_state state;
    std::array<std::uint8_t, crypto_hash_sha256_BYTES> full;
    crypto_hash_sha256_init(&state);
    crypto_hash_sha256_update(&state, key.bytes().data(), key.bytes().size());
    crypto_hash_sha256_update(&state, up_to_time.data(), up_to_time.size());
    crypto_hash_sha256_final(&state, full.data());
    std::array<std::uint8_t, hash_length> first;
    std::copy_n(full.begin(), first.size(), first.begin());
    return first;
}

// Parses one word of hexadecimal digits with optional white space around it.
std::optional<std::array<std::uint8_t, SigningKey::length>> parse_hex(std::string_view text) {
    text = trimmed(text);
    std::array<std::uint8_t, SigningKey::length> key{};
    std::size_t written = 0;
    const char* end = nullptr;
    if (text.size() != 2 * key.size()) return std::nullopt;
    if (sodium_hex2bin(key.data(), key.size(), text.data(), text.size(), nullptr, &written, &end) != 0)
        return std::nullopt;
    if (written != key.size() || end != text.data() + text.size()) return std::nullopt;
    return key;
}

}  // namespace

std::uint64_t SigningKey::fingerprint() const noexcept {
    constexpr std::string_view purpose = "mavloom: which signing key";
    std::array<std::uint8_t, purpose.size() + length> text;
    std::copy(bytes_.begin(), bytes_.end(), std::copy(purpose.begin(), purpose.end(), text.begin()));
    std::array<std::uint8_t, crypto_hash_sha256_BYTES> hash;
    crypto_hash_sha256(hash.data(), text.data(), text.size());
    sodium_memzero(text.data(), text.size());
    return load_le<std::uint64_t>(hash.data());
}

SigningKey::~SigningKey() { sodium_memzero(bytes_.data(), bytes_.size()); }

static SetupError with_remedy(SetupError error, const std::filesystem::path& file) {
    if (error.sys_errno == ENOENT && !file.empty())
        error.text += fmt::format("; copy the other side's key there, or make one: mavloom key new '{}'", file.string());
    return error;
}

SetupResult<SigningKey> SigningKey::load(const std::filesystem::path& file) {
    auto text = read_secret_file(file, "key file");
    if (!text) return tl::unexpected(with_remedy(std::move(text.error()), file));
    const auto key = parse_hex(*text);
    sodium_memzero(text->data(), text->size());
    if (key) return SigningKey(*key);
    return setup_error(SetupCode::bad_input,
                       fmt::format("{}: expected 64 hexadecimal digits, a key of 32 bytes", file.string()));
}

std::size_t Signer::sign(ByteSpan frame, std::size_t size, SigningTime now) noexcept {
    assert(frame.size() >= size + signature_length && (frame[2] & incompat_signed) != 0);
    last_ = std::min(std::max(SigningTime{last_.ticks + 1}, now), SigningTime{SigningTime::limit - 1});
    std::uint8_t* const signature = frame.data() + size;
    signature[0] = link_id_;
    store_time(signature + 1, last_.ticks & time_mask);
    const auto hash = hash_of(key_, frame.first(size + 1 + time_length));
    std::copy(hash.begin(), hash.end(), signature + 1 + time_length);
    return size + signature_length;
}

Verifier::Verifier(const SigningKey& key, SigningTime newest) : key_(key), newest_(newest) {
    streams_.reserve(max_streams);
}

Verifier::Stream Verifier::stream_of(const FrameView& frame) noexcept {
    const auto signature = frame.signature();
    return {std::uint32_t{signature[0]} << 16 | std::uint32_t{frame.system().value} << 8 | frame.component().value,
            SigningTime{load_time(signature.data() + 1)}};
}

SigningTime Verifier::last(std::uint32_t key) const noexcept {
    const auto it = std::ranges::lower_bound(streams_, key, {}, &Stream::key);
    return it != streams_.end() && it->key == key ? it->last : SigningTime{};
}

SigningTime Verifier::refused_until(std::uint32_t key, SigningTime now) const noexcept {
    if (const SigningTime known = last(key); known != SigningTime{}) return known;
    const std::uint64_t latest = std::max(now, newest_).ticks;
    return {latest - std::min(latest, first_tolerance_ticks + 1)};
}

void Verifier::restore(const Stream& stream) noexcept {
    const auto it = std::ranges::lower_bound(streams_, stream.key, {}, &Stream::key);
    if (it != streams_.end() && it->key == stream.key) {
        it->last = std::max(it->last, stream.last);
    } else if (streams_.size() < max_streams || forget_oldest(stream.last)) {
        insert(stream);
    } else {
        return;
    }
    newest_ = std::max(newest_, stream.last);
}

void Verifier::insert(const Stream& stream) noexcept {
    streams_.insert(std::ranges::lower_bound(streams_, stream.key, {}, &Stream::key), stream);
}

bool Verifier::forget_oldest(SigningTime before) noexcept {
    const auto oldest = std::ranges::min_element(streams_, {}, &Stream::last);
    if (oldest->last >= before) return false;
    streams_.erase(oldest);
    return true;
}

bool Verifier::is_of_key(const FrameView& frame) const noexcept {
    if (!frame.is_signed()) return false;
    const auto hash = hash_of(key_, frame.bytes().first(frame.size() - hash_length));
    return sodium_memcmp(hash.data(), frame.signature().data() + 1 + time_length, hash.size()) == 0;
}

Verifier::Verdict Verifier::verify(const FrameView& frame, SigningTime now) noexcept {
    if (!frame.is_signed()) return Verdict::unsigned_frame;
    if (!is_of_key(frame)) return Verdict::bad_signature;

    const auto [key, time] = stream_of(frame);
    const auto it = std::ranges::lower_bound(streams_, key, {}, &Stream::key);
    if (it != streams_.end() && it->key == key) {
        if (time <= it->last) return Verdict::replay;
        it->last = time;
    } else {
        const std::uint64_t latest = std::max(now, newest_).ticks;
        if (time.ticks + first_tolerance_ticks < latest) return Verdict::too_old;
        // A stream that is forgotten must be so old that its frames are refused as too old from now on.
        const SigningTime forgettable{latest - std::min(latest, first_tolerance_ticks)};
        if (streams_.size() == max_streams && !forget_oldest(forgettable)) return Verdict::too_many_streams;
        insert({key, time});
    }
    newest_ = std::max(newest_, time);
    return Verdict::good;
}

}  // namespace mavloom::wire
