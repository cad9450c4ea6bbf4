#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Stands in for PX4 at the simulator's port, 4560 + instance. It keeps PX4's rules of the lock-step:

- It connects, sends the same first frames, and boots for some steps without answers.
- It answers each HIL_SENSOR of id 0 with HIL_ACTUATOR_CONTROLS of the same time.
- It is silent while the time stands still or goes back.

It takes off, holds, lands and disarms by itself; as a rover, it drives, turns and stops (stand_in_flights.py).

It takes PX4's command line: px4 [-d] [-i INSTANCE] [-w FOLDER] [FOLDER ...]. Its own options are in PX4_STAND_IN, as
JSON (see Options). It prints a JSON object a line. Everything on the wire is coded by pymavlink."""
import argparse
import contextlib
import dataclasses
import hashlib
import json
import math
import os
import socket
import sys
import time

os.environ["MAVLINK20"] = "1"
from pymavlink.dialects.v20 import common as mavlink  # noqa: E402

from stand_in_flights import FLIGHTS, State, tell  # noqa: E402
from stand_in_pilot import euler  # noqa: E402

GYRO, MAGNETOMETER, BAROMETER, AIRSPEED = 0x038, 0x1C0, 0x1A00, 0x400
ARMED, DISARMED = 1 | 128, 1  # `mode` of HIL_ACTUATOR_CONTROLS
LOCKSTEP = 1                  # `flags`
GROUND_STATION = 14550


@dataclasses.dataclass
class Options:
    port: int = 0               # instead of 4560 + instance
    vehicle: str = "quad"       # "plane", "rover": what it flies or drives, with the outputs of PX4's airframe for it
    boot_steps: int = 35        # HIL_SENSOR without an answer
    arm_at: float = 1.0         # s of flight after the first answer
    height: float = 5.0         # m
    hold: float = 3.0           # s; a plane circles before, and a rover turns
    slow: float = 0.0           # s of wall time before each answer
    silent_at: float = math.inf   # s after the first answer: no answers any more
    silent_steps: float = math.inf  # so many steps long
    copies: int = 1             # of each answer
    ahead_us: int = 0           # added to the time of each answer
    faulty: str = ""            # "nan", "beyond": what the controls of each 50th answer are while armed
    stay: bool = True           # after the flight, answer until the simulator ends
    telemetry: bool = False     # from port 18570 + instance to 14550, and then to the first that sends to it


def airspeed_of(sensor):
    """The true airspeed by pitot tube, barometer and thermometer, as PX4 computes it."""
    density = 100 * sensor.abs_pressure / (287.1 * (sensor.temperature + 273.15))
    return math.sqrt(2 * 100 * max(sensor.diff_pressure, 0) / density)


class Sensors:
    """Compares the sensors with the truth."""

    def __init__(self):
        self.counts, self.first = {}, {}
        self.worst = {"baro_m": 0.0, "gps_m": 0.0, "speed_m_s": 0.0, "airspeed_m_s": 0.0}
        self.rest = []  # accelerations and magnetic fields before take-off
        self.digest = hashlib.sha256()  # of the first 200 HIL_SENSOR

    def count(self, what):
        self.counts[what] = self.counts.get(what, 0) + 1

    def compare(self, name, value):
        self.worst[name] = max(self.worst[name], value)

    def on_sensor(self, message, state):
        for name, bits in (("gyro", GYRO), ("mag", MAGNETOMETER), ("baro", BAROMETER), ("airspeed", AIRSPEED)):
            if message.fields_updated & bits == bits:
                self.count(name)
        if self.counts.get("gyro", 0) <= 200:
            self.digest.update(message.to_json().encode())
        if message.fields_updated & BAROMETER == BAROMETER:
            altitude = 44330.77 * (1 - (message.abs_pressure / 1013.25) ** 0.190263)
            up = state.place[2]
            self.compare("baro_m", abs(altitude - self.first.setdefault("baro", altitude - up) - up))
        if message.fields_updated & AIRSPEED == AIRSPEED and state.airspeed > 8:
            self.compare("airspeed_m_s", abs(airspeed_of(message) - state.airspeed))

    def on_rest(self, message):
        if message.fields_updated & MAGNETOMETER == MAGNETOMETER:
            self.rest.append((message.xacc, message.yacc, message.zacc, message.xmag, message.ymag, message.zmag))

    def mean_at_rest(self):
        """The accelerometer must show the ground's push, the compass the heading."""
        mean = [sum(values) / len(self.rest) for values in zip(*self.rest)]
        return {"acceleration": mean[:3], "field_gauss": math.hypot(*mean[3:]),
                "compass_deg": math.degrees(math.atan2(-mean[4], mean[3]))}


