# SPDX-License-Identifier: MIT
"""The flight clock: as fast as possible, standing still, by steps; and flights that are recorded without any socket."""
import contextlib
import json
import math
import re
import time

import frames
import harness
import pytest
from pymavlink import mavutil

from disks import SmallDisk
from simulators import item, unique_name

FLIGHT = """
[sim]
speed = "max"
for = "60s"
start_time = "2026-11-29T12:00:00Z"
[[vehicle]]
count = 2
[[event]]
at = "40s"
do = "land"
[[event]]
at = "8s"
do = "takeoff 10"
[[event]]
at = "20s"
do = "goto 47.3980 8.5456"
system = 2
"""
BEGIN = 1795953600  # of the flight, in UTC


@pytest.fixture
def fly(run, tmp_path):
    """fly("--seed", 2) -> the path of a recording of FLIGHT."""
    scenario = tmp_path / "flight.toml"
    scenario.write_text(FLIGHT)

    def record(*options):
        path = tmp_path / f"flight{len(list(tmp_path.iterdir()))}.tlog"
        done = run("sim", scenario, "--record", path, *options)
        assert done.status == 0 and "60.0 s of flight" in done.stderr, done
        return path
    return record


def test_the_same_seed_gives_the_same_bytes(fly):
    first = fly().read_bytes()
    assert fly().read_bytes() == first
    assert fly("--seed", 2).read_bytes() != first


def test_a_recording_alone_is_the_same_at_each_speed(fly):
    assert fly().read_bytes() == fly("--speed", 60).read_bytes()


def test_orders_of_the_time_line_are_flown_at_their_times(fly):
    path = fly()
    heights, north = {1: {}, 2: {}}, {1: 0, 2: 0}
    log = mavutil.mavlink_connection(str(path))
    while message := log.recv_match(type=["GLOBAL_POSITION_INT", "SYSTEM_TIME"]):
        at = message._timestamp - BEGIN
        if message.get_type() == "SYSTEM_TIME":
            assert abs(message.time_unix_usec / 1e6 - message._timestamp) < 0.1
            continue
        assert abs(message.time_boot_ms / 1000 - at) < 0.1
        heights[message.get_srcSystem()][int(at)] = message.relative_alt / 1000
        north[message.get_srcSystem()] = max(north[message.get_srcSystem()], message.lat / 1e7 - 47.397742)
    for its in heights.values():
        assert abs(its[7]) < 0.5 and its[19] == pytest.approx(10, abs=0.5) and its[59] < 5
    assert north[2] - north[1] > 1.5e-4 > north[1]  # 17 m


def test_a_recording_has_each_frame_and_the_times_of_the_flight(fly):
    records = frames.read_tlog(fly())
    times = [time_us / 1e6 - BEGIN for time_us, _ in records]
    assert times == sorted(times) and 0 <= times[0] and 59 < times[-1] <= 60
    for system in (1, 2):
        numbers = [frame[4] for _, frame in records if frame[5] == system]
        assert len(numbers) > 5000 and all((b - a) % 256 == 1 for a, b in zip(numbers, numbers[1:]))


def test_a_paused_flight_moves_by_exact_steps(sim):
    simulator = sim()
    with simulator.station() as station:
        station.ready()
        clock = json.loads(simulator.ctl("pause").splitlines()[0])
        assert clock["kind"] == "clock" and clock["paused"]
        station.parameter("MIS_TAKEOFF_ALT")  # the answer comes after all that was on its way
        mark = station.mark()
        time.sleep(0.5)  # time under test
        assert not station.since(mark, "ATTITUDE"), "it stands still"

        later = json.loads(simulator.ctl("step", "2s").splitlines()[0])
        assert later["flight_s"] - clock["flight_s"] == pytest.approx(2, abs=1e-9)
        station.until(lambda: len(station.since(mark, "ATTITUDE")) >= 20, what="the telemetry of two seconds")
        station.parameter("MIS_TAKEOFF_ALT")
        times = [message.time_boot_ms for message in station.since(mark, "ATTITUDE")]
        assert len(times) == 20 and times[-1] - times[0] == 1900, "10 Hz"

        simulator.ctl("resume")
        station.until(lambda: len(station.since(mark, "ATTITUDE")) > 25, what="telemetry")


@pytest.mark.parametrize("arguments, status, text", [
    (["--speed", "max"], 2, "speed max needs the length of the flight"),
    (["--speed", "max", "--for", "1s", "--to", "serial:///dev/null"], 2, "too slow for --speed max"),
    (["--record", "flight.bin"], 2, "ends in .tlog"),
    (["--start-time", "yesterday"], 2, "such as 2026-11-29T12:00:00Z"),
])
def test_wrong_use(run, arguments, status, text):
    done = run("sim", *arguments)
    assert done.status == status and text in done.stderr, done


