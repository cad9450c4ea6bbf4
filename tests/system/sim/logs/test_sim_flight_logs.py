# SPDX-License-Identifier: MIT
"""Behaviour 62 of docs/guide/sim-behaviour.md: the log of a flight, as PX4's and ArduPilot's own readers see it, agrees
with the telemetry of the same flight."""
import math
import os
import time

import numpy
import pytest
import pyulog
from pymavlink import DFReader

import mavutils
from flights import fly_to, ready_vehicle
from ftp import FtpClient

ARMED = 128
INTERVAL = 20_000  # us; a log has a sample every 200 ms
ATTITUDE, GLOBAL_POSITION_INT, BATTERY_STATUS = 30, 33, 147
# PX4's NAVIGATION_STATE_* (vehicle_status.msg), by main and sub mode (px4_custom_mode.h).
NAVIGATION_STATES = {(4, 2): 17, (4, 3): 4, (4, 5): 5, (4, 6): 18}


def log_files(station):
    """The paths of all logs."""
    folders, files = ["/@MAV_LOG"], set()
    for folder in folders:
        for entry in FtpClient(station).list(folder):
            path = f"{folder}/{entry[1:].split(chr(9))[0]}"
            if entry[0] == "D":
                folders.append(path)
            else:
                files.add(path)
    return files


def flown_log(sim, tmp_path, autopilot):
    """The file of the log of a short flight, and the telemetry of the flight."""
    station = ready_vehicle(sim, autopilot=autopilot)
    for message in (ATTITUDE, GLOBAL_POSITION_INT, BATTERY_STATUS):
        station.set_interval(message, INTERVAL)
    before = log_files(station)
    mark = station.mark()
    station.simulator.ctl("takeoff", 12)
    station.height_is(12)
    fly_to(station, 40, 20, 12)
    station.expect("GLOBAL_POSITION_INT", where=lambda m: math.hypot(m.vx, m.vy) > 300)
    station.simulator.ctl("mode", "Return" if autopilot == "px4" else "RTL")
    station.armed_is(False, timeout=60, since=station.mark())
    telemetry = station.since(mark)
    path, = log_files(station) - before
    with mavutils.connected(station.vehicle_port) as connection:
        content = mavutils.download(connection, path)
    file = tmp_path / os.path.basename(path)
    file.write_bytes(content)
    return station, telemetry, file


def timed(telemetry):
    """Each message with its time since the boot, in seconds. Those without a time have that of the one before."""
    now = None
    for message in telemetry:
        now = getattr(message, "time_boot_ms", now)
        if now is not None:
            yield now / 1000, message


def columns(telemetry, name, *fields):
    """The time and fields (functions) of all messages of this name, as an array of rows."""
    return numpy.array([(when, *(field(m) for field in fields)) for when, m in timed(telemetry)
                        if m.get_type() == name]).T


def deviations(log_times, log_values, sent_times, sent_values, turn=None):
    """The differences between the log and the message that is nearest in time, where there is one within 21 ms.
    `turn`: values are angles, and this is a full turn."""
    nearest = numpy.abs(sent_times[None, :] - numpy.asarray(log_times)[:, None]).argmin(axis=1)
    is_near = numpy.abs(sent_times[nearest] - log_times) < 0.021
    assert is_near.sum() > 60
    off = (numpy.asarray(log_values) - sent_values[nearest])[is_near]
    return numpy.abs(off if turn is None else (off + turn / 2) % turn - turn / 2)


def assert_same(log_times, log_columns, sent, typical, greatest, turn=None):
    """`sent` has a row of times, then a row for each column of the log."""
    for column, values in zip(log_columns, sent[1:], strict=True):
        off = deviations(log_times, column, sent[0], values, turn)
        assert numpy.median(off) <= typical and off.max() <= greatest, (numpy.median(off), off.max())


def assert_same_attitude(telemetry, times, *angles):
    """Roll, pitch and yaw, in degrees."""
    sent = columns(telemetry, "ATTITUDE", *(lambda m, name=name: math.degrees(getattr(m, name))
                                            for name in ("roll", "pitch", "yaw")))
    assert numpy.ptp(sent[2]) > 10  # it leans forwards and backwards
    assert_same(times, angles, sent, 0.3, 4, turn=360)


def assert_same_position(telemetry, times, latitude, longitude, altitude):
    sent = columns(telemetry, "GLOBAL_POSITION_INT", lambda m: m.lat / 1e7, lambda m: m.lon / 1e7,
                   lambda m: m.alt / 1e3)
    assert_same(times, (latitude, longitude), sent[:3], 1e-6, 4e-6)  # degrees; 0.1 m, 0.4 m
    assert_same(times, (altitude,), sent[[0, 3]], 0.02, 0.15)


def assert_same_battery(telemetry, times, volts, amperes, used_mah, remaining_percent):
    sent = columns(telemetry, "BATTERY_STATUS",
                   lambda m: sum(v for v in m.voltages if v != 0xFFFF) / 1e3, lambda m: m.current_battery / 100,
                   lambda m: m.current_consumed, lambda m: m.battery_remaining)
    assert numpy.ptp(sent[1]) > 0.3 and sent[2].max() > 5 and numpy.ptp(sent[3]) > 20
    assert_same(times, (volts,), sent[[0, 1]], 0.02, 0.3)
    assert_same(times, (amperes,), sent[[0, 2]], 0.3, 4)
    # From the disarming on it is charged, faster than these times are exact.
    flies = times < times[-1] - 0.3
    assert_same(times[flies], (used_mah[flies],), sent[[0, 3]], 1, 3)
    assert_same(times[flies], (remaining_percent[flies],), sent[[0, 4]], 1, 1)


