# SPDX-License-Identifier: MIT
"""Simulators for the tests: started with options or a scenario, reached at ports that the kernel chose."""
import json
import lzma
import math
import os
import subprocess
import tempfile

import harness
from stations import Station, mavlink

# Where PX4's built-in simulator stands, and the height of its ground.
HOME = (47.397742, 8.545594, 489.4)
# custom_mode of PX4's modes: sub mode << 24 | main mode << 16.
MANUAL, ALTITUDE, POSITION, OFFBOARD = 0x10000, 0x20000, 0x30000, 0x60000
TAKEOFF, HOLD, MISSION, RETURN, LAND = 0x2040000, 0x3040000, 0x4040000, 0x5040000, 0x6040000
ORBIT = 0x1030000
ON_GROUND, IN_AIR, CLIMBING, LANDING = 1, 2, 3, 4

_count = iter(range(1_000_000))


def unique_name():
    return f"simt-{os.getpid()}-{next(_count)}"


def scenario_of(vehicle, parameters):
    def lines(values):
        return "".join(f"{key} = {in_toml(value)}\n" for key, value in values.items())

    def in_toml(value):
        if isinstance(value, dict):
            return "{" + ", ".join(f"{key} = {json.dumps(one)}" for key, one in value.items()) + "}"
        return json.dumps(value)
    table = f"[vehicle.parameters]\n{lines(parameters)}" if parameters else ""
    return f"[[vehicle]]\n{lines(vehicle)}{table}"


class Simulator:
    """A running `mavloom sim` that listens at a UDP port, `port`. `vehicle` has keys of a scenario's vehicle, and
    `parameters` values of its parameters at the start."""

    def __init__(self, program, *options, vehicle=None, parameters=None, listen=("udpin://127.0.0.1:0",)):
        self.name = unique_name()
        self.program = program
        command = [str(program), "sim"]
        self._scenario = None
        if vehicle or parameters:
            self._scenario = tempfile.NamedTemporaryFile("w", suffix=".toml")
            self._scenario.write(scenario_of(vehicle or {}, parameters or {}))
            self._scenario.flush()
            command.append(self._scenario.name)
        for url in listen:
            command += ["--listen", url]
        command += ["--name", self.name, *map(str, options)]
        self.process = harness.Running(command, env=harness.environment())
        self._stations = []
        self.port = self.listening_port() if listen else None

    def listening_port(self, which=0):
        """The port of the n-th endpoint that listens at port 0."""
        return int(self.process.wait_output(rf"(?:listening on port \d+[\s\S]*?){{{which}}}listening on port (\d+)")[1])

    def station(self, identity=(255, 190), scheme="udp", port=None, **options):
        """A client that the vehicle has heard."""
        self._stations.append(Station(port or self.port, identity, scheme, **options))
        return self._stations[-1].meet()

    def ctl(self, *args):
        """Runs `mavloom ctl NAME ...` to its end."""
        done = subprocess.run([str(self.program), "ctl", self.name, *map(str, args)], capture_output=True, text=True,
                              timeout=harness.DEFAULT_TIMEOUT_S, env=harness.environment(), stdin=subprocess.DEVNULL)
        assert done.returncode == 0, done
        return done.stdout

    def fault(self, faults, rng, link=None):
        """Faults of all links of the port, or of one, from now on: "loss:0.2", "off"."""
        self.ctl("fault", link or f"udpin://127.0.0.1:{self.port}", faults, "--seed", rng.getrandbits(63))

    def newest_link(self):
        return json.loads(self.ctl("links").splitlines()[-1])["link"]

    def state(self):
        return json.loads(self.ctl("state").splitlines()[0])

    def stop(self):
        return self.process.stop()

    def end(self):
        for station in self._stations:
            station.close()
        harness.end([self.process])
        if self._scenario:
            self._scenario.close()
        report = self.process.stderr
        assert not harness.SANITIZER_REPORT.search(report), report
        crashed = self.process.process.returncode
        assert crashed is None or crashed in (0, -2, -9, -15, 130, 143), (crashed, report)


# ---- geometry, by the sphere: good to a centimetre over the distances of the tests

def offset(latitude, longitude, north, east):
    """The position so many metres away."""
    radius = 6371008.8
    return (latitude + math.degrees(north / radius),
            longitude + math.degrees(east / radius / math.cos(math.radians(latitude))))


def metres_between(a, b):
    """Distance of two GLOBAL_POSITION_INT-like (latitude, longitude) in degrees."""
    radius = 6371008.8
    north = math.radians(b[0] - a[0]) * radius
    east = math.radians(b[1] - a[1]) * radius * math.cos(math.radians(a[0]))
    return math.hypot(north, east)


def place(message):
    """Degrees of a message with lat and lon."""
    return message.lat / 1e7, message.lon / 1e7


def item(seq, command, north=0.0, east=0.0, height=10.0, *, frame=6, p=(0, 0, 0, math.nan), plan=0, current=None,
         target=(1, 1), home=HOME, x=None, y=None, autocontinue=1):
    """A mission item so many metres from home."""
    latitude, longitude = offset(home[0], home[1], north, east)
    return mavlink.MAVLink_mission_item_int_message(
        *target, seq, frame, command, int(seq == 0) if current is None else current, autocontinue, *p,
        round(latitude * 1e7) if x is None else x, round(longitude * 1e7) if y is None else y, height, plan)


ITEM_FIELDS = ("seq", "frame", "command", "autocontinue", "param1", "param2", "param3", "param4", "x", "y", "z",
               "mission_type")


def plain(item_message):
    """An item as the vehicle must return it; NaN compares equal."""
    def same(value):
        return "nan" if isinstance(value, float) and math.isnan(value) else value
    packed = mavlink.MAVLink(None)
    again = packed.decode(bytearray(item_message.pack(packed)))  # floats as the wire carries them
    return tuple(same(getattr(again, name)) for name in ITEM_FIELDS)


def metadata_file(ftp, uri):
    """The file that a metadata URI leads to, decompressed."""
    content = ftp.read(uri.removeprefix("mftp:/"))
    return lzma.decompress(content) if uri.endswith((".xz", ".lzma")) else content
