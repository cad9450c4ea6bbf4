// SPDX-License-Identifier: MIT
// Any bytes as the messages of an autopilot to a simulated vehicle, with time passing between them. The times of the
// steps grow, no sensor shows a value that is no number, and the counters account for every step.
//
// An input begins with a byte of options. Then come actions: a byte of which the low three bits choose the kind, and
// its arguments.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "mavloom/hil/pair.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/hil_actuator_controls.hpp"
#include "mavloom/msg/hil_gps.hpp"
#include "mavloom/msg/hil_sensor.hpp"
#include "mavloom/wire/struct_frame.hpp"

namespace {

using namespace mavloom;
using namespace std::chrono_literals;

void require(bool holds) {
    if (!holds) std::abort();
}

class Session {
public:
    Session(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size), pair_(options(byte())) {
        pair_.begin(now_);
    }

    void run() {
        while (at_ != end_) act(byte());
        const auto& counters = pair_.lock_step().counters();
        require(counters.answered + counters.unanswered <= counters.steps);
        require(counters.steps == steps_);
    }

private:
    std::uint8_t byte() { return at_ == end_ ? std::uint8_t{0} : *at_++; }

    static hil::PairOptions options(std::uint8_t bits) {
        hil::PairOptions options;
        options.speed = (bits & 1) != 0 ? 1 : hil::any_speed;
        options.has_own_clock = (bits & 2) != 0;
        options.vehicle.has_noise = (bits & 4) != 0;
        options.rates.distance_hz = (bits & 8) != 0 ? 100 : 0;
        options.rates.imu_hz = (bits & 16) != 0 ? 1000 : 250;
        options.rates.imus = (bits & 32) != 0 ? 3 : 1;
        options.vehicle.kind = static_cast<flight::Kind>((bits >> 5) % 3);
        return options;
    }

    void act(std::uint8_t what) {
        switch (what & 7) {
            case 0: return step(1 + (what >> 3));
            case 1: return answer(what);
            case 2: return message<msg::HilActuatorControls>();
            case 3: return message<msg::CommandLong>();
            case 4: return message<msg::Heartbeat>();
            case 5: return restart();
            case 6: return manage(what >> 3);
            default: now_ += std::chrono::milliseconds{byte()}; return;
        }
    }
    void step(int most) {
        for (int i = 0; i < most && pair_.due() != MonoTime::max(); ++i) {
            now_ = std::max(now_, pair_.due());
            for (const auto& frame : pair_.step(now_)) check(frame);
            ++steps_;
        }
    }
    void check(const wire::FrameView& frame) {
        require(wire::frame_length(frame.bytes()) == frame.size());
        if (frame.id() != msg::HilSensor::id) return;
        const auto sensor = msg::HilSensor::decode(frame.payload());
        require(sensor.id_ == 0 ? sensor.time_usec > time_us_ : sensor.time_usec == time_us_);
        time_us_ = sensor.time_usec;
        for (const float value : {sensor.xacc, sensor.yacc, sensor.zacc, sensor.xgyro, sensor.ygyro, sensor.zgyro,
                                  sensor.xmag, sensor.abs_pressure, sensor.temperature})
            require(std::isfinite(value));
    }
    // To the last step, or to one near it.
    void answer(std::uint8_t what) {
        msg::HilActuatorControls controls{.time_usec = time_us_ + (what >> 3) - 2u, .mode = 129, .flags = 1};
        for (int i = 0; i < 4; ++i) controls.controls[static_cast<std::size_t>(i)] = static_cast<float>(byte()) / 200;
        if ((what & 8) != 0) controls.time_usec = time_us_;
        send(controls);
    }
    template <class Message>
    void message() {
        std::array<std::uint8_t, Message::max_length> payload;
        std::ranges::generate(payload, [this] { return byte(); });
        send(Message::decode(payload));
    }
    template <class Message>
    void send(const Message& message) {
        wire::FrameBuffer buffer;
        const Source source{SystemId{1}, ComponentId{1}};
        pair_.receive(wire::write_frame(buffer, {.source = source}, message), now_);
    }
    void restart() {
        pair_.end();
        require(pair_.due() == MonoTime::max());
        pair_.begin(now_);
    }
    void manage(int what) {
        if (what == 0) pair_.pause(now_);
        if (what == 1) pair_.resume(now_);
        if (what == 2) pair_.allow(std::chrono::milliseconds{byte()});
        if (what == 3) pair_.reset();
        if (what == 4) pair_.push({.north_m_s = byte() / 10.0, .yaw_deg_s = byte() * 4.0});
        if (what == 5) pair_.set_wind({.speed_m_s = byte() / 5.0, .gust_m_s = byte() / 20.0});
        if (what == 6) pair_.set_mass(0.5 + byte() / 10.0);
        if (what == 7) fail();
    }
    void fail() {
        const auto forms = flight::fault_forms();
        const flight::FaultForm& form = forms[byte() % forms.size()];
        flight::Fault fault{.part = form.part, .kind = form.kind, .count = form.most};
        for (std::size_t i = 0; i < form.most; ++i)
            fault.numbers.at(i) = std::round(form.lowest + (form.highest - form.lowest) * byte() / 255);
        require(pair_.fail(fault).has_value() || !hil::has_part(form.part) || form.part == flight::FaultPart::motor);
    }

    const std::uint8_t* at_;
    const std::uint8_t* end_;
    MonoTime now_{1h};
    hil::Pair pair_;
    std::uint64_t time_us_ = 0, steps_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Session(data, std::min<std::size_t>(size, 4096)).run();
    return 0;
}
