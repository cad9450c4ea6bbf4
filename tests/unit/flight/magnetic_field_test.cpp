// SPDX-License-Identifier: MIT
#include "flight/physics/magnetic_field.hpp"

#include <gmock/gmock.h>

namespace mavloom::flight {
namespace {

// X, Y and Z in nT, computed with pygeomag 1.1.0 and the same coefficients. Its total fields of the first three rows
// are those of NOAA's table of test values.
struct FieldCase {
    GeoPoint point;
    double year, x, y, z;
};

class MagneticFieldTest : public ::testing::TestWithParam<FieldCase> {};
INSTANTIATE_TEST_SUITE_P(Places, MagneticFieldTest,
                         ::testing::Values(FieldCase{{14, 143, 66'000}, 2025, 35003.4, -116.6, 7966.3},
                                           FieldCase{{0, 21, 18'000}, 2025, 29274.8, 659.8, -14316.7},
                                           FieldCase{{-59, -8, 39'000}, 2025, 14358.1, -4049.1, -24389.1},
                                           FieldCase{{80, 0, 0}, 2027.5, 6500.8, 294.5, 54869.4},
                                           FieldCase{{-80, 240, 100'000}, 2027.5, 5984.0, 14760.1, -49317.7},
                                           FieldCase{{47.397742, 8.545594, 489.4}, 2027.5, 21528.0, 1404.8, 43361.3},
                                           FieldCase{{-35.363, 149.165, 584}, 2027.5, 22994.6, 5185.9, -53062.7},
                                           FieldCase{{37.41, -122, 0}, 2027.5, 22422.3, 5023.2, 41125.7}));

TEST_P(MagneticFieldTest, IsThatOfTheWorldMagneticModel) {
    const FieldCase& given = GetParam();
    const Vector3 field = magnetic_field(given.point, given.year) * 1e5;
    EXPECT_NEAR(field.x(), given.x, 0.1);
    EXPECT_NEAR(field.y(), given.y, 0.1);
    EXPECT_NEAR(field.z(), given.z, 0.1);
}

// North and east turn with the longitude there; the field itself does not.
TEST(MagneticFieldAtPolesTest, HasNoHoleAtThePoles) {
    const Vector3 at = magnetic_field({90, 10, 0}), near = magnetic_field({89.9999, 10, 0});
    EXPECT_LT((at - near).norm(), 1e-4);
    EXPECT_NEAR(magnetic_field({-90, 0, 0}).norm(), magnetic_field({-90, 77, 0}).norm(), 1e-9);
}

}  // namespace
}  // namespace mavloom::flight
