# SPDX-License-Identifier: MIT
"""Behaviours 11 to 33 of docs/guide/sim-behaviour.md: commands, and the flights that they fly."""
import math
import statistics

import pytest

import mavsdks
from flights import (angle_between, arm, arrives, command_message, flight_time, fly_to, landed_and_disarmed,
                     ready_vehicle, results_in_time, speed_of, take_off)
from simulators import (ALTITUDE, CLIMBING, HOLD, HOME, IN_AIR, LAND, LANDING, MISSION, ON_GROUND, ORBIT, POSITION,
                        RETURN, TAKEOFF, item, metres_between, offset, place)
from stations import HERE, NAN, mavlink

ACCEPTED, TEMPORARILY_REJECTED, DENIED, UNSUPPORTED, FAILED = range(5)
ATTITUDE_ID = 30


# ---- the command protocol

def test_b11_the_version_comes_before_its_acknowledgement(px4):
    answers = results_in_time(px4, lambda: px4.send(command_message(px4, 512, 148)), "COMMAND_ACK", 0.1)
    names = [m.get_type() for m in answers if m.get_type() in ("AUTOPILOT_VERSION", "COMMAND_ACK")]
    version = next(m for m in answers if m.get_type() == "AUTOPILOT_VERSION")

    assert names == ["AUTOPILOT_VERSION", "COMMAND_ACK"]
    # PX4's: MISSION_FLOAT, PARAM_FLOAT, MISSION_INT, COMMAND_INT, PARAM_ENCODE_BYTEWISE, FTP, SET_ATTITUDE_TARGET,
    # SET_POSITION_TARGET_LOCAL_NED, ..._GLOBAL_INT, FLIGHT_TERMINATION, MAVLINK2, MISSION_FENCE, MISSION_RALLY
    assert version.capabilities == 0b1110100111111111
    assert version.flight_sw_version >> 8 == 0x011100 and version.flight_sw_version & 0xFF == 255


def test_b12_older_commands_bring_versions(px4):
    mark = px4.mark()
    assert px4.command(520, 1) == ACCEPTED
    assert px4.command(519, 1) == ACCEPTED

    assert len(px4.since(mark, "AUTOPILOT_VERSION")) == 1
    (version,) = px4.since(mark, "PROTOCOL_VERSION")
    assert (version.version, version.min_version, version.max_version) == (200, 100, 203)


@pytest.mark.parametrize("message", [9999, 0xFFFFFF, 258])
def test_b13_an_unknown_message_is_refused_at_once(px4, message):
    answers = results_in_time(px4, lambda: px4.send(command_message(px4, 512, message)), "COMMAND_ACK", 0.1)
    (ack,) = [m for m in answers if m.get_type() == "COMMAND_ACK"]

    assert ack.result in (DENIED, UNSUPPORTED)


@pytest.mark.parametrize("form", ["long", "int"])
def test_b14_an_unknown_command_is_unsupported_at_once(px4, form):
    answers = results_in_time(px4, lambda: px4.send(command_message(px4, 31999, form=form)), "COMMAND_ACK", 0.1)
    (ack,) = [m for m in answers if m.get_type() == "COMMAND_ACK"]

    assert (ack.command, ack.result) == (31999, UNSUPPORTED)


def test_b15_an_acknowledgement_is_addressed_to_the_sender(shared):
    for identity in ((250, 7), (99, 200)):
        with shared().station(identity) as station:
            mark = station.mark()
            station.command(512, 148)
            (ack,) = station.since(mark, "COMMAND_ACK")

            assert (ack.target_system, ack.target_component) == identity


def interval_of(station, count=12):
    """Seconds of flight between ATTITUDE messages."""
    mark = station.mark()
    station.until(lambda: len(station.since(mark, "ATTITUDE")) > count, what="ATTITUDE")
    stamps = [m.time_boot_ms for m in station.since(mark, "ATTITUDE")]
    return statistics.median(b - a for a, b in zip(stamps, stamps[1:])) / 1000


