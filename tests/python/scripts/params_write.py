#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Reads a parameter, sets it and checks it."""
import sys
from pymavlink import mavutil

master = mavutil.mavlink_connection(sys.argv[1])
master.wait_heartbeat()

master.mav.param_request_read_send(master.target_system, master.target_component, b"RTL_ALT", -1)
message = master.recv_match(type="PARAM_VALUE", blocking=True).to_dict()
print("name: %s\tvalue: %d" % (message["param_id"], message["param_value"]))

master.mav.param_set_send(master.target_system, master.target_component, b"RTL_ALT", 2000.0,
                          mavutil.mavlink.MAV_PARAM_TYPE_REAL32)
message = master.recv_match(type="PARAM_VALUE", blocking=True)
print("name: %s\tvalue: %d" % (message.param_id, message.param_value))

master.param_set_send("WPNAV_SPEED", 750)
ack = master.recv_match(condition='PARAM_VALUE.param_id == "WPNAV_SPEED"', type="PARAM_VALUE", blocking=True, timeout=5)
print(ack)
master.param_fetch_one("WPNAV_SPEED")
print(master.recv_match(type=["PARAM_VALUE"], blocking=True, timeout=5).param_value, master.params["RTL_ALT"])
