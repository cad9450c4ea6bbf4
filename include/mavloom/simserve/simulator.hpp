// SPDX-License-Identifier: MIT
// The simulator puts simulated vehicles on links. Its loop advances the vehicles when they are due, sends their frames,
// and passes each received frame to the vehicle that it targets. See docs/guide/sim.md.
//
// Every vehicle is on every link. Each peer of an endpoint is a link of its own, with its own stream rates and sequence
// numbers. One thread owns and drives a simulator; any thread may call `wake` and `post`. Sending and advancing do not
// allocate, lock or log.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mavloom/config/config.hpp"
#include "mavloom/control/served.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/sim/vehicle.hpp"

namespace mavloom::control {
class PostBox;
}

namespace mavloom::simserve {

class Connections;
class Fleet;
class FlightClock;
class FlightRecording;
class InputReplay;
class LinkSink;
class SharedMemory;
class TimeLine;

struct SimEndpoint {
    // The option `max_bytes` limits the telemetry on each of its links in real time, summed over all vehicles. A serial
    // endpoint without it gets half of what its baud rate carries, so that parameters get through.
    endpoint::Endpoint endpoint;
    std::optional<sim::Profile> profile{};  // empty: the profile of SimulatorOptions
    std::vector<sim::MessageRate> rates{};  // these take precedence over the rates of SimulatorOptions
};

// The speed of a flight clock that runs as fast as the vehicles can fly.
inline constexpr double max_speed = std::numeric_limits<double>::infinity();

// An order to vehicles at a time of the flight.
struct TimedOrder {
    sim::FlightTime at{};
    std::string text;                  // as the user wrote it
    std::string request;               // as `mavloom ctl` sends it
    std::optional<SystemId> system{};  // empty: for all vehicles
};

struct SimulatorOptions {
    // Of the flight clock. Protocol time-outs run in real time, but at `max_speed` by the flight clock, too.
    double speed = 1;
    // When the vehicles stop flying. At `max_speed`, or if `is_repeatable`, the simulator ends then, too.
    sim::FlightTime flight_end = sim::FlightTime::max();
    WallTime utc_at_start{};  // UTC at flight time 0; the epoch: the time at which it begins
    std::vector<TimedOrder> orders{};
    std::optional<sim::Profile> profile{};  // empty: the usual profile of each vehicle's autopilot
    std::vector<sim::MessageRate> rates{};  // each replaces the profile's rate of that message
    bool keeps_reports = false;             // keeps the reports of links that are gone
    // The session can be repeated: whatever the speed, all steps are made in their order and none late, and protocol
    // time-outs run by the flight clock.
    bool is_repeatable = false;
};

// How well the streams of one link kept their rates.
struct LinkReport {
    std::string link;                     // its name
    std::uint64_t frames = 0, bytes = 0;  // sent
    // Frames that the vehicles numbered but that were not sent, because the link's queue was full or the kernel
    // rejected them. The peer sees a gap in the sequence numbers for each.
    std::uint64_t gaps = 0;
    std::vector<sim::StreamReport> streams{};
};

// Sums over all links and vehicles.
struct SimulatorTotals {
    std::uint64_t frames_sent = 0, bytes_sent = 0;
    std::uint64_t gaps = 0;  // as in LinkReport
    std::uint64_t frames_received = 0;
};

class Simulator : public control::Served {
public:
    // Receives log lines about links that come and go, and about anything unusual. Called on the simulator's thread.
    using Notice = std::function<void(config::LogLevel, std::string_view)>;

    // `dialect` must outlive the simulator.
    [[nodiscard]] static SetupResult<std::unique_ptr<Simulator>> create(const dialect::Dialect& dialect,
                                                                        const SimulatorOptions& options, Notice notice);
    Simulator(const Simulator&) = delete;
    Simulator& operator=(const Simulator&) = delete;
    ~Simulator() override;

    // Set-up. Before the first turn, call in this order: open_ring() and open_inlet(), or open_page(); then add() for
    // each vehicle; then add() for each endpoint.

    // Opens a ring of the simulator's own, which programs read as shm://NAME. The ring is a link: it contains
    // everything that the vehicles send on that link. The ring's counter page has the simulator's counters.
    [[nodiscard]] SetupResult<void> open_ring(const config::RingConfig& config);
    // Opens the ring's inlet, the socket through which readers of the ring send frames. See Links::add_inlet.
    [[nodiscard]] SetupResult<void> open_inlet(const config::RingConfig& config, const std::filesystem::path& socket);
    // Records what the vehicles send into this tlog file, with the times of the flight clock, whatever its speed. The
    // recording is a link. It waits for the disk. Call it before the first turn.
    [[nodiscard]] SetupResult<void> open_recording(const std::filesystem::path& path);
    // Records what the vehicles receive into this tlog file, with the times of the flight clock. Only if the session is
    // repeatable.
    [[nodiscard]] SetupResult<void> open_input_recording(const std::filesystem::path& path);
    // Plays such a recording. Its session began at the same UTC.
    [[nodiscard]] SetupResult<void> open_input(const std::filesystem::path& path);
    // Opens a counter page of this name. Call it only if there is no ring.
    [[nodiscard]] SetupResult<void> open_page(const std::string& name);
    using Parameters = std::span<const std::pair<std::string, double>>;
    // Adds a vehicle, with values for some of its parameters. Its flight begins with the first turn.
    [[nodiscard]] SetupResult<void> add(const sim::VehicleOptions& options, Parameters parameters = {});

