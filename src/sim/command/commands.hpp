// SPDX-License-Identifier: MIT
// The command protocol: COMMAND_LONG, COMMAND_INT, COMMAND_CANCEL, SET_MODE, and their COMMAND_ACK. Private to module
// sim; single owner.
//
// Each command is a row of a table: its id, the function that carries it out, and whether PX4, ArduPilot or both know
// it. A command without a row is UNSUPPORTED. A command that takes time answers IN_PROGRESS and repeats that with its
// progress twice a second. It ends with ACCEPTED or FAILED, or with CANCELLED if a client sent COMMAND_CANCEL.
// Source: MAVLink guide, "Command Protocol".
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "flight/firmware/known_by.hpp"
#include "flight/flight.hpp"
#include "flight/orders.hpp"
#include "flight/plan.hpp"
#include "sim/radio/client.hpp"
#include "sim/service/service.hpp"

namespace mavloom::sim {

using flight::Result;  // and not mavloom::Result

struct Parts;

// A command, received in either form. Positions are in degrees, or metres in local frames; `nan` where the client gave
// none.
struct Command {
    Client from{};
    std::uint16_t id = 0;
    std::array<float, 7> params{};  // as sent; 5 and 6 of COMMAND_INT are converted
    double x = nan, y = nan;        // params 5 and 6 in full precision
    double z = nan;
    std::uint8_t frame = 0;  // MAV_FRAME; COMMAND_LONG has MAV_FRAME_GLOBAL
    bool is_int = false;

    [[nodiscard]] float param(std::size_t number) const noexcept { return params[number - 1]; }  // 1 to 7
    // A parameter as a whole number; empty if it is not in [0, most].
    [[nodiscard]] std::optional<std::uint32_t> whole(std::size_t number, double most = 0xffffffff) const noexcept {
        const double value{param(number)};
        return value >= 0 && value <= most ? std::optional(static_cast<std::uint32_t>(value)) : std::nullopt;
    }
};

// The altitude that `z` stands for in the command's frame, above mean sea level. `nan` stays `nan`.
[[nodiscard]] double altitude_of(const Command& command, const Flight& flight);

struct CommandRow {
    std::uint16_t id;
    Outcome (*carry_out)(Parts& parts, const Command& command, Moment now);
    KnownBy known_by = KnownBy::both;
};

class Commands final : public Service {
public:
    // All parts: each command reaches one or two of them, and together they reach nearly all.
    explicit Commands(Parts& parts) noexcept : parts_(parts) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;

    [[nodiscard]] FlightTime wakes_at() const noexcept override;
    void pump(Moment now) override;
    void reboot() override { tasks_.clear(); }
    void forget(LinkId link) override;

    // Starts work that takes `length`. It fails as soon as `may_continue` is false. A repeated command changes nothing.
    Result begin(const Command& command, Nanoseconds length, bool (*may_continue)(const Parts&), Moment now);

private:
    struct Task {
        Client client;
        std::uint16_t command = 0;
        FlightTime begun{}, reports{};  // `reports`: when it reports its progress next
        Nanoseconds length{};
        bool (*may_continue)(const Parts&) = nullptr;

        [[nodiscard]] std::uint8_t percent(FlightTime now) const noexcept;
    };

    void carry_out(const Command& command, Moment now);
    void cancel(const Client& from, std::uint16_t command);
    // Returns false once the task is over.
    bool move_on(Task& task, FlightTime now);
    void acknowledge(const Client& to, std::uint16_t command, Result result, std::uint8_t progress = 0);

    Parts& parts_;
    std::vector<Task> tasks_;
};

// The rows, by subject. Each file of command/ that carries out commands has one of these.
[[nodiscard]] std::span<const CommandRow> flight_commands() noexcept;       // arm, modes, take-off, reposition ...
[[nodiscard]] std::span<const CommandRow> message_commands() noexcept;      // intervals, requests
[[nodiscard]] std::span<const CommandRow> maintenance_commands() noexcept;  // reboot, storage, calibration, failures
[[nodiscard]] std::span<const CommandRow> payload_commands() noexcept;      // gimbal, actuators, camera, logging
// Carries out a mission item of payload_commands() as an order of the vehicle itself. Ignores all other items.
void carry_out_payload_item(Parts& parts, const PlanItem& item);
// Null if this firmware does not know the command.
[[nodiscard]] const CommandRow* find_command(std::uint16_t id, bool is_px4) noexcept;

}  // namespace mavloom::sim
