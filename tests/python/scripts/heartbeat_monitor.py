#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A ground station's heartbeats in a thread, and a watch on those of the vehicle."""
import sys
import threading
import time
from pymavlink import mavutil

conn = mavutil.mavlink_connection(sys.argv[1])
hooked = []
conn.message_hooks.append(lambda c, m: hooked.append(m.get_type()))
conn.wait_heartbeat()


def beat(count):
    for _ in range(count):
        conn.mav.heartbeat_send(mavutil.mavlink.MAV_TYPE_GCS, mavutil.mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0)
        time.sleep(0.01)


thread = threading.Thread(target=beat, args=(10,), daemon=True)
thread.start()
seen = 0
while seen < 5:
    msg = conn.recv_match(type="HEARTBEAT", blocking=True, timeout=3)
    if msg is None:
        print("lost the vehicle")
        break
    if msg.get_srcSystem() == conn.target_system:
        seen += 1
thread.join()
print("alive:", seen, conn.target_system, mavutil.mavlink.enums["MAV_TYPE"][conn.mav_type].name,
      conn.time_since("HEARTBEAT") < 3, "HEARTBEAT" in hooked)
print(conn.recv_match(type="PING", blocking=True, timeout=0.1), conn.packet_loss() >= 0)
