// SPDX-License-Identifier: MIT
// The options sign= and verify= of an endpoint. Private to module link; single owner thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "link/signing/key_store.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::link::detail {

// Signing (sign=) and verification (verify=) for one endpoint.
class Signature {
public:
    // Loads the keys. Timestamps of earlier runs come from `store`, which must outlive the object; problems with
    // them go to `notices`. `signs_as` is the link id of signed frames. Returns null if neither option is set.
    [[nodiscard]] static SetupResult<std::unique_ptr<Signature>> load(const endpoint::EndpointOptions& options,
                                                                      std::uint8_t signs_as, KeyStore& store,
                                                                      std::vector<std::string>& notices);
    explicit Signature(KeyStore& store) : store_(store) { store_.add(*this); }
    Signature(const Signature&) = delete;
    Signature& operator=(const Signature&) = delete;
    ~Signature();

    // Copies the timestamps used so far into the key files' states.
    void keep_times() const;
    // True if a key file now holds a different key from the one in use. False while one of the files cannot be read.
    [[nodiscard]] bool has_other_keys() const;
    [[nodiscard]] bool verifies() const noexcept { return verifying_key_ != nullptr; }
    [[nodiscard]] bool signs() const noexcept { return signer_.has_value(); }
    // Whether it also signs frames that own links brought (sign_all=true).
    [[nodiscard]] bool signs_own() const noexcept { return signs_own_; }
    [[nodiscard]] bool accepts(const wire::FrameView& frame, WallTime time, MonoTime now) noexcept;
    // True if another endpoint had already heard the last accepted frame. It may be a replay by a sender without the
    // key.
    [[nodiscard]] bool is_repeated() const noexcept { return is_repeated_; }
    // Like `accepts`, for a frame whose bytes the link's parser will find again. `accepts` then does not treat that
    // second appearance as a replay. Does not accept repeated frames.
    [[nodiscard]] bool accepts_early(const wire::FrameView& frame, WallTime time, MonoTime now) noexcept;
    // Call it before the buffer with these bytes is reused.
    void forget_accepted() noexcept { accepted_ = nullptr; }
    // Returns the signed frame, in a buffer that is valid until the next call. Returns the original frame if it
    // cannot be signed: MAVLink 1, or an unknown id whose checksum matches no CRC_EXTRA.
    [[nodiscard]] wire::FrameView sign(const wire::FrameView& frame, const wire::MessageTable& table,
                                       WallTime now) noexcept;

private:
    struct OpenKey {
        std::string path;
        wire::SigningKey key;
        std::shared_ptr<KeyFile> times;
        [[nodiscard]] bool is_current() const noexcept { return times->state.key == key.fingerprint(); }
    };
    [[nodiscard]] SetupResult<OpenKey> open(const std::string& path, std::vector<std::string>& notices);
    void verify_with(const OpenKey& with, bool in_group);
    [[nodiscard]] SetupResult<void> sign_with(OpenKey with, std::uint8_t link_id);
    [[nodiscard]] bool is_own(const wire::FrameView& frame) const noexcept;
    [[nodiscard]] bool takes(const wire::FrameView& frame, wire::SigningTime time, MonoTime now);
    [[nodiscard]] bool takes_in_group(const wire::FrameView& frame, wire::SigningTime time);

    KeyStore& store_;
    std::optional<OpenKey> verify_with_, sign_with_;
    std::shared_ptr<SharedKey> verifying_key_;  // null without verify=
    std::shared_ptr<SharedKey> signing_key_;    // of the key of sign=; null without it
    std::optional<wire::Verifier> own_;         // in a group, the endpoint's own verifier
    std::optional<wire::Signer> signer_;
    std::optional<std::uint8_t> signs_as_;  // the link id
    bool signs_own_ = false;
    bool is_repeated_ = false;
    // Start of the frame that `accepts_early` has already verified.
    const std::uint8_t* accepted_ = nullptr;
    std::array<std::uint8_t, wire::max_frame_length> buffer_{};
};

}  // namespace mavloom::link::detail
