#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Copies the messages of one system to a new recording, and reads that."""
import hashlib
import os
import struct
import sys
from pymavlink import mavutil

source, target = sys.argv[1], sys.argv[1] + ".part"
log = mavutil.mavlink_connection(source, notimestamps=False)
with open(target, "wb") as out:
    while True:
        m = log.recv_match(condition="ATTITUDE.pitch < 0.05")
        if m is None:
            break
        if m.get_srcSystem() != 1 or m.get_type() == "BAD_DATA":
            continue
        out.write(struct.pack(">Q", int(m._timestamp * 1.0e6)) + m.get_msgbuf())

again = mavutil.mavlogfile(target)
count = 0
while again.recv_match(type="HEARTBEAT") is not None:
    count += 1
print(count, "heartbeats,", os.path.getsize(target), "bytes", hashlib.sha256(open(target, "rb").read()).hexdigest())
os.remove(target)
