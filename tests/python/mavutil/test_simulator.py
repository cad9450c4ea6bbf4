# SPDX-License-Identifier: MIT
"""Link.vehicle, and scripts on both sides, with the simulator of `mavloom sim` as the vehicle."""
import asyncio
import pathlib
import re
import subprocess
import sys
import threading

import pytest

import both
import mavloom
from places import ROOT
from vehicles import DEADLINE_S, simulator, until

HOME = (47.397742, 8.545594)


@pytest.mark.parametrize("autopilot, mode", [("px4", "Hold"), ("ardupilot", "GUIDED")])
def test_a_flight(autopilot, mode):
    with simulator(autopilot) as port, mavloom.connect(f"tcpout://127.0.0.1:{port}") as link:
        vehicle = link.vehicle(timeout=DEADLINE_S)
        vehicle.set_mode(mode)
        vehicle.arm()
        assert vehicle.armed and vehicle.mode == mode
        vehicle.takeoff(10)
        assert link.recv_match(lambda m: m.relative_alt > 9000, "GLOBAL_POSITION_INT", True, DEADLINE_S)
        with pytest.raises(mavloom.CommandError, match="MAV_CMD_COMPONENT_ARM_DISARM: MAV_RESULT_"):
            vehicle.disarm()  # in flight
        vehicle.land()
        assert vehicle.mode.upper() == "LAND"
        until(lambda: not vehicle.armed)


@pytest.mark.parametrize("autopilot, name", [("px4", "MPC_XY_VEL_MAX"), ("ardupilot", "WPNAV_SPEED")])
def test_parameters_and_missions(autopilot, name):
    items = [mavloom.MissionItem.at(HOME[0] + i * 1e-4, HOME[1], 20) for i in range(30)]
    with simulator(autopilot) as port, mavloom.connect(f"tcpout://127.0.0.1:{port}") as link:
        vehicle = link.vehicle(timeout=DEADLINE_S)
        found = vehicle.params.fetch()
        assert len(found) > 100 and name in vehicle.params
        vehicle.params[name] = found[name] + 1
        whole = next(one for one in found if vehicle.params.type_of(one) == 6 and 0 < found[one] < 100)
        vehicle.params[whole] = found[whole]
        del vehicle.params[name], vehicle.params[whole]
        assert (vehicle.params[name], vehicle.params[whole]) == (found[name] + 1, found[whole])
        with pytest.raises(KeyError):
            vehicle.params["NO_SUCH"]
        vehicle.mission.upload(items)
        assert [(one.x, one.y, one.z) for one in vehicle.mission.download()] == [
            (one.x, one.y, one.z) for one in items]
        vehicle.mission.clear()
        assert vehicle.mission.download() == []


def test_tasks_use_a_vehicle():
    async def work(link):
        vehicle = link.vehicle_async(system=1)
        await vehicle.set_mode("LOITER")
        await vehicle.arm()
        values, items = await asyncio.gather(vehicle.params.fetch(), vehicle.mission.download())
        await vehicle.disarm()
        return len(values), items
    with simulator("px4") as port, mavloom.connect(f"tcpout://127.0.0.1:{port}") as link:
        count, items = asyncio.run(work(link))
        assert count > 100 and items == []


def without_numbers(text):
    """The lines without numbers; equal ones that follow each other are one."""
    lines = [re.sub(r"[-\d.]+", "#", line) for line in text.splitlines()]
    return [line for i, line in enumerate(lines) if i == 0 or lines[i - 1] != line]


@pytest.mark.parametrize("script, autopilot, same_numbers", [
    ("params_read", "ardupilot", True), ("params_write", "ardupilot", True), ("mission_upload", "ardupilot", True),
    ("mission_download", "px4", True), ("heartbeat_monitor", "ardupilot", True), ("arm_takeoff", "ardupilot", False),
    ("offboard_px4", "px4", True)])
def test_scripts_fly_the_simulator_on_both_sides(script, autopilot, same_numbers, peer, tmp_path, child_environment):
    folders = both.lay_out(tmp_path, [ROOT / "tests" / "python" / "scripts" / f"{script}.py"], peer)
    printed = []
    for side in both.SIDES:
        with simulator(autopilot) as port:
            printed.append(both.run(folders[side], script, f"tcp:127.0.0.1:{port}", environment=child_environment))
    assert without_numbers(printed[0]) == without_numbers(printed[1])
    assert not same_numbers or printed[0] == printed[1]


# MAVProxy imports pymavlink in each of its files, so the modules are replaced before it starts.
MAVPROXY = """import runpy, sys
import pymavlink
from mavloom import mavutil
pymavlink.mavutil = sys.modules["pymavlink.mavutil"] = mavutil
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
"""


@pytest.mark.unsanitized
def test_mavproxy_flies_over_mavutil(tmp_path, child_environment):
    program = pathlib.Path(sys.executable).parent / "mavproxy.py"
    with simulator("ardupilot") as port:
        process = subprocess.Popen([sys.executable, "-c", MAVPROXY, program, "--master", f"tcp:127.0.0.1:{port}"],
                                   env={**child_environment, "PYTHONUNBUFFERED": "1"}, cwd=tmp_path, text=True,
                                   stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        printed = []
        reader = threading.Thread(target=lambda: printed.extend(iter(lambda: process.stdout.read(1), "")))
        reader.start()
        try:
            for command, answer in (("", "Received \\d+ parameters"), ("mode GUIDED", "Mode GUIDED"),
                                    ("arm throttle", "ARMED"), ("takeoff 10", "height 10|height 15"),
                                    ("param set WPNAV_SPEED 800", ""), ("mode LAND", "DISARMED")):
                process.stdin.write(command + "\n")
                process.stdin.flush()
                until(lambda: re.search(answer, "".join(printed)))
            with mavloom.connect(f"tcpout://127.0.0.1:{port}") as link:
                assert link.vehicle(timeout=DEADLINE_S).params["WPNAV_SPEED"] == 800
        finally:
            process.kill()
            reader.join()
            print("".join(printed))
            process.wait()
        assert "Traceback" not in "".join(printed)
