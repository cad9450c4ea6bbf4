// SPDX-License-Identifier: MIT
#include "flight/physics/magnetic_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "flight/physics/math.hpp"

namespace mavloom::flight {

namespace {

constexpr int degree = 12;

struct Coefficient {
    double g, h;            // nT, at the beginning of 2025
    double g_rate, h_rate;  // nT a year
};
// Of degree n and order m in the order (1, 0), (1, 1), (2, 0) ... as in the file WMM.COF of 2024-11-13.
constexpr std::array<Coefficient, 90> coefficients{{
    {-29351.8, 0, 12, 0},
    {-1410.8, 4545.4, 9.7, -21.5},
    {-2556.6, 0, -11.6, 0},
    {2951.1, -3133.6, -5.2, -27.7},
    {1649.3, -815.1, -8, -12.1},
    {1361, 0, -1.3, 0},
    {-2404.1, -56.6, -4.2, 4},
    {1243.8, 237.5, 0.4, -0.3},
    {453.6, -549.5, -15.6, -4.1},
    {895, 0, -1.6, 0},
    {799.5, 278.6, -2.4, -1.1},
    {55.7, -133.9, -6, 4.1},
    {-281.1, 212, 5.6, 1.6},
    {12.1, -375.6, -7, -4.4},
    {-233.2, 0, 0.6, 0},
    {368.9, 45.4, 1.4, -0.5},
    {187.2, 220.2, 0, 2.2},
    {-138.7, -122.9, 0.6, 0.4},
    {-142, 43, 2.2, 1.7},
    {20.9, 106.1, 0.9, 1.9},
    {64.4, 0, -0.2, 0},
    {63.8, -18.4, -0.4, 0.3},
    {76.9, 16.8, 0.9, -1.6},
    {-115.7, 48.8, 1.2, -0.4},
    {-40.9, -59.8, -0.9, 0.9},
    {14.9, 10.9, 0.3, 0.7},
    {-60.7, 72.7, 0.9, 0.9},
    {79.5, 0, 0, 0},
    {-77, -48.9, -0.1, 0.6},
    {-8.8, -14.4, -0.1, 0.5},
    {59.3, -1, 0.5, -0.8},
    {15.8, 23.4, -0.1, 0},
    {2.5, -7.4, -0.8, -1},
    {-11.1, -25.1, -0.8, 0.6},
    {14.2, -2.3, 0.8, -0.2},
    {23.2, 0, -0.1, 0},
    {10.8, 7.1, 0.2, -0.2},
    {-17.5, -12.6, 0, 0.5},
    {2, 11.4, 0.5, -0.4},
    {-21.7, -9.7, -0.1, 0.4},
    {16.9, 12.7, 0.3, -0.5},
    {15, 0.7, 0.2, -0.6},
    {-16.8, -5.2, 0, 0.3},
    {0.9, 3.9, 0.2, 0.2},
    {4.6, 0, 0, 0},
    {7.8, -24.8, -0.1, -0.3},
    {3, 12.2, 0.1, 0.3},
    {-0.2, 8.3, 0.3, -0.3},
    {-2.5, -3.3, -0.3, 0.3},
    {-13.1, -5.2, 0, 0.2},
    {2.4, 7.2, 0.3, -0.1},
    {8.6, -0.6, -0.1, -0.2},
    {-8.7, 0.8, 0.1, 0.4},
    {-12.9, 10, -0.1, 0.1},
    {-1.3, 0, 0.1, 0},
    {-6.4, 3.3, 0, 0},
    {0.2, 0, 0.1, 0},
    {2, 2.4, 0.1, -0.2},
    {-1, 5.3, 0, 0.1},
    {-0.6, -9.1, -0.3, -0.1},
    {-0.9, 0.4, 0, 0.1},
    {1.5, -4.2, -0.1, 0},
    {0.9, -3.8, -0.1, -0.1},
    {-2.7, 0.9, 0, 0.2},
    {-3.9, -9.1, 0, 0},
    {2.9, 0, 0, 0},
    {-1.5, 0, 0, 0},
    {-2.5, 2.9, 0, 0.1},
    {2.4, -0.6, 0, 0},
    {-0.6, 0.2, 0, 0.1},
    {-0.1, 0.5, -0.1, 0},
    {-0.6, -0.3, 0, 0},
    {-0.1, -1.2, 0, 0.1},
    {1.1, -1.7, -0.1, 0},
    {-1, -2.9, -0.1, 0},
    {-0.2, -1.8, -0.1, 0},
    {2.6, -2.3, -0.1, 0},
    {-2, 0, 0, 0},
    {-0.2, -1.3, 0, 0},
    {0.3, 0.7, 0, 0},
    {1.2, 1, 0, -0.1},
    {-1.3, -1.4, 0, 0.1},
    {0.6, 0, 0, 0},
    {0.6, 0.6, 0.1, 0},
    {0.5, -0.1, 0, 0},
    {-0.1, 0.8, 0, 0},
    {-0.4, 0.1, 0, 0},
    {-0.2, -1, -0.1, 0},
    {-1.3, 0.1, 0, 0},
    {-0.7, 0.2, -0.1, -0.1},
}};
constexpr double epoch = 2025, reference_radius = 6'371'200;  // m

constexpr std::size_t place_of(int n, int m) noexcept {
    const int place = n * (n + 1) / 2 + m;
    return static_cast<std::size_t>(place);
}
constexpr std::size_t places = place_of(degree, degree) + 1;
using Functions = std::array<double, places>;

// A point in geocentric coordinates.
struct Spherical {
    double radius, sine, cosine;  // m; of the latitude
    double turn;                  // rad, from the geocentric to the geodetic vertical
};
Spherical to_spherical(const GeoPoint& point) {
    constexpr double squared = flattening * (2 - flattening);
    const double latitude = to_radians(point.latitude), sine = math::sin(latitude);
    const double curvature = semi_major / std::sqrt(1 - squared * sine * sine);
    const double out = (curvature + point.altitude) * math::cos(latitude);
    const double up = (curvature * (1 - squared) + point.altitude) * sine;
    const double radius = math::hypot(out, up);
    constexpr double smallest = 1e-10;  // at a pole, east is still the limit of east nearby
    return {radius, up / radius, std::max(out / radius, smallest), math::atan2(up, out) - latitude};
}

// Schmidt's quasi-normal associated Legendre functions of the sine of the latitude, and their derivatives by the
// latitude.
struct Legendre {
    Functions value{}, slope{};
};
Legendre legendre(double sine, double cosine) {
    Legendre p;
    p.value[0] = 1;
    for (int n = 1; n <= degree; ++n) {
        for (int m = 0; m <= n; ++m) {
            const std::size_t at = place_of(n, m);
            if (m == n) {
                const double scale = n == 1 ? 1 : std::sqrt(1 - 0.5 / n);
                const std::size_t last = place_of(n - 1, n - 1);
                p.value[at] = scale * cosine * p.value[last];
                p.slope[at] = scale * (cosine * p.slope[last] - sine * p.value[last]);
                continue;
            }
            const std::size_t last = place_of(n - 1, m);
            const double scale = 1 / std::sqrt(n * n - m * m);
            p.value[at] = scale * (2 * n - 1) * sine * p.value[last];
            p.slope[at] = scale * (2 * n - 1) * (sine * p.slope[last] + cosine * p.value[last]);
            if (m > n - 2) continue;
            const std::size_t before = place_of(n - 2, m);
            const double weight = scale * std::sqrt((n - 1) * (n - 1) - m * m);
            p.value[at] -= weight * p.value[before];
            p.slope[at] -= weight * p.slope[before];
        }
    }
    return p;
}

// The sum of the model in geocentric north, east, down; nT.
Vector3 sum_of(const Spherical& at, double longitude, double years) {
    const Legendre p = legendre(at.sine, at.cosine);
    const double shrink = reference_radius / at.radius;
    Vector3 field = Vector3::Zero();
    double power = shrink * shrink;
    for (int n = 1; n <= degree; ++n) {
        power *= shrink;
        for (int m = 0; m <= n; ++m) {
            const std::size_t place = place_of(n, m);
            const Coefficient& c = coefficients[place - 1];
            const double g = c.g + years * c.g_rate, h = c.h + years * c.h_rate;
            const double cos_m = math::cos(m * longitude), sin_m = math::sin(m * longitude);
            const double even = g * cos_m + h * sin_m, odd = g * sin_m - h * cos_m;
            field += power * Vector3(-even * p.slope[place], m * odd * p.value[place] / at.cosine,
                                     -(n + 1) * even * p.value[place]);
        }
    }
    return field;
}

}  // namespace

// Source: NOAA, "The US/UK World Magnetic Model for 2025-2030", section 1.2.
Vector3 magnetic_field(const GeoPoint& point, double year) {
    const Spherical at = to_spherical(point);
    const Vector3 field = sum_of(at, to_radians(point.longitude), year - epoch);
    const double sine = math::sin(at.turn), cosine = math::cos(at.turn);
    constexpr double gauss = 1e-5;  // per nT
    return gauss * Vector3(field.x() * cosine - field.z() * sine, field.y(), field.x() * sine + field.z() * cosine);
}

}  // namespace mavloom::flight
