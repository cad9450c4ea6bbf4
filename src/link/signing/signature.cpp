// SPDX-License-Identifier: MIT
// sign= and verify= of an endpoint: drops incoming frames that are unsigned or wrongly signed, and signs outgoing
// frames.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "link/signing/signature.hpp"
#include "mavloom/wire/crc.hpp"

namespace mavloom::link::detail {

SetupResult<std::unique_ptr<Signature>> Signature::load(const endpoint::EndpointOptions& options, std::uint8_t signs_as,
                                                        KeyStore& store, std::vector<std::string>& notices) {
    if (options.sign_key_file.empty() && options.verify_key_file.empty()) return nullptr;
    auto signature = std::make_unique<Signature>(store);
    if (!options.verify_key_file.empty()) {
        auto opened = signature->open(options.verify_key_file, notices);
        if (!opened) return tl::unexpected(std::move(opened).error());
        signature->verify_with_.emplace(std::move(*opened));
        signature->verify_with(*signature->verify_with_, !options.group.empty());
    }
    if (!options.sign_key_file.empty()) {
        auto opened = signature->open(options.sign_key_file, notices);
        if (!opened) return tl::unexpected(std::move(opened).error());
        if (auto begun = signature->sign_with(std::move(*opened), signs_as); !begun)
            return tl::unexpected(std::move(begun).error());
        signature->signs_own_ = options.signs_own;
    }
    return signature;
}

SetupResult<Signature::OpenKey> Signature::open(const std::string& path, std::vector<std::string>& notices) {
    auto key = wire::SigningKey::load(path);
    if (!key) return tl::unexpected(std::move(key).error());
    return OpenKey{path, *key, store_.open(path, *key, notices)};
}

// Endpoints with the same key share one verifier, so a frame that one of them accepted is a replay at the others. In
// a group the same frame arrives over several links, sometimes late. There each endpoint has its own verifier, and
// SeenSignatures rejects frames that are too late.
void Signature::verify_with(const OpenKey& with, bool in_group) {
    verifying_key_ = store_.shared_key(with.key);
    if (!store_.endpoints_are_independent) {
        verifying_key_->compares_heard = true;
        store_.compares_heard = true;
    }
    if (!in_group) return;
    own_.emplace(with.key);
    for (const auto& stream : verifying_key_->verifier.streams()) own_->restore(stream);
}

SetupResult<void> Signature::sign_with(OpenKey with, std::uint8_t link_id) {
    const auto& [path, key, times] = sign_with_.emplace(std::move(with));
    signing_key_ = store_.shared_key(key);
    if (auto begun = KeyStore::begin_signing(*times); !begun) return begun;
    signing_key_->seen.sign_as(link_id);
    signs_as_ = link_id;
    signer_.emplace(key, link_id, times->state.last_signed);
    return {};
}

// Whether the frame is one that this process signed, and that somebody has sent back.
bool Signature::is_own(const wire::FrameView& frame) const noexcept {
    if (!frame.is_signed()) return false;
    if (store_.endpoints_are_independent && signs_as_ != frame.signature()[0]) return false;
    return verifying_key_->seen.is_own(frame);
}

bool Signature::takes(const wire::FrameView& frame, wire::SigningTime time, MonoTime now) {
    is_repeated_ = false;
    if (is_own(frame)) return false;
    const bool is_good = own_ ? takes_in_group(frame, time)
                              : verifying_key_->verifier.verify(frame, time) == wire::Verifier::Verdict::good;
    if (!is_good) return false;
    const auto heard = verifying_key_->seen.hear(frame, now);
    is_repeated_ = heard == SeenSignatures::Verdict::repeated;
    return heard != SeenSignatures::Verdict::too_late;
}

bool Signature::takes_in_group(const wire::FrameView& frame, wire::SigningTime time) {
    if (own_->verify(frame, time) != wire::Verifier::Verdict::good) return false;
    const auto stream = wire::Verifier::stream_of(frame);
    verifying_key_->verifier.restore(stream);
    return verifying_key_->verifier.last(stream.key) != wire::SigningTime{};  // else there was no place for the sender
}

Signature::~Signature() {
    keep_times();
    store_.remove(*this);
}

bool Signature::has_other_keys() const {
    bool other = false;
    for (const auto* with : {&verify_with_, &sign_with_}) {
        if (!*with) continue;
        const auto now = wire::SigningKey::load((*with)->path);
        if (!now) return false;
        other = other || *now != (*with)->key;
    }
    return other;
}

// The file's state may belong to another key by now: an endpoint opened later may have loaded a new key from it.
void Signature::keep_times() const {
    if (verifying_key_ && verify_with_->is_current() &&
        verify_with_->times->state.merge_heard(verifying_key_->verifier.streams()))
        verify_with_->times->changed = true;
    if (signer_ && signer_->last() > sign_with_->times->state.last_signed) {
        sign_with_->times->state.last_signed = signer_->last();
        sign_with_->times->changed = true;
    }
}

bool Signature::accepts(const wire::FrameView& frame, WallTime time, MonoTime now) noexcept {
    if (!verifying_key_) return true;
    if (accepted_ == frame.bytes().data()) {
        accepted_ = nullptr;
        is_repeated_ = false;
        return true;
    }
    return takes(frame, wire::SigningTime::from(time), now);
}

bool Signature::accepts_early(const wire::FrameView& frame, WallTime time, MonoTime now) noexcept {
    if (!accepts(frame, time, now) || is_repeated_) return false;
    accepted_ = frame.bytes().data();
    return true;
}

// Returns the CRC_EXTRA byte of this frame: from the dialect, else derived from the checksum. Returns -1 if none fits.
static int crc_extra_of(const wire::FrameView& frame, std::uint16_t before_extra,
                        const wire::MessageTable& table) noexcept {
    if (const wire::MessageInfo* info = table.find(frame.id())) return info->crc_extra;
    return wire::crc_extra_between(before_extra, frame.checksum());
}

wire::FrameView Signature::sign(const wire::FrameView& frame, const wire::MessageTable& table, WallTime now) noexcept {
    assert(signer_.has_value() == (signing_key_ != nullptr));
    if (!signer_ || !frame.is_v2()) return frame;
    const std::size_t covered = frame.header_length() + frame.payload_length();
    const ByteView header_and_payload = frame.bytes().first(covered);
    const int extra = crc_extra_of(frame, wire::crc_update(wire::crc_seed, header_and_payload.subspan(1)), table);
    if (extra < 0) return frame;
    std::copy(header_and_payload.begin(), header_and_payload.end(), buffer_.begin());
    buffer_[2] |= wire::incompat_signed;
    const ByteView now_covered = ByteView(buffer_).subspan(1, covered - 1);
    const std::uint16_t before_extra = wire::crc_update(wire::crc_seed, now_covered);
    store_le(buffer_.data() + covered, wire::crc_update(before_extra, static_cast<std::uint8_t>(extra)));
    const std::size_t size = signer_->sign(buffer_, covered + wire::checksum_length, wire::SigningTime::from(now));
    const auto signed_frame = wire::FrameView::unchecked(ByteView(buffer_).first(size));
    signing_key_->seen.note_signed(signed_frame);
    return signed_frame;
}

}  // namespace mavloom::link::detail
