#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Forwards the messages of a vehicle to a ground station, and the answers back."""
import select
import sys
import time
from pymavlink import mavutil

vehicle = mavutil.mavlink_connection(sys.argv[1])
station = mavutil.mavlink_connection(sys.argv[2], input=False)
forwarded = returned = 0
end = time.time() + 20
while (forwarded < 40 or returned < 3) and time.time() < end:
    select.select([vehicle.fd, station.fd], [], [], 0.1)
    while (msg := vehicle.recv_msg()) is not None:
        if msg.get_type() != "BAD_DATA":
            station.write(msg.get_msgbuf())
            forwarded += 1
    while (msg := station.recv_msg()) is not None:
        if msg.get_type() == "COMMAND_LONG":
            print(msg.get_srcSystem(), msg.command, [msg.param1, msg.param7])
        vehicle.write(msg.get_msgbuf())
        returned += 1
print(forwarded >= 40, returned)
