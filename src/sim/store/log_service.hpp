// SPDX-License-Identifier: MIT
// Download of recorded logs, and log streaming. Private to module sim; single owner.
#pragma once

#include "sim/flight/orders.hpp"
#include "sim/service/service.hpp"

namespace mavloom::sim {

struct Parts;

class LogService final : public Service {
public:
    explicit LogService(Parts& parts) noexcept : parts_(parts) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;

    // MAV_CMD_LOGGING_START and _STOP, which PX4 knows: streams the running log to the client.
    [[nodiscard]] Result start_stream(const Client& to, Moment now);
    Result stop_stream(const Client& to);

private:
    Parts& parts_;
};

}  // namespace mavloom::sim
