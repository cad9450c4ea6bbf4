#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Uploads a mission, item by item as the vehicle requests them."""
import sys
from pymavlink import mavutil

master = mavutil.mavlink_connection(sys.argv[1])
master.wait_heartbeat(blocking=True)
mavlink = mavutil.mavlink

frame = mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT
waypoints = [(-35.363 + i * 0.001, 149.165 + i * 0.0005, 20 + i) for i in range(5)]
items = []
for seq, (lat, lon, alt) in enumerate(waypoints):
    items.append(mavlink.MAVLink_mission_item_int_message(
        master.target_system, master.target_component, seq, frame, mavlink.MAV_CMD_NAV_WAYPOINT, 0, 1,
        0, 10, 0, float("nan"), int(lat * 1e7), int(lon * 1e7), alt))

master.waypoint_clear_all_send()
ack = master.recv_match(type="MISSION_ACK", blocking=True, timeout=5)
print("clear:", mavlink.enums["MAV_MISSION_RESULT"][ack.type].name)
master.waypoint_count_send(len(items))
for i in range(len(items)):
    msg = master.recv_match(type=["MISSION_REQUEST", "MISSION_REQUEST_INT"], blocking=True, timeout=5)
    master.mav.send(items[msg.seq])
    print("Sending waypoint", msg.seq, items[msg.seq].x, items[msg.seq].frame)
ack = master.recv_match(type="MISSION_ACK", blocking=True, timeout=5)
print("upload:", mavlink.enums["MAV_MISSION_RESULT"][ack.type].name)
master.waypoint_set_current_send(1)
print("current:", master.waypoint_current())
