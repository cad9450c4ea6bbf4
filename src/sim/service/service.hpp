// SPDX-License-Identifier: MIT
// One MAVLink microservice of a vehicle. Private to module sim; single owner.
//
// The vehicle checks targets and signatures first, then passes each message to the service that handles its id. State
// belongs to clients and is bounded (sim::Limits).
#pragma once

#include <span>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/sim/flight.hpp"
#include "sim/radio/client.hpp"

namespace mavloom::sim {

class Service {
public:
    Service() = default;
    Service(const Service&) = delete;
    Service& operator=(const Service&) = delete;
    virtual ~Service() = default;

    [[nodiscard]] virtual std::span<const MessageId> handled() const noexcept = 0;
    // `payload` may be shorter than the message; missing bytes are 0. Any bytes are possible: decode, then check.
    virtual void receive(const Client& from, MessageId id, ByteView payload, Moment now) = 0;
    // While true, the vehicle calls `pump` every 10 ms of flight time.
    [[nodiscard]] virtual bool is_busy() const noexcept { return false; }
    // When the service wants to be pumped once although it is not busy: for rare deadlines. After a pump at this time,
    // the function must return a later time.
    [[nodiscard]] virtual FlightTime wakes_at() const noexcept { return FlightTime::max(); }
    // Sends the next piece of bulk transfers, repeats requests and ends what timed out.
    virtual void pump(Moment /*now*/) {}
    // The vehicle boots again: drop whatever is in progress.
    virtual void reboot() {}
    // A link closed: drop the state of its clients.
    virtual void forget(LinkId /*link*/) {}
};

// How often a busy service is pumped, in flight time.
inline constexpr Nanoseconds pump_interval = std::chrono::milliseconds{10};

}  // namespace mavloom::sim
