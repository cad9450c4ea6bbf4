// SPDX-License-Identifier: MIT
// The magnetic field of the earth, by the World Magnetic Model 2025 (WMM2025) of NOAA's National Centers for
// Environmental Information and the British Geological Survey, which is in the public domain. Private to flight; pure
// functions.
#pragma once

#include "flight/physics/geodesy.hpp"
#include "flight/physics/rotation.hpp"

namespace mavloom::flight {

// The model's years are 2025 to 2030.
inline constexpr double usual_field_year = 2027.5;

// Gauss; north, east, down. Altitudes above mean sea level count as heights above the ellipsoid: at most 0.01 % off.
[[nodiscard]] Vector3 magnetic_field(const GeoPoint& point, double year = usual_field_year);

}  // namespace mavloom::flight
