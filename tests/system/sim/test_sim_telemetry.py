# SPDX-License-Identifier: MIT
"""Behaviours 64 to 78 of docs/guide/sim-behaviour.md: telemetry and health, Offboard and manual control."""
import itertools
import json
import math
import statistics
import struct
import threading
import time

import pytest

import coherence
import frames
import mavsdks
from flights import arm, flight_time, fly_to, ready_vehicle, results_in_time, speed_of, take_off
from simulators import (ALTITUDE, HOLD, HOME, LAND, OFFBOARD, POSITION, RETURN, TAKEOFF, item, metres_between, offset,
                        place)
from stations import NAN, mavlink

ACCEPTED = 0
ON_GROUND, IN_AIR, CLIMBING, LANDING = 1, 2, 3, 4


# ---- health

def test_b64_health_becomes_good_and_shows_a_failure(sim):
    simulator = sim("--speed", "2")
    with simulator.station() as station:
        mavsdks.run(simulator.port, "health")
        gps, prearm = mavlink.MAV_SYS_STATUS_SENSOR_GPS, mavlink.MAV_SYS_STATUS_PREARM_CHECK

        def healthy(bits, wanted):
            station.expect("SYS_STATUS", where=lambda m: bool(m.onboard_control_sensors_health & bits) == wanted)
        healthy(gps, True)
        healthy(prearm, True)
        assert station.command(420, mavlink.FAILURE_UNIT_SENSOR_GPS, mavlink.FAILURE_TYPE_OFF) == ACCEPTED
        healthy(gps, False)
        healthy(prearm, False)
        assert station.command(400, 1) == 1  # TEMPORARILY_REJECTED
        assert station.command(420, mavlink.FAILURE_UNIT_SENSOR_GPS, mavlink.FAILURE_TYPE_OK) == ACCEPTED
        healthy(gps, True)
        healthy(prearm, True)


# ---- coherence

def record_flight(sim):
    """Take-off, a mission with turns, a return and a landing, with fast streams and snapshots of single steps."""
    station = ready_vehicle(sim, speed=4, parameters={"RTL_RETURN_ALT": 15.0})
    for message, hertz in ((30, 50), (32, 50), (105, 100), (147, 5), (1, 5)):
        assert station.set_interval(message, 1e6 / hertz) == ACCEPTED
    station.ask_for(49, "GPS_GLOBAL_ORIGIN")
    plan = [item(0, 22, 0, 0, 10), item(1, 16, 30, 0, 10, p=(0, 2, 0, NAN)), item(2, 16, 30, 25, 13, p=(0, 2, 0, NAN)),
            item(3, 16, 10, 30, 10, p=(0, 2, 0, NAN)), item(4, 20, frame=2)]
    assert station.upload(plan).type == ACCEPTED
    station.download()
    mark = station.mark()
    with coherence.Snapshots(station):
        station.until(lambda: len(station.since(mark, "ODOMETRY")) > 5, what="snapshots on the ground")
        assert station.command(176, 1, 4, 4) == ACCEPTED
        arm(station)
        station.armed_is(True, since=mark)
        station.armed_is(False)
        after = station.mark()
        station.until(lambda: len(station.since(after, "ODOMETRY")) > 5, what="snapshots after the landing")
    assert station.lost == 0
    return coherence.Recording([m for m in station.since(0) if m.get_srcComponent() == 1])


def test_b65_all_messages_agree_with_each_other(sim):
    recording = record_flight(sim)
    wrong = {rule.__name__: violations for rule in coherence.RULES if (violations := rule(recording))}

    assert len(recording.snapshots) > 40, len(recording.snapshots)
    assert not wrong, "\n".join(f"{name}: {text}" for name, texts in wrong.items() for text in texts)