def test_b16_a_message_interval_is_kept_and_returned(shared):
    with shared().station() as station:
        assert station.set_interval(ATTITUDE_ID, 40_000) == ACCEPTED
        assert 0.038 < interval_of(station) < 0.042
        mark = station.mark()
        assert station.command(510, ATTITUDE_ID) == ACCEPTED
        assert [m.interval_us for m in station.since(mark, "MESSAGE_INTERVAL")] == [40_000]

        assert station.set_interval(ATTITUDE_ID, 0) == ACCEPTED
        assert 0.095 < interval_of(station) < 0.105

        assert station.set_interval(ATTITUDE_ID, -1) == ACCEPTED
        mark = station.mark()
        station.until(lambda: len(station.since(mark, "ATTITUDE_QUATERNION")) > 20, what="other telemetry")
        assert not station.since(mark, "ATTITUDE")
        assert station.command(510, ATTITUDE_ID) == ACCEPTED
        assert station.latest("MESSAGE_INTERVAL").interval_us == -1
        assert station.set_interval(0, 100_000) == FAILED  # HEARTBEAT keeps its rate
        assert station.set_interval(9999, 100_000) == FAILED


def test_b17_a_rate_applies_to_one_link(shared):
    with shared().station() as first, shared().station((254, 191)) as second:
        assert first.set_interval(ATTITUDE_ID, 20_000) == ACCEPTED

        assert 0.019 < interval_of(first) < 0.021
        assert 0.095 < interval_of(second) < 0.105


# ---- arming

def test_b18_arming_waits_for_readiness(sim):
    with sim(vehicle={"ready_after": "30s"}).station() as station:
        mark = station.mark()
        assert station.command(400, 1) == TEMPORARILY_REJECTED
        assert station.expect("STATUSTEXT", since=mark, timeout=5).severity <= mavlink.MAV_SEVERITY_WARNING
        assert not station.is_armed
    with sim(vehicle={"ready_after": "0s"}).station() as station:
        station.ready()
        answers = results_in_time(station, lambda: station.send(command_message(station, 400, 1)), "COMMAND_ACK", 0.2)
        beat = next(m for m in answers if m.get_type() == "HEARTBEAT")

        assert beat.base_mode & 128 and beat.system_status == mavlink.MAV_STATE_ACTIVE


def test_b19_arming_twice_and_disarming_in_the_air(sim):
    station = ready_vehicle(sim)
    take_off(station)
    assert station.command(400, 1) == ACCEPTED
    assert station.command(400, 0) in (TEMPORARILY_REJECTED, DENIED)
    assert station.is_armed
    mark = station.mark()
    assert station.command(400, 0, 21196) == ACCEPTED
    station.armed_is(False, since=mark)
    station.height_is(0, 1.0)  # it fell


def test_b20_an_armed_vehicle_disarms_itself(sim):
    station = ready_vehicle(sim, parameters={"COM_DISARM_PRFLT": 10.0})
    mark = station.mark()
    assert station.command(400, 1) == ACCEPTED
    armed, disarmed = station.armed_is(True, since=mark), station.armed_is(False, since=mark)
    waited = flight_time(station, station.expect("HEARTBEAT", since=mark, where=lambda m: not m.base_mode & 128 and
                                                 flight_time(station, m) > flight_time(station, armed)))
    assert 9.5 < waited - flight_time(station, armed) < 11
    assert not disarmed.base_mode & 128

    mark = station.mark()
    take_off(station, 3)
    assert station.command(21) == ACCEPTED
    touched = station.landed(ON_GROUND, since=station.mark())
    off = station.armed_is(False)
    assert 1.5 < flight_time(station, off) - flight_time(station, touched) < 4


# ---- take-off, landing, return

