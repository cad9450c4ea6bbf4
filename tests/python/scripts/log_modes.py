#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Lists the flight modes, the arming and the texts of a flight."""
import sys
import time
from pymavlink import mavutil

log = mavutil.mavlink_connection(sys.argv[1])
mode = None
armed = None
while True:
    msg = log.recv_match(type=["HEARTBEAT", "STATUSTEXT", "COMMAND_ACK", "COMMAND_LONG"])
    if msg is None:
        break
    stamp = time.strftime("%H:%M:%S", time.gmtime(msg._timestamp))
    if msg.get_type() == "STATUSTEXT":
        name = mavutil.mavlink.enums["MAV_SEVERITY"][msg.severity].name
        print(stamp, name.replace("MAV_SEVERITY_", ""), msg.text)
    elif msg.get_type() == "COMMAND_LONG":
        commands = mavutil.mavlink.enums["MAV_CMD"]
        name = commands[msg.command].name if msg.command in commands else "?"
        print(stamp, "command", name, msg.param1, msg.param2)
    elif msg.get_type() == "COMMAND_ACK":
        print(stamp, "ack", msg.command, mavutil.mavlink.enums["MAV_RESULT"][msg.result].name)
    elif msg.type not in (mavutil.mavlink.MAV_TYPE_GCS, mavutil.mavlink.MAV_TYPE_ONBOARD_CONTROLLER):
        if log.flightmode != mode:
            mode = log.flightmode
            print(stamp, "mode", mode, mavutil.mode_string_v10(msg))
        now = bool(msg.base_mode & mavutil.mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
        if now != armed:
            armed = now
            print(stamp, "armed" if armed else "disarmed", log.motors_armed() != 0)
print(log.flightmode_list()[:4], log.target_system, log.mav_type)