@pytest.mark.parametrize("order, text", [
    ('at = "5s"', "an event needs the key do"),
    ('at = "5s"\ndo = "takeof 5"', "did you mean 'takeoff'?"),
    ('at = "5s"\ndo = "takeoff"', "write takeoff ALTITUDE"),
    ('at = "5s"\ndo = "goto 47 north"', "longitude: 'north' is not a number"),
    ('at = "5s"\ndo = "land"\nsystem = 9', "there is no vehicle 9"),
    ('at = "5m"\ndo = "land"\n[sim]\nspeed = "max"\nfor = "1m"', "the flight ends before this event"),
])
def test_wrong_orders(run, tmp_path, order, text):
    (tmp_path / "x.toml").write_text(f"[[vehicle]]\n[[event]]\n{order}\n")
    done = run("check", tmp_path / "x.toml")
    assert done.status == 3 and f"{tmp_path / 'x.toml'}:" in done.stderr and text in done.stderr, done


def test_a_refused_order_is_reported(run, tmp_path):
    (tmp_path / "x.toml").write_text('[[event]]\nat = "1s"\ndo = "takeoff 5"\n')
    done = run("sim", tmp_path / "x.toml", "--speed", "max", "--for", "2s", "--record", tmp_path / "x.tlog")
    assert done.status == 1 and "order 'takeoff 5' at 1 s: Navigation error" in done.stderr, done


def test_a_clock_that_runs_takes_no_step(sim, run):
    simulator = sim()
    done = run("ctl", simulator.name, "step", "10ms")
    assert done.status == 1 and "pause it first" in done.stderr, done


def test_a_full_disk_ends_the_flight(run, tmp_path):
    with contextlib.closing(SmallDisk(tmp_path)):
        done = run("sim", "--speed", "max", "--for", "1h", "--record", tmp_path / "x.tlog")
    assert done.status == 1 and "No space left" in done.stderr, done


ALL_KINDS = """
[sim]
speed = "max"
for = "60s"
start_time = "2026-11-29T12:00:00Z"
[[vehicle]]
[[vehicle]]
kind = "plane"
[[vehicle]]
kind = "rover"
""" + "".join(f'[[event]]\nat = "{at}s"\nsystem = {system}\ndo = "{order}"\n' for at, system, order in [
    (8, 1, "takeoff 10"), (8, 2, "takeoff 30"), (10, 3, "arm"), (11, 3, "goto 47.3980 8.5456"),
    (20, 1, "goto 47.3980 8.5456"), (40, 1, "land"), (40, 2, "goto 47.3990 8.5456")])
WITHOUT_FMA = "glibc.cpu.hwcaps=-AVX2,-FMA"  # the C library then has other sines; on Arm it changes nothing


def test_the_same_bytes_without_fma(run, tmp_path):
    (tmp_path / "x.toml").write_text(ALL_KINDS)
    recordings = []
    for tunables in ("", WITHOUT_FMA):
        recordings.append(tmp_path / f"{len(recordings)}.tlog")
        done = run("sim", tmp_path / "x.toml", "--record", recordings[-1], env={"GLIBC_TUNABLES": tunables})
        assert done.status == 0, done
    assert recordings[0].read_bytes() == recordings[1].read_bytes()


@pytest.mark.short
def test_sanitized_and_released_programs_fly_the_same_bytes(run, tmp_path, program):
    """Compilers and their options do not change a flight. `./run test` builds one program, `./run sanitize` the other.
    """
    (tmp_path / "x.toml").write_text(ALL_KINDS)
    other = harness.ROOT / "build/release/bin/mavloom"
    if not other.exists() or other.samefile(program) or version(other) != version(program):
        pytest.skip("needs the released and the sanitized program of one version, which only .ci/run --full builds")
    recordings = []
    for which, tunables in ((program, ""), (other, ""), (other, WITHOUT_FMA)):
        recordings.append(tmp_path / f"{len(recordings)}.tlog")
        done = harness.Running([which, "sim", tmp_path / "x.toml", "--record", recordings[-1]],
                               env=harness.environment({"GLIBC_TUNABLES": tunables})).wait()
        assert done.status == 0, done
    assert len({recording.read_bytes() for recording in recordings}) == 1


def version(program):
    return harness.Running([program, "--version"]).wait().stdout


# ---- sessions that are repeated