def test_b66_states_and_modes_of_a_flight(sim):
    station = ready_vehicle(sim)
    mark = station.mark()
    take_off(station, 6)
    assert station.command(21) == ACCEPTED
    station.armed_is(False)
    station.mode_is(HOLD)
    states = [s for s, _ in itertools.groupby(m.landed_state for m in station.since(mark, "EXTENDED_SYS_STATE"))]
    modes = [m for m, _ in itertools.groupby(m.custom_mode for m in station.since(mark, "HEARTBEAT"))]
    current = [m for m, _ in itertools.groupby(m.custom_mode for m in station.since(mark, "CURRENT_MODE"))]

    assert states == [ON_GROUND, CLIMBING, IN_AIR, LANDING, ON_GROUND]
    assert [m for m in modes if m in (TAKEOFF, LAND)] == [TAKEOFF, LAND] and modes[-1] == HOLD
    assert [m for m in current if m in (TAKEOFF, LAND)] == [TAKEOFF, LAND]


def test_b67_the_battery_warns_as_it_empties(sim):
    station = ready_vehicle(sim, parameters={"COM_LOW_BAT_ACT": 0}, vehicle={"battery": {"minutes": 1.5}})
    mark = station.mark()
    take_off(station)
    levels = {}
    for state, threshold in ((2, 15), (3, 7), (4, 5)):  # LOW, CRITICAL, EMERGENCY
        battery = station.expect("BATTERY_STATUS", since=mark, where=lambda m, s=state: m.charge_state == s)
        levels[state] = battery.battery_remaining
        assert threshold - 3 <= battery.battery_remaining <= threshold
    remaining = [m.battery_remaining for m in station.since(mark, "BATTERY_STATUS")]
    warnings = [m.text for m in station.since(mark, "STATUSTEXT") if m.severity <= 4 and "attery" in m.text]

    assert remaining == sorted(remaining, reverse=True)
    assert len(warnings) >= 3, station.texts()


def test_b68_gnss_is_good_and_the_position_rests(shared):
    with shared("--speed", "20").station() as station:
        station.ready()
        mark = station.mark()
        station.until(lambda: len(station.since(mark, "GPS_RAW_INT")) > 100, what="20 s")
        fixes, positions = station.since(mark, "GPS_RAW_INT"), station.since(mark, "GLOBAL_POSITION_INT")

    assert {(m.fix_type, m.satellites_visible) for m in fixes} == {(3, 10)}
    assert all(50 < m.eph < 150 for m in fixes)
    assert max(metres_between(place(m), HOME) for m in positions) < 0.5
    assert max(metres_between(place(m), HOME) for m in fixes) < 1.5
    assert max(abs(m.relative_alt) for m in positions) < 500


def test_b69_texts_arrive_complete(sim):
    """MAVSDK and pymavlink join the same texts."""
    simulator = sim()
    with simulator.station() as station:
        station.ready()
        with mavsdks.started(simulator.port, "texts", 3) as client:
            assert client.answer()["ready"]
            mark = station.mark()
            for _ in range(3):
                station.command(176, 1, 77)  # refused, with a text
            heard = client.answer()["texts"]
        chunks = station.since(mark, "STATUSTEXT")

    assert joined(chunks)[:3] == heard[:3]
    assert all(len(text) > 5 for text in heard)


def joined(chunks):
    """Texts of STATUSTEXT messages, as the MAVLink guide joins them: a chunk that is not full ends a text."""
    texts, open_texts = [], {}
    for chunk in chunks:
        text = chunk.text
        if chunk.id == 0:
            texts.append(text)
            continue
        parts = open_texts.setdefault(chunk.id, [])
        assert chunk.chunk_seq == len(parts)
        parts.append(text)
        if len(text) < 50:
            texts.append("".join(open_texts.pop(chunk.id)))
    assert not open_texts
    return texts


def test_b70_home_can_be_requested(px4):
    home = px4.ask_for(242, "HOME_POSITION")

    assert metres_between((home.latitude / 1e7, home.longitude / 1e7), HOME) < 1
    assert abs(home.altitude / 1000 - HOME[2]) < 1
    assert px4.command(410) == ACCEPTED


# ---- rates and times

RATES = {0: 1, 1: 1, 245: 1, 147: 1, 242: 1, 436: 1, 2: 1, 36: 1, 24: 5, 74: 5, 33: 5, 141: 5, 29: 5, 230: 5, 241: 5,
         30: 10, 32: 10, 31: 20}


