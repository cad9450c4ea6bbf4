// SPDX-License-Identifier: MIT
// Download of recorded logs, and log streaming. Private to module sim; single owner.
#pragma once

#include "sim/service/service.hpp"

namespace mavloom::sim {

struct Parts;

class LogService final : public Service {
public:
    explicit LogService(Parts& parts) noexcept : parts_(parts) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;

private:
    Parts& parts_;
};

}  // namespace mavloom::sim
