# SPDX-License-Identifier: MIT
"""Flights with DroneKit (2.9.2, the last release): python dronekit_flights.py URL AUTOPILOT. Prints what it saw as one
line of JSON. The moves are those of DroneKit's examples guided_set_speed_yaw, simple_goto and mission_basic."""
import collections
import collections.abc
import json
import math
import sys
import time

collections.MutableMapping = collections.abc.MutableMapping  # DroneKit uses the name of Python before 3.10
import dronekit  # noqa: E402
from dronekit import Command, LocationGlobal, LocationGlobalRelative, VehicleMode  # noqa: E402
from pymavlink import mavutil  # noqa: E402

mavlink = mavutil.mavlink
HEIGHT = 5.0  # metres
TEXTS = []


def wait_for(condition, what, timeout=40):
    deadline = time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < deadline, f"waited {timeout} s in vain for {what}; texts: {TEXTS}"
        time.sleep(0.02)


def offset(place, north, east):
    """DroneKit's get_location_metres()."""
    radius = 6378137.0
    return LocationGlobal(place.lat + math.degrees(north / radius),
                          place.lon + math.degrees(east / (radius * math.cos(math.radians(place.lat)))), place.alt)


def distance(a, b):
    """DroneKit's get_distance_metres(), with the length of a degree of longitude."""
    return math.hypot(a.lat - b.lat, (a.lon - b.lon) * math.cos(math.radians(a.lat))) * 1.113195e5


def set_mode(vehicle, name):
    vehicle.mode = VehicleMode(name)
    wait_for(lambda: vehicle.mode.name == name, f"mode {name}")


def take_off(vehicle, autopilot):
    if autopilot == "ardupilot":
        wait_for(lambda: vehicle.is_armable, "is_armable")
        set_mode(vehicle, "GUIDED")
        vehicle.armed = True
        wait_for(lambda: vehicle.armed, "arming")
        vehicle.simple_takeoff(HEIGHT)
    else:
        vehicle.parameters["MIS_TAKEOFF_ALT"] = HEIGHT
        set_mode(vehicle, "TAKEOFF")
        vehicle.armed = True
    wait_for(lambda: vehicle.location.global_relative_frame.alt > 0.95 * HEIGHT, "the take-off")


# From the example guided_set_speed_yaw, with its mask.
def send_ned_velocity(vehicle, velocity_x, velocity_y, velocity_z):
    message = vehicle.message_factory.set_position_target_local_ned_encode(
        0, 0, 0, mavlink.MAV_FRAME_LOCAL_NED, 0b0000111111000111,
        0, 0, 0, velocity_x, velocity_y, velocity_z, 0, 0, 0, 0, 0)
    vehicle.send_mavlink(message)


def fly_by_velocity(vehicle, autopilot, home, metres):
    """Flies north; returns the speed that the vehicle had."""
    speeds = []
    if autopilot == "px4":
        send_ned_velocity(vehicle, 3, 0, 0)
        set_mode(vehicle, "OFFBOARD")
    mode = vehicle.mode.name

    def is_there():
        send_ned_velocity(vehicle, 3, 0, 0)
        speeds.append(vehicle.velocity[0])
        return distance(vehicle.location.global_frame, home) > metres
    wait_for(is_there, f"{metres} m by velocities")
    assert vehicle.mode.name == mode, (vehicle.mode.name, TEXTS)
    return max(speeds)


def fly_to(vehicle, place):
    """simple_goto(), until the vehicle is there."""
    vehicle.simple_goto(LocationGlobalRelative(place.lat, place.lon, HEIGHT + 2))
    wait_for(lambda: distance(vehicle.location.global_frame, place) < 1 and
             vehicle.location.global_relative_frame.alt > HEIGHT + 1.5, "the goal of simple_goto")


def square(vehicle, home, size):
    """adds_square_mission() of the example mission_basic: a take-off, four corners, and a dummy at the last one."""
    commands = vehicle.commands
    commands.clear()

    def add(command, place, height):
        commands.add(Command(0, 0, 0, mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT, command, 0, 0, 0, 0, 0, 0,
                             place.lat if place else 0, place.lon if place else 0, height))
    corners = [offset(home, north * size, east * size) for north, east in ((1, -1), (1, 1), (-1, 1), (-1, -1))]
    add(mavlink.MAV_CMD_NAV_TAKEOFF, None, HEIGHT)
    for corner in [*corners, corners[-1]]:
        add(mavlink.MAV_CMD_NAV_WAYPOINT, corner, HEIGHT)
    commands.upload(timeout=10)
    return corners


def download(vehicle):
    vehicle.commands.download()
    vehicle.commands.wait_ready(timeout=10)
    return [(int(command.command), command.x, command.y) for command in vehicle.commands]


def fly_mission(vehicle, autopilot, last):
    """Until the vehicle flies to the last item, then home."""
    items = []
    vehicle.commands.next = 0
    vehicle.mode = VehicleMode("AUTO" if autopilot == "ardupilot" else "MISSION")

    def is_at_last():
        items.append(vehicle.commands.next)
        return items[-1] == last
    wait_for(is_at_last, f"item {last}")
    vehicle.mode = VehicleMode("RTL")
    wait_for(lambda: not vehicle.armed, "the return", 60)
    return sorted(set(items))


def main(url, autopilot):
    answer = {}
    vehicle = dronekit.connect(url, wait_ready=True, timeout=30, heartbeat_timeout=60)
    vehicle.add_message_listener("STATUSTEXT", lambda _, __, message: TEXTS.append(message.text))
    if autopilot == "ardupilot":
        vehicle.commands.download()
        vehicle.commands.wait_ready(timeout=10)
    wait_for(lambda: vehicle.home_location, "home_location")
    home = vehicle.home_location
    answer["home"] = [home.lat, home.lon, home.alt]
    take_off(vehicle, autopilot)
    answer["speed"] = fly_by_velocity(vehicle, autopilot, home, 10)
    if autopilot == "ardupilot":
        fly_to(vehicle, offset(home, 0, 8))
    else:
        vehicle.simple_goto(LocationGlobalRelative(home.lat, home.lon, HEIGHT))
        wait_for(lambda: any("MISSION_ITEM" in text for text in TEXTS), "the refusal of simple_goto")
    corners = square(vehicle, home, 6)
    answer["items"] = download(vehicle)
    answer["corners"] = [(place.lat, place.lon) for place in corners]
    answer["flown"] = fly_mission(vehicle, autopilot, len(answer["items"]))
    vehicle.close()
    answer["texts"] = TEXTS
    print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
