// SPDX-License-Identifier: MIT
// REQUEST_DATA_STREAM, with which clients of ArduPilot set the rate of groups of messages on their link. PX4 ignores
// the message. Private to module sim; single owner. Source: MAVLink common.xml, REQUEST_DATA_STREAM, MAV_DATA_STREAM.
#pragma once

#include "sim/service/service.hpp"
#include "sim/telemetry/streams.hpp"

namespace mavloom::sim {

class DataStreams final : public Service {
public:
    DataStreams(const Firmware& firmware, Streams& streams) noexcept : firmware_(firmware), streams_(streams) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;

private:
    const Firmware& firmware_;
    Streams& streams_;
};

}  // namespace mavloom::sim
