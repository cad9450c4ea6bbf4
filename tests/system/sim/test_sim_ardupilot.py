# SPDX-License-Identifier: MIT
"""Behaviours 79 to 82 of docs/guide/sim-behaviour.md: what differs for ArduPilot."""
import collections
import math
import time

import pytest

import mavproxies
import mavutils
from flights import ready_vehicle, speed_of
from simulators import HOME, item, metres_between, offset, place
from stations import mavlink

from pymavlink import mavutil

ACCEPTED = 0
STABILIZE, AUTO, GUIDED, RTL, LAND = 0, 3, 4, 6, 9


@pytest.mark.parametrize("kind, mapping", [("quad", mavutil.mode_mapping_acm), ("plane", mavutil.mode_mapping_apm),
                                           ("rover", mavutil.mode_mapping_rover)])
def test_b79_pymavlinks_names_select_modes(sim, kind, mapping):
    simulator = sim("--autopilot", "ardupilot", "--vehicle", kind, vehicle={"ready_after": "0s"})
    simulator.station(identity=(254, 1)).ready()
    with mavutils.connected(simulator.port) as connection:
        names = connection.mode_mapping()
        assert names and set(names.values()) <= set(mapping)
        refused = []
        for name, number in names.items():
            if not number_is_selectable(kind, name):
                continue
            connection.set_mode(name)
            try:
                mavutils.receive(connection, "HEARTBEAT", timeout=3, where=lambda m, n=number: m.custom_mode == n)
                assert connection.flightmode == name
            except AssertionError:
                refused.append(name)
        connection.set_mode("GUIDED")
        mavutils.receive(connection, "HEARTBEAT", where=lambda m: m.custom_mode == names["GUIDED"])

    assert refused == []


def number_is_selectable(kind, name):
    """Not simulated: modes of hardware, of VTOL planes and helicopters, and the mode during boot."""
    return name not in ("INITIALISING", "FLIP", "AUTOTUNE", "THROW", "AVOID_ADSB", "FLOWHOLD", "ZIGZAG", "SYSTEMID",
                        "AUTOROTATE", "AUTO_RTL", "TURTLE", "RATE_ACRO", "LEARNING", "OF_LOITER", "POSITION", "THERMAL",
                        "DOCK") and \
        not (kind == "plane" and name.startswith("Q") or "QLAND" in name)


@pytest.fixture
def copter(sim):
    def make(**options):
        return ready_vehicle(sim, autopilot="ardupilot", **options)
    return make


def test_b80_mavproxy_flies_a_copter(sim, tmp_path):
    simulator = sim("--autopilot", "ardupilot", "--speed", "8", parameters={"DISARM_DELAY": 127, "RTL_ALT": 1500})
    station = simulator.station().ready()
    proxy = mavproxies.Mavproxy(tmp_path / "proxy", simulator.port)
    try:
        proxy.says(r"online system 1")
        proxy.says(r"Received \d+ parameters|Saved \d+ parameters")
        proxy.repeats("mode GUIDED", r"Mode GUIDED|GUIDED>")
        proxy.type("arm throttle")
        station.armed_is(True)
        proxy.type("takeoff 12")
        station.height_is(12)
        target = offset(*HOME[:2], 30, 20)
        proxy.type(f"guided {target[0]:.7f} {target[1]:.7f} 15")
        station.expect("GLOBAL_POSITION_INT", where=lambda m: metres_between(place(m), target) < 1.5)
        proxy.type("rtl")
        station.mode_is(RTL)
        station.armed_is(False)
        assert metres_between(place(station.expect("GLOBAL_POSITION_INT")), HOME) < 2
        proxy.repeats("mode GUIDED", r"Mode GUIDED|GUIDED>")
        proxy.type("arm throttle")
        station.armed_is(True)
        proxy.type("takeoff 5")
        station.height_is(5)
        proxy.type("mode LAND")
        station.mode_is(LAND)
        station.armed_is(False)
        assert proxy.complaints == []
    finally:
        proxy.close()


GROUPS = {1: ("RAW_IMU", "SCALED_IMU2", "SCALED_PRESSURE"), 2: ("SYS_STATUS", "MISSION_CURRENT", "GPS_RAW_INT"),
          3: ("SERVO_OUTPUT_RAW",), 6: ("GLOBAL_POSITION_INT", "LOCAL_POSITION_NED"), 10: ("ATTITUDE", "AHRS2"),
          11: ("VFR_HUD",), 12: ("SYSTEM_TIME", "BATTERY_STATUS", "VIBRATION", "EKF_STATUS_REPORT")}