def modes_of(telemetry):
    """(time, custom_mode) of each change of mode of the armed vehicle."""
    changes = []
    for when, message in timed(telemetry):
        if message.get_type() == "HEARTBEAT" and message.base_mode & ARMED:
            if not changes or changes[-1][1] != message.custom_mode:
                changes.append((when, message.custom_mode))
    return changes


def assert_same_modes(expected, logged, tolerance):
    """Rows of (time, mode)."""
    assert [mode for _, mode in logged] == [mode for _, mode in expected]
    assert [when for when, _ in logged[1:]] == pytest.approx([when for when, _ in expected[1:]], abs=tolerance)


def angles_of(w, x, y, z):
    """Roll, pitch, yaw in degrees."""
    return (numpy.degrees(numpy.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))),
            numpy.degrees(numpy.arcsin(numpy.clip(2 * (w * y - z * x), -1, 1))),
            numpy.degrees(numpy.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))))


def changes_of(times, values):
    rows = list(zip(times, values))
    return rows[:1] + [b for a, b in zip(rows, rows[1:]) if a[1] != b[1]]


def test_b62_pyulog_reads_the_log_of_a_flight(sim, tmp_path):
    station, telemetry, file = flown_log(sim, tmp_path, "px4")
    log = pyulog.ULog(str(file))
    topics = {topic.name: topic.data for topic in log.data_list}
    seconds = {name: data["timestamp"] / 1e6 for name, data in topics.items()}

    attitude = topics["vehicle_attitude"]
    assert_same_attitude(telemetry, seconds["vehicle_attitude"], *angles_of(*(attitude[f"q[{i}]"] for i in range(4))))
    position = topics["vehicle_global_position"]
    assert_same_position(telemetry, seconds["vehicle_global_position"], *(position[x] for x in ("lat", "lon", "alt")))
    battery = topics["battery_status"]
    assert_same_battery(telemetry, seconds["battery_status"], battery["voltage_v"], battery["current_a"],
                        battery["discharged_mah"], battery["remaining"] * 100)
    status = topics["vehicle_status"]
    assert status["arming_state"].tolist() == [2] * (len(status["timestamp"]) - 1) + [1]  # armed, then disarmed
    flown = [(when, NAVIGATION_STATES[mode >> 16 & 0xFF, mode >> 24]) for when, mode in modes_of(telemetry)]
    assert len(flown) == 3
    assert_same_modes(flown, changes_of(seconds["vehicle_status"][:-1], status["nav_state"]), 0.3)
    assert {"vehicle_local_position", "vehicle_gps_position"} <= topics.keys()
    assert set(log.initial_parameters) == set(station.parameters()) - {"_HASH_CHECK"}
    assert log.initial_parameters["COM_DISARM_PRFLT"] == 600
    texts = [message.message for message in log.logged_messages]
    assert texts[0] == "Armed by external command" and "Takeoff detected" in texts
    assert texts[-1] == "Disarmed by landing"


def test_b62_pymavlink_reads_the_log_of_a_flight(sim, tmp_path):
    station, telemetry, file = flown_log(sim, tmp_path, "ardupilot")
    log = DFReader.DFReader_binary(str(file))
    messages = {}
    while (message := log.recv_msg()) is not None:
        messages.setdefault(message.get_type(), []).append(message)

    def of(kind, *fields):
        return [numpy.array([getattr(m, field) for m in messages[kind]]) for field in fields]

    def seconds(kind):
        return of(kind, "TimeUS")[0] / 1e6

    assert_same_attitude(telemetry, seconds("ATT"), *of("ATT", "Roll", "Pitch", "Yaw"))
    assert_same_position(telemetry, seconds("POS"), *of("POS", "Lat", "Lng", "Alt"))
    above_home = columns(telemetry, "GLOBAL_POSITION_INT", lambda m: m.relative_alt / 1e3)
    assert_same(seconds("POS"), of("POS", "RelHomeAlt"), above_home, 0.02, 0.15)
    assert_same_battery(telemetry, seconds("BAT"), *of("BAT", "Volt", "Curr", "CurrTot", "RemPct"))
    flown = modes_of(telemetry)
    assert [mode for _, mode in flown] == [4, 6]  # GUIDED, RTL
    assert_same_modes(flown, list(zip(seconds("MODE"), *of("MODE", "ModeNum"))), 0.3)
    assert of("MODE", "Mode")[0].tolist() == of("MODE", "ModeNum")[0].tolist() and log.flightmode == "RTL"
    assert all(m.fmt.units is not None for kind in ("ATT", "GPS", "POS", "BAT") for m in messages[kind][:1])
    assert abs(messages["GPS"][0]._timestamp - time.time()) < 600
    assert log.params["DISARM_DELAY"] == 127
    texts = [m.Message for m in messages["MSG"]]
    assert texts[0].startswith("ArduCopter V4.6") and texts[1] == "Arming motors" and texts[-1] == "Disarming motors"
