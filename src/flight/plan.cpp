// SPDX-License-Identifier: MIT
#include "flight/plan.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "mavloom/msg/enums/mav_frame.hpp"
#include "mavloom/wire/crc32.hpp"

namespace mavloom::flight {

namespace {

// frame, command, autocontinue, params 1 to 4, x, y, z: packed, little-endian.
constexpr std::size_t packed_length = 1 + 2 + 1 + 4 * 4 + 2 * 4 + 4;

std::uint32_t checksum_of(std::uint32_t crc, const PlanItem& item) noexcept {
    std::array<std::uint8_t, packed_length> bytes;
    std::size_t at = 0;
    const auto put = [&](auto value) {
        store_le(bytes.data() + at, value);
        at += sizeof value;
    };
    put(item.frame);
    put(item.command);
    put(item.autocontinue);
    for (const float param : item.params) put(param);
    put(item.x);
    put(item.y);
    put(item.z);
    return wire::crc32(crc, bytes);
}

bool is_global(std::uint8_t frame) noexcept {
    using namespace msg;
    switch (frame) {
        case MAV_FRAME_GLOBAL:
        case MAV_FRAME_GLOBAL_RELATIVE_ALT:
        case MAV_FRAME_GLOBAL_INT:
        case MAV_FRAME_GLOBAL_RELATIVE_ALT_INT:
        case MAV_FRAME_GLOBAL_TERRAIN_ALT:
        case MAV_FRAME_GLOBAL_TERRAIN_ALT_INT: return true;
        default: return false;
    }
}

}  // namespace

std::optional<GeoPoint> position_of(const PlanItem& item) {
    using Range = std::numeric_limits<std::int32_t>;
    const auto given = [](std::int32_t v) { return v != Range::min() && v != Range::max(); };
    if (!is_global(item.frame) || !given(item.x) || !given(item.y) || (item.x == 0 && item.y == 0)) return std::nullopt;
    const GeoPoint point{from_degrees_e7(item.x), from_degrees_e7(item.y), double{item.z}};
    const bool is_on_earth = std::abs(point.latitude) <= 90 && std::abs(point.longitude) <= 180;
    return is_on_earth ? std::optional(point) : std::nullopt;
}

void Plan::replace(std::vector<PlanItem> items) {
    items_ = std::move(items);
    id_ = 0;
    for (const PlanItem& item : items_) id_ = checksum_of(id_, item);
    ++edition_;
}

}  // namespace mavloom::flight
