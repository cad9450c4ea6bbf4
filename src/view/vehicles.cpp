// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "view/table.hpp"
#include "view/vehicle_text.hpp"
#include "view/words.hpp"

namespace mavloom::view {

namespace {

constexpr std::array<Spec, 12> vehicle_specs{{{" ID", 9, 0, false},
                                              {"TYPE", 16, 1, false},
                                              {"AUTOPILOT", 13, 6, false},
                                              {"MODE", 14, 2, false},
                                              {"ARMED", 7, 3, false},
                                              {"STATE", 10, 7, false},
                                              {"BATTERY", 15, 4, false},
                                              {"GPS", 15, 5, false},
                                              {"ALTITUDE", 10, 8},
                                              {"SPEED", 10, 10},
                                              {"HZ", 9, 9},
                                              {"ROUND TRIP", 12, 11}}};

constexpr std::size_t rate_column = 10;

// From a request to its answer.
std::string round_trip_text(const observe::Vehicle& vehicle) {
    for (const auto* const trip : {&vehicle.timesync, &vehicle.ping, &vehicle.command})
        if (trip->count != 0) return time_text(trip->mean());
    return "-";
}

std::string text_in(std::size_t column, const observe::Vehicle& its, const dialect::Dialect& dialect) {
    switch (column) {
        case 0: return fmt::format(" {}", source_text(its.source));
        case 1: return entry_text(dialect, "MAV_TYPE", its.type);
        case 2: return entry_text(dialect, "MAV_AUTOPILOT", its.autopilot);
        case 3: return its.mode.empty() ? "-" : std::string(its.mode);
        case 4: return its.is_armed ? "armed" : "no";
        case 5: return entry_text(dialect, "MAV_STATE", its.status);
        case 6: return battery_text(its);
        case 7: return gps_text(its, dialect);
        case 8: return its.position ? fmt::format("{:.1f} m", its.position->relative_alt_m) : "-";
        case 9: return its.position ? fmt::format("{:.1f} m/s", its.position->ground_speed_m_s) : "-";
        case rate_column: return hz_text(its.hz);
        default: return round_trip_text(its);
    }
}

class VehicleTable : public Table {
public:
    VehicleTable(const Snapshot& shown, int width) : shown_(shown), ends_(fit(vehicle_specs, 0, width - 1)) {}

    [[nodiscard]] int size() const override { return static_cast<int>(shown_.vehicles.size()); }
    void draw_head(Grid& grid, int y) const override {
        for (std::size_t i = 0; i < vehicle_specs.size(); ++i) put(grid, y, i, vehicle_specs[i].title, Ink::strong);
    }
    void draw_line(Grid& grid, int y, int line) const override {
        const auto& its = shown_.vehicles[static_cast<std::size_t>(line)];
        const bool is_silent = its.is_silent(shown_.now.mono);
        for (std::size_t i = 0; i < vehicle_specs.size(); ++i) {
            const auto ink = is_silent ? Ink::dim : i == 4 && its.is_armed ? Ink::warning : Ink::plain;
            put(grid, y, i, is_silent && i == rate_column ? "-" : text_in(i, its, *shown_.dialect), ink);
        }
        if (is_silent) grid.put(0, y, "!", Ink::warning);
    }

private:
    void put(Grid& grid, int y, std::size_t column, std::string_view text, Ink ink) const {
        put_in(grid, y, vehicle_specs[column], ends_[column], text, ink);
    }

    const Snapshot& shown_;
    const std::vector<int> ends_;
};

}  // namespace

std::string battery_text(const observe::Vehicle& vehicle) {
    if (!vehicle.battery) return "-";
    std::string text;
    if (vehicle.battery->percent) text = fmt::format("{:.0f} %", *vehicle.battery->percent);
    if (vehicle.battery->voltage_v)
        text += fmt::format("{}{:.1f} V", text.empty() ? "" : " ", *vehicle.battery->voltage_v);
    return text.empty() ? "-" : text;
}

std::string gps_text(const observe::Vehicle& vehicle, const dialect::Dialect& dialect) {
    if (!vehicle.gps) return "-";
    auto text = entry_text(dialect, "GPS_FIX_TYPE", vehicle.gps->fix);
    if (vehicle.gps->satellites) text += fmt::format(", {} sat", *vehicle.gps->satellites);
    return text;
}

std::unique_ptr<Table> vehicle_table(const Snapshot& shown, int width) {
    return std::make_unique<VehicleTable>(shown, width);
}

}  // namespace mavloom::view
