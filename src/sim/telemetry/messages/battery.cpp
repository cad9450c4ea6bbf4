// SPDX-License-Identifier: MIT
#include "flight/wire_units.hpp"
#include "mavloom/msg/battery_status.hpp"
#include "mavloom/msg/enums/mav_battery_charge_state.hpp"
#include "mavloom/msg/enums/mav_battery_function.hpp"
#include "mavloom/msg/enums/mav_battery_type.hpp"
#include "sim/telemetry/projections.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

std::uint8_t charge_state(const Battery& battery, const Tuning& tuning) noexcept {
    const double left = battery.remaining();
    if (left < tuning.battery_emergency) return MAV_BATTERY_CHARGE_STATE_EMERGENCY;
    if (left < tuning.battery_critical) return MAV_BATTERY_CHARGE_STATE_CRITICAL;
    return left < tuning.battery_low ? MAV_BATTERY_CHARGE_STATE_LOW : MAV_BATTERY_CHARGE_STATE_OK;
}

// Cells of equal voltage whose sum is exactly the battery's; fields without a cell are UINT16_MAX.
std::array<std::uint16_t, 10> cell_voltages(const Battery& battery) noexcept {
    const unsigned total = battery_on_wire(battery).millivolts;
    const unsigned cells = std::clamp<unsigned>(battery.cells(), 1, 10);
    std::array<std::uint16_t, 10> voltages;
    for (unsigned i = 0; i < voltages.size(); ++i)
        voltages[i] = static_cast<std::uint16_t>(i < cells ? (total + i) / cells : 0xffff);
    return voltages;
}

}  // namespace

BatteryOnWire battery_on_wire(const Battery& battery) noexcept {
    return {.millivolts = saturated<std::uint16_t>(battery.voltage() * 1e3),
            .centiamperes = saturated<std::int16_t>(battery.current() * 1e2),
            .percent = saturated<std::int8_t>(std::ceil(std::clamp(battery.remaining() * 100, 0.0, 100.0)))};
}

bool write_battery_status(const View& view, ByteSpan payload) {
    constexpr std::int16_t unknown_temperature = 0x7fff;
    const Battery& battery = view.flight.battery();
    const BatteryOnWire now = battery_on_wire(battery);
    return put(BatteryStatus{.battery_function = MAV_BATTERY_FUNCTION_ALL,
                             .type = MAV_BATTERY_TYPE_LIPO,
                             .temperature = unknown_temperature,
                             .voltages = cell_voltages(battery),
                             .current_battery = now.centiamperes,
                             .current_consumed = saturated<std::int32_t>(battery.used_mah()),
                             .energy_consumed = saturated<std::int32_t>(battery.used_joule() / 100),
                             .battery_remaining = now.percent,
                             .time_remaining = saturated<std::int32_t>(battery.seconds_left()),
                             .charge_state = charge_state(battery, view.flight.tuning())},
               payload);
}

}  // namespace mavloom::sim
