# SPDX-License-Identifier: MIT
"""mavloom info: the summary of a recording. Expected values come from pymavlink."""
import collections
import datetime
import importlib.util
import json
import math
import os
import pathlib
import pty
import re
import struct
import subprocess
import xml.etree.ElementTree

import lxml.etree
import pytest

import frames
import harness
from frames import mavlink
from pymavlink import mavutil

pytestmark = pytest.mark.short

SESSION = harness.DATA / "px4_gcs_session.tlog"
# pymavlink's names of PX4's modes, and those that Mavloom and QGroundControl print.
MODES = {"LOITER": "Hold", "TAKEOFF": "Takeoff", "RTL": "Return", "MISSION": "Mission"}


def messages(path, source=None):
    """(Unix microseconds, message) of what pymavlink's dialect `common` knows."""
    parser = mavlink.MAVLink(None)
    for time_us, frame in frames.read_tlog(path):
        if source in (None, (frame[5], frame[6])) and int.from_bytes(frame[7:10], "little") in mavlink.mavlink_map:
            yield time_us, parser.decode(bytearray(frame))


def of_type(path, name, source=(1, 1)):
    return [(time_us, message) for time_us, message in messages(path, source) if message.get_type() == name]


def summary(run, *args):
    done = run("info", *args, "--json")
    assert done.status == 0, done
    return json.loads(done.stdout)


def changes(values):
    """(time, value) where a value differs from the one before."""
    found = []
    for time_us, value in values:
        if not found or found[-1][1] != value:
            found.append((time_us, value))
    return found


@pytest.fixture(scope="module")
def flight():
    return frames.read_tlog(frames.FLIGHT)


def test_time_and_counts_are_those_of_the_file(run, flight):
    ours = summary(run, frames.FLIGHT)

    assert (ours["begin_us"], ours["end_us"], ours["frames"]) == (flight[0][0], flight[-1][0], len(flight))
    assert ours["duration_s"] == pytest.approx((flight[-1][0] - flight[0][0]) / 1e6)
    counted = collections.Counter((f[5], f[6], int.from_bytes(f[7:10], "little")) for _, f in flight)
    assert {(s["sys"], s["comp"], m["id"]): m["count"] for s in ours["senders"] for m in s["messages"]} == counted
    attitude = next(m for m in ours["senders"][0]["messages"] if m["name"] == "ATTITUDE")
    assert attitude["rate_hz"] == pytest.approx(5312 / ours["duration_s"])
    assert (ours["junk_bytes"], ours["clock_jumps"], ours["unlisted_frames"]) == (0, [], 0)


@pytest.mark.parametrize("path", [frames.FLIGHT, SESSION], ids=lambda path: path.stem)
def test_modes_and_armed_times_are_those_of_pymavlink(run, path):
    beats = of_type(path, "HEARTBEAT")
    [vehicle] = summary(run, path)["vehicles"]

    assert (vehicle["autopilot"], vehicle["type"]) == ("MAV_AUTOPILOT_PX4", "MAV_TYPE_QUADROTOR")
    modes = changes((time_us, MODES[mavutil.mode_string_v10(beat)]) for time_us, beat in beats)
    assert [(mode["time_us"], mode["mode"]) for mode in vehicle["modes"]] == modes
    ends = [time_us for time_us, _ in modes[1:]] + [beats[-1][0]]
    assert [mode["duration_s"] for mode in vehicle["modes"]] == \
        pytest.approx([(end - begin) / 1e6 for end, (begin, _) in zip(ends, modes)])

    armed = changes((time_us, beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED != 0) for time_us, beat in beats)
    begins = [(time_us, (armed + [(beats[-1][0], False)])[i + 1][0]) for i, (time_us, on) in enumerate(armed) if on]
    assert [(one["time_us"], pytest.approx(one["duration_s"])) for one in vehicle["armed"]] == \
        [(begin, (end - begin) / 1e6) for begin, end in begins]


def test_heights_speed_way_and_battery_are_those_of_pymavlink(run):
    positions = of_type(frames.FLIGHT, "GLOBAL_POSITION_INT")
    [vehicle] = summary(run, frames.FLIGHT)["vehicles"]

    only = [message for _, message in positions]
    assert vehicle["highest_alt_m"] == max(p.alt for p in only) / 1e3
    assert vehicle["highest_relative_alt_m"] == max(p.relative_alt for p in only) / 1e3
    assert vehicle["highest_speed_m_s"] == pytest.approx(max(math.hypot(p.vx, p.vy) for p in only) / 1e2)
    for key, (time_us, at) in (("first_position", positions[0]), ("last_position", positions[-1])):
        assert (vehicle[key]["time_us"], vehicle[key]["lat_deg"], vehicle[key]["lon_deg"], vehicle[key]["alt_m"]) == \
            (time_us, at.lat / 1e7, at.lon / 1e7, at.alt / 1e3)
    # tests/data/README.md: 30 m north and 20 m east, and back.
    assert vehicle["distance_m"] == pytest.approx(2 * math.hypot(30, 20), rel=0.02)
    percents = [status.battery_remaining for _, status in of_type(frames.FLIGHT, "BATTERY_STATUS")]
    assert vehicle["battery"]["lowest_percent"] == min(percents) < 100
    assert vehicle["battery"]["last_percent"] == percents[-1]