def session(sim, tmp_path, speed="1"):
    """A client flies; returns the arguments that repeat its session, and the recording."""
    simulator = sim("--record-input", tmp_path / "in.tlog", "--record", tmp_path / "out.tlog", "--speed", speed)
    with simulator.station() as px4:
        px4.ready()
        home = px4.expect("HOME_POSITION", since=0).altitude / 1000
        assert px4.command(22, -1, 0, 0, math.nan, math.nan, math.nan, home + 5) == 0
        assert px4.command(400, 1) == 0
        px4.set_interval(30, 20_000)
        px4.set_parameter("MPC_XY_CRUISE", 3.0)
        assert px4.upload([item(0, 22, height=5), item(1, 16, 20, height=5)]).type == 0
        px4.expect("GLOBAL_POSITION_INT", where=lambda m: m.relative_alt > 2000)
    report = simulator.stop().stderr
    start = re.search(r"in\.tlog: play it with --replay-input and --start-time (\S+)", report)[1]
    return ["--replay-input", tmp_path / "in.tlog", "--start-time", start], tmp_path / "out.tlog"


@pytest.mark.parametrize("speed", ["1", "3"])
def test_a_session_is_played_again(sim, run, tmp_path, speed):
    arguments, recorded = session(sim, tmp_path, speed)
    done = run("sim", *arguments, "--speed", "max", "--for", "5m", "--record", tmp_path / "again.tlog")
    assert done.status == 0, done
    whole = recorded.read_bytes()
    assert whole == (tmp_path / "again.tlog").read_bytes()[:len(whole)] and len(whole) > 20_000
    log = mavutil.mavlink_connection(str(recorded))
    heights = []
    while message := log.recv_match(type="GLOBAL_POSITION_INT"):
        heights.append(message.relative_alt)
    assert max(heights) > 2000, "it did fly"


def test_what_is_played_is_kept_again(fly, run, tmp_path):
    played, kept = fly(), tmp_path / "kept.tlog"
    done = run("sim", "--replay-input", played, "--start-time", "2026-11-29T12:00:00Z", "--record-input", kept,
               "--record", tmp_path / "x.tlog", "--for", "2m", "--speed", "max", "--ring", unique_name())
    assert done.status == 0, done
    assert kept.read_bytes() == played.read_bytes()


def test_without_its_input_the_session_is_another_one(sim, run, tmp_path):
    arguments, recorded = session(sim, tmp_path)
    done = run("sim", *arguments[2:], "--speed", "max", "--for", "5m", "--record", tmp_path / "other.tlog")
    whole = recorded.read_bytes()
    assert done.status == 0 and whole != (tmp_path / "other.tlog").read_bytes()[:len(whole)]


@pytest.mark.parametrize("arguments, status, text", [
    (["--replay-input", "in.tlog", "--for", "1s"], 2, "needs the start_time"),
    (["--replay-input", "no.tlog", "--for", "1s", "--start-time", "2026-11-29T12:00:00Z"], 3, "no.tlog"),
    (["--record-input", "in.bin"], 2, "ends in .tlog"),
    (["--record", "a.tlog", "--record-input", "./a.tlog"], 2, "record and record_input are the same file: a.tlog"),
    (["--replay-input", "a.tlog", "--record", "a.tlog", "--start-time", "2026-01-01T00:00:00Z"], 2,
     "record and replay_input are the same file: a.tlog"),
])
def test_wrong_use_of_sessions(run, tmp_path, arguments, status, text):
    done = run("sim", *arguments, cwd=tmp_path)
    assert done.status == status and text in done.stderr, done


def test_a_session_without_frames_is_refused(run, tmp_path):
    (tmp_path / "in.tlog").write_bytes(b"")
    done = run("sim", "--replay-input", tmp_path / "in.tlog", "--for", "1s", "--start-time", "2026-11-29T12:00:00Z")
    assert done.status == 3 and "in.tlog has no frames" in done.stderr, done


def test_a_session_that_was_cut_is_reported(fly, run, tmp_path):
    (tmp_path / "in.tlog").write_bytes(fly().read_bytes()[:1000])
    done = run("sim", "--replay-input", tmp_path / "in.tlog", "--for", "1s", "--start-time", "2026-11-29T12:00:00Z",
               "--record", tmp_path / "x.tlog", "--speed", "max")
    assert done.status == 0 and "is damaged or cut off" in done.stderr, done


def test_what_is_no_recording_is_not_played(run, tmp_path):
    (tmp_path / "in.tlog").write_bytes(b"x" * 5000)
    done = run("sim", "--replay-input", tmp_path / "in.tlog", "--for", "1s", "--start-time", "2026-11-29T12:00:00Z",
               "--record", tmp_path / "x.tlog")
    assert done.status in (1, 3) and "in.tlog" in done.stderr, done