# Where messages carry the vehicle's time, as their first field: the field's form, and its ticks a second.
STAMPS = {30: ("<I", 1e3), 32: ("<I", 1e3), 31: ("<I", 1e3), 33: ("<I", 1e3), 29: ("<I", 1e3), 36: ("<I", 1e6),
          24: ("<Q", 1e6), 141: ("<Q", 1e6), 230: ("<Q", 1e6), 241: ("<Q", 1e6)}


@pytest.mark.parametrize("max_skipped", [0.1, pytest.param(0.001, marks=pytest.mark.long)])
def test_b71_fifty_vehicles_keep_their_rates(sim, udp_socket, max_skipped):
    """On a busy machine, a stream may skip instants. So this compares the times in the messages, and the instants that
    are missing between them with those that the simulator counts as skipped; `max_skipped` is their share. Only
    headers and times are read: 6,000 messages a second are many for pymavlink."""
    simulator = sim(vehicle={"count": 50, "ready_after": "0s"})  # a change of status sends HEARTBEAT once more
    simulator.station().close()
    sock = udp_socket()
    sock.connect(("127.0.0.1", simulator.port))
    beat = mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3).pack(mavlink.MAVLink(None, 255, 190))
    sent, began = {}, time.monotonic()
    while time.monotonic() < began + 6:
        sock.send(beat)
        until = time.monotonic() + 1
        while time.monotonic() < until:
            for frame in frames.split_frames(sock.recv(65536)):
                key = (frame[5], int.from_bytes(frame[7:10], "little"))
                form, ticks = STAMPS.get(key[1], ("<x", 1))
                stamp = struct.unpack_from(form, frame[10:-2].ljust(255, b"\0")) if key[1] in STAMPS else (0,)
                sent.setdefault(key, []).append(stamp[0] / ticks)
    seconds = time.monotonic() - began
    rows = [json.loads(line) for line in simulator.ctl("streams").splitlines()]
    ours = f":{sock.getsockname()[1]}"
    streams = {(row["system"], row["id"]): row for row in rows if row["link"].endswith(ours)}

    for vehicle in range(1, 51):
        for message, hertz in RATES.items():
            stamps, stream = sent[vehicle, message], streams[vehicle, message]
            assert stream["asked_hz"] == hertz
            assert len(stamps) + stream["skipped"] >= 5 * hertz, (vehicle, message, len(stamps), stream)
            assert len(stamps) <= seconds * hertz + 2, (vehicle, message, len(stamps), seconds)
            if message in STAMPS:
                steps = [(b - a) * hertz for a, b in zip(stamps, stamps[1:])]
                assert all(step > 0.5 and abs(step - round(step)) < 0.1 for step in steps), (vehicle, message, steps)
                assert sum(round(step) - 1 for step in steps) <= stream["skipped"], (vehicle, message, steps)
    skipped = sum(stream["skipped"] for stream in streams.values())
    assert skipped <= max_skipped * (skipped + sum(map(len, sent.values())))
    phases = {round(sent[vehicle, 30][0] * 1000) % 100 for vehicle in range(1, 51)}
    assert len(phases) > 10, phases  # of 25: flights have steps of 4 ms


def test_b72_the_clock_of_the_vehicle_runs_as_ours(sim):
    simulator = sim("--profile", "px4-onboard")
    with simulator.station() as station:
        station.ready()
        answer = mavsdks.run(simulator.port, "information")
        timed = [(when, m) for when, m in station.log if m.get_type() == "ATTITUDE"]
        stamps = [m.time_boot_ms for m in station.since(0) if hasattr(m, "time_boot_ms")]
        offsets = [when - m.time_boot_ms / 1000 for when, m in timed]

    assert stamps == sorted(stamps)
    assert abs(statistics.median(offsets[-200:]) - statistics.median(offsets[:200])) < 0.02
    assert 0.95 < answer["speed"] < 1.05
    assert answer["version"] == [1, 17, 0] and answer["kind"] == "RELEASE"
    assert answer["flights"] == sorted(answer["flights"])