def test_b21_a_take_off_without_altitude(sim):
    station = ready_vehicle(sim, parameters={"MIS_TAKEOFF_ALT": 4.0})
    mark = station.mark()
    assert station.command(22, NAN, NAN, NAN, NAN, NAN, NAN, NAN) == ACCEPTED
    station.mode_is(TAKEOFF, since=mark)
    arm(station)
    station.landed(CLIMBING, since=mark)
    station.landed(IN_AIR, since=station.at)
    station.mode_is(HOLD, since=station.at)

    station.expect("GLOBAL_POSITION_INT", where=lambda m: abs(m.vz) < 10)
    station.height_is(4, timeout=1)
    states = [m.landed_state for m in station.since(mark, "EXTENDED_SYS_STATE")]
    assert sorted(set(states), key=states.index) == [ON_GROUND, CLIMBING, IN_AIR]


@pytest.mark.parametrize("altitude, above_home", [(HOME[2] + 6, 6), (7.0, 7)])
def test_b22_a_take_off_to_an_altitude(sim, altitude, above_home):
    station = ready_vehicle(sim)
    mark = station.mark()
    arm(station)
    assert station.command(22, 0, 0, 0, NAN, 0, 0, altitude) == ACCEPTED
    station.mode_is(TAKEOFF, since=mark)
    station.mode_is(HOLD, since=station.at)

    station.height_is(above_home)
    station.expect("GLOBAL_POSITION_INT", where=lambda m: abs(m.vz) < 10)
    station.height_is(above_home, timeout=1)


def test_b23_a_landing(sim):
    station = ready_vehicle(sim)
    take_off(station)
    where = place(station.latest("GLOBAL_POSITION_INT"))
    mark = station.mark()
    assert station.command(21) == ACCEPTED
    station.mode_is(LAND, since=mark)
    station.landed(LANDING, since=mark)
    station.landed(ON_GROUND, since=station.at)
    station.armed_is(False, since=station.at)
    station.mode_is(HOLD, since=station.at)

    assert metres_between(where, place(station.expect("GLOBAL_POSITION_INT"))) < 2


def test_b24_a_return(sim):
    station = ready_vehicle(sim, parameters={"RTL_RETURN_ALT": 25.0})
    take_off(station)
    arrives(station, fly_to(station, 40, 30, 12), 12)
    mark = station.mark()
    assert station.command(20) == ACCEPTED
    station.mode_is(RETURN, since=mark)
    end = landed_and_disarmed(station, mark)
    heights = [m.relative_alt / 1000 for m in station.since(mark, "GLOBAL_POSITION_INT")]

    assert 24.5 < max(heights) < 26
    assert metres_between(place(end), HOME) < 2


# ---- going somewhere

@pytest.mark.parametrize("frame, height", [(5, HOME[2] + 15), (0, HOME[2] + 15), (6, 15), (3, 15)])
def test_b25_reposition_flies_to_a_point(sim, frame, height):
    station = ready_vehicle(sim)
    take_off(station)
    mark = station.mark()
    arrives(station, fly_to(station, 25, -10, height, frame=frame, yaw=math.radians(135)), 15)
    station.expect("ATTITUDE", since=mark, where=lambda m: angle_between(math.degrees(m.yaw), 135) < 3)
    if frame != 5:
        return
    fly_to(station, 300, 0, height, frame=frame)
    station.expect("GLOBAL_POSITION_INT", where=lambda m: speed_of(m) > 3)
    assert station.command(192, -1, 1, 0, NAN, form="int", frame=frame, x=HERE, y=HERE, p7=NAN) == ACCEPTED
    stopped = station.expect("GLOBAL_POSITION_INT", where=lambda m: speed_of(m) < 0.3)
    assert metres_between(place(stopped), HOME) < 150


def test_b26_a_changed_speed_shows(sim):
    station = ready_vehicle(sim)
    take_off(station)
    fly_to(station, 2000, 0)

    def settles_at(speed):
        return station.expect("VFR_HUD", where=lambda m: abs(m.groundspeed - speed) < 0.3)
    settles_at(5)  # MPC_XY_CRUISE
    assert station.command(178, 1, 8, -1) == ACCEPTED
    settles_at(8)
    assert station.command(178, 1, 3, -1) == ACCEPTED
    settles_at(3)