def counts(station, until):
    """How often messages came while ATTITUDE-independent HEARTBEATs came `until` times."""
    mark = station.mark()
    started = time.monotonic()
    station.until(lambda: len(station.since(mark, "HEARTBEAT")) >= until, what="heartbeats")
    return collections.Counter(m.get_type() for m in station.since(mark)), time.monotonic() - started


def test_b81_rates_of_groups(sim):
    station = sim("--autopilot", "ardupilot").station().ready()
    stream = mavlink.MAVLink_request_data_stream_message

    def rates_are(hertz, names):
        mark = station.mark()
        for name in names:
            station.until(lambda: len(station.times(name, mark)) > 20, what=name)
        for name in names:
            times = station.times(name, mark)
            assert abs((len(times) - 1) / (times[-1] - times[0]) / hertz - 1) < 0.15, (name, times)
    station.send(stream(1, 1, 0, 10, 1))
    rates_are(10, [name for names in GROUPS.values() for name in names])
    station.send(stream(1, 1, 10, 25, 1))
    rates_are(25, GROUPS[10])
    rates_are(10, GROUPS[11])
    station.send(stream(1, 1, 0, 10, 0))
    station.command(512, 148)  # the vehicle has carried it out
    seen, _ = counts(station, 3)
    assert {name for names in GROUPS.values() for name in names} & set(seen) == set()


def test_b82_item_0_is_home(copter):
    station = copter()
    assert station.download() == []
    mark = station.mark()
    station.send_to_vehicle("mission_request", 0)
    home = station.expect("MISSION_ITEM", since=mark)
    assert metres_between((home.x, home.y), HOME) < 2  # degrees as floats
    assert station.upload([item(0, 16, 500, 500, 50), item(1, 22, 0, 0, 10), item(2, 16, 40, 0, 10),
                           item(3, 20, frame=2)]).type == ACCEPTED
    # An answer that comes late is asked for again.
    assert {m.seq for m in station.since(mark, "MISSION_REQUEST")} == {0, 1, 2, 3}
    assert not station.since(mark, "MISSION_REQUEST_INT")
    items = station.download()
    assert len(items) == 4
    assert metres_between((items[0].x / 1e7, items[0].y / 1e7), HOME) < 1
    assert abs(items[0].z - HOME[2]) < 1

    mark = station.mark()
    assert station.command(176, 1, GUIDED) == ACCEPTED
    assert station.command(400, 1) == ACCEPTED
    assert station.command(22, 0, 0, 0, 0, 0, 0, 8) == ACCEPTED
    station.height_is(8)
    assert station.command(176, 1, AUTO) == ACCEPTED
    station.expect("MISSION_ITEM_REACHED", since=mark, where=lambda m: m.seq == 2)
    station.armed_is(False)
    assert 0 not in {m.seq for m in station.since(mark, "MISSION_ITEM_REACHED")}


def test_guided_forms_of_ardupilot(copter):
    """Take-off only in GUIDED; go-to by MISSION_ITEM_INT with current 2 and by DO_REPOSITION; CONDITION_YAW."""
    station = copter()
    mark = station.mark()
    assert station.command(22, 0, 0, 0, 0, 0, 0, 8) in (2, 4)  # in STABILIZE
    assert station.command(176, 1, GUIDED) == ACCEPTED
    assert station.command(22, 0, 0, 0, 0, 0, 0, 8) in (2, 4)  # disarmed
    assert station.command(400, 1) == ACCEPTED
    assert station.command(22, 0, 0, 0, 0, 0, 0, 8) == ACCEPTED
    station.height_is(8)
    target = offset(*HOME[:2], 20, 10)
    station.send(item(0, 16, 20, 10, 12, p=(0, 0, 0, 0), current=2))
    assert station.expect("MISSION_ACK", since=mark).type == ACCEPTED
    station.expect("GLOBAL_POSITION_INT", where=lambda m: metres_between(place(m), target) < 1 and
                   abs(m.relative_alt - 12_000) < 800 and speed_of(m) < 0.5)
    assert station.command(115, 90, 0, 1, 0) == ACCEPTED
    station.expect("ATTITUDE", where=lambda m: abs(m.yaw - math.pi / 2) < 0.05)
    assert station.command(176, 1, 99) in (2, 4)
