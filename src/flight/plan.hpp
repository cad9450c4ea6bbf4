// SPDX-License-Identifier: MIT
// Plans that clients upload: mission, fence and rally points. Private to flight and sim; single owner. Items are kept
// as they arrived, so that a download returns them bit for bit.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "flight/physics/geodesy.hpp"

namespace mavloom::flight {

// MAV_MISSION_TYPE.
enum class PlanType : std::uint8_t { mission = 0, fence = 1, rally = 2 };
inline constexpr std::size_t plan_types = 3;

// One item, in the units of MISSION_ITEM_INT.
struct PlanItem {
    std::uint16_t command = 0;
    std::uint8_t frame = 0;
    std::uint8_t autocontinue = 1;
    std::array<float, 4> params{};
    std::int32_t x = 0, y = 0;
    float z = 0;
};

// Latitude, longitude and z of an item, if it has a position on earth. INT32_MIN, INT32_MAX and 0/0 mean that it has
// none.
[[nodiscard]] std::optional<GeoPoint> position_of(const PlanItem& item);

class Plan {
public:
    [[nodiscard]] std::span<const PlanItem> items() const noexcept { return items_; }
    [[nodiscard]] std::uint16_t size() const noexcept { return static_cast<std::uint16_t>(items_.size()); }
    [[nodiscard]] bool empty() const noexcept { return items_.empty(); }
    // A checksum of all items; 0 for an empty plan. Equal plans have equal ids. Algorithm: docs/design/simulator.md.
    [[nodiscard]] std::uint32_t id() const noexcept { return id_; }
    // Counts the replacements, so that others notice a new plan with an equal id.
    [[nodiscard]] std::uint32_t edition() const noexcept { return edition_; }

    void replace(std::vector<PlanItem> items);
    void clear() { replace({}); }

private:
    std::vector<PlanItem> items_;
    std::uint32_t id_ = 0, edition_ = 0;
};

class Plans {
public:
    [[nodiscard]] Plan& of(PlanType type) noexcept { return plans_[static_cast<std::size_t>(type)]; }
    [[nodiscard]] const Plan& of(PlanType type) const noexcept { return plans_[static_cast<std::size_t>(type)]; }
    [[nodiscard]] Plan& mission() noexcept { return of(PlanType::mission); }
    [[nodiscard]] const Plan& mission() const noexcept { return of(PlanType::mission); }
    [[nodiscard]] const Plan& fence() const noexcept { return of(PlanType::fence); }
    [[nodiscard]] const Plan& rally() const noexcept { return of(PlanType::rally); }

private:
    std::array<Plan, plan_types> plans_;
};

}  // namespace mavloom::flight
