// SPDX-License-Identifier: MIT
// The facts about each message that parsing and routing need: id, CRC_EXTRA, lengths, and the offsets of target and
// clock fields. Names and fields are in mavloom/dialect. A MessageTable allocates only when constructed and is
// immutable afterwards, so threads and parsers can share one.
// Source: MAVLink guide, "Serialization" (CRC_EXTRA, extension fields) and "Routing" (target fields).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mavloom/base/ids.hpp"

namespace mavloom::wire {

struct MessageInfo {
    static constexpr std::uint8_t no_target = 0xff;
    static constexpr std::uint8_t no_boot_time = 0xff;

    MessageId id;
    std::uint8_t crc_extra = 0;
    std::uint8_t min_length = 0;  // payload bytes without extension fields: the payload length in MAVLink 1
    std::uint8_t max_length = 0;  // payload bytes with all extension fields
    // Offsets in the payload. The field `target` of MANUAL_CONTROL counts as a target system.
    std::uint8_t target_system_offset = no_target;
    std::uint8_t target_component_offset = no_target;
    // Offset of `time_boot_ms` (uint32), only for messages without a target system.
    std::uint8_t boot_time_offset = no_boot_time;
    friend constexpr bool operator==(const MessageInfo&, const MessageInfo&) = default;
};

class MessageTable {
public:
    // If two entries have the same id, the first is used.
    explicit MessageTable(std::span<const MessageInfo> messages);

    // Returns null for an id that is not in the table. Constant time, no allocation. The pointer is valid as long as
    // the table.
    [[nodiscard]] const MessageInfo* find(MessageId id) const noexcept {
        if (id.value < direct_size) [[likely]] {
            const auto index = direct_[id.value];
            return index == 0 ? nullptr : &infos_[index - 1u];
        }
        return find_hashed(id);
    }

    [[nodiscard]] std::span<const MessageInfo> messages() const noexcept { return infos_; }

private:
    static constexpr std::uint32_t direct_size = 1024;  // covers the telemetry of PX4 and ArduPilot

    [[nodiscard]] const MessageInfo* find_hashed(MessageId id) const noexcept;
    [[nodiscard]] std::uint32_t slot_of(std::uint32_t id) const noexcept { return (id * 0x9e3779b1u) >> hash_shift_; }

    std::vector<MessageInfo> infos_;
    std::array<std::uint16_t, direct_size> direct_{};  // index into infos_ plus one
    std::vector<std::uint16_t> hashed_;                // open addressing, index plus one
    std::uint32_t hash_shift_ = 31;
};

}  // namespace mavloom::wire
