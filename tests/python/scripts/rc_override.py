#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Overrides the channels of a submarine's remote control, and turns on its lights."""
import sys
from pymavlink import mavutil

master = mavutil.mavlink_connection(sys.argv[1])
master.wait_heartbeat()


def set_rc_channel_pwm(channel_id, pwm=1500):
    if channel_id < 1 or channel_id > 18:
        print("Channel does not exist.")
        return
    rc_channel_values = [65535 for _ in range(18)]
    rc_channel_values[channel_id - 1] = pwm
    master.mav.rc_channels_override_send(master.target_system, master.target_component, *rc_channel_values)


set_rc_channel_pwm(2, 1600)
set_rc_channel_pwm(4, 1400)
set_rc_channel_pwm(20, 1400)
master.mav.manual_control_send(master.target_system, 500, -500, 250, 500, 1 + 1 << 3)
master.set_servo(9, 1900)
master.set_relay(0, True)
ack = master.recv_match(type="COMMAND_ACK", blocking=True, timeout=5)
print(ack.command, mavutil.mavlink.enums["MAV_RESULT"][ack.result].name)
print(mavutil.mode_mapping_byname(mavutil.mavlink.MAV_TYPE_SUBMARINE), mavutil.mode_mapping_bynumber(12)[19])
