// SPDX-License-Identifier: MIT
// The stage that decodes, changes on request and re-encodes frames: the only place, with a link's own options, where a frame's bytes change
// (DESIGN.md rule 1). Without options every frame that can be decoded comes out byte for byte as it went in, and what cannot passes
// untouched. One owner thread; time is a parameter; nothing allocates per frame. docs/guide/relay.md says what passes untouched and why.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/counter.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::edit {

// As users type them; `Stage::create` checks every word.
struct Options {
    std::vector<std::string> set;           // "MESSAGE.field=value"
    std::vector<std::string> remap_system;  // "A=B"
    std::vector<std::string> only;          // message names or ids
    std::vector<std::string> max_rate;      // "ATTITUDE:10", "*:50"
    std::optional<wire::Version> as_version;
    std::optional<wire::SigningKey> sign_key;
    std::uint8_t sign_link_id = 0;
    bool resequence = false;
};

// Every frame that does not come out, or not as somebody might expect, has a name (DESIGN.md rule 3).
struct Counters {
    Counter frames;             // that went in
    Counter reencoded;          // decoded and encoded again
    Counter passed_untouched;   // could not be, or must not be, decoded and encoded: unknown id, not canonical, signed
    Counter filtered;           // --only
    Counter rate_limited;       // --max-rate
    Counter not_v1;             // as MAVLink 1: id over 255
    Counter signature_removed;  // a signed frame was changed and no key was given
};

enum class Verdict : std::uint8_t { forward, filtered, rate_limited, not_v1 };

struct Outcome {
    Verdict verdict = Verdict::forward;
    wire::FrameView frame;  // to be sent; valid until the next call. Empty unless `forward`
};

class Stage {
public:
    // `dialect` must outlive the stage. Errors are `usage`, name the option and the nearest valid spelling.
    [[nodiscard]] static SetupResult<std::unique_ptr<Stage>> create(const dialect::Dialect& dialect, const Options& options);
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    // On the way from the sources to the destinations: all options apply.
    [[nodiscard]] Outcome forward(const wire::FrameView& frame, MonoTime now, WallTime wall) noexcept;
    // On the way back: only what keeps the conversation whole, which is remap_system in reverse (source and target system).
    [[nodiscard]] Outcome backward(const wire::FrameView& frame, MonoTime now, WallTime wall) noexcept;

    [[nodiscard]] const Counters& counters() const noexcept;

private:
    class Impl;
    explicit Stage(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mavloom::edit
