// SPDX-License-Identifier: MIT
#include "flight/physics/geodesy.hpp"

#include <GeographicLib/AzimuthalEquidistant.hpp>
#include <GeographicLib/Geodesic.hpp>
#include <cmath>

#include "flight/physics/rotation.hpp"
#include "mavloom/flight/options.hpp"

namespace mavloom::flight {

namespace {

const GeographicLib::AzimuthalEquidistant& projection() {
    static const GeographicLib::AzimuthalEquidistant wgs84(GeographicLib::Geodesic::WGS84());
    return wgs84;
}

}  // namespace

Vector3 LocalFrame::to_local(const GeoPoint& point) const {
    double east = 0, north = 0;
    projection().Forward(origin_.latitude, origin_.longitude, point.latitude, point.longitude, east, north);
    return {north, east, origin_.altitude - point.altitude};
}

GeoPoint LocalFrame::to_geo(const Vector3& local) const {
    GeoPoint point{.altitude = origin_.altitude - local.z()};
    projection().Reverse(origin_.latitude, origin_.longitude, local.y(), local.x(), point.latitude, point.longitude);
    return point;
}

double distance_m(const GeoPoint& from, const GeoPoint& to) {
    double distance = 0;
    GeographicLib::Geodesic::WGS84().Inverse(from.latitude, from.longitude, to.latitude, to.longitude, distance);
    return distance;
}

double bearing_rad(const GeoPoint& from, const GeoPoint& to) {
    double first = 0, second = 0;
    GeographicLib::Geodesic::WGS84().Inverse(from.latitude, from.longitude, to.latitude, to.longitude, first, second);
    return wrap_2pi(to_radians(first));
}

std::int32_t to_degrees_e7(double degrees) noexcept {
    return std::abs(degrees) <= 180 ? static_cast<std::int32_t>(std::lround(degrees * 1e7)) : 0;
}

Home moved(const Home& home, double north_m, double east_m) {
    const LocalFrame frame({home.latitude_deg, home.longitude_deg, home.altitude_m});
    const GeoPoint place = frame.to_geo({north_m, east_m, 0});
    return {place.latitude, place.longitude, home.altitude_m, home.heading_deg};
}

}  // namespace mavloom::flight
