// SPDX-License-Identifier: MIT
// MAVLink FTP: a small file system of the vehicle. Private to module sim; single owner. Source: MAVLink guide, "File
// Transfer Protocol (FTP)".
#pragma once

#include "sim/service/service.hpp"

namespace mavloom::sim {

struct Parts;

class FileService final : public Service {
public:
    explicit FileService(Parts& parts) noexcept : parts_(parts) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;

private:
    Parts& parts_;
};

}  // namespace mavloom::sim