def test_b73_timesync_is_answered_at_once(px4):
    stamp = 123_456_789_000
    answers = results_in_time(px4, lambda: px4.send(mavlink.MAVLink_timesync_message(0, stamp)), "TIMESYNC", 0.005)
    (answer,) = [m for m in answers if m.get_type() == "TIMESYNC"]

    assert answer.ts1 == stamp
    assert abs(answer.tc1 / 1e6 - px4.expect("ATTITUDE").time_boot_ms) < 1000
    assert (answer.target_system, answer.target_component) == (255, 190)


def test_b74_ping_and_system_time(px4):
    mark = px4.mark()
    px4.send(mavlink.MAVLink_ping_message(987654, 77, 0, 0))
    answer = px4.expect("PING", since=mark, where=lambda m: m.target_system == 255)
    now = px4.expect("SYSTEM_TIME")

    assert (answer.time_usec, answer.seq) == (987654, 77)
    assert abs(now.time_unix_usec / 1e6 - time.time()) < 5
    assert abs(now.time_boot_ms - px4.expect("ATTITUDE").time_boot_ms) < 1000


# ---- Offboard

class Setpoints:
    """Sends what `make()` returns at 20 Hz."""

    def __init__(self, station, make):
        self.station, self.make, self._stop = station, make, threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def _run(self):
        while not self._stop.wait(0.05):
            self.station.send(self.make())

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._stop.set()
        self._thread.join()


def local(mask, position=(0, 0, 0), velocity=(0, 0, 0), yaw=0.0, yaw_rate=0.0, frame=1):
    return mavlink.MAVLink_set_position_target_local_ned_message(0, 1, 1, frame, mask, *position, *velocity, 0, 0, 0,
                                                                 yaw, yaw_rate)


VELOCITY, PLACE, BODY_VELOCITY = 0x9C7, 0x9F8, 0x5C7
OFFBOARD_SPEED = 5
SLOW_LOSS = {"COM_OF_LOSS_T": 20.0}  # the tests' own threads may be slow


def test_b75_offboard_needs_set_points(sim):
    station = ready_vehicle(sim, speed=OFFBOARD_SPEED, parameters=SLOW_LOSS)
    assert station.command(176, 1, 6) == ACCEPTED
    assert station.command(400, 1) == 1  # TEMPORARILY_REJECTED: Offboard without set-points
    assert station.command(176, 1, 4, 3) == ACCEPTED
    take_off(station)
    assert station.command(176, 1, 6) == 1
    assert station.expect("HEARTBEAT").custom_mode == HOLD
    with Setpoints(station, lambda: local(VELOCITY)):
        station.until(lambda: station.command(176, 1, 6) == ACCEPTED, 5, "Offboard with set-points")
        station.mode_is(OFFBOARD)


def test_b76_set_points_are_followed(sim):
    station = ready_vehicle(sim, speed=OFFBOARD_SPEED, parameters=SLOW_LOSS)
    take_off(station)
    wanted = [local(VELOCITY, velocity=(2, -1, 0), yaw=1.0)]
    with Setpoints(station, lambda: wanted[0]):
        station.until(lambda: station.command(176, 1, 6) == ACCEPTED, 5, "Offboard")

        def comes(name, what, timeout=30):
            station.expect(name, where=what, timeout=timeout, what=f"for {wanted[0]}")
        comes("LOCAL_POSITION_NED", lambda m: math.hypot(m.vx - 2, m.vy + 1) < 0.2 and abs(m.vz) < 0.2)
        comes("ATTITUDE", lambda m: abs(m.yaw - 1.0) < 0.05)

        wanted[0] = local(PLACE, position=(20, 10, -15), velocity=(9, 9, 9), yaw=-0.5)  # the velocity is masked
        comes("LOCAL_POSITION_NED", lambda m: math.dist((m.x, m.y, m.z), (20, 10, -15)) < 0.5)
        comes("ATTITUDE", lambda m: abs(m.yaw + 0.5) < 0.05)

        wanted[0] = local(BODY_VELOCITY, velocity=(0, 2, 0), yaw_rate=0.0, frame=8)
        comes("LOCAL_POSITION_NED", lambda m: math.hypot(m.vx - 2 * math.sin(0.5), m.vy - 2 * math.cos(0.5)) < 0.25)

        there = offset(*HOME[:2], -10, 5)
        wanted[0] = mavlink.MAVLink_set_position_target_global_int_message(
            0, 1, 1, 6, PLACE, round(there[0] * 1e7), round(there[1] * 1e7), 12, 0, 0, 0, 0, 0, 0, 0, 0)
        comes("GLOBAL_POSITION_INT", lambda m: metres_between(place(m), there) < 0.7 and
              abs(m.relative_alt - 12_000) < 700)
        comes("POSITION_TARGET_LOCAL_NED", lambda m: not m.type_mask & 7)

        roll = math.radians(8)
        wanted[0] = mavlink.MAVLink_set_attitude_target_message(
            0, 1, 1, 0x07, [math.cos(roll / 2), math.sin(roll / 2), 0, 0], 0, 0, 0, 0.5)
        comes("ATTITUDE", lambda m: abs(m.roll - roll) < 0.03)
    assert station.is_armed


