// SPDX-License-Identifier: MIT
// The parameter protocol. Private to module sim; single owner. Source: MAVLink guide, "Parameter Protocol".
#pragma once

#include "sim/firmware/parameters.hpp"
#include "sim/service/service.hpp"

namespace mavloom::sim {

struct Parts;

class ParameterService final : public Service {
public:
    explicit ParameterService(Parts& parts) noexcept : parts_(parts) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;

    // Sends the value of a parameter to all links.
    void announce(ParamIndex /*index*/) {}

private:
    Parts& parts_;
};

}  // namespace mavloom::sim
