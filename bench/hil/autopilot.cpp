// SPDX-License-Identifier: MIT
// Takes PX4's place in `bench hil` where there is no PX4: it answers each HIL_SENSOR, with motors at rest, after it has
// computed for this many microseconds.
//
// Usage: hil_autopilot PORT MICROSECONDS
#include <chrono>

#include "loopback.hpp"

namespace {

using hil_bench::Connection;

constexpr std::uint8_t lockstep_build = 1;

int connect_to(const char* port) {
    const sockaddr_in address = hil_bench::loopback(port);
    while (true) {
        const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return fd;
        ::close(fd);
        ::usleep(2000);
    }
}

// PX4's first words: it asks for HIL_STATE_QUATERNION every 5 ms.
void greet(Connection& link) {
    mavlink_message_t message;
    mavlink_msg_command_long_pack(1, 1, &message, 0, 0, MAV_CMD_SET_MESSAGE_INTERVAL, 0, 115, 5000, 0, 0, 0, 0, 0);
    link.add(message);
    mavlink_msg_heartbeat_pack(1, 1, &message, MAV_TYPE_GENERIC, MAV_AUTOPILOT_PX4, 0, 0, 0);
    link.add(message);
    link.flush();
}

void compute_for(std::chrono::microseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < end) {}
}

void answer(Connection& link, const mavlink_message_t& message, std::chrono::microseconds time) {
    if (message.msgid != MAVLINK_MSG_ID_HIL_SENSOR || mavlink_msg_hil_sensor_get_id(&message) != 0) return;
    compute_for(time);
    mavlink_hil_actuator_controls_t controls{};
    controls.time_usec = mavlink_msg_hil_sensor_get_time_usec(&message);
    controls.mode = MAV_MODE_FLAG_CUSTOM_MODE_ENABLED;
    controls.flags = lockstep_build;
    mavlink_message_t out;
    mavlink_msg_hil_actuator_controls_encode(1, 1, &out, &controls);
    link.add(out);
    link.flush();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const std::chrono::microseconds time{std::atoi(argv[2])};
    Connection link(connect_to(argv[1]));
    greet(link);
    while (link.read([&](const mavlink_message_t& message) { answer(link, message, time); })) {}
}
