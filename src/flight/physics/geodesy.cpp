// SPDX-License-Identifier: MIT
// Geodesics by T. Vincenty, "Direct and inverse solutions of geodesics on the ellipsoid with application of nested
// equations", Survey Review 23 (1975): within 0.1 mm. Names follow that paper, with spheres' angles spelt out.
#include "flight/physics/geodesy.hpp"

#include <cmath>

#include "flight/physics/math.hpp"
#include "flight/physics/rotation.hpp"
#include "mavloom/flight/options.hpp"

namespace mavloom::flight {

namespace {

constexpr double semi_minor = semi_major * (1 - flattening);
constexpr int max_rounds = 20;  // three are usual; points on opposite sides of the Earth do not converge

struct SineCosine {
    double sine, cosine;
};
SineCosine of_angle(double angle) noexcept { return {math::sin(angle), math::cos(angle)}; }

// Of the reduced latitude: that on the sphere that touches the ellipsoid along the equator.
SineCosine reduced_latitude(double degrees) noexcept {
    const auto [sine, cosine] = of_angle(to_radians(degrees));
    const double out = cosine, up = (1 - flattening) * sine, length = math::hypot(out, up);
    return {up / length, out / length};
}

// A geodesic, by the sine of its bearing at the equator.
struct Geodesic {
    explicit Geodesic(double sine_at_equator) noexcept
        : sine(sine_at_equator), squared_cosine(1 - sine_at_equator * sine_at_equator) {
        constexpr double stretch = (semi_major * semi_major - semi_minor * semi_minor) / (semi_minor * semi_minor);
        const double u = squared_cosine * stretch;
        a = 1 + u / 16384 * (4096 + u * (-768 + u * (320 - 175 * u)));
        b = u / 1024 * (256 + u * (-128 + u * (74 - 47 * u)));
        c = flattening / 16 * squared_cosine * (4 + flattening * (4 - 3 * squared_cosine));
    }
    // The angle on the sphere exceeds, by this much, the distance over `semi_minor` * a. `middle` is the cosine of
    // twice the angle from the equator to the middle of the arc.
    [[nodiscard]] double angle_excess(const SineCosine& arc, double middle) const noexcept {
        const double square = 2 * middle * middle - 1;
        return b * arc.sine *
               (middle +
                b / 4 * (arc.cosine * square - b / 6 * middle * (4 * arc.sine * arc.sine - 3) * (2 * square - 1)));
    }
    // By this much, the longitude on the sphere exceeds that on the ellipsoid.
    [[nodiscard]] double longitude_excess(double angle, const SineCosine& arc, double middle) const noexcept {
        const double square = 2 * middle * middle - 1;
        return (1 - c) * flattening * sine * (angle + c * arc.sine * (middle + c * arc.cosine * square));
    }

    double sine, squared_cosine, a, b, c;
};

}  // namespace

Vector3 LocalFrame::to_local(const GeoPoint& point) const {
    const SineCosine from = reduced_latitude(origin_.latitude), to = reduced_latitude(point.latitude);
    const double turn = wrap_pi(to_radians(point.longitude - origin_.longitude));
    double longitude = turn, distance = 0, north = 0, east = 0;
    for (int round = 0; round < max_rounds; ++round) {
        const SineCosine side = of_angle(longitude);
        east = to.cosine * side.sine;
        north = from.cosine * to.sine - from.sine * to.cosine * side.cosine;
        const SineCosine arc{math::hypot(north, east), from.sine * to.sine + from.cosine * to.cosine * side.cosine};
        if (arc.sine == 0) return {0, 0, origin_.altitude - point.altitude};
        const double angle = math::atan2(arc.sine, arc.cosine);
        const Geodesic line(from.cosine * east / arc.sine);
        const double middle = line.squared_cosine > 0 ? arc.cosine - 2 * from.sine * to.sine / line.squared_cosine : 0;
        // Per unit of `north` and `east`.
        distance = semi_minor * line.a * (angle - line.angle_excess(arc, middle)) / arc.sine;
        const double last = longitude;
        longitude = turn + line.longitude_excess(angle, arc, middle);
        if (std::abs(longitude - last) < 1e-15) break;
    }
    return {north * distance, east * distance, origin_.altitude - point.altitude};
}

GeoPoint LocalFrame::to_geo(const Vector3& local) const {
    const double distance = math::hypot(local.x(), local.y());
    GeoPoint point{origin_.latitude, origin_.longitude, origin_.altitude - local.z()};
    if (distance == 0) return point;
    const SineCosine from = reduced_latitude(origin_.latitude), bearing{local.y() / distance, local.x() / distance};
    const Geodesic line(from.cosine * bearing.sine);
    const double start = math::atan2(from.sine, from.cosine * bearing.cosine);
    const double unbent = distance / (semi_minor * line.a);
    double angle = unbent, middle = 0;
    SineCosine arc{};
    for (int round = 0; round < max_rounds; ++round) {
        arc = of_angle(angle);
        middle = math::cos(2 * start + angle);
        const double last = angle;
        angle = unbent + line.angle_excess(arc, middle);
        if (std::abs(angle - last) < 1e-15) break;
    }
    arc = of_angle(angle);
    const double out = from.cosine * arc.cosine - from.sine * arc.sine * bearing.cosine;
    const double up = from.sine * arc.cosine + from.cosine * arc.sine * bearing.cosine;
    const double turn = math::atan2(arc.sine * bearing.sine, out) - line.longitude_excess(angle, arc, middle);
    const double across = (1 - flattening) * math::hypot(out, arc.sine * bearing.sine);
    point.latitude = to_degrees(math::atan2(up, across));
    point.longitude = to_degrees(wrap_pi(to_radians(origin_.longitude) + turn));
    return point;
}

double distance_m(const GeoPoint& from, const GeoPoint& to) {
    const Vector3 way = LocalFrame(from).to_local(to);
    return math::hypot(way.x(), way.y());
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
