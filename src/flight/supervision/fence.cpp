// SPDX-License-Identifier: MIT
#include "flight/supervision/fence.hpp"

#include <algorithm>

#include "flight/physics/math.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"

namespace mavloom::flight {

namespace {

using namespace msg;

bool is_inclusion(std::uint16_t command) noexcept {
    return command == MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION || command == MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION;
}
bool is_circle(std::uint16_t command) noexcept {
    return command == MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION || command == MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION;
}

}  // namespace

// Even-odd rule.
bool Fence::Area::contains(const Point& point) const {
    if (radius > 0) return (point - corners.front()).norm() <= radius;
    bool inside = false;
    for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
        const Point &a = corners[i], &b = corners[j];
        if ((a.y() > point.y()) == (b.y() > point.y())) continue;
        if (point.x() < a.x() + (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y())) inside = !inside;
    }
    return inside;
}

void Fence::rebuild() {
    areas_.clear();
    missing_corners_ = 0;
    for (const PlanItem& item : context_.plans.fence().items()) add(item);
    std::erase_if(areas_, [](const Area& area) { return area.radius <= 0 && area.corners.size() < 3; });
}

// Each corner states how many corners its polygon has. A polygon with fewer ends where another kind of item begins.
void Fence::add(const PlanItem& item) {
    const double number = double{item.params[0]};
    const auto place = position_of(item);
    if (!place || item.command == MAV_CMD_NAV_FENCE_RETURN_POINT) return;
    const Point point = context_.craft.frame().to_local(*place).head<2>();
    if (is_circle(item.command)) {
        missing_corners_ = 0;
        if (number > 0) areas_.push_back({is_inclusion(item.command), std::min(number, 1e6), {point}});
        return;
    }
    const bool continues = missing_corners_ > 0 && areas_.back().is_inclusion == is_inclusion(item.command);
    if (!continues) {
        areas_.push_back({.is_inclusion = is_inclusion(item.command)});
        missing_corners_ = number >= 3 && number <= 1e4 ? static_cast<std::size_t>(number) : 3;
    }
    areas_.back().corners.push_back(point);
    --missing_corners_;
}

unsigned Fence::breaches() const {
    return is_enabled_ ? breached_limits() | (breaches_areas() ? breaches_polygon : 0u) : 0u;
}

unsigned Fence::breached_limits() const {
    if (!context_.craft.home()) return 0;
    const Vector3 way = context_.craft.estimate().position - context_.craft.home_place();
    const Tuning& tuning = context_.tuning;
    const bool is_far = tuning.fence_radius > 0 && math::hypot(way.x(), way.y()) > tuning.fence_radius;
    const bool is_high = tuning.fence_height > 0 && -way.z() > tuning.fence_height;
    return (is_far ? breaches_circle : 0u) | (is_high ? breaches_height : 0u);
}

// Outside of all inclusions, or inside of an exclusion.
bool Fence::breaches_areas() const {
    const Point here = context_.craft.estimate().position.head<2>();
    bool has_inclusion = false, is_included = false;
    for (const Area& area : areas_) {
        const bool inside = area.contains(here);
        if (!area.is_inclusion && inside) return true;
        has_inclusion |= area.is_inclusion;
        is_included |= area.is_inclusion && inside;
    }
    return has_inclusion && !is_included;
}

}  // namespace mavloom::flight
