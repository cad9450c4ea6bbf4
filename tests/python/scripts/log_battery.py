#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The batteries and ESCs of a flight, with units."""
import sys
from pymavlink import mavutil

mlog = mavutil.mavlink_connection(sys.argv[1])
seen = {}
while True:
    msg = mlog.recv_match(type=["BATTERY_STATUS", "SYS_STATUS", "ESC_STATUS"], condition="SYS_STATUS.voltage_battery>0")
    if msg is None:
        break
    if isinstance(msg, mavutil.mavlink.MAVLink_battery_status_message):
        cells = [v / 1000.0 for v in msg.voltages if v != 65535]
        print("battery %u: %s V, %.2f A, %d %%" % (msg.id, cells, msg.current_battery / 100.0, msg.battery_remaining))
        print("  ", msg.fieldunits_by_name["voltages"], msg.fieldenums_by_name["type"], msg.get_fieldnames()[:4])
    elif msg.get_type() == "ESC_STATUS":
        seen[msg.index] = (msg.rpm, len(msg.voltage))
    else:
        load = msg.load / 10.0
for index in sorted(seen):
    print("escs from", index, seen[index])
names = sorted(name for name in mlog.messages if "BATTERY" in name)
print("load", load, mlog.messages["BATTERY_STATUS"].battery_remaining, names)
print(mlog.messages["BATTERY_STATUS"][0].voltages[0], mlog.field("SYS_STATUS", "voltage_battery", 0))
