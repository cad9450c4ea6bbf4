#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the attitude of a flight as CSV."""
import sys
from pymavlink import mavutil

mlog = mavutil.mavlink_connection(sys.argv[1])
print("timestamp,roll,pitch,yaw")
while True:
    msg = mlog.recv_match(type=["ATTITUDE"])
    if msg is None:
        break
    print("%.6f,%.5f,%.5f,%.5f" % (msg._timestamp, msg.roll, msg.pitch, msg.yaw))