def test_firmware_and_changed_parameters(run):
    ours = summary(run, SESSION)
    [(_, version)] = of_type(SESSION, "AUTOPILOT_VERSION")
    parts = struct.pack(">I", version.flight_sw_version)
    assert ours["vehicles"][0]["firmware"]["version"] == f"{parts[0]}.{parts[1]}.{parts[2]} alpha"
    assert parts[3] == mavlink.FIRMWARE_VERSION_TYPE_ALPHA

    before, changed = {}, []
    for time_us, value in of_type(SESSION, "PARAM_VALUE"):
        bits = struct.pack("<f", value.param_value)  # integers are bytes of it, so NaN too
        if before.setdefault(value.param_id, bits) != bits:
            changed.append((time_us, value.param_id, *struct.unpack("<f", before[value.param_id]), value.param_value))
        before[value.param_id] = bits
    assert [(p["time_us"], p["name"], p["before"], p["after"]) for p in ours["parameters"]] == changed
    assert len(changed) == 1


def test_losses_are_the_frames_that_are_missing(run, flight, tmp_path):
    vehicles = [record for record in flight if record[1][5] == 1]
    left_out = {id(record) for record in vehicles[50:-50:97]}
    path = frames.write_tlog(tmp_path / "gaps.tlog", [record for record in flight if id(record) not in left_out])

    vehicle, station = summary(run, path)["senders"]
    assert (vehicle["lost"], station["lost"]) == (len(left_out), 0)
    assert vehicle["loss_percent"] == pytest.approx(100 * len(left_out) / len(vehicles))


def test_texts_of_warning_and_above_are_joined_and_counted(run, tmp_path):
    mav = frames.sender()
    long = b"a text that is longer than fifty characters, so that it needs two messages"
    texts = [mavlink.MAVLink_statustext_message(severity, text, number, chunk) for severity, text, number, chunk in
             ((4, b"low", 0, 0), (6, b"only a remark", 0, 0), (2, long[:50], 7, 0), (2, long[50:], 7, 1),
              (4, b"low", 0, 0))]
    records = []
    for i, text in enumerate(texts):
        records.append((1_700_000_000_000_000 + i * 1_000_000, bytes(text.pack(mav))))
        mav.seq += 1
    ours = summary(run, frames.write_tlog(tmp_path / "x.tlog", records))

    assert [(t["at_s"], t["severity"], t["text"], t["count"], t["last_time_us"]) for t in ours["warnings"]] == [
        (0, "MAV_SEVERITY_WARNING", "low", 2, records[4][0]),
        (2, "MAV_SEVERITY_CRITICAL", long.decode(), 1, records[2][0])]


@pytest.mark.parametrize("step_s", [-100, 40 * 365 * 86400])
def test_a_clock_that_jumps_adds_no_time(run, flight, tmp_path, step_s):
    """The clock of a computer that finds the network in flight."""
    half = len(flight) // 2
    later = [(time_us + step_s * 1_000_000, frame) for time_us, frame in flight[half:]]
    path = frames.write_tlog(tmp_path / "x.tlog", flight[:half] + later)
    moved = [(t + step_s * 1_000_000, f) for t, f in flight[half:]]
    path = frames.write_tlog(tmp_path / "x.tlog", flight[:half] + moved)
    ours = summary(run, path)

    gap_s = (flight[half][0] - flight[half - 1][0]) / 1e6
    assert [jump["step_s"] for jump in ours["clock_jumps"]] == pytest.approx([step_s + gap_s])
    assert ours["duration_s"] == pytest.approx((flight[-1][0] - flight[0][0]) / 1e6 - gap_s)
    assert "the time goes " + ("back" if step_s < 0 else "forward") in run("info", path).stdout


