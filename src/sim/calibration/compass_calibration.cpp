// SPDX-License-Identifier: MIT
#include "sim/calibration/compass_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mavloom/msg/enums/mag_cal_status.hpp"
#include "mavloom/msg/mag_cal_progress.hpp"
#include "mavloom/msg/mag_cal_report.hpp"
#include "sim/parts.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

constexpr Nanoseconds compass_report_interval = std::chrono::milliseconds{250};
// ArduPilot counts its first step as a third of the whole.
constexpr Nanoseconds step_one = std::chrono::seconds{4}, step_two = std::chrono::seconds{8};
constexpr double percent_one = 33, percent_two = 99;

constexpr unsigned sections = 80;      // of the sphere, in MAG_CAL_PROGRESS.completion_mask
constexpr float fitness = 2;           // mGauss; up to COMPASS_CAL_FIT is good
constexpr float longest_delay = 3600;  // s
constexpr float largest_mask = 255;
constexpr std::uint32_t all_compasses = 0;  // as a mask in commands

constexpr std::array<std::string_view, 3> suffixes{"", "2", "3"};
constexpr std::array<std::string_view, 3> axes{"X", "Y", "Z"};
constexpr std::array<float, 3> offsets{5, 13, -18};  // mGauss

bool is_chosen(std::uint32_t mask, std::size_t index) noexcept {
    return mask == all_compasses || (mask >> index & 1) != 0;
}

}  // namespace

// --- One compass

bool CompassCalibration::Compass::is_done(FlightTime now) const noexcept {
    return is_started() && now >= begins && now - begins >= step_one + step_two;
}

std::uint8_t CompassCalibration::Compass::status(FlightTime now) const noexcept {
    if (!is_started()) return MAG_CAL_NOT_STARTED;
    if (now < begins) return MAG_CAL_WAITING_TO_START;
    if (is_done(now)) return MAG_CAL_SUCCESS;
    return now - begins < step_one ? MAG_CAL_RUNNING_STEP_ONE : MAG_CAL_RUNNING_STEP_TWO;
}

std::uint8_t CompassCalibration::Compass::percent(FlightTime now) const noexcept {
    if (!is_started() || now < begins) return 0;
    const auto share = [](Nanoseconds time, Nanoseconds of) {
        return std::clamp(static_cast<double>(time.count()) / static_cast<double>(of.count()), 0.0, 1.0);
    };
    const Nanoseconds passed = now - begins;
    const double of_two = (percent_two - percent_one) * share(passed - step_one, step_two);
    return static_cast<std::uint8_t>(percent_one * share(passed, step_one) + of_two);
}

// --- Commands

Outcome CompassCalibration::start(const Command& command, Moment now) {
    if (parts_.flight.armed()) {
        parts_.on_text(Severity::notice, "Disarm to allow compass calibration");
        return Result::failed;
    }
    const bool calibrates_another = parts_.flight.is_calibrating() && !is_calibrating_;
    if (calibrates_another) return Result::temporarily_rejected;
    const auto mask = command.whole(1, largest_mask);
    const float delay = command.param(4);
    if (!mask || std::isnan(delay)) return Result::failed;
    const auto wait = std::chrono::duration<double>(std::clamp(delay, 0.0f, longest_delay));
    // As ArduPilot, also if the command then fails.
    saves_by_itself_ = command.param(3) != 0;
    reboots_by_itself_ = command.param(5) != 0;
    return begin(*mask, now.flight + std::chrono::duration_cast<Nanoseconds>(wait), now.flight) ? Result::accepted
                                                                                                : Result::failed;
}

// With all compasses, those that are not in use are left out; a mask must name none of them.
bool CompassCalibration::begin(std::uint32_t mask, FlightTime begins, FlightTime now) {
    bool has_started = false;
    for (std::size_t i = 0; i < compasses_.size(); ++i) {
        if (!is_chosen(mask, i)) continue;
        if (!is_usable(i)) {
            if (mask == all_compasses) continue;
            stop(mask);
            return false;
        }
        if (!compasses_[i].is_started() || compasses_[i].is_done(now)) compasses_[i] = {.begins = begins};
        has_started = true;
    }
    if (!has_started) return false;
    parts_.put_parameter("COMPASS_LEARN", 0);
    parts_.flight.set_calibrating(true);
    parts_.flight.require_reboot(unready_compass_calibrated);  // also if the calibration is cancelled
    is_calibrating_ = true;
    next_ = now + compass_report_interval;
    return true;
}

// Clients may accept without having calibrated. A calibration that is not done yet is lost.
Outcome CompassCalibration::accept(const Command& command, Moment now) {
    const auto mask = command.whole(1, largest_mask);
    if (!mask) return Result::failed;
    bool all_done = true;
    for (std::size_t i = 0; i < compasses_.size(); ++i) {
        if (!is_chosen(*mask, i) || !compasses_[i].is_started()) continue;
        if (!compasses_[i].is_done(now.flight)) {
            all_done = false;
        } else if (!compasses_[i].is_saved) {
            save(i);
        }
    }
    stop(*mask);
    return all_done ? Result::accepted : Result::failed;
}

