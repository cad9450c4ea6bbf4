# SPDX-License-Identifier: MIT
"""Scripts as people post them on forums, run over mavloom.mavutil with one line changed. They fly the simulator.

pymavlink prints the same when it runs them. Only Mavloom runs here, because pymavlink's run takes as long again.
"""
import re

import pytest

import both
from places import ROOT
from vehicles import simulator

SCRIPTS = ROOT / "tests" / "python" / "scripts" / "simulated"
MISSION = """heartbeat from 1 0
cleared 0
uploaded {count} items: MAV_MISSION_ACCEPTED
armed
{reached}
landed and disarmed
"""
DUMP = """got all parameters: True
set True
Loaded all parameters from FILE
{name:16} {before:12.4f} {after:12.4f}
changed {name} from {after:.6f} to {before:.6f}
Loaded 1 parameters from FILE (changed 1)
{name} True
"""
DRONEKIT = """position
mode GUIDED
armed
took off
reached the target
flew east: True True
mode RTL
landed
at home: True True
"""
PLOT = """50 points, True True
lat 47.398 lon 8.546 True
"""
INTERVALS = """ATTITUDE True True
GLOBAL_POSITION_INT True True
LOCAL_POSITION_NED True True
30 50000
stopped True
None
capabilities True True
"""
FILES = """list 0 True
put 0
get 0
same True
[('hello.bin', 2304)]
rm 0
gone True
"""
MODES = """True autopilot {autopilot}
{modes}
Unknown mode : NOPE
Try: True
"""
OFFBOARD = """offboard MAV_RESULT_ACCEPTED
arm MAV_RESULT_ACCEPTED
(0, 0, -5) True OFFBOARD
(8, 0, -5) True OFFBOARD
(8, 8, -5) True OFFBOARD
(0, 0, -5) True OFFBOARD
land MAV_RESULT_ACCEPTED
disarmed True
"""
TWO = """systems [1, 2]
1 armed 0
1 takeoff 0
2 armed 0
2 takeoff 0
{1: 1, 2: 2}
1 GUIDED True True
2 GUIDED True True
[1, 2]
"""
STICKS = """armed in ALT_HOLD
climbed True
channels 1500 1800 1500
flew forward True
down True
disarmed True
"""
COPTER_MODES = "LOITER RTL ALT_HOLD STABILIZE POSHOLD BRAKE GUIDED"
PX4_MODES = "POSCTL ALTCTL LOITER RTL LAND MANUAL STABILIZED ACRO"


def modes(autopilot, names):
    return MODES.format(autopilot=autopilot, modes="\n".join(f"{name} True True" for name in names.split()))


def mission(mode, numbers):
    return MISSION.format(count=numbers[-1] + 1, reached="\n".join(f"reached {number} {mode}" for number in numbers))


def dump(name, before):
    return DUMP.format(name=name, before=before, after=before + 1)


# (script, autopilot, the words that follow the address, what it prints). OUT is the path of a file.
RUNS = [("mission_fly", "ardupilot", "OUT", mission("AUTO", range(1, 5))),
        ("mission_fly", "px4", "OUT", mission("MISSION", range(4))),
        ("param_dump", "ardupilot", "WPNAV_SPEED OUT", dump("WPNAV_SPEED", 1000)),
        ("param_dump", "px4", "MPC_XY_VEL_MAX OUT", dump("MPC_XY_VEL_MAX", 12)),
        ("dronekit_like", "ardupilot", "", DRONEKIT), ("gps_plot", "px4", "OUT", PLOT),
        ("intervals", "px4", "", INTERVALS), ("intervals", "ardupilot", "", INTERVALS),
        ("ftp_files", "ardupilot", "/APM OUT", FILES), ("rc_fly", "ardupilot", "", STICKS),
        ("modes_all", "ardupilot", f"{COPTER_MODES} NOPE", modes("MAV_AUTOPILOT_ARDUPILOTMEGA", COPTER_MODES)),
        ("modes_all", "px4", f"{PX4_MODES} NOPE", modes("MAV_AUTOPILOT_PX4", PX4_MODES)),
        ("offboard_loop", "px4", "", OFFBOARD), ("two_vehicles", "ardupilot", "", TWO)]


def changed(script, folder):
    """Copies a script, with its import changed."""
    text = script.read_text()
    assert text.count(both.IMPORT) == 1
    (folder / script.name).write_text(text.replace(both.IMPORT, "from mavloom import mavutil"))


@pytest.mark.parametrize("script, autopilot, words, expected", RUNS, ids=[f"{run[0]}-{run[1]}" for run in RUNS])
def test_a_forum_script_flies_the_simulator(script, autopilot, words, expected, tmp_path, child_environment):
    changed(SCRIPTS / f"{script}.py", tmp_path)
    out = str(tmp_path / "out.tlog")
    with simulator(autopilot, "--vehicles", "2" if script == "two_vehicles" else "1") as port:
        printed = both.run(tmp_path, script, f"tcp:127.0.0.1:{port}", *words.replace("OUT", out).split(),
                           environment=child_environment)
    assert re.sub(r"\d\d+ parameters", "all parameters", printed.replace(out, "FILE")) == expected
    if script == "mission_fly":
        check_log(tmp_path, expected, child_environment)


def check_log(folder, expected, environment):
    """The log of the flight, read by the script that lists its modes."""
    changed(SCRIPTS.parent / "log_modes.py", folder)
    printed = both.run(folder, "log_modes", folder / "out.tlog", environment=environment)
    events = re.findall(r"^\S+ (mode \w+|armed|disarmed)", printed, re.MULTILINE)
    mode = re.search(r"reached \d (\w+)", expected)[1]
    assert f"mode {mode}" in events and events.index("armed") < len(events) - 1 - events[::-1].index("disarmed")
