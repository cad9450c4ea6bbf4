# SPDX-License-Identifier: MIT
"""The simulator for PX4, and stand-ins for PX4 that fly on it (px4_stand_in.py)."""
import json
import pathlib
import sys

import pytest

import harness
from simulators import Simulator

STAND_IN = pathlib.Path(__file__).parent / "px4_stand_in.py"


class StandIn(harness.Running):
    """A stand-in in a process of its own, so that a test can kill it. `options` are those of px4_stand_in.py."""

    def __init__(self, port, instance=0, **options):
        environment = harness.environment({"PX4_STAND_IN": json.dumps({"port": port, "stay": False, **options})})
        super().__init__([sys.executable, str(STAND_IN), "-d", "-i", str(instance)], env=environment)

    def said(self, what):
        """The object of this kind that it printed; waits for it."""
        line = self.wait_output(rf'^\{{"stand_in": "{what}".*\}}$', stream="out")
        return json.loads(line[0])


class HilSimulator(Simulator):
    """`mavloom sim --hil px4` at `hil_port` and the ports after it."""

    def __init__(self, program, *options, **more):
        self.hil_port = harness.free_port(harness.socket.SOCK_STREAM)
        super().__init__(program, "--hil", f"px4=tcpin://127.0.0.1:{self.hil_port}", *options, listen=(), **more)
        harness.wait_for(lambda: self.hil(), what="the control socket")

    def hil(self, system=1):
        """The state of one PX4's link, by `ctl state`."""
        try:
            rows = [json.loads(line) for line in self.ctl("state").splitlines()]
        except AssertionError:
            return None
        return next((row for row in rows if row["kind"] == "hil" and row["system"] == system), None)


@pytest.fixture
def hil(program):
    """hil("--speed", "max", vehicle={...}) -> a HilSimulator that ends with the test."""
    running = []

    def start(*options, **more):
        running.append(HilSimulator(program, *options, **more))
        return running[-1]
    yield start
    for one in running:
        one.end()


@pytest.fixture
def stand_in():
    """stand_in(port, instance, hold=1) -> a StandIn that ends with the test."""
    running = []

    def start(port, instance=0, **options):
        running.append(StandIn(port, instance, **options))
        return running[-1]
    yield start
    harness.end(running)
