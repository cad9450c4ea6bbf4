#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Flies a copter by its sticks: RC_CHANNELS_OVERRIDE in ALT_HOLD, then the channels are released."""
import sys
import time
from pymavlink import mavutil

master = mavutil.mavlink_connection(sys.argv[1], source_system=255)
master.wait_heartbeat()


def override(roll=1500, pitch=1500, throttle=1500, yaw=1500):
    master.mav.rc_channels_override_send(master.target_system, master.target_component, roll, pitch, throttle, yaw,
                                         0, 0, 0, 0)


def hold(until, **sticks):
    end = time.time() + 60
    while time.time() < end:
        override(**sticks)
        msg = master.recv_match(type="GLOBAL_POSITION_INT", blocking=True, timeout=0.1)
        if msg is not None and until(msg):
            return True
    return False


override(throttle=1000)
master.set_mode("ALT_HOLD")
master.arducopter_arm()
while not master.motors_armed():
    override(throttle=1000)
    master.recv_match(type="HEARTBEAT", blocking=True, timeout=0.2)
print("armed in", master.flightmode)
print("climbed", hold(lambda m: m.relative_alt > 5000, throttle=1800))
rc = master.recv_match(type="RC_CHANNELS", blocking=True, timeout=5)
print("channels", rc.chan1_raw, rc.chan3_raw, rc.chan4_raw)
start = master.recv_match(type="GLOBAL_POSITION_INT", blocking=True, timeout=5)
print("flew forward", hold(lambda m: abs(m.lat - start.lat) + abs(m.lon - start.lon) > 500, pitch=1300))
print("down", hold(lambda m: m.relative_alt < 200, throttle=1100))
end = time.time() + 30
while master.motors_armed() and time.time() < end:
    override(throttle=1000)
    master.recv_match(type="HEARTBEAT", blocking=True, timeout=0.2)
print("disarmed", not master.motors_armed())
master.mav.rc_channels_override_send(master.target_system, master.target_component, *[0] * 8)
