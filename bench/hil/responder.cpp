// SPDX-License-Identifier: MIT
// The upper bound of `bench hil`: a simulator that computes nothing. It sends the sensors of a vehicle at rest, 250 a
// second of flight, each as soon as the autopilot has answered the last one, and every 4 ms before the first answer.
// The magnetometer and the barometer toggle by their least unit: PX4 takes a sensor that never moves for a failed
// one.
//
// Usage: hil_responder PORT COUNTER. The file COUNTER gets the number of answered steps, as 8 bytes.
#include <fcntl.h>
#include <sys/mman.h>

#include <atomic>

#include "loopback.hpp"

namespace {

using hil_bench::Connection;

constexpr std::uint64_t step_us = 4000;
constexpr std::uint32_t inertial = 0x3F, magnetometer = 0x1C0, barometer = 0x1A00;

mavlink_message_t sensors(std::uint64_t step) {
    const bool with_slow = step % 5 == 0;  // magnetometer and barometer at 50 Hz
    const float toggle = step % 10 == 0 ? 1.0F : 0.0F;
    mavlink_hil_sensor_t values{};
    values.time_usec = step * step_us;
    values.zacc = -9.80665F;
    values.temperature = 15;
    values.fields_updated = inertial;
    if (with_slow) {
        values.xmag = 0.2151F + 1e-4F * toggle;
        values.ymag = 0.0127F;
        values.zmag = 0.4303F;
        values.abs_pressure = 955.98F + 1e-3F * toggle;
        values.pressure_alt = 488;
        values.fields_updated |= magnetometer | barometer;
    }
    mavlink_message_t message;
    mavlink_msg_hil_sensor_encode(1, 51, &message, &values);
    return message;
}

mavlink_message_t position(std::uint64_t step) {
    mavlink_hil_gps_t values{};
    values.time_usec = 1'700'000'000'000'000 + step * step_us;
    values.lat = 473'977'420;
    values.lon = 85'455'940;
    values.alt = 488'000;
    values.eph = 30;
    values.epv = 40;
    values.cog = 65535;
    values.fix_type = 3;
    values.satellites_visible = 10;
    mavlink_message_t message;
    mavlink_msg_hil_gps_encode(1, 51, &message, &values);
    return message;
}

std::atomic<std::uint64_t>* open_counter(const char* path) {
    const int fd = ::open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (fd < 0 || ::ftruncate(fd, sizeof(std::uint64_t)) != 0) std::exit(3);
    void* const memory = ::mmap(nullptr, sizeof(std::uint64_t), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    if (memory == MAP_FAILED) std::exit(3);
    return static_cast<std::atomic<std::uint64_t>*>(memory);
}

int wait_for_autopilot(const char* port) {
    const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int on = 1;
    ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    const sockaddr_in address = hil_bench::loopback(port);
    if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 || ::listen(fd, 1) != 0)
        std::exit(3);
    return ::accept4(fd, nullptr, nullptr, SOCK_CLOEXEC);
}

class Steps {
public:
    Steps(Connection& link, std::atomic<std::uint64_t>& answered) : link_(link), answered_(answered) {}

    void run() {
        for (std::uint64_t step = 1;; ++step) {
            link_.add(sensors(step));
            if (step % 25 == 1) link_.add(position(step));
            if (!link_.flush() || !wait_for_answer(step * step_us)) return;
        }
    }

private:
    // Returns false if the autopilot is gone.
    bool wait_for_answer(std::uint64_t time_us) {
        while (newest_us_ < time_us) {
            if (!link_.is_ready(newest_us_ == 0 ? 4 : 1000)) return true;
            if (!link_.read([&](const mavlink_message_t& message) { take(message); })) return false;
        }
        answered_.fetch_add(1, std::memory_order_relaxed);
        return true;
    }
    void take(const mavlink_message_t& message) {
        if (message.msgid == MAVLINK_MSG_ID_HIL_ACTUATOR_CONTROLS)
            newest_us_ = mavlink_msg_hil_actuator_controls_get_time_usec(&message);
    }

    Connection& link_;
    std::atomic<std::uint64_t>& answered_;
    std::uint64_t newest_us_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    std::atomic<std::uint64_t>& answered = *open_counter(argv[2]);
    Connection link(wait_for_autopilot(argv[1]));
    Steps(link, answered).run();
}
