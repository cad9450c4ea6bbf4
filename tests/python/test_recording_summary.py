# SPDX-License-Identifier: MIT
"""Recording.summary() has the values of `mavloom info --json`, whose tests compare them with pymavlink."""
import json
import os
import subprocess

import pytest

import mavloom
from places import PROGRAM, ROOT
from tlogs import frames_of

SESSION = ROOT / "tests/data/px4_gcs_session.tlog"


def by_program(path):
    done = subprocess.run([PROGRAM, "info", str(path), "--json"], capture_output=True, check=True)
    return json.loads(done.stdout)


@pytest.mark.parametrize("name", ["flight", "session"])
def test_the_summary_is_the_programs(flight, name):
    path = flight if name == "flight" else SESSION
    ours, theirs = mavloom.read(path).summary(), by_program(path)

    assert (ours.begin_ns, ours.end_ns) == (theirs["begin_us"] * 1000, theirs["end_us"] * 1000)
    for key, value in (("duration", "duration_s"), ("frames", "frames"), ("bytes", "bytes"),
                       ("junk_bytes", "junk_bytes")):
        assert getattr(ours, key) == theirs[value]
    assert [(s.sys, s.comp, s.frames, s.lost, [(m.id, m.name, m.count, m.bytes) for m in s.messages])
            for s in ours.senders] == [
        (s["sys"], s["comp"], s["frames"], s["lost"], [(m["id"], m["name"], m["count"], m["bytes"])
                                                       for m in s["messages"]]) for s in theirs["senders"]]
    assert [(p.sys, p.time_ns // 1000, p.name, p.before, p.after) for p in ours.parameters] == [
        (p["sys"], p["time_us"], p["name"], p["before"], p["after"]) for p in theirs["parameters"]]

    [vehicle], [expected] = [s for s in ours.senders if s.is_vehicle], theirs["vehicles"]
    assert [(m.time_ns // 1000, m.at, m.duration, m.name, m.custom_mode) for m in vehicle.modes] == [
        (m["time_us"], m["at_s"], m["duration_s"], m["mode"], m["custom_mode"]) for m in expected["modes"]]
    assert [(a.at, a.duration) for a in vehicle.armed] == [(a["at_s"], a["duration_s"]) for a in expected["armed"]]
    assert vehicle.firmware == (expected["firmware"] and expected["firmware"]["version"])
    for key in ("highest_alt_m", "highest_relative_alt_m", "highest_speed_m_s", "distance_m"):
        assert getattr(vehicle, key) == expected[key]
    for key in ("first_position", "last_position"):
        fix = getattr(vehicle, key)
        assert (fix.lat_deg, fix.lon_deg, fix.alt_m, fix.relative_alt_m) == tuple(
            expected[key][name] for name in ("lat_deg", "lon_deg", "alt_m", "relative_alt_m"))
    assert (vehicle.first_battery_percent, vehicle.lowest_battery_percent, vehicle.last_voltage_v) == tuple(
        expected["battery"][key] for key in ("first_percent", "lowest_percent", "last_voltage_v"))


def test_the_summary_does_not_change_which_message_comes_next(flight):
    times = (time_us * 1000 for time_us, _ in frames_of(flight))
    log = mavloom.read(flight)
    assert next(log).time_ns == next(times)
    messages = log.summary().senders[0].messages  # parts outlive the summary
    assert next(log).time_ns == next(times)
    assert messages[0].name == "ATTITUDE" and repr(messages[0]).startswith("MessageTotal(id=30, name='ATTITUDE'")


def test_a_selection_does_not_limit_the_summary(flight):
    assert mavloom.read(flight, type="HEARTBEAT").summary().frames == 40_087


def test_texts_are_the_warnings(tmp_path, peer):
    sender = peer.MAVLink(None, srcSystem=3, srcComponent=1)
    with mavloom.write(tmp_path / "x.tlog") as out:
        for severity, text in ((6, b"a remark"), (2, b"no heading")):
            out.write(bytes(peer.MAVLink_statustext_message(severity, text).pack(sender)), time_ns=severity * 10**15)
    [text] = mavloom.read(tmp_path / "x.tlog").summary().warnings
    assert (text.sys, text.comp, text.severity, text.text, text.count, text.last_time_ns) == (
        3, 1, 2, "no heading", 1, 2 * 10**15)


def test_what_has_no_summary(tmp_path, flight):
    path = tmp_path / "x.tlog"
    path.touch()
    empty = mavloom.read(path).summary()
    assert (empty.frames, empty.begin_ns, empty.senders) == (0, None, [])

    os.truncate(path, 1 << 20)
    with pytest.raises(mavloom.InputError, match="is not a tlog"):
        mavloom.read(path).summary()
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(mavloom.UsageError, match="only once"):
        mavloom.read(tmp_path / "pipe").summary()
