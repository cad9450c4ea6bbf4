// SPDX-License-Identifier: MIT
// Calibration of sensors, with the texts that ground stations parse. Private to module sim; single owner.
#pragma once

#include "sim/service/service.hpp"

namespace mavloom::sim {

struct Parts;

class CalibrationService final : public Service {
public:
    explicit CalibrationService(Parts& parts) noexcept : parts_(parts) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;

private:
    Parts& parts_;
};

}  // namespace mavloom::sim
