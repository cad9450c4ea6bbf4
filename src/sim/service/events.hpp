// SPDX-License-Identifier: MIT
// The events interface: EVENT, CURRENT_EVENT_SEQUENCE, REQUEST_EVENT. Private to module sim; single owner. Source:
// MAVLink guide, "Events Interface".
#pragma once

#include "sim/service/service.hpp"

namespace mavloom::sim {

struct Parts;

class EventService final : public Service {
public:
    explicit EventService(Parts& parts) noexcept : parts_(parts) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;

    // Sends the arming checks and the health of all components, as RUN_PREARM_CHECKS asks. Does nothing for ArduPilot.
    void report_health() {}

private:
    Parts& parts_;
};

}  // namespace mavloom::sim
