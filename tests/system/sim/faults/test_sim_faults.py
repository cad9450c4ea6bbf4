# SPDX-License-Identifier: MIT
"""Faults of vehicles (docs/guide/vehicle-faults.md), as clients see them: by `ctl`, by the time line of a scenario, and
by MAV_CMD_INJECT_FAILURE."""
import json
import math

import frames
import pytest
from pymavlink import mavutil

import mavsdks
from flights import ready_vehicle, take_off
from simulators import HOLD, metres_between, place

ACCEPTED, TEMPORARILY_REJECTED, UNSUPPORTED = 0, 1, 3
INJECT = 420
GYRO, ACCEL, MAG, BARO, GPS, MOTOR = 0, 1, 2, 3, 4, 101
OK, OFF, STUCK, WRONG = 0, 1, 2, 4


def test_injected_failures_are_answered_and_announced_as_by_px4(sim):
    with sim().station() as px4:
        px4.ready()
        mark = px4.mark()
        assert px4.command(INJECT, GPS, WRONG) == ACCEPTED
        text = px4.expect("STATUSTEXT", since=mark)
        assert (text.text, text.severity) == ("Injected: gps wrong, all instances", 4)
        px4.expect("GPS_RAW_INT", where=lambda m: m.fix_type == 2)
        px4.expect("SYS_STATUS", where=lambda m: not m.onboard_control_sensors_health & 32)
        for unit in (GYRO, ACCEL, MAG):
            assert px4.command(INJECT, unit, OFF) == ACCEPTED
        assert px4.command(INJECT, BARO, OFF) == TEMPORARILY_REJECTED
        assert px4.command(INJECT, MAG, WRONG) == UNSUPPORTED
        for unit in (GYRO, ACCEL, MAG, GPS):
            assert px4.command(INJECT, unit, OK) == ACCEPTED
        px4.expect("GPS_RAW_INT", where=lambda m: m.fix_type == 3)
        px4.expect("SYS_STATUS", where=lambda m: m.onboard_control_sensors_health & 39 == 39)


def test_mavsdk_stops_a_motor(sim):
    simulator = sim()
    answer = mavsdks.run(simulator.port, "motor_failure")
    assert (answer["unsupported"], answer["stop"]) == ("UNSUPPORTED", "SUCCESS")
    assert answer["fell_m"] > 8


def test_a_gps_that_drifts_carries_the_vehicle_away(sim):
    with ready_vehicle(sim) as px4:
        take_off(px4)
        truth = px4.ask_for(115, "HIL_STATE_QUATERNION")
        before = place(px4.expect("GLOBAL_POSITION_INT"))
        px4.simulator.ctl("fail", "gps", "drift", "0", "-2")
        there = px4.expect("GPS_RAW_INT")
        px4.until(lambda: metres_between(place(px4.ask_for(115, "HIL_STATE_QUATERNION")), place(truth)) > 30,
                  what="the way that the vehicle really goes")
        now = px4.ask_for(115, "HIL_STATE_QUATERNION")
        assert now.lon > truth.lon, "against the drift"
        assert metres_between(place(px4.expect("GLOBAL_POSITION_INT")), before) < 3, "it believes that it stays"
        assert there.fix_type == 3 and px4.latest("HEARTBEAT").custom_mode == HOLD


def test_a_heartbeat_goes_silent_and_comes_back(sim):
    simulator = sim()
    with simulator.station() as px4:
        px4.ready()
        simulator.ctl("fail", "heartbeat", "off")
        px4.parameter("MIS_TAKEOFF_ALT")  # the answer comes after all that was on its way
        mark = px4.mark()
        px4.until(lambda: len(px4.since(mark, "ATTITUDE")) >= 30, what="3 s of telemetry")
        assert not px4.since(mark, "HEARTBEAT") and px4.lost == 0
        simulator.ctl("fail", "all", "ok")
        px4.expect("HEARTBEAT")


def test_the_state_names_all_faults_and_all_ok_ends_those_of_clients_too(sim):
    simulator = sim()
    with simulator.station() as px4:
        px4.ready()
        assert px4.command(420, 101, 1, 2) == 0  # MAV_CMD_INJECT_FAILURE: motor 2 off
        state = json.loads(simulator.ctl("fail", "gps", "drift", "0", "2.5").splitlines()[0])
        assert state["faults"] == ["motor off, instances 2", "gps drift 0 2.5"]
        assert json.loads(simulator.ctl("fail", "all", "ok").splitlines()[0])["faults"] == []
        assert px4.command(400, 1) == 0


def test_sequence_numbers_start_again(sim):
    simulator = sim()
    with simulator.station() as px4:
        px4.ready()
        assert px4.lost == 0
        simulator.ctl("fail", "sequence", "restart")
        px4.parameter("MIS_TAKEOFF_ALT")
        assert px4.lost > 0, "a gap"
        lost = px4.lost
        px4.parameter("MIS_TAKEOFF_ALT")
        assert px4.lost == lost


def test_a_reboot(sim):
    simulator = sim()
    with simulator.station() as px4:
        px4.ready()
        mark = px4.mark()
        simulator.ctl("fail", "autopilot", "restart")
        px4.expect("SYSTEM_TIME", since=mark, where=lambda m: m.time_boot_ms < 2000)
        px4.ready()


FLIGHT = """
[sim]
speed = "max"
for = "40s"
[[event]]
at = "8s"
do = "takeoff 20"
[[event]]
at = "25s"
do = "fail motor off 1"
[[event]]
at = "35s"
do = "fail battery charge 3"
"""


def test_faults_of_the_time_line_come_at_their_times(run, tmp_path):
    (tmp_path / "x.toml").write_text(FLIGHT)
    recordings = [tmp_path / "1.tlog", tmp_path / "2.tlog"]
    for path in recordings:
        done = run("sim", tmp_path / "x.toml", "--start-time", "2026-11-29T12:00:00Z", "--record", path)
        assert done.status == 0, done
    assert recordings[0].read_bytes() == recordings[1].read_bytes()
    begin = frames.read_tlog(recordings[0])[0][0] / 1e6
    heights, battery = {}, {}
    log = mavutil.mavlink_connection(str(recordings[0]))
    while message := log.recv_match(type=["GLOBAL_POSITION_INT", "SYS_STATUS"]):
        at = math.floor(message._timestamp - begin)
        if message.get_type() == "SYS_STATUS":
            battery[at] = message.battery_remaining
        else:
            heights[at] = message.relative_alt / 1000
    assert heights[24] == pytest.approx(20, abs=0.5) and heights[31] < 1
    assert battery[34] > 50 and battery[36] <= 5  # it has crashed, and charges at rest


@pytest.mark.parametrize("words, text", [
    (["gsp", "off"], "did you mean 'gps'?"),
    (["gps", "fast"], "gps takes ok, off, stuck, wrong, jump NORTH EAST, drift NORTH EAST"),
    (["gps"], "as in fail gps off"),
    (["motor", "off", "5"], "the vehicle has 4 motors"),
])
def test_wrong_faults(shared, run, words, text):
    done = run("ctl", shared().name, "fail", *words)
    assert done.status in (1, 2) and text in done.stderr, done


def test_negative_numbers_are_no_options(shared):
    simulator = shared()
    assert json.loads(simulator.ctl("fail", "gps", "jump", "-30", "-0.5").splitlines()[0])["kind"] == "vehicle"
    simulator.ctl("fail", "all", "ok")
