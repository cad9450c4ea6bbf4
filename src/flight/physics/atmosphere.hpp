// SPDX-License-Identifier: MIT
// The international standard atmosphere below 11 km (ISO 2533). Private to flight; pure functions.
#pragma once

#include <algorithm>

#include "flight/physics/math.hpp"

namespace mavloom::flight {

inline constexpr double sea_level_pressure = 1013.25;    // hPa
inline constexpr double sea_level_temperature = 288.15;  // K
inline constexpr double temperature_lapse = 0.0065;      // K/m
inline constexpr double pressure_exponent = 5.255876;    // g M / (R L)

// Altitudes are metres above mean sea level. Below -1 km and above 11 km, the values at these limits apply.
[[nodiscard]] inline double temperature_at(double altitude) noexcept {
    return sea_level_temperature - temperature_lapse * std::clamp(altitude, -1000.0, 11'000.0);
}
// hPa.
[[nodiscard]] inline double pressure_at(double altitude) noexcept {
    return sea_level_pressure * math::pow(temperature_at(altitude) / sea_level_temperature, pressure_exponent);
}
[[nodiscard]] inline double altitude_of(double pressure) noexcept {
    const double ratio = math::pow(pressure / sea_level_pressure, 1 / pressure_exponent);
    return sea_level_temperature / temperature_lapse * (1 - ratio);
}
// kg/m^3.
[[nodiscard]] inline double density_at(double altitude) noexcept {
    constexpr double gas_constant = 287.05;  // J/(kg K), dry air
    return 100 * pressure_at(altitude) / (gas_constant * temperature_at(altitude));
}

}  // namespace mavloom::flight
