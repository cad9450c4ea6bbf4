#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Flies a PX4 offboard: a thread sends set-points at 20 Hz while the main loop watches the position."""
import sys
import threading
import time
from pymavlink import mavutil

px4 = mavutil.mavlink_connection(sys.argv[1], source_system=255, source_component=191)
px4.wait_heartbeat()
target, lock, stop = [0.0, 0.0, -5.0], threading.Lock(), threading.Event()
POSITION = 0b0000110111111000


def stream():
    while not stop.is_set():
        with lock:
            x, y, z = target
            px4.mav.set_position_target_local_ned_send(
                int(time.time() * 1000) & 0xffffffff, px4.target_system, px4.target_component,
                mavutil.mavlink.MAV_FRAME_LOCAL_NED, POSITION, x, y, z, 0, 0, 0, 0, 0, 0, 0, 0)
        time.sleep(0.05)


def command(number, *params):
    with lock:
        px4.mav.command_long_send(px4.target_system, px4.target_component, number, 0,
                                  *(list(params) + [0] * (7 - len(params))))
    while True:
        ack = px4.recv_match(type="COMMAND_ACK", blocking=True, timeout=5)
        if ack is None or ack.command == number:
            return None if ack is None else mavutil.mavlink.enums["MAV_RESULT"][ack.result].name


def fly_to(*place):
    with lock:
        target[:] = place
    end = time.time() + 60
    while time.time() < end:
        p = px4.recv_match(type="LOCAL_POSITION_NED", blocking=True, timeout=5)
        if p and max(abs(p.x - place[0]), abs(p.y - place[1]), abs(p.z - place[2])) < 0.5:
            return True
    return False


thread = threading.Thread(target=stream, daemon=True)
thread.start()
while (offboard := command(mavutil.mavlink.MAV_CMD_DO_SET_MODE, 1, 6)) != "MAV_RESULT_ACCEPTED":
    pass  # PX4 refuses until it has set-points
print("offboard", offboard)
print("arm", command(mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1))
px4.motors_armed_wait()
for corner in ((0, 0, -5), (8, 0, -5), (8, 8, -5), (0, 0, -5)):
    print(corner, fly_to(*corner), px4.flightmode)
print("land", command(mavutil.mavlink.MAV_CMD_NAV_LAND, 0, 0, 0, float("nan")))
px4.motors_disarmed_wait()
stop.set()
thread.join()
print("disarmed", not px4.motors_armed())