def test_a_recording_cut_in_the_middle_is_summarized(run, flight, tmp_path):
    whole = frames.FLIGHT.read_bytes()[:1_000_000]
    path = tmp_path / "cut.tlog"
    path.write_bytes(whole)
    ours, at, count = summary(run, path), 0, 0
    while at + 8 + frames.frame_length(whole, at + 8) <= len(whole):
        at += 8 + frames.frame_length(whole, at + 8)
        count += 1

    assert (ours["frames"], ours["junk_bytes"], ours["damaged_places"]) == (count, len(whole) - at, 1)
    assert f"{len(whole) - at} bytes lost in 1 damaged place" in run("info", path).stdout


def test_what_is_no_recording_gets_one_line_and_status_3(run, tmp_path):
    (tmp_path / "zeros").touch()
    os.truncate(tmp_path / "zeros", 64 << 20)
    (tmp_path / "text").write_text("hello\n")
    for name, what in (("zeros", "is not a tlog"), ("text", "is text"), ("missing", "No such file"),
                       (".", "directory")):
        done = run("info", tmp_path / name)
        assert (done.status, done.stdout, done.stderr.count("\n")) == (3, "", 1), done
        assert what in done.stderr and str(tmp_path) in done.stderr


def test_an_empty_recording_is_reported(run, tmp_path):
    (tmp_path / "x.tlog").touch()
    done = run("info", tmp_path / "x.tlog", "--json")

    assert done.status == 0 and "x.tlog holds no frames" in done.stderr
    assert (json.loads(done.stdout)["frames"], json.loads(done.stdout)["begin_us"]) == (0, None)
    assert run("info", tmp_path / "x.tlog", "-q").stderr == ""


def test_a_bad_file_among_others_does_not_hide_them(run, tmp_path):
    done = run("info", tmp_path / "missing", frames.FLIGHT, SESSION, "--json")

    assert done.status == 3 and "missing" in done.stderr
    assert [json.loads(line)["file"] for line in done.lines] == [str(frames.FLIGHT), str(SESSION)]


def test_tracks_are_the_positions_of_the_vehicle(run, tmp_path):
    gpx, kml = tmp_path / "x.gpx", tmp_path / "x.kml"
    done = run("info", frames.FLIGHT, "--gpx", gpx, "--kml", kml)
    assert done.status == 0, done

    positions = {f"{at.lat / 1e7:.7f} {at.lon / 1e7:.7f} {at.alt / 1e3:.3f}"
                 for _, at in of_type(frames.FLIGHT, "GLOBAL_POSITION_INT")}
    space = "{http://www.topografix.com/GPX/1/1}"
    root = xml.etree.ElementTree.parse(gpx).getroot()
    assert (root.tag, root.get("version")) == (space + "gpx", "1.1")
    [segment] = root.findall(f"{space}trk/{space}trkseg")
    points = [f"{p.get('lat')} {p.get('lon')} {p.findtext(space + 'ele')}" for p in segment]
    times = [p.findtext(space + "time") for p in segment]
    assert set(points) <= positions and len(points) == pytest.approx(108 * 5, rel=0.1)  # five a second
    assert times == sorted(times) and re.fullmatch(r"2026-11-21T00:44:30\.\d{3}Z", times[0])

    space = "{http://www.opengis.net/kml/2.2}"
    [line] = xml.etree.ElementTree.parse(kml).getroot().iter(space + "coordinates")
    assert [" ".join((p[1], p[0], p[2])) for p in (c.split(",") for c in line.text.split())] == points


def test_tracks_follow_the_schemas(run, tmp_path):
    """KML: the OGC's schema. GPX, of which no package has the schema: the order and the ranges that it demands."""
    gpx, kml = tmp_path / "x.gpx", tmp_path / "x.kml"
    assert run("info", frames.FLIGHT, SESSION, "--gpx", gpx, "--kml", kml).status == 0
    package = importlib.util.find_spec("fastkml")
    assert package, "fastkml is missing: ./run test installs it"
    schema = lxml.etree.XMLSchema(lxml.etree.parse(pathlib.Path(package.origin).with_name("schema") / "ogckml22.xsd"))
    schema.assertValid(lxml.etree.parse(kml))

    space = "{http://www.topografix.com/GPX/1/1}"
    root = xml.etree.ElementTree.parse(gpx).getroot()
    assert root.tag == space + "gpx" and set(root.attrib) == {"version", "creator"} and root.get("version") == "1.1"
    assert len(root) == 2 and {track.tag for track in root} == {space + "trk"}
    for track in root:
        assert [child.tag for child in track][0] == space + "name"
        assert {child.tag for child in list(track)[1:]} == {space + "trkseg"}
        for point in track.iter(space + "trkpt"):
            assert set(point.attrib) == {"lat", "lon"}
            assert [child.tag for child in point] == [space + "ele", space + "time"]
            assert -90 <= float(point.get("lat")) <= 90 and -180 <= float(point.get("lon")) < 180
            datetime.datetime.fromisoformat(point.findtext(space + "time").replace("Z", "+00:00"))