Outcome CompassCalibration::cancel(const Command& command) {
    const auto mask = command.whole(1, largest_mask);
    if (!mask) return Result::failed;
    stop(*mask);
    return Result::accepted;
}

Outcome CompassCalibration::calibrate_by_heading(const Command& command) {
    const bool has_place = command.param(3) != 0 || command.param(4) != 0;
    if (!has_place && !parts_.flight.sensors().has_position()) {
        parts_.on_text(Severity::error, "Mag: no position available");
        return Result::failed;
    }
    const auto mask = command.whole(2, largest_mask);
    if (!mask || std::isnan(command.param(1))) return Result::failed;
    for (std::size_t i = 0; i < compasses_.size(); ++i)
        if (is_chosen(*mask, i) && is_usable(i)) save(i);
    return Result::accepted;
}

// --- Progress

void CompassCalibration::pump(Moment now) {
    if (now.flight < next_) return;
    next_ = now.flight + compass_report_interval;
    for (std::size_t i = 0; i < compasses_.size(); ++i) {
        if (!compasses_[i].is_started()) continue;
        if (!compasses_[i].is_done(now.flight)) {
            send_progress(i, now.flight);
            continue;
        }
        if (saves_by_itself_ && !compasses_[i].is_saved) save(i);
        send_report(i);
    }
    if (is_calibrating_ && !is_running(now.flight)) end();
}

void CompassCalibration::end() {
    is_calibrating_ = false;
    parts_.flight.set_calibrating(false);
    if (reboots_by_itself_) parts_.reboot(true);
}

void CompassCalibration::stop(std::uint32_t mask) {
    for (std::size_t i = 0; i < compasses_.size(); ++i)
        if (is_chosen(mask, i)) compasses_[i] = {};
    if (started() != 0) return;
    next_ = FlightTime::max();
    if (std::exchange(is_calibrating_, false)) parts_.flight.set_calibrating(false);
}

void CompassCalibration::reboot() { stop(all_compasses); }

bool CompassCalibration::is_usable(std::size_t index) const noexcept {
    const auto value = [&](std::string_view name, double fallback) {
        return parts_.parameters.get(fmt::format("COMPASS_{}{}", name, suffixes[index]), fallback);
    };
    const bool is_first = index == 0;
    return value("DEV_ID", is_first ? 1 : 0) != 0 && value("USE", is_first ? 1 : 0) != 0 &&
           !is_frozen(parts_.flight.sensors().failures().magnetometer);
}

bool CompassCalibration::is_running(FlightTime now) const noexcept {
    return std::ranges::any_of(compasses_, [&](const Compass& c) { return c.is_started() && !c.is_done(now); });
}

std::uint8_t CompassCalibration::started() const noexcept {
    unsigned mask = 0;
    for (std::size_t i = 0; i < compasses_.size(); ++i) mask |= unsigned{compasses_[i].is_started()} << i;
    return static_cast<std::uint8_t>(mask);
}

// The results: an offset, and no correction of the sphere's shape.
void CompassCalibration::save(std::size_t index) {
    compasses_[index].is_saved = true;
    const auto put = [&](std::string_view name, std::string_view axis, double value) {
        parts_.put_parameter(fmt::format("COMPASS_{}{}{}", name, suffixes[index], axis), value);
    };
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        put("OFS", fmt::format("_{}", axes[axis]), double{offsets[axis]});
        put("DIA", fmt::format("_{}", axes[axis]), 1);
        put("ODI", fmt::format("_{}", axes[axis]), 0);
    }
    put("SCALE", "", 1);
}

void CompassCalibration::send_progress(std::size_t index, FlightTime now) {
    const std::uint8_t percent = compasses_[index].percent(now);
    MagCalProgress message{.compass_id = static_cast<std::uint8_t>(index),
                           .cal_mask = started(),
                           .cal_status = compasses_[index].status(now),
                           .attempt = 1,
                           .completion_pct = percent};
    for (unsigned section = 0; section < sections * percent / 100u; ++section)
        message.completion_mask[section / 8] |= static_cast<std::uint8_t>(1u << section % 8);
    parts_.radio.broadcast(message);
}

void CompassCalibration::send_report(std::size_t index) {
    parts_.radio.broadcast(MagCalReport{.compass_id = static_cast<std::uint8_t>(index),
                                        .cal_mask = started(),
                                        .cal_status = MAG_CAL_SUCCESS,
                                        .autosaved = compasses_[index].is_saved,
                                        .fitness = fitness,
                                        .ofs_x = offsets[0],
                                        .ofs_y = offsets[1],
                                        .ofs_z = offsets[2],
                                        .diag_x = 1,
                                        .diag_y = 1,
                                        .diag_z = 1,
                                        .scale_factor = 1});
}

}  // namespace mavloom::sim
