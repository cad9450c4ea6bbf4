// SPDX-License-Identifier: MIT
#include "bench_sim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <map>
#include <memory>
#include <vector>

#include "mavloom/base/counted.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/sim/vehicle.hpp"
#include "mavloom/wire/datagram_parser.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;

constexpr double steps_per_s = 250;
constexpr LinkId bench_link{1};
constexpr double flight_altitude_m = 20;
constexpr Nanoseconds until_ready = 3s;

// Counts what the vehicles send.
class CountingSink final : public sim::Sink {
public:
    void send(LinkId, const wire::FrameView& frame) override {
        ++frames;
        bytes += frame.size();
    }
    [[nodiscard]] bool has_room(LinkId) const override { return true; }

    std::uint64_t frames = 0, bytes = 0;
};

// Checks what the vehicles send: every frame parses, and no sequence number is missing.
class CheckingSink final : public sim::Sink {
public:
    explicit CheckingSink(const wire::MessageTable& table) : parser_(table) {}

    void send(LinkId, const wire::FrameView& frame) override {
        std::size_t found = 0;
        parser_.parse(frame.bytes(), [&](const wire::ParseEvent& event) {
            found += event.kind == wire::ParseEvent::Kind::frame && event.info != nullptr ? 1 : 0;
        });
        bad += found == 1 ? 0 : 1;
        const auto key = frame.system().value * 256u + frame.component().value;
        const auto [last, is_first] = last_.try_emplace(key, frame.sequence());
        if (!is_first) gaps += static_cast<std::uint8_t>(frame.sequence() - last->second) == 1 ? 0 : 1;
        last->second = frame.sequence();
    }
    [[nodiscard]] bool has_room(LinkId) const override { return true; }

    std::uint64_t bad = 0, gaps = 0;

private:
    wire::DatagramParser parser_;
    std::map<unsigned, std::uint8_t> last_;
};

// Vehicles whose clock runs as fast as they step.
class BenchFleet {
public:
    BenchFleet(const SimBenchOptions& options, sim::Sink& sink) {
        sim::VehicleOptions vehicle;
        vehicle.kind = static_cast<sim::Kind>(index_of(sim::kind_names, options.kind));
        vehicle.autopilot = static_cast<sim::Autopilot>(index_of(sim::autopilot_names, options.autopilot));
        const sim::LinkOptions link{.profile = static_cast<sim::Profile>(index_of(sim::profile_names, options.profile))};
        for (int i = 0; i < options.vehicles; ++i) {
            vehicle.system = SystemId{static_cast<std::uint8_t>(i % 250 + 1)};
            vehicle.seed = static_cast<std::uint64_t>(i) + 1;
            vehicles_.push_back(std::make_unique<sim::Vehicle>(vehicle, sink, now()));
            vehicles_.back()->open(bench_link, link, now());
        }
        run(until_ready);
        if (options.flies)
            for (const auto& one : vehicles_) took_off_ = one->take_off(flight_altitude_m).has_value() && took_off_;
    }

    // Advances each vehicle whenever it is due, as a simulator does that is never late. All advance together in slices,
    // so that they share the caches as in one process.
    void run(Nanoseconds time) {
        constexpr Nanoseconds slice = 100ms;
        for (const auto end = flight_ + time; flight_ < end;) {
            const auto to = std::min(flight_ + slice, end);
            for (const auto& vehicle : vehicles_) {
                for (sim::FlightTime due = vehicle->next_due(); due <= to; due = vehicle->next_due())
                    vehicle->advance(at(std::max(due, flight_)));
                vehicle->advance(at(to));
            }
            flight_ = to;
        }
    }

    // The largest deviation of a stream from the rate that was asked for, in parts of it.
    [[nodiscard]] double worst_rate() const {
        double worst = 0;
        for (const auto& vehicle : vehicles_)
            for (const auto& stream : vehicle->stream_reports(LinkId{1}))
                if (stream.sent > 10) worst = std::max(worst, std::abs(stream.achieved_hz / stream.asked_hz - 1));
        return worst;
    }
    [[nodiscard]] bool took_off() const noexcept { return took_off_; }

private:
    template <std::size_t n>
    static std::size_t index_of(const std::string_view (&names)[n], std::string_view name) {
        return static_cast<std::size_t>(std::ranges::find(names, name) - std::begin(names));
    }
    [[nodiscard]] static sim::Moment at(sim::FlightTime flight) { return {.flight = flight, .real = MonoTime{flight}}; }
    [[nodiscard]] sim::Moment now() const { return at(flight_); }

    sim::FlightTime flight_{};
    std::vector<std::unique_ptr<sim::Vehicle>> vehicles_;
    bool took_off_ = true;
};

