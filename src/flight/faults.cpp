// SPDX-License-Identifier: MIT
#include "flight/faults.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mavloom/base/counted.hpp"

namespace mavloom::flight {

namespace {

using enum FaultPart;
using enum FaultKind;

constexpr double largest_error_m = 100'000;  // farther away, the local plane differs too much from the earth
constexpr double max_motors = 16;

constexpr FaultForm form(FaultPart part, FaultKind kind) { return {.part = part, .kind = kind}; }
constexpr FaultForm of_number(FaultPart part, FaultKind kind) {
    return {.part = part, .kind = kind, .most = 1, .lowest = 1, .highest = max_motors, .usage = "[NUMBER]"};
}

constexpr std::array forms{
    form(gyroscope, ok),
    form(gyroscope, off),
    form(gyroscope, stuck),
    form(accelerometer, ok),
    form(accelerometer, off),
    form(accelerometer, stuck),
    form(compass, ok),
    form(compass, off),
    form(compass, stuck),
    FaultForm{compass, turn, 1, 1, -180, 180, "DEGREES"},
    form(barometer, ok),
    form(barometer, off),
    form(barometer, stuck),
    FaultForm{barometer, jump, 1, 1, -1000, 1000, "METRES"},
    FaultForm{barometer, drift, 1, 1, -50, 50, "METRES_PER_SECOND"},
    form(gps, ok),
    form(gps, off),
    form(gps, stuck),
    form(gps, wrong),
    FaultForm{gps, jump, 2, 2, -largest_error_m, largest_error_m, "NORTH EAST"},
    FaultForm{gps, drift, 2, 2, -100, 100, "NORTH EAST"},
    form(rangefinder, ok),
    form(rangefinder, off),
    form(rangefinder, stuck),
    form(airspeed, ok),
    form(airspeed, off),
    form(airspeed, stuck),
    form(airspeed, wrong),
    form(battery, ok),
    form(battery, off),
    FaultForm{battery, charge, 1, 1, 0, 100, "PERCENT"},
    of_number(motor, ok),
    of_number(motor, off),
    of_number(esc, ok),
    of_number(esc, off),
    of_number(esc, wrong),
    form(heartbeat, ok),
    form(heartbeat, off),
    form(radio, ok),
    form(radio, off),
    form(sequence, restart),
    form(autopilot, restart),
    form(all, ok),
};

bool is_numbered(FaultPart part) noexcept { return part == motor || part == esc; }

// Motors or ESCs, by number; without one, all.
std::uint16_t mask_of(const Fault& fault) noexcept {
    if (fault.count == 0) return 0xffff;
    return static_cast<std::uint16_t>(1u << (static_cast<unsigned>(fault.numbers[0]) - 1));
}

Failure failure_of(FaultKind kind) noexcept {
    switch (kind) {
        case off: return Failure::off;
        case stuck: return Failure::stuck;
        case wrong: return Failure::wrong;
        default: return Failure::none;
    }
}

void fail_numbered(Failures& failures, const Fault& fault) noexcept {
    const auto mark = [&](std::uint16_t& mask, FaultKind kind) {
        const auto others = static_cast<std::uint16_t>(mask & ~mask_of(fault));
        mask = fault.kind == kind ? static_cast<std::uint16_t>(others | mask_of(fault)) : others;
    };
    if (fault.part == motor) return mark(failures.stopped_motors, off);
    mark(failures.silent_escs, off);
    mark(failures.wrong_escs, wrong);
}

Failure* part_of(Failures& failures, FaultPart part) noexcept {
    switch (part) {
        case gyroscope: return &failures.gyroscope;
        case accelerometer: return &failures.accelerometer;
        case compass: return &failures.magnetometer;
        case barometer: return &failures.barometer;
        case gps: return &failures.gps;
        case rangefinder: return &failures.rangefinder;
        case airspeed: return &failures.airspeed;
        case battery: return &failures.battery;
        default: return nullptr;
    }
}

}  // namespace

std::span<const FaultForm> fault_forms() noexcept { return forms; }

std::string text_of(const Fault& fault) {
    std::string text = fmt::format("{} {}", fault_part_names[static_cast<std::size_t>(fault.part)],
                                   fault_kind_names[static_cast<std::size_t>(fault.kind)]);
    for (std::size_t i = 0; i < fault.count; ++i) text += fmt::format(" {:g}", fault.numbers[i]);
    return text;
}

std::string motor_refusal(const Fault& fault, const Channels& channels) {
    if (!is_numbered(fault.part)) return {};
    const auto motors = std::ranges::count(channels.is_motor, true);
    if (motors == 0) return "a rover's motor does not fail";
    if (fault.count == 0 || fault.numbers[0] <= static_cast<double>(motors)) return {};
    return fmt::format("the vehicle has {}", counted(static_cast<std::uint64_t>(motors), "motor"));
}

void Faults::set(const Fault& fault) {
    if (fault.part == all) return faults_.clear();
    std::erase_if(faults_, [&](const Fault& other) {
        if (other.part != fault.part) return false;
        if (!is_numbered(fault.part) || fault.count == 0) return true;
        return other.count != 0 && other.numbers[0] == fault.numbers[0];
    });
    // One of them works again while all others fail.
    const bool is_exception = fault.count != 0 && std::ranges::any_of(faults_, [&](const Fault& other) {
                                  return other.part == fault.part && other.count == 0;
                              });
    if (fault.kind != ok || is_exception) faults_.push_back(fault);
}

Failures Faults::failures() const noexcept {
    Failures failures;
    for (const Fault& fault : faults_) {
        if (is_numbered(fault.part)) fail_numbered(failures, fault);
        else if (Failure* const part = part_of(failures, fault.part)) *part = failure_of(fault.kind);
    }
    return failures;
}

Deceptions Faults::deceptions() const noexcept {
    Deceptions all_of_them;
    for (const auto& [part, kind, numbers, count] : faults_) {
        const Vector3 horizontal(numbers[0], numbers[1], 0);
        if (part == gps && kind == jump) all_of_them.gps_jump = horizontal;
        if (part == gps && kind == drift) all_of_them.gps_drift = horizontal;
        if (part == barometer && kind == jump) all_of_them.barometer_offset = numbers[0];
        if (part == barometer && kind == drift) all_of_them.barometer_drift = numbers[0];
        if (part == compass && kind == turn) all_of_them.compass_turn = to_radians(numbers[0]);
    }
    return all_of_them;
}

bool Faults::has(FaultPart part) const noexcept {
    return std::ranges::find(faults_, part, &Fault::part) != faults_.end();
}

}  // namespace mavloom::flight
