// SPDX-License-Identifier: MIT
#include "mavloom/simserve/simulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "mavloom/base/counted.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/control/post_box.hpp"
#include "mavloom/link/flush.hpp"
#include "simserve/connections.hpp"
#include "simserve/fleet.hpp"
#include "simserve/flight_clock.hpp"
#include "simserve/flight_recording.hpp"
#include "simserve/input_replay.hpp"
#include "simserve/link_sink.hpp"
#include "simserve/scenario/time_line.hpp"
#include "simserve/shared_memory.hpp"

namespace mavloom::simserve {

using namespace std::chrono_literals;

static constexpr Nanoseconds maintain_interval = 1s, page_interval = 250ms;

namespace {

SimulatorOptions dated(SimulatorOptions options) {
    if (options.utc_at_start == WallTime{}) options.utc_at_start = wall_now();
    if (options.is_repeatable) options.utc_at_start = std::chrono::floor<std::chrono::seconds>(options.utc_at_start);
    return options;
}

}  // namespace

Simulator::Simulator(const dialect::Dialect& dialect, const SimulatorOptions& options, Notice notice,
                     std::unique_ptr<link::Links> links)
    : dialect_(dialect),
      options_(dated(options)),
      notice_(std::move(notice)),
      links_(std::move(links)),
      posted_(std::make_unique<control::PostBox>()),
      clock_(std::make_unique<FlightClock>(options.speed)),
      time_line_(std::make_unique<TimeLine>(options.orders)),
      shared_(std::make_unique<SharedMemory>()),
      recording_(std::make_unique<FlightRecording>()),
      received_(std::make_unique<FlightRecording>()),
      input_(std::make_unique<InputReplay>()),
      sink_(std::make_unique<LinkSink>(*links_, *clock_, options_.utc_at_start, *shared_, *recording_, *input_)),
      fleet_(std::make_unique<Fleet>(*sink_)),
      connections_(std::make_unique<Connections>(Connections::Parts{dialect_, *links_, *clock_, *shared_, *recording_,
                                                                    *received_, sink_->lines(), *fleet_, options_,
                                                                    notice_, [this] { return catch_up(); }})) {
    if (options_.is_repeatable) clock_->make_exact();
}

Simulator::~Simulator() { shared_->close(); }  // stops the thread that may call post()

SetupResult<std::unique_ptr<Simulator>> Simulator::create(const dialect::Dialect& dialect,
                                                          const SimulatorOptions& options, Notice notice) {
    auto links = link::Links::create(dialect);
    if (!links) return tl::unexpected(std::move(links.error()));
    return std::unique_ptr<Simulator>(new Simulator(dialect, options, std::move(notice), std::move(*links)));
}

SetupResult<void> Simulator::open_ring(const config::RingConfig& config) {
    auto opened = shared_->open_ring(config, [this] { post([this] { maintain(mono_now()); }); });
    if (opened) links_->count_from(shared_->ring_link());
    return opened;
}

SetupResult<void> Simulator::open_inlet(const config::RingConfig& config, const std::filesystem::path& socket) {
    return connections_->open_inlet(config, socket);
}

// Its id follows those of the ring, and the links' ids follow it.
SetupResult<void> Simulator::open_recording(const std::filesystem::path& path) {
    const LinkId link{shared_->ring_link().value + 1};
    auto opened = recording_->open(path, link);
    if (opened) links_->count_from(link);
    return opened;
}

SetupResult<void> Simulator::open_input_recording(const std::filesystem::path& path) {
    return received_->open(path, LinkId{});
}

SetupResult<void> Simulator::open_input(const std::filesystem::path& path) {
    return input_->open(path, dialect_.wire_table(), options_.utc_at_start);
}

SetupResult<void> Simulator::open_page(const std::string& name) { return shared_->open_page(name); }

SetupResult<void> Simulator::add(const sim::VehicleOptions& options, Parameters parameters) {
    sim::VehicleOptions dated = options;
    if (dated.utc_at_start == WallTime{}) dated.utc_at_start = options_.utc_at_start;
    dated.wakes_for_changes = options_.is_repeatable;
    if (auto added = fleet_->add(dated, clock_->at(mono_now())); !added) return added;
    sim::Vehicle& vehicle = *fleet_->find(options.system);
    for (const auto& [name, value] : parameters)
        if (auto set = vehicle.set_parameter(name, value); !set) return set;
    return {};
}

SetupResult<void> Simulator::add(const SimEndpoint& endpoint) { return connections_->add(endpoint); }

// First, what the vehicles have queued leaves.
bool Simulator::remove(std::string_view label) {
    links_->turn(*connections_, MonoTime{});
    return connections_->remove(label);
}

// ---- turns ----------------------------------------------------------------------------------------------------------

void Simulator::turn(MonoTime deadline) {
    if (!clock_->has_started()) {
        clock_->start(mono_now());
        connections_->open_own_links();
    }
    deadline = std::min({deadline, next_due(), connections_->rings_due(), maintain_due_});
    links_->turn(*connections_, posted_->empty() ? deadline : MonoTime{});
    connections_->play_rings();
    fly();
    const MonoTime now = mono_now();
    if (!posted_->empty()) posted_->run_one();  // one a turn, because reports take long and frames go first
    if (now >= page_due_) refresh_page(now);
    if (now >= maintain_due_) maintain(now);
}

MonoTime Simulator::next_due() const {
    if (has_ended()) return MonoTime::max();
    return clock_->when(std::min(next_event(), options_.flight_end));
}

sim::FlightTime Simulator::next_event() const {
    return std::min({fleet_->next_due(), time_line_->next_due(), input_->next_due()});
}

void Simulator::fly() {
    if (clock_->is_exact() && !clock_->is_free()) return fly_until(clock_->target(mono_now()));
    if (!clock_->is_free()) {
        const auto now = clock_->at(mono_now());
        fleet_->advance(now);
        return run_orders(now);
    }
    // Partners get each step before the next one, or the queues would keep only the newest values.
    const MonoTime end = mono_now() + (connections_->has_partners() ? 0ms : 1ms);
    while (!clock_->is_paused() && !has_ended()) {
        fly_to(std::max(std::min(next_event(), options_.flight_end), flight_time()));
        if (mono_now() >= end) return;
    }
}

// A free clock does not wait for partners.
bool Simulator::catch_up() {
    if (!clock_->is_exact()) return true;
    if (!clock_->is_free()) fly();
    return !has_ended();
}

// Only if the clock is exact.
void Simulator::fly_until(sim::FlightTime target) {
    if (clock_->is_paused()) return;
    const auto end = std::max(std::min(target, options_.flight_end), flight_time());
    for (auto at = next_event(); at <= end && !has_ended(); at = next_event()) fly_to(std::max(at, flight_time()));
    if (!has_ended()) fly_to(end);
}

// Only if the clock is free, exact or paused.
void Simulator::fly_to(sim::FlightTime flight) {
    clock_->set(flight);
    const auto now = clock_->at(mono_now());
    fleet_->advance(now);
    run_orders(now);
    if (input_->next_due() <= flight) play_input(now);
}

// One frame: what it makes due comes before the next one.
void Simulator::play_input(sim::Moment now) {
    const auto& record = input_->next();
    LinkId link = input_->link_of(record.frame.source());
    if (link == LinkId{}) {
        link = links_->take_link_id();
        input_->set_link(record.frame.source(), link);
        fleet_->open(link, {}, now);
    }
    received_->write(options_.utc_at_start + now.flight, record.frame);
    fleet_->receive(link, record.frame, record.info, now);
    input_->advance();
}

void Simulator::run_orders(sim::Moment now) {
    while (time_line_->next_due() <= now.flight) {
        const auto& order = time_line_->take();
        runs_orders_ = true;
        const auto error = error_of(answer(order.request));
        runs_orders_ = false;
        if (error.empty()) continue;
        ++refused_orders_;
        notice_(config::LogLevel::warning,
                fmt::format("order '{}' at {:g} s: {}", order.text, seconds(order.at), error));
    }
}

sim::FlightTime Simulator::flight_time() const { return clock_->at(mono_now()).flight; }

bool Simulator::has_ended() const {
    const bool counts_time = clock_->is_free() || clock_->is_exact();
    return recording_->error() || received_->error() || input_->error() ||
           (counts_time && flight_time() >= options_.flight_end);
}

void Simulator::pause() {
    (void)catch_up();
    clock_->pause(mono_now());
}
void Simulator::resume() { clock_->resume(mono_now()); }
bool Simulator::is_paused() const { return clock_->is_paused(); }

bool Simulator::step(Nanoseconds time) {
    if (!clock_->is_paused()) return false;
    const auto end = std::min(flight_time() + std::clamp(time, Nanoseconds{}, max_step), options_.flight_end);
    const auto next = [&] { return std::max(next_event(), flight_time()); };
    for (auto at = next(); at < end; at = next()) {
        fly_to(at);
        links_->turn(*connections_, MonoTime{});
    }
    fly_to(end);
    return true;
}

SetupResult<void> Simulator::finish(Nanoseconds limit) {
    link::flush(*links_, *connections_, limit);
    while (!posted_->empty()) posted_->run_one();
    connections_->close_inlet();
    shared_->close();
    if (const auto lost = input_->lost_bytes(); lost != 0)
        notice_(config::LogLevel::warning,
                fmt::format("the replayed session is damaged or cut off: {} of its file were not played",
                            counted(lost, "byte")));
    const auto received = received_->close();
    if (auto closed = recording_->close(); !closed) return closed;
    if (input_->error()) return tl::unexpected(*input_->error());
    return received;
}

void Simulator::maintain(MonoTime now) {
    maintain_due_ = now + maintain_interval;
    connections_->refill_lines();
    recording_->flush();
    received_->flush();
    for (const auto& text : shared_->maintain(*links_)) notice_(config::LogLevel::warning, text);
}

void Simulator::refresh_page(MonoTime now) {
    page_due_ = now + page_interval;
    const SimulatorTotals all = totals();
    const std::array<ring::OwnCount, 5> counts{{{"vehicles", fleet_->size(), shm::CounterType::gauge},
                                                {"frames_sent", all.frames_sent},
                                                {"bytes_sent", all.bytes_sent},
                                                {"gaps", all.gaps},
                                                {"frames_received", all.frames_received}}};
    shared_->refresh_page(*links_, connections_->inlet(), counts);
}

void Simulator::post(std::function<void()> work) {
    posted_->post(std::move(work));
    wake();
}

void Simulator::drop_posted() { posted_->drop(); }

// ---- reports and requests -------------------------------------------------------------------------------------------

std::vector<sim::Vehicle*> Simulator::vehicles() const {
    std::vector<sim::Vehicle*> all;
    fleet_->each([&](sim::Vehicle& vehicle) { all.push_back(&vehicle); });
    return all;
}

SetupResult<void> Simulator::give(sim::Vehicle& vehicle, const Order& order) {
    if (received_->is_open() && !runs_orders_ && !std::exchange(has_warned_, true))
        notice_(config::LogLevel::warning,
                "orders by ctl are not among the recorded inputs; put them into the time line");
    if (!runs_orders_) (void)catch_up();
    const sim::Moment now = clock_->at(mono_now());
    vehicle.advance(now);
    auto done = order(vehicle);
    fleet_->reschedule(vehicle, now);
    return done;
}

std::vector<LinkReport> Simulator::reports() const { return connections_->reports(); }

SimulatorTotals Simulator::totals() const {
    SimulatorTotals all{.frames_sent = sink_->frames(),
                        .bytes_sent = sink_->bytes(),
                        .frames_received = connections_->frames_received()};
    const auto add_gaps = [&](const link::LinkCounters& counters) {
        all.gaps += counters.queue_bytes.value() + counters.queue_age.value() + counters.frames_not_sent.value();
    };
    for (const auto& link : links_->links()) add_gaps(*link.counters);
    for (const auto& endpoint : links_->endpoints()) add_gaps(endpoint.counters->gone);
    return all;
}

}  // namespace mavloom::simserve
