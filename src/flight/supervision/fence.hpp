// SPDX-License-Identifier: MIT
// The geofence: polygons and circles of the fence plan, and the radius and height around home that parameters set.
// Private to flight; single owner. Allocates only when the plan changes.
#pragma once

#include <vector>

#include "flight/context.hpp"

namespace mavloom::flight {

class Fence {
public:
    explicit Fence(const FlightContext& context) noexcept : context_(context) {}

    // Call it after the plan or the origin changed.
    void rebuild();
    void enable(bool enabled) noexcept { is_enabled_ = enabled; }
    // The fences that the vehicle is outside of, as bits.
    enum Breach : unsigned { breaches_height = 1, breaches_circle = 2, breaches_polygon = 4 };
    [[nodiscard]] unsigned breaches() const;

private:
    using Point = Eigen::Vector2d;
    // A circle has one point and a radius.
    struct Area {
        bool is_inclusion = false;
        double radius = 0;
        std::vector<Point> corners{};

        [[nodiscard]] bool contains(const Point& point) const;
    };

    [[nodiscard]] unsigned breached_limits() const;
    [[nodiscard]] bool breaches_areas() const;
    void add(const PlanItem& item);

    const FlightContext& context_;
    std::vector<Area> areas_;
    std::size_t missing_corners_ = 0;  // of the last polygon
    bool is_enabled_ = true;
};

}  // namespace mavloom::flight