class StandIn:
    def __init__(self, instance, options):
        self.options, self.instance = options, instance
        self.mav, self.station_mav = (mavlink.MAVLink(None, instance + 1, 1) for _ in range(2))
        self.state, self.home = State(), None
        self.sensors, self.flight = Sensors(), FLIGHTS[options.vehicle](options)
        self.steps = self.answers = self.time_errors = self.skip = 0
        self.newest_us, self.began_us, self.ended = 0, None, False
        self.link = self.station = None
        self.partner = ("127.0.0.1", GROUND_STATION)

    def connect(self):
        address = (os.environ.get("PX4_SIM_HOSTNAME", "127.0.0.1"), self.options.port or 4560 + self.instance)
        while True:
            try:
                self.link = socket.create_connection(address)
                break
            except OSError:
                time.sleep(0.002)
        self.link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        # HIL_STATE_QUATERNION every 5 ms, as PX4 asks.
        self.send(mavlink.MAVLink_command_long_message(0, 0, 511, 0, 115, 5000, 0, 0, 0, 0, 0),
                  mavlink.MAVLink_heartbeat_message(0, 12, 0, 0, 0, 3))
        if self.options.telemetry:
            self.station = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            self.station.bind(("127.0.0.1", 18570 + self.instance))
            self.station.setblocking(False)
        tell("connected", port=address[1])

    def send(self, *messages):
        self.link.sendall(b"".join(self.coded(message, self.mav) for message in messages))

    @staticmethod
    def coded(message, mav):
        frame = message.pack(mav)
        mav.seq = (mav.seq + 1) % 256
        return frame

    def run(self):
        reader = mavlink.MAVLink(None)
        while not self.ended:
            try:
                data = self.link.recv(65536)
            except OSError:
                data = b""
            if not data:
                tell("simulator gone", answers=self.answers)
                return
            for message in reader.parse_buffer(data) or ():
                getattr(self, f"on_{message.get_type().lower()}", self.on_other)(message)

    def on_other(self, message):
        self.sensors.count(message.get_type())

    def on_hil_gps(self, message):
        self.sensors.count("gps")
        if self.home and message.fix_type >= 3:
            north, east, up = self.from_home(message.lat, message.lon, message.alt)
            self.sensors.compare("gps_m", math.dist((north, east, up), self.state.place))
            self.sensors.compare("speed_m_s", math.dist(
                (message.vn / 100, message.ve / 100, -message.vd / 100), self.state.velocity))

    def from_home(self, lat, lon, alt):
        latitude, longitude, altitude = self.home
        metres = math.radians(1) * 6371008.8 / 1e7
        return (lat - latitude) * metres, (lon - longitude) * metres * math.cos(math.radians(latitude / 1e7)), \
            (alt - altitude) / 1000

    def on_hil_state_quaternion(self, message):
        self.sensors.count("truth")
        self.home = self.home or (message.lat, message.lon, message.alt)
        self.state = State(self.from_home(message.lat, message.lon, message.alt),
                           (message.vx / 100, message.vy / 100, -message.vz / 100),
                           tuple(message.attitude_quaternion), (message.lat, message.lon, message.alt),
                           message.true_airspeed / 100)

    def on_hil_sensor(self, message):
        self.sensors.on_sensor(message, self.state)
        if message.id != 0:
            return
        self.steps += 1
        step_us, fresh = message.time_usec - self.newest_us, message.time_usec > self.newest_us
        if not fresh:
            self.time_errors += 1
            self.skip = 1  # the next step remains unanswered too
            return
        self.newest_us = message.time_usec
        if self.skip or self.steps <= self.options.boot_steps or message.fields_updated & GYRO != GYRO:
            self.skip = 0
            return
        self.answer(message, step_us / 1e6)

    def answer(self, message, dt):
        if self.began_us is None:
            self.began_us, dt = message.time_usec, 0.004
            tell("first answer", step=self.steps, time_us=message.time_usec)
        at = (message.time_usec - self.began_us) / 1e6
        if self.flight.phase == "rest":
            self.sensors.on_rest(message)
        was = self.flight.phase
        self.flight.step(at, self.state)
        silent = (at - self.options.silent_at) / 0.004
        if 0 <= silent < self.options.silent_steps:
            return
        if self.options.slow:
            time.sleep(self.options.slow)
        outputs = self.flight.outputs(self.state, (message.xgyro, message.ygyro, message.zgyro), min(dt, 0.1))
        self.send(*[self.controls(message.time_usec + self.options.ahead_us, outputs)] * self.options.copies)
        self.answers += 1
        if self.station and self.answers % 50 == 1:
            self.send_telemetry()
        if self.flight.phase == "landed" != was:
            self.report(at)

    def send_telemetry(self):
        """Sends as PX4 does on its link for ground stations."""
        with contextlib.suppress(BlockingIOError):
            while self.partner[1] == GROUND_STATION:
                self.partner = self.station.recvfrom(2048)[1]
        latitude, longitude, altitude = self.state.degrees
        armed = 128 if self.flight.is_armed else 0
        for message in (mavlink.MAVLink_heartbeat_message(2, 12, 81 | armed, 0, 4 if armed else 3, 3),
                        mavlink.MAVLink_global_position_int_message(
                            self.newest_us // 1000, latitude, longitude, altitude,
                            round(1000 * self.state.place[2]), 0, 0, 0, 65535)):
            self.station.sendto(self.coded(message, self.station_mav), self.partner)

    def controls(self, time_us, outputs):
        armed = self.flight.is_armed
        if armed and self.options.faulty and self.answers % 50 == 0 and self.flight.phase != "stop":
            outputs = [{"nan": math.nan, "beyond": 7.0}[self.options.faulty]] * 16
        values = [*outputs, *[0.0] * (16 - len(outputs))]
        return mavlink.MAVLink_hil_actuator_controls_message(time_us, values, ARMED if armed else DISARMED, LOCKSTEP)

    def report(self, at):
        tell("report", flight_s=at, steps=self.steps, answers=self.answers, time_errors=self.time_errors,
             highest_m=self.flight.highest, place=self.state.place, **self.flight.figures(),
             heading_deg=math.degrees(euler(self.state.attitude)[2]), counts=self.sensors.counts,
             rest=self.sensors.mean_at_rest(), worst=self.sensors.worst, digest=self.sensors.digest.hexdigest())
        self.ended = not self.options.stay


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-d", action="store_true", help="ignored")
    parser.add_argument("-i", type=int, default=0, help="instance: port 4560 + i, system id 1 + i")
    parser.add_argument("-w", help="the folder to work in; PX4 would create it")
    parser.add_argument("folders", nargs="*", help="ignored")
    given = parser.parse_args()
    if given.w:
        os.chdir(given.w)
    stand_in = StandIn(given.i, Options(**json.loads(os.environ.get("PX4_STAND_IN", "{}"))))
    stand_in.connect()
    stand_in.run()


if __name__ == "__main__":
    sys.exit(main())
