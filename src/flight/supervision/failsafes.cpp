// SPDX-License-Identifier: MIT
#include "flight/supervision/failsafes.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <string>
#include <utility>

namespace mavloom::flight {

namespace {

constexpr unsigned fence_period = 5;  // updates between two looks at the fence

// ArduPilot's names of fences, by the bits of Fence::Breach: "Max Alt and Polygon fences".
std::string names_of(unsigned breaches) {
    constexpr std::array<std::string_view, 3> names{"Max Alt", "Circle", "Polygon"};
    std::string all;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if ((breaches >> i & 1) == 0) continue;
        const bool is_last = breaches >> (i + 1) == 0;
        if (!all.empty()) all += is_last ? " and " : ", ";
        all += names[i];
    }
    return all + (std::has_single_bit(breaches) ? " fence" : " fences");
}

}  // namespace

void Failsafes::update() {
    watch_battery();
    watch_ground_station();
    watch_setpoints();
    watch_sticks();
    watch_position();
    if (++state_.updates % fence_period == 0) watch_fence();
}

void Failsafes::judge(bool& was_present, bool is_present, FailsafeAction action, std::string_view text) {
    if (std::exchange(was_present, is_present) == is_present) return;
    if (!is_present) return commander_.resume();
    if (is_px4()) context_.say(Severity::critical, text);
    commander_.perform(action);
    if (!is_px4()) context_.say(Severity::warning, filled(text, commander_.mode().name));
}

Failsafes::BatteryLevel Failsafes::battery_level() const noexcept {
    const double share = context_.craft.battery().remaining();
    const Tuning& tuning = context_.tuning;
    if (share < tuning.battery_emergency) return BatteryLevel::emergency;
    if (share < tuning.battery_critical) return BatteryLevel::critical;
    return share < tuning.battery_low ? BatteryLevel::low : BatteryLevel::good;
}

// Each level is announced once, by ArduPilot only while armed. The vehicle acts on it in the air, and does not continue
// afterwards.
void Failsafes::watch_battery() {
    if (!is_px4() && !context_.armed) return;
    const BatteryLevel level = battery_level();
    if (std::exchange(state_.battery, level) >= level) return;
    announce(level);
    if (context_.is_on_ground()) return;
    if (level == BatteryLevel::critical) commander_.perform(context_.tuning.on_battery_critical);
    if (level == BatteryLevel::emergency) commander_.perform(context_.tuning.on_battery_emergency);
}

void Failsafes::announce(BatteryLevel level) const {
    const Texts& texts = context_.texts();
    const std::array<std::string_view, 4> text{"", texts.battery_low, texts.battery_critical, texts.battery_emergency};
    constexpr std::array severity{Severity::info, Severity::warning, Severity::critical, Severity::emergency};
    const auto index = static_cast<std::size_t>(level);
    const Battery& battery = context_.craft.battery();
    const std::string with_volts = filled(text[index], fmt::format("{:.2f}", battery.voltage()));
    context_.say(is_px4() ? severity[index] : Severity::warning,
                 filled(with_volts, fmt::format("{:.0f}", battery.used_mah())));
    context_.say(Severity::warning, texts.battery_acts);
}

// ArduPilot does not watch for the ground station unless a parameter asks for it.
void Failsafes::watch_ground_station() {
    const auto& sign = inputs_.ground_station;
    const bool watches = is_px4() || context_.tuning.on_gcs_loss != FailsafeAction::none;
    const bool is_lost = watches && sign.was_heard() && !sign.is_fresh(context_.input_time(), context_.tuning.gcs_loss);
    const bool had_it = !state_.lacks_ground_station;
    judge(state_.lacks_ground_station, is_lost, context_.tuning.on_gcs_loss, context_.texts().gcs_lost);
    const bool is_info = is_px4() || context_.kind() == Kind::rover;
    if (!had_it && !is_lost) context_.say(is_info ? Severity::info : Severity::warning, context_.texts().gcs_regained);
}

void Failsafes::watch_setpoints() {
    const Tuning& tuning = context_.tuning;
    const bool is_needed = context_.armed && commander_.intended_mode().behaviour == Behaviour::offboard &&
                           tuning.on_offboard_loss != FailsafeAction::none;
    const bool is_lost = is_needed && !inputs_.offboard.is_fresh(context_.input_time(), tuning.offboard_loss);
    judge(state_.lacks_setpoints, is_lost, tuning.on_offboard_loss, context_.texts().offboard_lost);
}

void Failsafes::watch_sticks() {
    const Tuning& tuning = context_.tuning;
    const bool is_needed = context_.armed && needs_sticks(commander_.intended_mode().behaviour) &&
                           tuning.on_manual_loss != FailsafeAction::none && inputs_.sticks.was_heard();
    const bool is_lost = is_needed && !inputs_.sticks.is_fresh(context_.input_time(), tuning.manual_loss);
    judge(state_.lacks_sticks, is_lost, tuning.on_manual_loss, context_.texts().manual_lost);
}

void Failsafes::watch_position() {
    const bool is_needed = context_.armed && needs_position(commander_.intended_mode().behaviour);
    const bool is_lost = is_needed && !context_.craft.sensors().has_position();
    judge(state_.lacks_position, is_lost, FailsafeAction::land, context_.texts().no_position);
}

// Back inside, the vehicle does not continue by itself: it would leave again. ArduPilot acts on each fence.
void Failsafes::watch_fence() {
    const unsigned now = context_.armed && !context_.is_on_ground() ? fence_.breaches() : 0;
    const unsigned before = std::exchange(state_.breaches, now), added = now & ~before;
    const Texts& texts = context_.texts();
    if (before != 0 && now == 0 && context_.armed && !context_.is_on_ground())
        context_.say(Severity::notice, texts.fence_cleared);
    if (added == 0 || (is_px4() && before != 0)) return;
    context_.say(is_px4() ? Severity::critical : Severity::notice, filled(texts.fence_breached, names_of(added)));
    commander_.perform(context_.tuning.on_fence);
}

}  // namespace mavloom::flight
