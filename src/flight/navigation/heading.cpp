// SPDX-License-Identifier: MIT
#include "flight/navigation/heading.hpp"

#include <cmath>

#include "flight/physics/math.hpp"

namespace mavloom::flight {

namespace {

constexpr double close = 2;  // m; nearer than this, the direction to a point means nothing

}  // namespace

void Heading::turn_to(double yaw, double rate) noexcept {
    ordered_ = std::isfinite(yaw) ? wrap_pi(yaw) : nan;
    ordered_rate_ = rate;
    if (std::isnan(ordered_)) keep();
}

void Heading::set_roi(const std::optional<GeoPoint>& point) {
    interest_ = point;
    if (point) interest_place_ = context_.craft.frame().to_local(*point);
    keep();
}

double Heading::yaw_for(const Vector3& way, double wanted) noexcept {
    const Vector3 view = interest_place_ - context_.craft.estimate().position;
    if (std::isfinite(wanted)) {
        kept_ = wrap_pi(wanted);
    } else if (std::isfinite(ordered_)) {
        kept_ = ordered_;
    } else if (interest_) {
        if (math::hypot(view.x(), view.y()) > close) kept_ = math::atan2(view.y(), view.x());
    } else if (math::hypot(way.x(), way.y()) > close) {
        kept_ = math::atan2(way.y(), way.x());
    }
    return kept_;
}

double Heading::fastest() const noexcept {
    const double usual = context_.tuning.max_yaw_rate;
    return ordered_rate_ > 0 ? std::min(ordered_rate_, 2 * usual) : usual;
}

}  // namespace mavloom::flight
