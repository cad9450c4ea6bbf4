// SPDX-License-Identifier: MIT
// The editing stage of `mavloom relay`: decodes frames, applies the options, and encodes them again. Apart from this
// stage, only the endpoint option sign= changes the bytes of frames. Without options, every frame leaves byte for byte
// as it came. A frame that cannot be decoded passes untouched. One owner thread; time is a parameter; nothing allocates
// per frame. docs/guide/relay.md lists what passes untouched and why.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/counter.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/dialect/filter.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::edit {

// The options as the user typed them; `Stage::create` checks every term.
// A string may hold several terms separated by commas, except in `set`.
struct Options {
    std::vector<std::string> set{};  // "MESSAGE.field=value"; applied after remap_system
    // "A=B": replaces source and target system A by B. All pairs apply at once, so "1=2" and "2=1" swap.
    std::vector<std::string> remap_system{};
    dialect::Filter filter{};  // drops the frames that it does not admit
    // "ATTITUDE:10", or "*:50" for all other telemetry (dialect/rates.hpp). The limit applies to each source and
    // message separately, measured in the frames' own time.
    std::vector<std::string> max_rate{};
    std::optional<wire::Version> as_version{};
    std::optional<wire::SigningKey> sign_key{};
    std::uint8_t sign_link_id = 0;
    wire::SigningTime sign_after{};  // new signatures get later timestamps than this
    bool resequence = false;
};

// Counts frames by how they were treated. For frames in the forward direction: frames = reencoded + rewrapped +
// passed_untouched + filtered + rate_limited + not_v1. A frame in the backward direction counts in `backward`, also in
// `signature_removed` if it loses its signature, and nowhere else.
struct Counters {
    Counter frames;            // input frames, forward direction
    Counter bytes;             // of these frames
    Counter reencoded;         // decoded and encoded again
    Counter rewrapped;         // new header, original payload: the definition is missing or does not cover the payload
    Counter passed_untouched;  // forwarded as it came: unknown id, signed, or encoded in an unusual way
    Counter filtered;          // dropped by `filter`
    Counter rate_limited;      // dropped by `max_rate`
    Counter not_v1;      // dropped because MAVLink 1 cannot carry it: id over 255, or no definition for the conversion
    Counter not_signed;  // forwarded unsigned although a key was given, because MAVLink 1 has no signatures
    Counter signature_removed;  // a signed frame was changed and not signed again, in either direction
    Counter backward;           // input frames, backward direction
};

// The decision about a frame. Every value except `forward` means that the frame was dropped. Each of these has a
// counter of the same name.
enum class Verdict : std::uint8_t { forward, filtered, rate_limited, not_v1 };

struct Outcome {
    Verdict verdict = Verdict::forward;
    wire::FrameView frame;  // the frame to send, valid until the next call; empty unless `forward`
};

class Stage {
public:
    // `dialect` must outlive the stage. Errors are `usage`; they name the option and suggest the closest valid
    // spelling.
    [[nodiscard]] static SetupResult<std::unique_ptr<Stage>> create(const dialect::Dialect& dialect,
                                                                    const Options& options);
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    // Processes a frame from a source to the destinations; all options apply. `received` is the frame's own time, from
    // the kernel or the recording; max_rate uses it. Signatures use `now`.
    [[nodiscard]] Outcome forward(const wire::FrameView& frame, WallTime received, WallTime now) noexcept;
    // Processes a frame from a destination back to the sources. Only remap_system applies, in reverse (source and
    // target system).
    [[nodiscard]] Outcome backward(const wire::FrameView& frame) noexcept;

    [[nodiscard]] const Counters& counters() const noexcept;
    // The time of the last signature. Before the first one it is `sign_after`; without a key it is 0.
    [[nodiscard]] wire::SigningTime last_signed() const noexcept;
    // Warnings about harmful options, one line each: for example, a rate for a message that a protocol waits for.
    [[nodiscard]] std::span<const std::string> warnings() const noexcept;

private:
    class Impl;
    explicit Stage(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mavloom::edit
