// SPDX-License-Identifier: MIT
// One simulated vehicle: its motion, its telemetry, and the MAVLink services with which it answers clients.
//
// A vehicle is one object without threads, clocks or sockets. Its owner passes the time, received frames and a sink for
// the frames that the vehicle sends. The same options, links, frames and moments give the same bytes. Single owner
// thread. docs/design/simulator.md describes the parts; docs/guide/sim.md describes what clients see.
//
// Memory: under 64 KiB with its services, plus what clients store and the logs of flights (both bounded by Limits).
// Sending and stepping allocate nothing; an upload, a file, a new link or an arming does.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/ids.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/sim/flight.hpp"
#include "mavloom/sim/report.hpp"
#include "mavloom/sim/sink.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::sim {

struct Parts;

// The rate of one message, which replaces the profile's. HEARTBEAT always keeps its own rate.
struct MessageRate {
    MessageId message;
    double hz = 0;  // 0: off
};
// No stream runs faster than the vehicle steps.
inline constexpr double fastest_stream_hz = 250;

struct LinkOptions {
    Profile profile = Profile::normal;
    std::vector<MessageRate> rates{};  // each replaces the profile's rate of that message
    // Bytes a second for telemetry. If the streams need more, all but HEARTBEAT slow down by one factor. 0: no limit.
    std::uint32_t max_bytes_s = 0;
};

// A message that vehicles can stream.
struct StreamInfo {
    MessageId message;
    std::string_view name;
};
[[nodiscard]] std::vector<StreamInfo> stream_infos();

class Vehicle {
public:
    // The vehicle boots at `now`. `sink` must outlive it.
    Vehicle(const VehicleOptions& options, Sink& sink, Moment now);
    ~Vehicle();
    Vehicle(const Vehicle&) = delete;
    Vehicle& operator=(const Vehicle&) = delete;

    // The vehicle streams on this link from now on. Each link has its own rates and sequence numbers.
    void open(LinkId link, const LinkOptions& options, Moment now);
    // Forgets the link, with the transfers of its clients.
    void close(LinkId link);

    // Handles a frame that arrived on an open link. Frames for other systems are ignored. `info` is null for an unknown
    // id. Replies leave through the sink during the call, bulk data later.
    void receive(LinkId link, const wire::FrameView& frame, const wire::MessageInfo* info, Moment now);

    // Flight time at which `advance` has something to do.
    [[nodiscard]] FlightTime next_due() const noexcept;
    // Moves the vehicle up to `now` and sends everything that is due. Call it at `next_due()`; if a call comes late,
    // the vehicle skips the instants that it missed and counts them.
    void advance(Moment now);

    // Orders from an operator at the simulator's console. The vehicle treats them like MAVLink commands. A refusal is
    // the error `usage` with the vehicle's own text. Call `advance` before an order.
    [[nodiscard]] SetupResult<void> arm(bool force);
    [[nodiscard]] SetupResult<void> disarm(bool force);
    // `altitude_m` above home.
    [[nodiscard]] SetupResult<void> take_off(double altitude_m);
    // In degrees. Without `altitude_m`, which is above home, the altitude stays.
    [[nodiscard]] SetupResult<void> go_to(double latitude, double longitude, std::optional<double> altitude_m);
    // A mode's name in any vocabulary of mavloom/message/modes.hpp.
    [[nodiscard]] SetupResult<void> set_mode(std::string_view name);
    [[nodiscard]] SetupResult<void> set_parameter(std::string_view name, double value);
    // A fault on purpose. `fault` has one of the forms of fault_forms().
    [[nodiscard]] SetupResult<void> fail(const Fault& fault);

    // A client may change the system id through a parameter. The new id takes effect after a reboot, unless `is_free`
    // returns false because another vehicle has that id. Without `is_free`, every id counts as free.
    [[nodiscard]] SystemId system() const noexcept;
    void ask_for_system(std::function<bool(SystemId)> is_free);
    [[nodiscard]] VehicleStatus status() const;
    [[nodiscard]] bool has_mode(std::string_view name) const;
    [[nodiscard]] std::vector<std::string_view> mode_names() const;
    [[nodiscard]] std::vector<std::string_view> parameter_names() const;
    // The parameter that holds the system id.
    [[nodiscard]] std::string_view system_parameter() const noexcept;
    // Empty if there is no parameter of this name. A 32-bit float comes with the fewest digits that stand for it.
    [[nodiscard]] std::optional<double> parameter(std::string_view name) const;
    // One row for each stream of an open link.
    [[nodiscard]] std::vector<StreamReport> stream_reports(LinkId link) const;

private:
    std::unique_ptr<Parts> parts_;
};

}  // namespace mavloom::sim