def test_b77_lost_set_points_end_offboard(sim):
    station = ready_vehicle(sim, speed=2)
    take_off(station)
    with Setpoints(station, lambda: local(VELOCITY)):
        station.until(lambda: station.command(176, 1, 6) == ACCEPTED, 5, "Offboard")
        station.mode_is(OFFBOARD)
    mark = station.mark()
    last = station.latest("ATTITUDE").time_boot_ms / 1000
    left = station.expect("HEARTBEAT", since=mark, where=lambda m: m.custom_mode != OFFBOARD, timeout=20)

    assert 0.9 < flight_time(station, left) - last < 3.5
    assert left.custom_mode in (HOLD, RETURN, POSITION)
    assert station.texts(mark)
    assert station.is_armed


# ---- manual control

def test_b78_sticks_move_the_vehicle_and_their_loss_holds_it(sim):
    station = ready_vehicle(sim, speed=2, parameters={"COM_RC_LOSS_T": 3.0})
    take_off(station)
    sticks = [mavlink.MAVLink_manual_control_message(1, 700, 0, 500, 0, 0)]
    start = place(station.latest("GLOBAL_POSITION_INT"))
    with Setpoints(station, lambda: sticks[0]):
        station.until(lambda: station.command(176, 1, 3) == ACCEPTED, 5, "Position with sticks")
        station.mode_is(POSITION)
        station.expect("GLOBAL_POSITION_INT", where=lambda m: m.lat / 1e7 > start[0] + 8e-5 and speed_of(m) > 2)
        sticks[0] = mavlink.MAVLink_manual_control_message(1, 0, 0, 900, 0, 0)
        station.expect("GLOBAL_POSITION_INT", where=lambda m: m.vz < -50)
    mark = station.mark()
    left = station.expect("HEARTBEAT", since=mark, where=lambda m: m.custom_mode not in (POSITION, ALTITUDE))
    assert left.custom_mode in (HOLD, RETURN)
    station.expect("GLOBAL_POSITION_INT", where=lambda m: speed_of(m) < 0.3 and abs(m.vz) < 30)
    assert fly_to(station, 0, 0)


def test_mavsdk_telemetry(sim):
    simulator = sim("--wind", "3,270")
    simulator.station()
    answer = mavsdks.run(simulator.port, "telemetry", "actuator_output_status", "rc_status")

    assert {name: result for name, result in answer["rates"].items() if result != "SUCCESS"} == {}
    assert answer["silent"] == []
    assert all(answer["health"].values()), answer["health"]
    assert metres_between(answer["position"][:2], HOME) < 1 and abs(answer["position"][2] - HOME[2]) < 1
    assert abs(answer["position"][3]) < 0.5 and metres_between(answer["home"][:2], HOME) < 1
    assert 14 < answer["battery"][0] < 17.5 and answer["battery"][1] > 95
    assert (answer["satellites"], answer["fix"], answer["mode"]) == (10, "FIX_3D", "HOLD")
    assert (answer["landed"], answer["in_air"]) == ("ON_GROUND", False)
