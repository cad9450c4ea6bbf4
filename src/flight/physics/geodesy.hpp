// SPDX-License-Identifier: MIT
// Positions on the WGS 84 ellipsoid, and the local frame around an origin. Private to flight, sim and hil.
//
// The local frame is north, east, down in metres. Its horizontal plane is the azimuthal equidistant projection around
// the origin: a point's distance and bearing from the origin are those of the geodesic.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace mavloom::flight {

using Vector3 = Eigen::Vector3d;

inline constexpr double semi_major = 6'378'137, flattening = 1 / 298.257223563;  // m; of WGS 84

struct GeoPoint {
    double latitude = 0, longitude = 0;  // degrees
    double altitude = 0;                 // metres above mean sea level
    friend bool operator==(const GeoPoint&, const GeoPoint&) = default;
};

class LocalFrame {
public:
    explicit LocalFrame(const GeoPoint& origin) noexcept : origin_(origin) {}

    [[nodiscard]] const GeoPoint& origin() const noexcept { return origin_; }
    [[nodiscard]] Vector3 to_local(const GeoPoint& point) const;
    [[nodiscard]] GeoPoint to_geo(const Vector3& local) const;

private:
    GeoPoint origin_;
};

// The geodesic between two points, without their altitudes.
[[nodiscard]] double distance_m(const GeoPoint& from, const GeoPoint& to);

// Degrees times 1e7, rounded, as messages carry them.
[[nodiscard]] std::int32_t to_degrees_e7(double degrees) noexcept;
[[nodiscard]] constexpr double from_degrees_e7(std::int32_t value) noexcept { return value * 1e-7; }

}  // namespace mavloom::flight
