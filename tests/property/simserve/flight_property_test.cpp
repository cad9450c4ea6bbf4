// SPDX-License-Identifier: MIT
// Random scenarios: vehicles, rates, orders, faults of vehicles, and faults of a link. How a flight is stepped changes
// nothing, and what was sent and what arrived differ by exactly what the faults report.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <rapidcheck/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <map>
#include <thread>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/record/tlog_reader.hpp"
#include "mavloom/simserve/simulator.hpp"
#include "mavloom/wire/frame.hpp"
#include "simserve/scenario/time_line.hpp"
#include "support/bytes.hpp"
#include "support/seed.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::simserve {
namespace {

using namespace std::chrono_literals;
using test::Bytes;
using test::TempDir;

// ---- scenarios ------------------------------------------------------------------------------------------------------

struct Event {
    Nanoseconds at{};
    std::string text;
    SystemId system{};
};

struct Scenario {
    std::vector<sim::VehicleOptions> vehicles;
    std::vector<sim::MessageRate> rates;
    std::vector<Event> events;
    std::string faults;  // of the link
    bool is_repeatable = false;
    Nanoseconds length{}, look{};  // the vehicles are looked at at `look`
    std::vector<Nanoseconds> steps;
};

void showValue(const Scenario& scenario, std::ostream& out) {
    for (const auto& v : scenario.vehicles)
        out << fmt::format("vehicle {}: kind {}, autopilot {}, seed {}\n", v.system.value, static_cast<int>(v.kind),
                           static_cast<int>(v.autopilot), v.seed);
    for (const auto& e : scenario.events)
        out << fmt::format("{} ms, vehicle {}: {}\n", e.at / 1ms, e.system.value, e.text);
    for (const auto& rate : scenario.rates) out << fmt::format("message {}: {} Hz\n", rate.message.value, rate.hz);
    std::vector<std::int64_t> steps;
    for (const auto step : scenario.steps) steps.push_back(step.count());
    out << fmt::format("{}; repeatable: {}; {} ns, looked at at {}, by steps of {}\n", scenario.faults,
                       scenario.is_repeatable, scenario.length.count(), scenario.look.count(), fmt::join(steps, ", "));
}

template <class T>
T one_of(std::initializer_list<T> values) {
    return *rc::gen::elementOf(std::vector<T>(values));
}

Nanoseconds time_until(Nanoseconds end) { return Nanoseconds{*rc::gen::inRange<std::int64_t>(1, end.count())}; }

sim::VehicleOptions any_vehicle(std::size_t number) {
    sim::VehicleOptions options;
    options.kind = one_of({sim::Kind::quad, sim::Kind::plane, sim::Kind::rover});
    options.autopilot = one_of({sim::Autopilot::px4, sim::Autopilot::ardupilot});
    options.system = SystemId{static_cast<std::uint8_t>(number + 1)};
    options.seed = *rc::gen::arbitrary<std::uint64_t>();
    options.has_noise = *rc::gen::arbitrary<bool>();
    options.has_gimbal = *rc::gen::arbitrary<bool>();
    options.ready_after = 200ms;
    return options;
}

Event any_event(Nanoseconds length, std::size_t vehicles) {
    return {
        time_until(length),
        one_of<const char*>({"arm", "disarm", "takeoff 5", "land", "goto 47.3978 8.5457 10", "fail gps off",
                             "fail gps drift 3 0", "fail gps jump 20 0", "fail compass turn 90", "fail barometer stuck",
                             "fail battery charge 0", "fail motor off 1", "fail heartbeat off", "fail radio off",
                             "fail all ok", "fail sequence restart", "fail autopilot restart"}),
        SystemId{static_cast<std::uint8_t>(*rc::gen::inRange<std::size_t>(1, vehicles + 1))}};
}

std::string any_faults() {
    const auto burst = *rc::gen::inRange(1, 12);
    return fmt::format("out_fault=loss:{:.2f}/{},duplicate:{:.2f}&fault_seed={}", *rc::gen::inRange(1, 40) / 100.0,
                       burst, *rc::gen::inRange(1, 30) / 100.0, *rc::gen::inRange(0, 1000));
}

Scenario any_scenario() {
    Scenario its;
    its.length = *rc::gen::inRange(1'000, 4'000) * 1ms;
    its.look = time_until(its.length);
    const auto vehicles = *rc::gen::inRange<std::size_t>(1, 4);
    for (std::size_t i = 0; i < vehicles; ++i) its.vehicles.push_back(any_vehicle(i));
    for (auto i = *rc::gen::inRange(0, 6); i > 0; --i) its.events.push_back(any_event(its.length, vehicles));
    for (auto i = *rc::gen::inRange(0, 3); i > 0; --i)
        its.rates.push_back({MessageId{one_of<std::uint32_t>({24, 30, 32, 33, 105})}, *rc::gen::inRange(0, 251) * 1.0});
    its.faults = any_faults();
    its.is_repeatable = *rc::gen::arbitrary<bool>();
    for (auto i = *rc::gen::inRange(1, 9); i > 0; --i)
        its.steps.push_back(Nanoseconds{*rc::gen::inRange<std::int64_t>(1, one_of({4'000'000, 700'000'000}))});
    its.steps.push_back(20ms);  // ends soon enough
    return its;
}

// Numbers begin at 0 again in the middle of the flight.
bool restarts(const Event& event) { return event.text.ends_with("restart"); }

// ---- flights --------------------------------------------------------------------------------------------------------

// The far end of a TCP link.
class Station {
public:
    Station() {
        sockaddr_in address{.sin_family = AF_INET, .sin_port = 0, .sin_addr = {htonl(INADDR_LOOPBACK)}, .sin_zero = {}};
        socklen_t size = sizeof address;
        RC_ASSERT(::bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) == 0);
        RC_ASSERT(::listen(listener_, 1) == 0);
        RC_ASSERT(::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
        port_ = ntohs(address.sin_port);
        reader_ = std::thread([this] { read(); });
    }
    Station(const Station&) = delete;
    Station& operator=(const Station&) = delete;
    ~Station() {
        ::shutdown(listener_, SHUT_RDWR);  // ends `accept`
        if (reader_.joinable()) reader_.join();
        ::close(listener_);
    }
    [[nodiscard]] int port() const { return port_; }

