#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Offboard control of a PX4: set points first, then the mode, then arming."""
import sys
import time
from pymavlink import mavutil
from pymavlink.quaternion import QuaternionBase

px4 = mavutil.mavlink_connection(sys.argv[1], source_system=1, source_component=191)
px4.wait_heartbeat()
print("PX4", px4.target_system, px4.flightmode, sorted(px4.mode_mapping())[:4])


def setpoint(i):
    px4.mav.set_attitude_target_send(i * 20, px4.target_system, 1, 0b00000111, QuaternionBase([0.0, 0.1, i * 0.01]),
                                     0, 0, 0, 0.5)


for i in range(10):
    setpoint(i)
    time.sleep(0.002)
px4.set_mode("OFFBOARD")
print("mode", px4.recv_match(type="COMMAND_ACK", blocking=True, timeout=5).result)
for i in range(10, 20):
    setpoint(i)
px4.mav.command_long_send(px4.target_system, 1, mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0,
                          1, 21196, 0, 0, 0, 0, 0)
print("arm", px4.recv_match(type="COMMAND_ACK", blocking=True, timeout=5).result)
px4.motors_armed_wait()
px4.recv_match(condition="MAV.flightmode == 'OFFBOARD'", blocking=True, timeout=5)
print(px4.flightmode, bool(px4.motors_armed()))