double cpu_s() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Empty if everything is right.
std::string fault_of(const SimBenchOptions& options) {
    constexpr double allowed = 0.001;
    CheckingSink sink(dialect::default_dialect().wire_table());
    BenchFleet fleet(options, sink);
    fleet.run(10s);
    if (!fleet.took_off()) return "a vehicle did not take off";
    if (sink.bad != 0) return counted(sink.bad, "frame") + " did not parse";
    if (sink.gaps != 0) return counted(sink.gaps, "sequence gap");
    if (fleet.worst_rate() > allowed) return fmt::format("a stream is {:.2f} % off its rate", 100 * fleet.worst_rate());
    return {};
}

struct Result {
    double cpu_ms;  // of one vehicle and simulated second
    double frames_s, bytes_s;
};

Result measure(const SimBenchOptions& options) {
    CountingSink sink;
    BenchFleet fleet(options, sink);
    fleet.run(5s);
    sink.frames = sink.bytes = 0;
    const double begin = cpu_s();
    fleet.run(std::chrono::seconds(options.seconds));
    const double vehicle_seconds = static_cast<double>(options.vehicles) * options.seconds;
    return {1e3 * (cpu_s() - begin) / vehicle_seconds, static_cast<double>(sink.frames) / vehicle_seconds,
            static_cast<double>(sink.bytes) / vehicle_seconds};
}

void print(const SimBenchOptions& options, const Result& result) {
    const double per_cpu_s = 1e3 / result.cpu_ms;  // vehicle seconds in a second of CPU time
    if (options.json)
        return fmt::print(
            "{{\"bench\":\"sim\",\"cpu_ms\":{:.4f},\"core_percent\":{:.4f},\"steps_per_second\":{:.0f},"
            "\"messages_per_second\":{:.0f},\"bytes_per_second\":{:.0f},\"messages\":{:.1f},\"bytes\":{:.0f},"
            "\"vehicles\":{},\"seconds\":{},\"turns\":{}}}\n",
            result.cpu_ms, result.cpu_ms / 10, steps_per_s * per_cpu_s, result.frames_s * per_cpu_s,
            result.bytes_s * per_cpu_s, result.frames_s, result.bytes_s, options.vehicles, options.seconds,
            options.turns);
    fmt::print("sim {:>22.3f} ms CPU per vehicle and simulated second: {:.3f} % of a core   ({}, {}, median of {})\n",
               result.cpu_ms, result.cpu_ms / 10, counted(static_cast<std::uint64_t>(options.vehicles), "vehicle"),
               options.profile, counted(static_cast<std::uint64_t>(options.turns), "turn"));
    fmt::print(
        "{:>26.0f} steps/s, {:.0f} messages/s, {:.0f} bytes/s; one vehicle sends {:.1f} messages and {:.0f} bytes "
        "a second\n",
        steps_per_s * per_cpu_s, result.frames_s * per_cpu_s, result.bytes_s * per_cpu_s, result.frames_s,
        result.bytes_s);
}

std::vector<std::string> words(std::span<const std::string_view> names) { return {names.begin(), names.end()}; }

}  // namespace

Exit run_sim_bench(const SimBenchOptions& options) {
    if (const auto fault = fault_of(options); !fault.empty()) return fail(Exit::mismatch, fault);
    std::vector<Result> results;
    while (static_cast<int>(results.size()) < options.turns && !(Signals::received() && !results.empty()))
        results.push_back(measure(options));
    const auto middle = results.begin() + static_cast<std::ptrdiff_t>(results.size() / 2);
    std::ranges::nth_element(results, middle, {}, &Result::cpu_ms);
    print(options, *middle);
    return Exit::done;
}

Arguments declare_sim_bench(Arguments command, SimBenchOptions& options) {
    auto sub = command.add_subcommand("sim", "step simulated vehicles that send into a counter: CPU of one vehicle");
    sub.add_option("--vehicles", "N", options.vehicles, "number of vehicles, 1 to 10000")
        .capture_default_str()
        .range(1, 10'000);
    sub.add_option("--seconds", "N", options.seconds, "simulated seconds of each measurement, 1 to 100000")
        .capture_default_str()
        .range(1, 100'000);
    sub.add_option("--turns", "N", options.turns, "number of measurements, 1 to 1000; the result is their median")
        .capture_default_str()
        .range(1, 1000);
    sub.add_option("--profile", "NAME", options.profile, "which messages they send, as in `mavloom sim`")
        .capture_default_str()
        .members(words(sim::profile_names));
    sub.add_option("--vehicle", "KIND", options.kind, "quad, plane or rover")
        .capture_default_str()
        .members(words(sim::kind_names));
    sub.add_option("--autopilot", "NAME", options.autopilot, "px4 or ardupilot")
        .capture_default_str()
        .members(words(sim::autopilot_names));
    sub.add_flag("--fly", options.flies, "they take off first; otherwise they stand on the ground");
    sub.add_flag("--json", options.json, "print one JSON object");
    sub.fallthrough();
    sub.footer(
        "Before the measurement, every frame of ten simulated seconds must parse, no sequence number may be missing, "
        "and\n"
        "every stream must keep its rate.\n\nExample:\n  mavloom bench sim --vehicles 10 --seconds 10 --turns 3");
    return sub;
}

}  // namespace mavloom::app
