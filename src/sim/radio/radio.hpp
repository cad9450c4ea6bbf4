// SPDX-License-Identifier: MIT
// The radio sends everything that a vehicle sends: it numbers, signs and writes the frames of each link. Private to
// module sim; single owner. Sending allocates nothing.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/sim/sink.hpp"
#include "mavloom/wire/signing.hpp"
#include "mavloom/wire/struct_frame.hpp"
#include "sim/radio/client.hpp"

namespace mavloom::sim {

class Radio {
public:
    // `sink` must outlive the object.
    Radio(SystemId system, Sink& sink) noexcept : system_(system), sink_(sink) {}

    void open(LinkId link);
    void close(LinkId link);
    [[nodiscard]] std::span<const LinkId> links() const noexcept { return ids_; }
    // The vehicle's system id. A reboot may change it.
    [[nodiscard]] SystemId system() const noexcept { return system_; }
    void set_system(SystemId system) noexcept { system_ = system; }

    template <class Message>
    void send(LinkId link, const Message& message, ComponentId from = autopilot_component) {
        std::array<std::uint8_t, Message::max_length> payload;
        (void)message.encode(payload);
        transmit(link, wire::info_of<Message>, payload, from);
    }
    template <class Message>
    void broadcast(const Message& message, ComponentId from = autopilot_component) {
        std::array<std::uint8_t, Message::max_length> payload;
        (void)message.encode(payload);
        for (const LinkId link : ids_) transmit(link, wire::info_of<Message>, payload, from);
    }
    void transmit(LinkId link, const wire::MessageInfo& info, ByteView payload, ComponentId from = autopilot_component);

    // True while the link has room for another frame of a bulk transfer.
    [[nodiscard]] bool has_room(LinkId link) const { return sink_.has_room(link); }
    // Traffic of a link so far.
    struct Totals {
        std::uint64_t frames = 0, bytes = 0;                    // sent
        std::uint64_t received_frames = 0, received_bytes = 0;  // for any vehicle
    };
    void note_received(LinkId link, std::size_t bytes) noexcept;
    [[nodiscard]] Totals totals(LinkId link) const noexcept;

    // Signs every frame from now on with this key; without a key, signs none. `now` is UTC.
    void sign_with(const std::optional<wire::SigningKey>& key, wire::SigningTime now);
    // Timestamps of signatures continue from `newest` if UTC is earlier.
    void raise_signing_time(wire::SigningTime newest) noexcept { signing_start_ = std::max(signing_start_, newest); }
    void set_utc(WallTime now) noexcept { utc_ = now; }
    // While silent, the radio sends nothing. A vehicle is silent while it reboots.
    void set_silent(bool silent) noexcept { silent_ = silent; }
    // Faults on purpose: the radio is off, or the autopilot's HEARTBEAT is not sent.
    void set_off(bool off) noexcept { is_off_ = off; }
    [[nodiscard]] bool is_off() const noexcept { return is_off_; }
    void withhold_heartbeat(bool withhold) noexcept { withholds_heartbeat_ = withhold; }
    // All sequence numbers begin at 0 again.
    void restart_sequences() noexcept;

private:
    struct Outlet {
        std::array<std::uint8_t, 256> sequences{};  // by component
        std::uint8_t signing_link = 0;              // the link id in signatures
        std::optional<wire::Signer> signer;
        Totals totals;
    };
    [[nodiscard]] Outlet* find(LinkId link) noexcept;

    SystemId system_;
    Sink& sink_;
    std::vector<LinkId> ids_;
    std::vector<Outlet> outlets_;  // as ids_
    std::optional<wire::SigningKey> key_;
    wire::SigningTime signing_start_;
    std::uint8_t next_signing_link_ = 0;
    WallTime utc_{};
    bool silent_ = false, is_off_ = false, withholds_heartbeat_ = false;
};

}  // namespace mavloom::sim