    // All that comes until the other side closes the connection.
    [[nodiscard]] const Bytes& received() {
        reader_.join();
        return received_;
    }

private:
    void read() {
        const int peer = ::accept(listener_, nullptr, nullptr);
        std::array<std::uint8_t, 65536> some;
        for (auto size = ::read(peer, some.data(), some.size()); size > 0; size = ::read(peer, some.data(), some.size()))
            received_.insert(received_.end(), some.begin(), some.begin() + size);
        ::close(peer);
    }

    int listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
    int port_ = 0;
    Bytes received_;
    std::thread reader_;
};

struct Flown {
    Bytes recorded, received;
    std::string looked, ended;  // the states of the vehicles
    std::uint64_t lost = 0, duplicated = 0, gaps = 0;
};

std::vector<TimedOrder> orders_of(const Scenario& scenario) {
    std::vector<TimedOrder> orders;
    for (const auto& event : scenario.events)
        orders.push_back({event.at, event.text, *request_of_order(event.text, event.system)});
    // Then each source is heard again, so that what it lost before can be seen.
    orders.push_back({scenario.length, "fail radio ok", *request_of_order("fail radio ok", {})});
    orders.push_back({scenario.length, "the end of the faults", R"({"cmd":"fault","name":"far","out":"off"})"});
    return orders;
}

class Flight {
public:
    Flight(const Scenario& scenario, double speed) : scenario_(scenario), end_(scenario.length + 1500ms) {
        sut_ = *Simulator::create(dialect::default_dialect(),
                                  {.speed = speed,
                                   .flight_end = end_,
                                   .utc_at_start = WallTime{1'000'000s},
                                   .orders = orders_of(scenario),
                                   .rates = scenario.rates,
                                   .is_repeatable = scenario.is_repeatable},
                                  [](config::LogLevel, std::string_view) {});
        RC_ASSERT(sut_->open_recording(folder_ / "x.tlog"));
        for (const auto& vehicle : scenario.vehicles) RC_ASSERT(sut_->add(vehicle));
        const auto url = fmt::format("tcpout://127.0.0.1:{}?name=far&queue_bytes=64M&queue_age=1h&{}", station_.port(),
                                     scenario.faults);
        RC_ASSERT(sut_->add({*endpoint::parse_endpoint(url)}));
        sut_->pause();
        while (sut_->reports().size() < 2) sut_->turn(mono_now() + 1ms);  // the recording, and the station
    }

    void by_steps(const std::vector<Nanoseconds>& steps) {
        for (std::size_t i = 0; sut_->flight_time() < end_; ++i) {
            const auto now = sut_->flight_time();
            const auto stop = now < scenario_.look ? scenario_.look : end_;
            RC_ASSERT(sut_->step(std::min(steps[std::min(i, steps.size() - 1)], stop - now)));
            if (sut_->flight_time() == scenario_.look) flown_.looked = states();
        }
    }
    void by_itself() {
        sut_->resume();
        while (!sut_->has_ended()) sut_->turn(mono_now() + 1ms);
    }

