#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Downloads the mission of a vehicle, and writes it as QGC WPL 110."""
import sys
from pymavlink import mavutil

connection = mavutil.mavlink_connection(sys.argv[1], baud=57600, autoreconnect=True)
connection.wait_heartbeat()
connection.waypoint_request_list_send()
count = connection.recv_match(type="MISSION_COUNT", blocking=True, timeout=5)
print("QGC WPL 110")
for i in range(count.count):
    connection.mav.mission_request_int_send(connection.target_system, connection.target_component, i)
    while True:
        item = connection.recv_match(type=["MISSION_ITEM_INT", "MISSION_ITEM"], blocking=True, timeout=5)
        if item is not None and item.seq == i:
            break
    print("%u\t%u\t%u\t%u\t%f\t%f\t%f\t%f\t%.7f\t%.7f\t%f\t%u" % (
        item.seq, item.current, item.frame, item.command, item.param1, item.param2, item.param3, item.param4,
        item.x / 1e7, item.y / 1e7, item.z, item.autocontinue))
connection.mav.mission_ack_send(connection.target_system, connection.target_component,
                                mavutil.mavlink.MAV_MISSION_ACCEPTED)