    // Opens an endpoint. May also be called after the first turn. For shm://NAME, the vehicles send to the inlet of the
    // router that writes the ring NAME, and hear what this router writes into the ring.
    [[nodiscard]] SetupResult<void> add(const SimEndpoint& endpoint);
    // Refuses an endpoint that a simulator cannot have. Opens nothing.
    [[nodiscard]] static SetupResult<void> check(const endpoint::Endpoint& endpoint);
    // Removes an endpoint by its label, after sending what is queued. If `label` is the name of a link, closes only it.
    // Returns false if nothing has that name.
    bool remove(std::string_view label);

    // Runs one turn: waits until a vehicle is due, something arrives, or `deadline`, and handles all of it.
    void turn(MonoTime deadline);
    // Sends what is queued, for at most `limit`, removes the ring, and closes the recordings. Reports stay available.
    // An error is that of a recording: the disk refused frames, or the input could not be read.
    [[nodiscard]] SetupResult<void> finish(Nanoseconds limit);
    // True at `flight_end`, or if a recording failed.
    [[nodiscard]] bool has_ended() const;

    // Async-signal-safe.
    void wake() noexcept { links_->wake(); }
    // control::Served.
    void post(std::function<void()> work) override;
    void drop_posted() override;
    [[nodiscard]] control::Report answer(std::string_view request) override;
    [[nodiscard]] control::Report metrics() override;

    // For reports and requests; on the simulator's thread only.
    [[nodiscard]] link::Links& links() noexcept { return *links_; }
    [[nodiscard]] const dialect::Dialect& dialect() const noexcept { return dialect_; }
    [[nodiscard]] std::vector<sim::Vehicle*> vehicles() const;
    // Advances the vehicle to now, and gives it an order: calls `order` and returns its result.
    using Order = std::function<SetupResult<void>(sim::Vehicle&)>;
    [[nodiscard]] SetupResult<void> give(sim::Vehicle& vehicle, const Order& order);
    // Reports of all current links and, with `keeps_reports`, of links that are gone.
    [[nodiscard]] std::vector<LinkReport> reports() const;
    [[nodiscard]] SimulatorTotals totals() const;
    [[nodiscard]] const SimulatorOptions& options() const noexcept { return options_; }
    [[nodiscard]] sim::FlightTime flight_time() const;
    // Orders of the time line that a vehicle refused. Each was reported.
    [[nodiscard]] std::uint64_t refused_orders() const noexcept { return refused_orders_; }
    // The flight clock stands still or runs again. `step` moves a clock that stands still by this time, from 0 to
    // `max_step`, though not beyond `flight_end`, and returns false if it runs. Frames from partners are answered all
    // the same.
    static constexpr Nanoseconds max_step = std::chrono::seconds{10};
    void pause();
    void resume();
    [[nodiscard]] bool is_paused() const;
    [[nodiscard]] bool step(Nanoseconds time);
    [[nodiscard]] Nanoseconds uptime() const { return mono_now() - created_; }
    // Logs a line through the simulator's Notice.
    void notify(config::LogLevel level, std::string_view text) const { notice_(level, text); }

private:
    Simulator(const dialect::Dialect& dialect, const SimulatorOptions& options, Notice notice,
              std::unique_ptr<link::Links> links);

    [[nodiscard]] MonoTime next_due() const;
    void fly();
    void fly_until(sim::FlightTime target);
    [[nodiscard]] bool catch_up();
    void fly_to(sim::FlightTime flight);
    [[nodiscard]] sim::FlightTime next_event() const;
    void run_orders(sim::Moment now);
    void play_input(sim::Moment now);
    void maintain(MonoTime now);
    void refresh_page(MonoTime now);

    const dialect::Dialect& dialect_;
    SimulatorOptions options_;
    Notice notice_;
    std::unique_ptr<link::Links> links_;
    std::unique_ptr<control::PostBox> posted_;
    std::unique_ptr<FlightClock> clock_;
    std::unique_ptr<TimeLine> time_line_;
    std::unique_ptr<SharedMemory> shared_;
    std::unique_ptr<FlightRecording> recording_, received_;
    std::unique_ptr<InputReplay> input_;
    std::unique_ptr<LinkSink> sink_;
    std::unique_ptr<Fleet> fleet_;
    std::unique_ptr<Connections> connections_;
    MonoTime created_ = mono_now();
    MonoTime maintain_due_{}, page_due_{};
    std::uint64_t refused_orders_ = 0;
    bool runs_orders_ = false, has_warned_ = false;
};

}  // namespace mavloom::simserve
