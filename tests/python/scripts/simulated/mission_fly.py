#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Uploads a mission with mavwp, starts it, reports the waypoints as the copter reaches them, and logs the flight."""
import math
import sys
import time
from pymavlink import mavutil, mavwp

master = mavutil.mavlink_connection(sys.argv[1], source_system=255)
master.setup_logfile(sys.argv[2])
px4 = master.wait_heartbeat(timeout=30).autopilot == mavutil.mavlink.MAV_AUTOPILOT_PX4
print("heartbeat from", master.target_system, master.target_component)
mavlink = mavutil.mavlink

msg = master.recv_match(type="GLOBAL_POSITION_INT", blocking=True, timeout=30)
home_lat, home_lon = msg.lat / 1e7, msg.lon / 1e7


def offset(north, east):
    return (home_lat + math.degrees(north / 6378137.0),
            home_lon + math.degrees(east / (6378137.0 * math.cos(math.radians(home_lat)))))


wp = mavwp.MAVWPLoader()
frame = mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT


def add(command, north=0, east=0, alt=0, p1=0):
    lat, lon = offset(north, east)
    wp.add(mavlink.MAVLink_mission_item_message(master.target_system, master.target_component, wp.count(), frame,
                                                command, 0, 1, p1, 0, 0, 0, lat, lon, alt))


if not px4:
    add(mavlink.MAV_CMD_NAV_WAYPOINT)  # home
add(mavlink.MAV_CMD_NAV_TAKEOFF, alt=10)
add(mavlink.MAV_CMD_NAV_WAYPOINT, 20, 0, 12)
add(mavlink.MAV_CMD_NAV_WAYPOINT, 20, 20, 12)
add(mavlink.MAV_CMD_NAV_LAND, 0, 0, 0)

master.waypoint_clear_all_send()
print("cleared", master.recv_match(type="MISSION_ACK", blocking=True, timeout=10).type)
master.waypoint_count_send(wp.count())
while True:
    msg = master.recv_match(type=["MISSION_REQUEST", "MISSION_REQUEST_INT", "MISSION_ACK"], blocking=True, timeout=10)
    if msg.get_type() == "MISSION_ACK":
        print("uploaded", wp.count(), "items:", mavlink.enums["MAV_MISSION_RESULT"][msg.type].name)
        break
    item = wp.wp(msg.seq)
    if msg.get_type() == "MISSION_REQUEST_INT":
        master.mav.mission_item_int_send(item.target_system, item.target_component, item.seq, item.frame, item.command,
                                         item.current, item.autocontinue, item.param1, item.param2, item.param3,
                                         item.param4, int(item.x * 1e7), int(item.y * 1e7), item.z)
    else:
        master.mav.send(item)

master.set_mode("MISSION" if px4 else "GUIDED")
master.arducopter_arm()
master.motors_armed_wait()
print("armed")
master.mav.command_long_send(master.target_system, master.target_component, mavlink.MAV_CMD_MISSION_START,
                             0, 0, 0, 0, 0, 0, 0, 0)
deadline, last = time.time() + 90, -1
while time.time() < deadline:
    msg = master.recv_match(type=["MISSION_ITEM_REACHED", "HEARTBEAT"], blocking=True, timeout=10)
    if msg.get_type() == "MISSION_ITEM_REACHED":
        if msg.seq != last:  # PX4 repeats it
            print("reached", msg.seq, master.flightmode)
        last = msg.seq
    elif msg.get_srcSystem() == master.target_system and not master.motors_armed():
        print("landed and disarmed")
        break
master.close()