def with_later_times(path, copies, folder):
    """The recording again and again, each time as if it was made after the one before."""
    whole, records = path.read_bytes(), frames.read_tlog(path)
    places, at = [], 0
    for _, frame in records:
        places.append(at)
        at += 8 + len(frame)
    span = records[-1][0] - records[0][0] + 20_000
    big = folder / "big.tlog"
    with big.open("wb") as out:
        for copy in range(copies):
            bytes_of = bytearray(whole)
            for place, (time_us, _) in zip(places, records):
                struct.pack_into(">Q", bytes_of, place, time_us + copy * span)
            out.write(bytes_of)
    return big


@pytest.mark.long
@pytest.mark.unsanitized
def test_two_gigabytes_take_three_seconds_and_little_memory(program, tmp_path):
    """Processor time of one thread: on a machine with nothing else to do, it is the time on the clock."""
    big = with_later_times(frames.FLIGHT, 928, tmp_path)
    assert big.stat().st_size > 2_000_000_000
    process = subprocess.Popen([program, "info", big, "--json"], stdout=subprocess.PIPE)
    told = json.loads(process.stdout.read())
    _, status, used = os.wait4(process.pid, 0)
    big.unlink()
    assert (status, told["frames"], told["junk_bytes"]) == (0, 928 * 40087, 0)
    assert used.ru_utime + used.ru_stime < 3 and used.ru_maxrss < 100_000, used


@pytest.mark.long
@pytest.mark.unsanitized
def test_two_gigabytes_of_zeros_are_refused_in_reasonable_time(run, tmp_path):
    zeros = tmp_path / "zeros.tlog"
    with zeros.open("wb") as file:
        file.truncate(2 << 30)
    done = run("info", zeros, timeout=60)
    assert done.status == 3 and "none of its 2147483648 bytes begins a MAVLink record" in done.stderr, done


def test_a_track_file_replaces_nothing(run, tmp_path):
    log = tmp_path / "x.tlog"
    log.write_bytes(frames.FLIGHT.read_bytes())
    done = run("info", log, "--gpx", log)

    assert done.status == 2 and "already exists" in done.stderr
    assert log.read_bytes() == frames.FLIGHT.read_bytes()


def test_a_recording_without_positions_has_no_track(run, tmp_path):
    path = frames.write_tlog(tmp_path / "x.tlog", [(1_700_000_000_000_000, next(frames.heartbeats(1)))])
    done = run("info", path, "--gpx", tmp_path / "x.gpx")

    assert done.status == 3 and "no track" in done.stderr
    assert not (tmp_path / "x.gpx").exists()


def test_a_pipe_is_read_to_its_end_and_a_terminal_sees_the_progress(program, tmp_path):
    path = tmp_path / "pipe"
    os.mkfifo(path)
    ours, theirs = pty.openpty()
    process = subprocess.Popen([program, "info", path, "--json"], stdout=subprocess.PIPE, stderr=theirs,
                               env=harness.environment())
    os.close(theirs)
    seen = b""
    with path.open("wb") as pipe:
        pipe.write(frames.FLIGHT.read_bytes())
        pipe.flush()
        while b" MB" not in seen and b" kB" not in seen:
            seen += os.read(ours, 1000)
    printed, _ = process.communicate(timeout=harness.DEFAULT_TIMEOUT_S)
    with pytest.raises(OSError):  # the end of a terminal
        while True:
            seen += os.read(ours, 1000)
    os.close(ours)

    assert json.loads(printed)["frames"] == 40087
    assert re.fullmatch(rb"\r[\d.]+ [kM]B.*\r *\r", seen, re.DOTALL)


def test_ctrl_c_ends_the_wait_for_a_pipe(spawn, tmp_path):
    path = tmp_path / "pipe"
    os.mkfifo(path)
    process = spawn("info", path)
    with path.open("wb"):
        done = process.stop()
    assert (done.status, done.stdout, done.stderr) == (130, "", "")


def test_the_text_is_aligned_and_has_the_sections(run):
    lines = run("info", SESSION).lines

    assert lines[0] == str(SESSION)
    for line in ("  kind      PX4 QUADROTOR", "  duration  14.0 s", "  armed     0:00:12.9  for 1.0 s",
                 "  0:00:06.7  1/1      MIS_TAKEOFF_ALT   2.5 -> 10"):
        assert line in lines
    table = lines[next(i for i, line in enumerate(lines) if line.startswith("sender    message")):]
    assert len({len(line) for line in table}) == 1