def test_b27_a_new_home_shows_at_once(sim):
    station = ready_vehicle(sim, speed=1)
    mark = station.mark()
    latitude, longitude = offset(*HOME[:2], 15, 0)
    result = station.command(179, 0, 0, 0, NAN, form="int", frame=0, x=round(latitude * 1e7), y=round(longitude * 1e7),
                             p7=HOME[2] - 20)
    home = station.expect("HOME_POSITION", since=mark)

    assert result == ACCEPTED
    assert (home.latitude, home.altitude) == (round(latitude * 1e7), round((HOME[2] - 20) * 1000))
    station.height_is(20, 0.7)
    assert station.command(179, 1) == ACCEPTED
    station.height_is(0, 0.7)


@pytest.mark.parametrize("radius", [20, -20])
def test_b28_an_orbit(sim, radius):
    station = ready_vehicle(sim)
    take_off(station)
    centre = offset(*HOME[:2], 30, 0)
    mark = station.mark()
    assert station.command(34, radius, 4, 0, 0, form="int", frame=5, x=round(centre[0] * 1e7),
                           y=round(centre[1] * 1e7), p7=HOME[2] + 12) == ACCEPTED
    station.mode_is(ORBIT, since=mark)
    station.expect("GLOBAL_POSITION_INT", where=lambda m: abs(metres_between(place(m), centre) - 20) < 0.5
                   and speed_of(m) > 3.5)
    mark = station.mark()
    station.until(lambda: len(station.since(mark, "GLOBAL_POSITION_INT")) > 50, what="10 s on the circle")
    positions = station.since(mark, "GLOBAL_POSITION_INT")[10:]  # in the first 2 s it may still turn onto the circle
    status = station.expect("ORBIT_EXECUTION_STATUS")

    assert max(abs(metres_between(place(m), centre) - 20) for m in positions) < 1.5
    bearings = [math.atan2((m.lon / 1e7 - centre[1]) * math.cos(math.radians(centre[0])), m.lat / 1e7 - centre[0])
                for m in positions]
    turns = [math.remainder(b - a, 2 * math.pi) for a, b in zip(bearings, bearings[1:])]
    assert all(turn * radius > 0 for turn in turns)  # clockwise if positive
    assert abs(status.radius - radius) < 0.01
    assert metres_between((status.x / 1e7, status.y / 1e7), centre) < 0.1


def test_b29_the_nose_looks_at_a_region_of_interest(sim):
    station = ready_vehicle(sim)
    plan = [item(0, 22, 0, 0, 10), item(1, 16, 150, 0, 10), item(2, 16, 150, 150, 10)]
    assert station.upload(plan).type == 0
    arm(station)
    assert station.command(176, 1, 4, 4) == ACCEPTED
    station.expect("GLOBAL_POSITION_INT", where=lambda m: speed_of(m) > 4)
    target = offset(*HOME[:2], 50, 200)
    assert station.command(195, form="int", frame=5, x=round(target[0] * 1e7), y=round(target[1] * 1e7),
                           p7=HOME[2]) == ACCEPTED

    def looks_there(m):
        here = place(m)
        east = (target[1] - here[1]) * math.cos(math.radians(here[0]))
        return angle_between(m.hdg / 100, math.degrees(math.atan2(east, target[0] - here[0]))) < 5 and speed_of(m) > 3
    station.expect("GLOBAL_POSITION_INT", where=looks_there, what="that looks at the region")
    assert station.command(197) == ACCEPTED


