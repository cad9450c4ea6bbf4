# SPDX-License-Identifier: MIT
"""DroneKit flies the vehicle: by velocities, by simple_goto, and by a mission."""
import json
import pathlib
import subprocess
import sys

import pytest

import harness
from simulators import HOME

FLIGHTS = pathlib.Path(__file__).with_name("dronekit_flights.py")
TAKEOFF, WAYPOINT = 22, 16
SPEED = 8
PATIENT = {"px4": {"COM_DISARM_PRFLT": 600.0, "RTL_RETURN_ALT": 10.0, "COM_OF_LOSS_T": 10.0},
           "ardupilot": {"DISARM_DELAY": 127, "RTL_ALT": 1000}}


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_dronekit_flies_its_examples(sim, autopilot):
    simulator = sim("--autopilot", autopilot, "--speed", SPEED, listen=("tcpin://127.0.0.1:0",),
                    parameters=PATIENT[autopilot])
    done = subprocess.run([sys.executable, str(FLIGHTS), f"tcp:127.0.0.1:{simulator.port}", autopilot],
                          capture_output=True, text=True, timeout=100, env=harness.environment())
    assert done.returncode == 0, done
    flight = json.loads(done.stdout.splitlines()[-1])

    assert flight["home"][:2] == pytest.approx(HOME[:2], abs=1e-5)
    assert flight["home"][2] == pytest.approx(HOME[2], abs=1)
    assert 2.5 < flight["speed"] < 3.5
    # To DroneKit, the first item of a mission is home. PX4 has no home there, and so DroneKit does not show its first.
    commands = [item[0] for item in flight["items"]]
    assert commands == ([TAKEOFF] if autopilot == "ardupilot" else []) + 5 * [WAYPOINT]
    for item, corner in zip(flight["items"][-5:], [*flight["corners"], flight["corners"][-1]]):
        assert item[1:] == pytest.approx(corner, abs=1e-5)  # floats on the wire
    assert set(flight["flown"]) >= set(range(2, len(commands) + 1))
    # simple_goto is an item of a mission that is no mission: PX4 refuses it.
    assert ("IGN MISSION_ITEM: No transfer" in flight["texts"]) == (autopilot == "px4")
