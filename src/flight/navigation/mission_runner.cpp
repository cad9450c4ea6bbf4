// SPDX-License-Identifier: MIT
#include "flight/navigation/mission_runner.hpp"

#include <algorithm>

#include "flight/navigation/mission_report.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"

namespace mavloom::flight {

namespace {

// Items that may act in one update. More of them wait for the next one, so that jumps cannot loop for ever.
constexpr int max_items_at_once = 32;
// ArduPilot ends a mission after so many items in a row that are no way to go.
constexpr int max_actions_in_a_row = 255;

}  // namespace

void MissionRunner::begin() {
    runs_ = true;
    is_announced_ = false;
    if (is_complete_ || index_ >= size()) restart();
    index_ = std::max(index_, first());
    enter(Stage::fresh);
    context_.observer.on_mission_progress();
}

void MissionRunner::leave() {
    runs_ = false;
    enter(Stage::fresh);
    context_.observer.on_mission_progress();
}

void MissionRunner::restart() {
    index_ = 0;
    is_complete_ = has_reached_any_ = false;
    std::ranges::fill(jumps_, std::uint16_t{0});
}

void MissionRunner::on_plan_changed() {
    const bool keeps_place = context_.firmware.is_px4() && !is_complete_ && index_ < size();
    jumps_.assign(size(), 0);
    if (!keeps_place) index_ = 0;
    is_complete_ = has_reached_any_ = false;
    if (runs_) index_ = std::max(index_, first());
    enter(Stage::fresh);
    context_.observer.on_mission_progress();
}

void MissionRunner::on_armed() {
    if (is_complete_) restart();
    if (runs_) begin();
}

bool MissionRunner::set_current(std::optional<std::uint16_t> seq, bool resets) {
    const std::uint16_t wanted = seq.value_or(index_);
    if (wanted >= size()) return false;
    if (resets) restart();
    index_ = wanted;
    is_complete_ = false;
    enter(Stage::fresh);
    context_.observer.on_mission_progress();
    return true;
}

std::optional<std::uint16_t> MissionRunner::landing_start() const noexcept {
    const auto items = context_.plans.mission().items();
    const auto at = std::ranges::find(items, std::uint16_t{msg::MAV_CMD_DO_LAND_START}, &PlanItem::command);
    if (at == items.end()) return std::nullopt;
    return static_cast<std::uint16_t>(at - items.begin());
}

MissionProgress MissionRunner::progress() const noexcept {
    if (size() == 0) return {};
    MissionState state = has_reached_any_ ? MissionState::paused : MissionState::not_started;
    if (is_complete_) {
        state = MissionState::complete;
    } else if (runs_ && context_.armed) {
        state = MissionState::active;
    }
    return {.current = index_, .state = state};
}

void MissionRunner::enter(Stage stage) noexcept {
    stage_ = stage;
    since_ = context_.now();
    if (stage == Stage::fresh) next_ = static_cast<std::uint16_t>(index_ + 1);
}

void MissionRunner::update() {
    if (index_ >= size()) {
        if (!guidance_.is_staying()) guidance_.stop();
        return;
    }
    if (!std::exchange(is_announced_, true)) context_.say(Severity::info, context_.texts().executing_mission);
    for (int left = max_items_at_once; left > 0 && !is_complete_ && !wants_return_; --left) {
        if (stage_ == Stage::fresh) report_begin(context_, index_, item());
        if (!fly()) return;
        finish_item();
    }
}

void MissionRunner::finish_item() {
    has_reached_any_ = true;
    report_end(context_, index_, item());
    context_.observer.on_item_reached(index_);
    actions_in_a_row_ = item().command <= msg::MAV_CMD_NAV_LAST ? 0 : actions_in_a_row_ + 1;
    if (next_ >= size() || is_endless()) return complete();
    index_ = next_;
    enter(Stage::fresh);
    context_.observer.on_mission_progress();
}

bool MissionRunner::is_endless() const noexcept {
    return !context_.firmware.is_px4() && actions_in_a_row_ >= max_actions_in_a_row;
}

void MissionRunner::complete() {
    is_complete_ = true;
    actions_in_a_row_ = 0;
    const Texts& texts = context_.texts();
    const bool has_landed = context_.is_on_ground();
    if (!wants_return_)
        context_.say(Severity::info, has_landed ? texts.mission_finished_landed : texts.mission_finished_hold);
    if (has_landed) {
        guidance_.rest();
    } else if (!guidance_.is_staying()) {
        guidance_.stay(guidance_.goal());
    }
    context_.observer.on_mission_progress();
}

}  // namespace mavloom::flight
