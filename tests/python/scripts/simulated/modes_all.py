#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Goes through flight modes by name and by number, and waits for each in the heartbeats."""
import sys
import time
from pymavlink import mavutil

master = mavutil.mavlink_connection(sys.argv[1])
master.wait_heartbeat()
mapping = master.mode_mapping()
autopilot = mavutil.mavlink.enums["MAV_AUTOPILOT"][master.field("HEARTBEAT", "autopilot")]
print(len(mapping) > 8, "autopilot", autopilot.name)


def wait_mode(name):
    end = time.time() + 10
    while time.time() < end:
        msg = master.recv_match(type="HEARTBEAT", blocking=True, timeout=2)
        if msg is not None and msg.get_srcComponent() == 1 and mavutil.mode_string_v10(msg) == name:
            return True
    return False


for mode in sys.argv[2:]:
    if mode not in mapping:
        print("Unknown mode : {}".format(mode))
        print("Try:", len(list(mapping.keys())) > 0)
        continue
    if isinstance(mapping[mode], int):
        master.mav.set_mode_send(master.target_system, mavutil.mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, mapping[mode])
    else:
        master.set_mode(mode)
    print(mode, wait_mode(mode), master.flightmode == mode)
