// SPDX-License-Identifier: MIT
// A simulated gimbal with its gimbal manager. Private to module sim; single owner. Source: MAVLink guide, "Gimbal
// Protocol v2".
#pragma once

#include "sim/service/service.hpp"

namespace mavloom::sim {

struct Parts;

class Gimbal final : public Service {
public:
    explicit Gimbal(Parts& parts) noexcept : parts_(parts) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;

private:
    Parts& parts_;
};

}  // namespace mavloom::sim
