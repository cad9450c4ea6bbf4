// SPDX-License-Identifier: MIT
// Message signing of a vehicle. SETUP_SIGNING sets the key. From then on the vehicle signs all frames, and drops
// unsigned frames, except a few messages that radios and other vehicles send. Private to module sim; single owner.
// Source: MAVLink guide, "Message Signing"; the exceptions are PX4's.
#pragma once

#include <optional>

#include "flight/flight.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/signing.hpp"
#include "sim/radio/radio.hpp"
#include "sim/service/service.hpp"

namespace mavloom::sim {

class Guard final : public Service {
public:
    Guard(const Flight& flight, Radio& radio, FlightObserver& observer) noexcept
        : flight_(flight), radio_(radio), observer_(observer) {}

    // Returns false if the frame must be dropped. `utc` is the current time, for checking timestamps.
    [[nodiscard]] bool admits(const wire::FrameView& frame, WallTime utc);

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;

private:
    void use(const std::optional<wire::SigningKey>& key, wire::SigningTime start);

    const Flight& flight_;
    Radio& radio_;
    FlightObserver& observer_;
    std::optional<wire::SigningKey> key_;
    std::optional<wire::Verifier> verifier_;
    bool last_was_signed_ = false;  // whether the last frame passed to `admits` was signed
};

}  // namespace mavloom::sim
