# SPDX-License-Identifier: MIT
"""MAVSDK as a client, in a process of its own (its library is native, and keeps threads): it runs the steps of
mavsdk_steps.py and prints their answers as lines of JSON."""
import contextlib
import json
import pathlib
import select
import subprocess
import sys
import tempfile
import time

import pytest

import harness

# MAVSDK's older form, whose Python package talks to a server process over gRPC.
GRPC_FLIGHT = """
import asyncio, sys
from mavsdk_grpc import System

async def first(stream, condition):
    async for value in stream:
        if condition(value):
            return value

async def fly(vehicle_port, server_port):
    drone = System(port=int(server_port))
    await drone.connect(system_address=f"udpout://127.0.0.1:{vehicle_port}")
    await first(drone.core.connection_state(), lambda state: state.is_connected)
    await first(drone.telemetry.health_all_ok(), bool)
    await drone.action.set_takeoff_altitude(5)
    await drone.action.arm()
    await drone.action.takeoff()
    print((await first(drone.telemetry.position(), lambda p: p.relative_altitude_m > 4.5)).relative_altitude_m)

asyncio.run(fly(*sys.argv[1:]))
"""
STEPS = pathlib.Path(__file__).with_name("mavsdk_steps.py")
ANSWER_TIMEOUT_S = 100


class Client:
    def __init__(self, url, step, arguments):
        self._errors = tempfile.TemporaryFile("w+")
        self.process = subprocess.Popen([sys.executable, "-u", str(STEPS), url, step, json.dumps(arguments)],
                                        stdout=subprocess.PIPE, stdin=subprocess.PIPE, stderr=self._errors, text=True,
                                        env=harness.environment())

    def answer(self, timeout=ANSWER_TIMEOUT_S):
        """The next answer. MAVSDK's own log lines go to stdout, too: they are no JSON objects."""
        deadline, kept = time.monotonic() + timeout, []
        while True:
            left = deadline - time.monotonic()
            assert left > 0, f"MAVSDK did not answer within {timeout} s: {kept[-20:]}{self.errors()}"
            if not select.select([self.process.stdout], [], [], left)[0]:
                continue
            line = self.process.stdout.readline()
            assert line, f"MAVSDK ended with {self.process.wait()}: {kept[-20:]}{self.errors()}"
            if line.startswith("{"):
                answer = json.loads(line)
                if "cannot" in answer:
                    pytest.skip(f"MAVSDK's library does not load here: {answer['cannot']}")
                return answer
            kept.append(line)

    def proceed(self):
        """Lets a waiting step continue."""
        self.process.stdin.write("\n")
        self.process.stdin.flush()

    def errors(self):
        self._errors.seek(0)
        return self._errors.read()[-4000:]

    def end(self):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()
        self._errors.close()


@contextlib.contextmanager
def started(port, step, *arguments, url="udpout://127.0.0.1:{}"):
    client = Client(url.format(port), step, arguments)
    try:
        yield client
    finally:
        client.end()


def run(port, step, *arguments, **options):
    """The one answer of a step."""
    with started(port, step, *arguments, **options) as client:
        return client.answer()


def fly_over_grpc(port, server_port):
    """Connects, arms and takes off to 5 m; returns the altitude reached, in metres."""
    done = subprocess.run([sys.executable, "-c", GRPC_FLIGHT, str(port), str(server_port)], capture_output=True,
                          text=True, timeout=ANSWER_TIMEOUT_S, env=harness.environment())
    assert done.returncode == 0, done
    return float(done.stdout.split()[-1])
