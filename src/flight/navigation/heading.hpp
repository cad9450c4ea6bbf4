// SPDX-License-Identifier: MIT
// Decides where the nose of a multicopter points: as a client or a mission orders, to a region of interest, or along
// the way. Private to flight; single owner; nothing allocates.
#pragma once

#include <optional>

#include "flight/context.hpp"

namespace mavloom::flight {

class Heading {
public:
    explicit Heading(const FlightContext& context) noexcept : context_(context) {}

    // Keeps the current heading until another function changes it.
    void keep() noexcept { kept_ = context_.craft.estimate().euler.yaw; }
    // Carries out a client's order; a `nan` yaw ends it. `rate` in rad/s; `nan`: the usual rate.
    void turn_to(double yaw, double rate) noexcept;
    void set_roi(const std::optional<GeoPoint>& point);
    void on_origin_moved() { set_roi(interest_); }

    [[nodiscard]] const std::optional<GeoPoint>& interest() const noexcept { return interest_; }
    // Returns the yaw for a vehicle that has `way` left to its goal. `wanted` is the yaw of the manoeuvre; `nan`: any.
    [[nodiscard]] double yaw_for(const Vector3& way, double wanted) noexcept;
    // The fastest turn rate: that of the client's order, or the usual one.
    [[nodiscard]] double fastest() const noexcept;

private:
    const FlightContext& context_;
    double kept_ = 0, ordered_ = nan, ordered_rate_ = nan;
    std::optional<GeoPoint> interest_;
    Vector3 interest_place_ = Vector3::Zero();
};

}  // namespace mavloom::flight
