#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Asks a vehicle for its attitude, and prints twenty of them."""
import sys
from pymavlink import mavutil

master = mavutil.mavlink_connection(sys.argv[1])
master.wait_heartbeat()
print("Heartbeat from system (system %u component %u)" % (master.target_system, master.target_component))
master.mav.request_data_stream_send(master.target_system, master.target_component,
                                    mavutil.mavlink.MAV_DATA_STREAM_EXTRA1, 10, 1)
received = 0
while received < 20:
    try:
        msg = master.recv_match(type="ATTITUDE", blocking=True, timeout=10)
        if not msg:
            raise ValueError()
        print(msg.to_dict())
        received += 1
    except KeyboardInterrupt:
        break
print(master.messages["ATTITUDE"].roll, master.flightmode, "%.1f" % master.field("ATTITUDE", "pitch", 0))
master.close()
