#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Requests messages at rates with SET_MESSAGE_INTERVAL, and measures them by the vehicle's clock."""
import sys
from pymavlink import mavutil

master = mavutil.mavlink_connection(sys.argv[1])
master.wait_heartbeat()
mavlink = mavutil.mavlink


def request_message_interval(message_id, frequency_hz):
    master.mav.command_long_send(master.target_system, master.target_component, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 0,
                                 message_id, 1e6 / frequency_hz if frequency_hz > 0 else -1, 0, 0, 0, 0, 0)
    while True:
        response = master.recv_match(type="COMMAND_ACK", blocking=True, timeout=5)
        if response is None or response.command == mavlink.MAV_CMD_SET_MESSAGE_INTERVAL:
            return response is not None and response.result == mavlink.MAV_RESULT_ACCEPTED


def rate(name, count=20):
    times = []
    while len(times) < count:
        times.append(master.recv_match(type=name, blocking=True, timeout=5).time_boot_ms)
    gaps = sorted(b - a for a, b in zip(times, times[1:]))
    return 1000.0 / gaps[len(gaps) // 2]


for message_id, name, hz in ((mavlink.MAVLINK_MSG_ID_ATTITUDE, "ATTITUDE", 20),
                             (mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT, "GLOBAL_POSITION_INT", 10),
                             (mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED, "LOCAL_POSITION_NED", 10)):
    ok = request_message_interval(message_id, hz)
    print(name, ok, abs(rate(name) / hz - 1) < 0.2)

master.mav.command_long_send(master.target_system, master.target_component, mavlink.MAV_CMD_GET_MESSAGE_INTERVAL, 0,
                             mavlink.MAVLINK_MSG_ID_ATTITUDE, 0, 0, 0, 0, 0, 0)
answer = master.recv_match(type="MESSAGE_INTERVAL", blocking=True, timeout=5)
print(answer.message_id, answer.interval_us)
print("stopped", request_message_interval(mavlink.MAVLINK_MSG_ID_ATTITUDE, 0))
while master.recv_match(type="ATTITUDE", blocking=False) is not None:
    pass
print(master.recv_match(type="ATTITUDE", blocking=True, timeout=0.3))
master.mav.command_long_send(master.target_system, master.target_component, mavlink.MAV_CMD_REQUEST_MESSAGE, 0,
                             mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION, 0, 0, 0, 0, 0, 0)
version = master.recv_match(type="AUTOPILOT_VERSION", blocking=True, timeout=5)
print("capabilities", bool(version.capabilities & mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_INT),
      version.flight_sw_version >> 24 > 0)
