#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A small Vehicle class in the manner of DroneKit: attributes that a thread keeps, listeners, simple_goto."""
import math
import sys
import threading
import time
from pymavlink import mavutil


class Vehicle:
    def __init__(self, url):
        self.master = mavutil.mavlink_connection(url, source_system=255, source_component=190)
        self.listeners = {}
        self.location = self.heading = None
        self.armed = False
        self.mode = ""
        self.alive = True
        self.master.wait_heartbeat(timeout=30)
        self.master.mav.request_data_stream_send(self.master.target_system, self.master.target_component,
                                                 mavutil.mavlink.MAV_DATA_STREAM_ALL, 10, 1)
        self.thread = threading.Thread(target=self.read, daemon=True)
        self.thread.start()

    def on_message(self, name):
        def decorator(function):
            self.listeners.setdefault(name, []).append(function)
            return function
        return decorator

    def read(self):
        while self.alive:
            msg = self.master.recv_msg()
            if msg is None:
                time.sleep(0.005)
                continue
            name = msg.get_type()
            if name == "HEARTBEAT" and msg.get_srcComponent() == 1:
                self.armed = (msg.base_mode & mavutil.mavlink.MAV_MODE_FLAG_SAFETY_ARMED) != 0
                self.mode = mavutil.mode_string_v10(msg)
            elif name == "GLOBAL_POSITION_INT":
                self.location = (msg.lat / 1e7, msg.lon / 1e7, msg.relative_alt / 1e3)
            for function in self.listeners.get(name, []):
                function(self, name, msg)

    def wait_for(self, condition, what, timeout=60):
        end = time.time() + timeout
        while not condition():
            if time.time() > end:
                sys.exit("timeout: " + what)
            time.sleep(0.05)
        print(what)

    def command(self, command, *params):
        values = list(params) + [0] * (7 - len(params))
        self.master.mav.command_long_send(self.master.target_system, self.master.target_component, command, 0, *values)

    def set_mode(self, name):
        self.master.set_mode(self.master.mode_mapping()[name])
        self.wait_for(lambda: self.mode == name, "mode " + name)

    def simple_takeoff(self, alt):
        self.command(mavutil.mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, alt)

    def simple_goto(self, lat, lon, alt):
        self.master.mav.mission_item_send(
            self.master.target_system, self.master.target_component, 0, mavutil.mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT,
            mavutil.mavlink.MAV_CMD_NAV_WAYPOINT, 2, 0, 0, 0, 0, 0, lat, lon, alt)

    def send_ned_velocity(self, north, east, down):
        self.master.mav.set_position_target_local_ned_send(
            0, self.master.target_system, self.master.target_component, mavutil.mavlink.MAV_FRAME_LOCAL_NED,
            0b0000111111000111, 0, 0, 0, north, east, down, 0, 0, 0, 0, 0)


def distance(a, b):
    dlat, dlon = a[0] - b[0], (a[1] - b[1]) * math.cos(math.radians(a[0]))
    return math.sqrt(dlat * dlat + dlon * dlon) * 1.113195e5


vehicle = Vehicle(sys.argv[1])
attitudes = []


@vehicle.on_message("ATTITUDE")
def listener(self, name, message):
    attitudes.append(message.yaw)


vehicle.wait_for(lambda: vehicle.location, "position")
home = vehicle.location
vehicle.set_mode("GUIDED")
vehicle.command(mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
vehicle.wait_for(lambda: vehicle.armed, "armed")
vehicle.simple_takeoff(10)
vehicle.wait_for(lambda: vehicle.location[2] > 9.5, "took off")
target = (home[0] + 0.0003, home[1], 10)
vehicle.simple_goto(*target)
vehicle.wait_for(lambda: distance(vehicle.location, target) < 1, "reached the target")
turn, start = vehicle.location, time.time()
while distance(vehicle.location, turn) < 10 and time.time() < start + 20:
    vehicle.send_ned_velocity(0, 5, 0)
    time.sleep(0.1)
print("flew east:", vehicle.location[1] > turn[1], abs(vehicle.location[0] - turn[0]) < 3e-5)
vehicle.set_mode("RTL")
vehicle.wait_for(lambda: not vehicle.armed, "landed")
print("at home:", distance(vehicle.location, home) < 2, len(attitudes) > 20)
vehicle.alive = False
vehicle.thread.join()
