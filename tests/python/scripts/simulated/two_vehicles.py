#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Flies two copters over one connection: each command names its system, each answer is read by its source."""
import sys
import time
from pymavlink import mavutil

master = mavutil.mavlink_connection(sys.argv[1])
systems = set()
while len(systems) < 2:
    msg = master.recv_match(type="HEARTBEAT", blocking=True, timeout=10)
    if msg.type == mavutil.mavlink.MAV_TYPE_QUADROTOR:
        systems.add(msg.get_srcSystem())
print("systems", sorted(systems))


def command(system, number, *params):
    master.mav.command_long_send(system, 1, number, 0, *(list(params) + [0] * (7 - len(params))))
    end = time.time() + 5
    while time.time() < end:
        ack = master.recv_match(type="COMMAND_ACK", blocking=True, timeout=1)
        if ack is not None and ack.get_srcSystem() == system and ack.command == number:
            return ack.result
    return None


for system in sorted(systems):
    master.mav.set_mode_send(system, 1, 4)
    print(system, "armed", command(system, mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1))
    print(system, "takeoff", command(system, mavutil.mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 5 * system))
heights, end = {}, time.time() + 60
while time.time() < end and not all(heights.get(s, 0) > 5 * s - 0.5 for s in systems):
    msg = master.recv_match(type="GLOBAL_POSITION_INT", blocking=True, timeout=5)
    heights[msg.get_srcSystem()] = msg.relative_alt / 1000.0
print({s: round(heights[s] / 5) for s in sorted(heights)})
for system in sorted(systems):
    master.target_system = system
    print(system, master.flightmode, master.motors_armed() > 0, round(master.messages["VFR_HUD"].alt) != 0)
print(sorted({m.get_srcSystem() for m in (master.recv_match(type="HEARTBEAT", blocking=True, timeout=5)
                                          for _ in range(6))} & systems))
