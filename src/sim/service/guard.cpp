// SPDX-License-Identifier: MIT
#include "sim/service/guard.hpp"

#include <algorithm>
#include <array>

#include "mavloom/msg/adsb_vehicle.hpp"
#include "mavloom/msg/collision.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/radio_status.hpp"
#include "mavloom/msg/setup_signing.hpp"

namespace mavloom::sim {

namespace {

constexpr std::array guard_messages{msg::SetupSigning::id};
constexpr std::array unsigned_messages{msg::Heartbeat::id, msg::RadioStatus::id, msg::AdsbVehicle::id,
                                       msg::Collision::id};

}  // namespace

// A frame without signature counts as signed while the vehicle has no key; a signature is not looked at then.
bool Guard::admits(const wire::FrameView& frame, WallTime utc) {
    last_was_signed_ = frame.is_signed();
    if (!verifier_) return true;
    if (!last_was_signed_) return std::ranges::find(unsigned_messages, frame.id()) != unsigned_messages.end();
    if (verifier_->verify(frame, wire::SigningTime::from(utc)) != wire::Verifier::Verdict::good) return false;
    radio_.raise_signing_time(verifier_->newest());
    return true;
}

std::span<const MessageId> Guard::handled() const noexcept { return guard_messages; }

// A key of zeros turns signing off. Only a client that has the key may do that. Clients send the message twice.
void Guard::receive(const Client& /*from*/, MessageId /*id*/, ByteView payload, Moment /*now*/) {
    const auto request = msg::SetupSigning::decode(payload);
    const wire::SigningKey key(request.secret_key);
    const bool is_off = std::ranges::all_of(request.secret_key, [](std::uint8_t byte) { return byte == 0; });
    if ((is_off && !last_was_signed_) || key == key_) return;
    if (flight_.armed()) return observer_.on_text(Severity::warning, "Signing key refused: vehicle is armed");
    constexpr std::uint64_t latest = (std::uint64_t{1} << 48) - 1;
    if (request.initial_timestamp > latest)
        return observer_.on_text(Severity::warning, "Signing key refused: bad time");
    use(is_off ? std::nullopt : std::optional(key), {request.initial_timestamp});
    observer_.on_text(Severity::info, is_off ? "Message signing is off" : "Message signing is on");
}

void Guard::use(const std::optional<wire::SigningKey>& key, wire::SigningTime start) {
    key_ = key;
    verifier_.reset();
    if (key) verifier_.emplace(*key, wire::SigningTime{});
    radio_.sign_with(key, start);
}

}  // namespace mavloom::sim