def test_b30_a_mission_pauses_and_resumes(sim):
    station = ready_vehicle(sim)
    plan = [item(0, 22, 0, 0, 10), item(1, 16, 100, 0, 10), item(2, 16, 100, 40, 10)]
    assert station.upload(plan).type == 0
    arm(station)
    assert station.command(176, 1, 4, 4) == ACCEPTED
    station.expect("GLOBAL_POSITION_INT", where=lambda m: speed_of(m) > 4)
    mark = station.mark()
    assert station.command(193, 0) == ACCEPTED
    station.mode_is(HOLD, since=mark)
    station.expect("GLOBAL_POSITION_INT", where=lambda m: speed_of(m) < 0.3)
    mark = station.mark()
    assert station.command(193, 1) == ACCEPTED
    station.mode_is(MISSION, since=mark)
    station.expect("MISSION_CURRENT", where=lambda m: m.mission_state == 5)


# ---- modes and maintenance

def test_b31_both_ways_to_set_a_mode_are_equal(px4):
    for main, sub, custom in ((3, 0, POSITION), (2, 0, ALTITUDE), (4, 5, RETURN), (4, 3, HOLD)):
        for by_message in (False, True):
            px4.command(176, 1, 7)  # Stabilized, in between
            mark = px4.mark()
            if by_message:
                px4.send(mavlink.MAVLink_set_mode_message(1, 1, custom))
                assert px4.expect("COMMAND_ACK", since=mark).result == ACCEPTED
            else:
                assert px4.command(176, 1, main, sub) == ACCEPTED
            px4.mode_is(custom, since=mark)
    mark = px4.mark()
    assert px4.command(176, 1, 77, 3) in (TEMPORARILY_REJECTED, DENIED)
    assert px4.expect("STATUSTEXT", since=mark).text
    assert px4.expect("HEARTBEAT").custom_mode == HOLD


def test_b32_a_reboot(sim):
    station = ready_vehicle(sim, speed=1)
    station.set_parameter("MIS_TAKEOFF_ALT", 7.25)
    assert station.upload([item(0, 22), item(1, 16, 50)]).type == 0
    before = station.expect("ATTITUDE").time_boot_ms
    arm(station)
    assert station.command(246, 1) == DENIED
    assert station.command(400, 0) == ACCEPTED
    mark = station.mark()
    assert station.command(246, 1) == ACCEPTED
    beat = station.expect("HEARTBEAT", since=station.mark())
    arrived = station.times("HEARTBEAT", mark)

    assert not beat.base_mode & 128
    assert any(1.9 < b - a < 4 for a, b in zip([station.log[mark][0], *arrived], arrived))
    station.until(lambda: station.latest("ATTITUDE").time_boot_ms < before, what="a clock that started again")
    assert min(m.time_boot_ms for m in station.since(mark, "ATTITUDE")) < 1000
    station.ready()
    assert station.parameter("MIS_TAKEOFF_ALT").param_value == 7.25
    assert len(station.download()) == 2


def test_b33_ardupilot_calibrates_its_compasses(sim):
    """As QGroundControl does it: all compasses, saved by the vehicle itself."""
    with sim("--autopilot", "ardupilot", "--speed", 20).station() as station:
        mark = station.mark()
        assert station.command(mavlink.MAV_CMD_DO_START_MAG_CAL, 0, 0, 1) == ACCEPTED
        station.expect("MAG_CAL_PROGRESS", since=mark, where=lambda m: m.completion_pct > 50)
        report = station.expect("MAG_CAL_REPORT", since=mark)
        for compass in range(8):
            if report.cal_mask >> compass & 1:
                last = station.expect("MAG_CAL_REPORT", since=mark, where=lambda m: m.compass_id == compass)
                assert (last.cal_status, last.autosaved) == (mavlink.MAG_CAL_SUCCESS, 1)
        assert station.command(mavlink.MAV_CMD_DO_CANCEL_MAG_CAL, 0) == ACCEPTED


def test_b33_mavsdk_calibrates_the_gyro(sim):
    simulator = sim("--speed", "5")
    simulator.station()
    answer = mavsdks.run(simulator.port, "calibration", "gyro")

    assert answer["result"] == "SUCCESS"
    assert answer["progress"] == sorted(answer["progress"]) and len(answer["progress"]) > 2