    [[nodiscard]] Flown end() {
        flown_.ended = states();
        const auto counters = sut_->links().links().front().counters;
        RC_ASSERT(sut_->finish(60s));
        flown_.lost = counters->fault_lost.value();
        flown_.duplicated = counters->fault_duplicated.value();
        flown_.gaps = sut_->totals().gaps;
        sut_.reset();
        flown_.received = station_.received();
        flown_.recorded = test::content_of(folder_ / "x.tlog");
        return flown_;
    }

private:
    [[nodiscard]] std::string states() const { return sut_->answer(R"({"cmd":"state"})").next_text(); }

    const Scenario& scenario_;
    Nanoseconds end_;
    TempDir folder_;
    Station station_;
    std::unique_ptr<Simulator> sut_;
    Flown flown_;
};

Flown flown_by(const Scenario& scenario, const std::vector<Nanoseconds>& steps) {
    Flight flight(scenario, max_speed);
    flight.by_steps(steps);
    return flight.end();
}

Flown flown_by_itself(const Scenario& scenario, double speed) {
    Flight flight(scenario, speed);
    flight.by_itself();
    return flight.end();
}

// ---- sequences ------------------------------------------------------------------------------------------------------

// Follows the numbers of each source, which begin at 0. If none can be missing, a 0 that is too early begins again.
class Numbers {
public:
    explicit Numbers(bool is_whole) : is_whole_(is_whole) {}

    void note(const wire::FrameView& frame) {
        const auto [at, is_new] = next_.try_emplace({frame.system().value, frame.source().component.value}, 0);
        const auto step = static_cast<std::uint8_t>(frame.sequence() - at->second);
        if (step != 0 && is_whole_ && frame.sequence() == 0) ++begun_again[frame.system().value];
        else if (step == 255) ++copies;
        else missing += step;
        at->second = static_cast<std::uint8_t>(frame.sequence() + 1);
    }

    std::uint64_t missing = 0, copies = 0;
    std::map<unsigned, std::size_t> begun_again;  // by system

private:
    bool is_whole_;
    std::map<std::pair<unsigned, unsigned>, std::uint8_t> next_;
};

Numbers numbers_received(const Bytes& bytes) {
    Numbers numbers(false);
    for (ByteView rest = bytes; !rest.empty();) {
        const auto frame = rest.first(wire::frame_length(rest));
        numbers.note(wire::FrameView::unchecked(frame));
        rest = rest.subspan(frame.size());
    }
    return numbers;
}

Numbers numbers_recorded(const Bytes& tlog) {
    const TempDir folder;
    test::write_file(folder / "x.tlog", tlog);
    auto reader = record::TlogReader::open(folder / "x.tlog", dialect::default_dialect().wire_table());
    Numbers numbers(true);
    while (const auto record = reader->next()) numbers.note(record->frame);
    RC_ASSERT(reader->counters().lost_bytes.value() == 0u);
    return numbers;
}

// ---- properties -----------------------------------------------------------------------------------------------------

void expect_equal(const Flown& flown, const Flown& other) {
    RC_ASSERT(flown.ended == other.ended);
    RC_ASSERT((flown.recorded == other.recorded));
    RC_ASSERT((flown.received == other.received));
}

RC_GTEST_PROP(Flight, DoesNotDependOnItsSteps, ()) {
    const auto scenario = *rc::gen::exec(any_scenario);
    const auto whole = flown_by(scenario, {Simulator::max_step});
    RC_ASSERT(whole.gaps == 0u);
    const auto stepped = flown_by(scenario, scenario.steps);
    RC_ASSERT(!whole.looked.empty());
    RC_ASSERT(stepped.looked == whole.looked);
    expect_equal(stepped, whole);
    expect_equal(flown_by_itself(scenario, max_speed), whole);
    if (scenario.is_repeatable) expect_equal(flown_by_itself(scenario, 100), whole);
}

RC_GTEST_PROP(Flight, SendsNothingTwiceAndHasNoGapsButThoseOfItsFaults, ()) {
    const auto scenario = *rc::gen::exec(any_scenario);
    const auto flown = flown_by_itself(scenario, max_speed);
    RC_ASSERT(flown.gaps == 0u);

    const auto recorded = numbers_recorded(flown.recorded);
    RC_ASSERT(recorded.missing == 0u && recorded.copies == 0u);
    for (const auto& [system, count] : recorded.begun_again) {
        const auto named = std::ranges::count_if(
            scenario.events, [&](const Event& event) { return event.system.value == system && restarts(event); });
        RC_ASSERT(count <= 2 * static_cast<std::size_t>(named));  // of the autopilot and the gimbal
    }

    RC_PRE(std::ranges::none_of(scenario.events, restarts));
    const auto received = numbers_received(flown.received);
    RC_ASSERT(received.missing == flown.lost);
    RC_ASSERT(received.copies == flown.duplicated);
}

}  // namespace
}  // namespace mavloom::simserve
