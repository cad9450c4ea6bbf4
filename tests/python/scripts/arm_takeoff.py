#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Arms a copter, takes off to ten metres and lands."""
import sys
from pymavlink import mavutil

the_connection = mavutil.mavlink_connection(sys.argv[1])
the_connection.wait_heartbeat()
print("vehicle %u in mode %s" % (the_connection.target_system, the_connection.flightmode))


def wait_ack(command):
    while True:
        msg = the_connection.recv_match(type="COMMAND_ACK", blocking=True, timeout=5)
        if msg.command == command:
            return msg.result


if "GUIDED" not in the_connection.mode_mapping():
    print("Unknown mode")
    sys.exit(1)
the_connection.set_mode(the_connection.mode_mapping()["GUIDED"])
print("mode:", wait_ack(mavutil.mavlink.MAV_CMD_DO_SET_MODE))
the_connection.arducopter_arm()
print("arm:", wait_ack(mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM))
the_connection.motors_armed_wait()
print("Armed!")
the_connection.mav.command_long_send(the_connection.target_system, the_connection.target_component,
                                     mavutil.mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 0, 10)
print("takeoff:", wait_ack(mavutil.mavlink.MAV_CMD_NAV_TAKEOFF))
while True:
    msg = the_connection.recv_match(type="GLOBAL_POSITION_INT", blocking=True, timeout=5)
    print("height %.1f m" % (msg.relative_alt / 1000.0))
    if msg.relative_alt >= 9500:
        break
the_connection.set_mode("LAND")
print("land:", wait_ack(mavutil.mavlink.MAV_CMD_DO_SET_MODE))
the_connection.arducopter_disarm()
print("disarm:", wait_ack(mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM))
the_connection.motors_disarmed_wait()
print("Disarmed", the_connection.motors_armed() == 0)
