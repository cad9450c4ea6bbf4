// SPDX-License-Identifier: MIT
#include "sim/command/commands.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/command_cancel.hpp"
#include "mavloom/msg/command_int.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/enums/mav_frame.hpp"
#include "mavloom/msg/set_mode.hpp"
#include "sim/parts.hpp"

namespace mavloom::sim {

namespace {

constexpr std::array command_messages{msg::CommandLong::id, msg::CommandInt::id, msg::CommandCancel::id,
                                      msg::SetMode::id};

constexpr Nanoseconds task_report_interval = std::chrono::milliseconds{500};

bool is_local(std::uint8_t frame) noexcept {
    using namespace msg;
    constexpr std::array local_frames{MAV_FRAME_LOCAL_NED, MAV_FRAME_LOCAL_ENU,       MAV_FRAME_LOCAL_OFFSET_NED,
                                      MAV_FRAME_BODY_NED,  MAV_FRAME_BODY_OFFSET_NED, MAV_FRAME_BODY_FRD,
                                      MAV_FRAME_LOCAL_FRD, MAV_FRAME_LOCAL_FLU};
    return std::ranges::find(local_frames, frame) != local_frames.end();
}

// INT32_MAX means "not given", and so does NaN cast to an integer by a client (INT32_MIN, or 0x7ff80000).
double coordinate(std::int32_t value, bool local) noexcept {
    constexpr std::int32_t nan_cast = 0x7ff80000;
    using Range = std::numeric_limits<std::int32_t>;
    if (value == Range::max() || value == Range::min() || value == nan_cast) return nan;
    return value * (local ? 1e-4 : 1e-7);
}

Command command_of(const Client& from, const msg::CommandLong& m) {
    Command command{.from = from, .id = m.command};
    command.params = {m.param1, m.param2, m.param3, m.param4, m.param5, m.param6, m.param7};
    const auto given = [](float value) { return std::abs(value) < 2e9f ? double{value} : nan; };
    command.x = given(m.param5);
    command.y = given(m.param6);
    command.z = std::isfinite(m.param7) ? double{m.param7} : nan;
    return command;
}

Command command_of(const Client& from, const msg::CommandInt& m) {
    const bool local = is_local(m.frame);
    Command command{.from = from, .id = m.command, .frame = m.frame, .is_int = true};
    command.x = coordinate(m.x, local);
    command.y = coordinate(m.y, local);
    command.z = std::isfinite(m.z) ? double{m.z} : nan;
    command.params = {
        m.param1, m.param2, m.param3, m.param4, static_cast<float>(command.x), static_cast<float>(command.y), m.z};
    return command;
}

// SET_MODE is DO_SET_MODE in an older form: the mode is one packed number.
Command command_of(const Client& from, const msg::SetMode& m, bool is_px4) {
    Command command{.from = from, .id = msg::MAV_CMD_DO_SET_MODE};
    const auto main = is_px4 ? m.custom_mode >> 16 & 0xff : m.custom_mode;
    const auto sub = is_px4 ? m.custom_mode >> 24 : 0;
    command.params = {static_cast<float>(m.base_mode), static_cast<float>(main), static_cast<float>(sub)};
    return command;
}

}  // namespace

double altitude_of(const Command& command, const Flight& flight) {
    using namespace msg;
    switch (command.frame) {
        case MAV_FRAME_GLOBAL_RELATIVE_ALT:
        case MAV_FRAME_GLOBAL_RELATIVE_ALT_INT:
            return command.z + (flight.home() ? flight.home()->altitude : flight.ground_altitude());
        case MAV_FRAME_GLOBAL_TERRAIN_ALT:
        case MAV_FRAME_GLOBAL_TERRAIN_ALT_INT: return command.z + flight.ground_altitude();
        default: return command.z;
    }
}

std::span<const MessageId> Commands::handled() const noexcept { return command_messages; }

void Commands::receive(const Client& from, MessageId id, ByteView payload, Moment now) {
    if (id == msg::CommandLong::id) {
        carry_out(command_of(from, msg::CommandLong::decode(payload)), now);
    } else if (id == msg::CommandInt::id) {
        carry_out(command_of(from, msg::CommandInt::decode(payload)), now);
    } else if (id == msg::SetMode::id) {
        carry_out(command_of(from, msg::SetMode::decode(payload), parts_.firmware.is_px4()), now);
    } else {
        cancel(from, msg::CommandCancel::decode(payload).command);
    }
}

void Commands::carry_out(const Command& command, Moment now) {
    const CommandRow* const row = find_command(command.id, parts_.firmware.is_px4());
    const Result result = row == nullptr ? Result::unsupported : row->carry_out(parts_, command, now).result;
    acknowledge(command.from, command.id, result);
}

void Commands::acknowledge(const Client& to, std::uint16_t command, Result result, std::uint8_t progress) {
    parts_.radio.send(to.link, msg::CommandAck{.command = command,
                                               .result = static_cast<std::uint8_t>(result),
                                               .progress = progress,
                                               .target_system = to.id.system.value,
                                               .target_component = to.id.component.value});
}

// --- Commands that take time

Result Commands::begin(const Command& command, Nanoseconds length, bool (*may_continue)(const Parts&), Moment now) {
    const auto running = std::ranges::find(tasks_, command.id, &Task::command);
    if (running != tasks_.end())
        return running->client == command.from ? Result::in_progress : Result::temporarily_rejected;
    tasks_.push_back({.client = command.from,
                      .command = command.id,
                      .begun = now.flight,
                      .reports = now.flight + task_report_interval,
                      .length = length,
                      .may_continue = may_continue});
    return Result::in_progress;
}

std::uint8_t Commands::Task::percent(FlightTime now) const noexcept {
    return static_cast<std::uint8_t>(std::clamp<std::int64_t>(100 * (now - begun) / length, 0, 100));
}

FlightTime Commands::wakes_at() const noexcept {
    FlightTime at = FlightTime::max();
    for (const Task& task : tasks_) at = std::min(at, task.reports);
    return at;
}

void Commands::pump(Moment now) {
    std::erase_if(tasks_, [&](Task& task) { return task.reports <= now.flight && !move_on(task, now.flight); });
}

bool Commands::move_on(Task& task, FlightTime now) {
    const bool is_done = now - task.begun >= task.length;
    const bool has_failed = task.may_continue != nullptr && !task.may_continue(parts_);
    const Result result = has_failed ? Result::failed : is_done ? Result::accepted : Result::in_progress;
    acknowledge(task.client, task.command, result, task.percent(now));
    task.reports = now + task_report_interval;
    return result == Result::in_progress;
}

// The client that gave the command gets the answer, as well as the one that cancels it. A command that is over, or was
// never begun, needs no answer.
void Commands::cancel(const Client& from, std::uint16_t command) {
    const auto task = std::ranges::find(tasks_, command, &Task::command);
    if (task == tasks_.end()) return;
    const Client client = task->client;
    tasks_.erase(task);
    acknowledge(client, command, Result::cancelled);
    if (client != from) acknowledge(from, command, Result::cancelled);
}

void Commands::forget(LinkId link) {
    std::erase_if(tasks_, [&](const Task& task) { return task.client.link == link; });
}

const CommandRow* find_command(std::uint16_t id, bool is_px4) noexcept {
    const KnownBy own = is_px4 ? KnownBy::px4 : KnownBy::ardupilot;
    for (const auto rows : {flight_commands(), message_commands(), maintenance_commands(), payload_commands()})
        for (const CommandRow& row : rows)
            if (row.id == id && (row.known_by == KnownBy::both || row.known_by == own)) return &row;
    return nullptr;
}

}  // namespace mavloom::sim
