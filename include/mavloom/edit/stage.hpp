// SPDX-License-Identifier: MIT
// The stage that decodes, changes on request and re-encodes frames: the only place, with a link's own options, where a frame's bytes change
// (DESIGN.md rule 1). Without options every frame that can be decoded comes out byte for byte as it went in, and what cannot passes
// untouched. One owner thread; time is a parameter; nothing allocates per frame. docs/guide/relay.md says what passes untouched and why.
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
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::edit {

// As users type them; `Stage::create` checks every word. Lists may also be one text with commas.
struct Options {
    std::vector<std::string> set{};           // "MESSAGE.field=value"; applied after remap_system
    std::vector<std::string> remap_system{};  // "A=B": source and target system; all at once, so "1=2" and "2=1" swap
    std::vector<std::string> only{};          // message names or ids
    // "ATTITUDE:10", "*:50" for all other telemetry (dialect/rates.hpp): of each source and message, counted in the frames' own time.
    std::vector<std::string> max_rate{};
    std::optional<wire::Version> as_version{};
    std::optional<wire::SigningKey> sign_key{};
    std::uint8_t sign_link_id = 0;
    bool resequence = false;
};

// Every frame that does not come out, or not as somebody might expect, has a name (DESIGN.md rule 3). Of the frames that went in forward:
// frames = reencoded + rewrapped + passed_untouched + filtered + rate_limited + not_v1. Frames on the way back are counted apart.
struct Counters {
    Counter frames;     // that went in
    Counter reencoded;  // decoded and encoded again
    Counter rewrapped;  // given a new header and checksum around a payload that has no (or not all of its) definition
    Counter passed_untouched;   // could not be, or must not be, decoded and encoded: unknown id, not canonical, signed
    Counter filtered;           // only
    Counter rate_limited;       // max_rate
    Counter not_v1;             // as MAVLink 1: id over 255, or without the definition that says what to cut
    Counter not_signed;         // of those that came out: MAVLink 1, which has no signatures, although a key was given
    Counter signature_removed;  // a signed frame was changed and not signed again, in either direction
    Counter backward;           // that went in on the way back
};

// All but `forward` by the names of their counters.
enum class Verdict : std::uint8_t { forward, filtered, rate_limited, not_v1 };

struct Outcome {
    Verdict verdict = Verdict::forward;
    wire::FrameView frame;  // to be sent; valid until the next call. Empty unless `forward`
};

class Stage {
public:
    // `dialect` must outlive the stage. Errors are `usage`, name the option and the nearest valid spelling.
    [[nodiscard]] static SetupResult<std::unique_ptr<Stage>> create(const dialect::Dialect& dialect,
                                                                    const Options& options);
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    // On the way from the sources to the destinations: all options apply. `received` is the frame's own time (the kernel's, or the
    // recording's), by which max_rate counts; `now` is the time for signatures.
    [[nodiscard]] Outcome forward(const wire::FrameView& frame, WallTime received, WallTime now) noexcept;
    // On the way back: only what keeps the conversation whole, which is remap_system in reverse (source and target system).
    [[nodiscard]] Outcome backward(const wire::FrameView& frame) noexcept;

    [[nodiscard]] const Counters& counters() const noexcept;
    // Options that will do harm, one line each: a rate on a message that a protocol waits for.
    [[nodiscard]] std::span<const std::string> warnings() const noexcept;

private:
    class Impl;
    explicit Stage(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mavloom::edit
