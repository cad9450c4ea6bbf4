// SPDX-License-Identifier: MIT
#include "flight/physics/geodesy.hpp"

#include <gmock/gmock.h>

#include <GeographicLib/AzimuthalEquidistant.hpp>
#include <cmath>

#include "flight/physics/random.hpp"

namespace mavloom::flight {
namespace {

GeoPoint any_place(Random& random) {
    return {random.uniform(-89, 89), random.uniform(-180, 180), random.uniform(0, 99)};
}

// Metres, for points that are near each other.
double apart(const GeoPoint& a, const GeoPoint& b) {
    double distance = 0;
    GeographicLib::Geodesic::WGS84().Inverse(a.latitude, a.longitude, b.latitude, b.longitude, distance);
    return distance;
}

class LocalFrameTest : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Distances, LocalFrameTest, ::testing::Values(0.001, 1, 1e3, 1e5, 1e7, 1.9e7));

TEST_P(LocalFrameTest, AgreesWithGeographicLib) {
    const GeographicLib::AzimuthalEquidistant oracle(GeographicLib::Geodesic::WGS84());
    const double tolerance = GetParam() <= 1e5 ? 1e-6 : 2e-3;  // m
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const GeoPoint origin = any_place(random);
        const LocalFrame frame(origin);
        const double bearing = random.uniform(-3.2, 3.2);
        const Vector3 place = GetParam() * Vector3(std::cos(bearing), std::sin(bearing), 0);
        GeoPoint expected;
        oracle.Reverse(origin.latitude, origin.longitude, place.y(), place.x(), expected.latitude, expected.longitude);
        ASSERT_LT(apart(frame.to_geo(place), expected), tolerance) << place.transpose();
        const Vector3 back = frame.to_local(expected);
        ASSERT_LT((back.head<2>() - place.head<2>()).norm(), tolerance) << place.transpose();
    }
}

TEST(GeodesyTest, HeightsAreDifferences) {
    const LocalFrame frame({47, 8, 500});
    EXPECT_EQ(frame.to_local({47, 8, 520}), Vector3(0, 0, -20));
    EXPECT_EQ(frame.to_geo({0, 0, 20}), (GeoPoint{47, 8, 480}));
}

// C. F. F. Karney's example for GeographicLib: from New York to London.
TEST(GeodesyTest, DistanceOfAKnownLine) {
    EXPECT_NEAR(distance_m({40.6, -73.8, 0}, {51.6, -0.5, 0}), 5'551'759.400, 0.001);
}

TEST(GeodesyTest, PolesEquatorAndDateLine) {
    EXPECT_NEAR(distance_m({0, 179.9999, 0}, {0, -179.9999, 0}), 0.0002 * 111'319.4908, 1e-4);
    EXPECT_NEAR(distance_m({90, 0, 0}, {0, 50, 0}), 10'001'965.729, 0.001);  // the quarter of a meridian
    EXPECT_NEAR(LocalFrame({90, 0, 0}).to_geo({-1000, 0, 0}).latitude, 89.99104697, 1e-8);
    EXPECT_NEAR(std::abs(LocalFrame({10, 180, 0}).to_geo({0, 10, 0}).longitude), 179.99990878, 1e-7);
}

// The series does not converge between places on opposite sides of the Earth. The result is finite nevertheless.
TEST(GeodesyTest, OppositeSidesOfTheEarth) {
    const double distance = distance_m({0.5, 0, 0}, {-0.4, 179.8, 0});
    EXPECT_GT(distance, 1.9e7);
    EXPECT_LT(distance, 2.1e7);
}

}  // namespace
}  // namespace mavloom::flight
