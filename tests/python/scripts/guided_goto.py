#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Sends a copter in guided mode to a place, and turns it."""
import os
import sys

os.environ["MAVLINK20"] = "1"
from pymavlink import mavutil

vehicle = mavutil.mavlink_connection(sys.argv[1], source_system=255, source_component=190)
vehicle.wait_heartbeat()
vehicle.set_mode("GUIDED")
vehicle.recv_match(type="COMMAND_ACK", blocking=True, timeout=5)
here = vehicle.location()
print("from", here)
type_mask = (mavutil.mavlink.POSITION_TARGET_TYPEMASK_VX_IGNORE | mavutil.mavlink.POSITION_TARGET_TYPEMASK_VY_IGNORE |
             mavutil.mavlink.POSITION_TARGET_TYPEMASK_VZ_IGNORE | mavutil.mavlink.POSITION_TARGET_TYPEMASK_AX_IGNORE |
             mavutil.mavlink.POSITION_TARGET_TYPEMASK_AY_IGNORE | mavutil.mavlink.POSITION_TARGET_TYPEMASK_AZ_IGNORE |
             mavutil.mavlink.POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE)
for step in range(5):
    vehicle.mav.set_position_target_global_int_send(
        step * 1000, vehicle.target_system, vehicle.target_component,
        mavutil.mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, type_mask,
        int(here.lat * 1e7) + step * 1000, int(here.lng * 1e7), 15.0, 0, 0, 0, 0, 0, 0, 0.5, 0)
vehicle.mav.send(vehicle.mav.command_long_encode(
    vehicle.target_system, 1, mavutil.mavlink.MAV_CMD_CONDITION_YAW, 0, 90, 25, 1, 0, 0, 0, 0))
print(vehicle.recv_match(type="COMMAND_ACK", blocking=True, timeout=5))
vehicle.mav.set_position_target_local_ned_send(
    0, vehicle.target_system, vehicle.target_component, mavutil.mavlink.MAV_FRAME_LOCAL_NED, 0b110111000111,
    0, 0, 0, 1.5, -0.5, 0, 0, 0, 0, 0, 0)
print(vehicle.mav.seq, vehicle.mav.total_packets_sent)
