# SPDX-License-Identifier: MIT
"""Behaviours 1 to 10 of docs/guide/sim-behaviour.md: connection and link. And the page itself."""
import pathlib
import re
import statistics
import time

import pytest

import harness
import mavsdks
import qgroundcontrol
from simulators import ALTITUDE, HOLD, Simulator, item
from stations import Station, mavlink

PAGE = harness.ROOT / "docs" / "guide" / "sim-behaviour.md"


def test_the_page_and_the_tests_have_the_same_numbers():
    promised = [int(number) for number in re.findall(r"^(\d+)\. ", PAGE.read_text(), re.MULTILINE)]
    tests = "".join(path.read_text() for path in pathlib.Path(__file__).parent.glob("test_*.py"))
    tested = sorted({int(number) for number in re.findall(r"^def test_b(\d+)_", tests, re.MULTILINE)})

    assert promised == list(range(1, len(promised) + 1))
    assert tested == promised


def test_b01_the_first_frame_is_a_heartbeat_and_more_follow_each_second(program):
    delays = []
    for _ in range(5):  # the machine may be busy
        with Station.listening(beats=False) as station:
            started = time.time()
            simulator = Simulator(program, "--to", station.url, listen=())
            try:
                station.expect("HEARTBEAT", since=0)
                first = station.log[0]
                delays.append(first[0] - started)
                if delays[-1] < 0.1:
                    assert first[1].get_type() == "HEARTBEAT" and first[1].get_msgbuf()[0] == 0xFD
                    station.ready()  # that changes the status
                    mark = station.mark()
                    station.until(lambda: len(station.times("HEARTBEAT", mark)) >= 4, what="four heartbeats")
                    arrived = station.times("HEARTBEAT", mark)[:4]
                    mark = station.mark()
                    station.command(176, 1, 2, 0)
                    changed = station.expect("HEARTBEAT", since=mark)
                    break
            finally:
                simulator.end()
    else:
        raise AssertionError(f"the first frames left after {delays} s")

    assert 0.7 < (arrived[-1] - arrived[0]) / 3 < 1.4  # on a busy machine, too
    assert changed.custom_mode == ALTITUDE


def test_b02_type_and_autopilot_never_change(px4):
    for mode in (2, 4):
        assert px4.command(176, 1, mode, 3 if mode == 4 else 0) == 0
    px4.mode_is(HOLD)
    identities = {(m.type, m.autopilot, m.mavlink_version) for m in px4.since(0, "HEARTBEAT")}

    assert identities == {(mavlink.MAV_TYPE_QUADROTOR, mavlink.MAV_AUTOPILOT_PX4, 3)}


def test_b03_sequence_numbers_have_no_gaps_during_transfers(sim):
    with sim("--profile", "px4-normal", "--speed", "20").station() as station:
        assert len(station.parameters()) > 100
        assert station.upload([item(seq, 16, north=seq) for seq in range(200)]).type == 0
        assert len(station.download()) == 200
        station.until(lambda: station.mark() > 10_000, what="10,000 frames")

        assert station.lost == 0
        assert station.damaged == 0


def test_b04_each_of_two_clients_loses_nothing(shared):
    simulator = shared()
    with simulator.station() as first, simulator.station((254, 191)) as second:
        assert len(first.parameters()) == len(second.parameters())
        marks = [station.mark() for station in (first, second)]
        for station, mark in zip((first, second), marks):
            station.until(lambda: station.mark() > mark + 100, what="more telemetry")

            assert station.lost == 0


def test_b05_qgroundcontrol_connects_without_a_warning(sim):
    simulator = sim()
    with simulator.station() as station:
        station.ready()
        session = qgroundcontrol.connect(station)
        again = qgroundcontrol.connect(station, cached=session.parameter_hash)

        assert again.seconds < session.seconds
        assert session.parameters == session.parameter_count > 100
        assert again.parameters == 0  # the cache was good
        assert [m.text for m in station.since(0, "STATUSTEXT") if m.severity <= mavlink.MAV_SEVERITY_WARNING] == []


def test_b06_only_requests_for_this_system_or_for_all_are_answered(px4):
    mark = px4.mark()
    px4.send(mavlink.MAVLink_command_long_message(77, 1, 512, 0, 148, 0, 0, 0, 0, 0, 0))
    px4.send(mavlink.MAVLink_command_long_message(1, 55, 512, 0, 148, 0, 0, 0, 0, 0, 0))
    assert px4.command(512, 148, target=(0, 0)) == 0

    assert len(px4.since(mark, "AUTOPILOT_VERSION")) == 1
    assert len(px4.since(mark, "COMMAND_ACK")) == 1


def test_b07_unknown_messages_and_noise_get_no_answer(px4, rng):
    state = px4.latest("HEARTBEAT")
    mark = px4.mark()
    good = mavlink.MAVLink_command_long_message(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0).pack(px4._coder)
    damaged = bytearray(good)
    damaged[12] ^= 1
    foreign = bytearray(good)
    foreign[7:10] = (0xFF, 0xFF, 0x7F)  # an id that nobody has
    for noise in (bytes(damaged), bytes(foreign), good[:20], b"\xfd", rng.randbytes(300), b"\xfe" * 300, bytes(1500)):
        px4.write(noise)
    px4.send(mavlink.MAVLink_debug_message(0, 1, 2.0))  # known, and of no interest to a vehicle
    assert px4.command(512, 148) == 0

    assert [m.command for m in px4.since(mark, "COMMAND_ACK")] == [512]
    assert px4.expect("HEARTBEAT").base_mode == state.base_mode
    assert px4.lost == 0


def test_b08_mavsdk_finds_the_vehicle_and_notices_its_end(sim):
    simulator = sim()
    simulator.station().close()
    with mavsdks.started(simulator.port, "watch_connection") as client:
        client.answer()
        alive = time.time()
        simulator.stop()
        noticed = client.answer()["at"]

    assert noticed - alive > 1  # MAVSDK waits for 3 s


def test_b10_250_vehicles_share_one_port(sim):
    with sim("--vehicles", "250", "--profile", "lite").station() as station:
        station.until(lambda: len({m.get_srcSystem() for m in station.since(0, "HEARTBEAT")}) == 250,
                      what="250 vehicles")
        mark = station.mark()
        station.send(mavlink.MAVLink_command_long_message(0, 0, 512, 0, 148, 0, 0, 0, 0, 0, 0))
        station.until(lambda: len(station.since(mark, "AUTOPILOT_VERSION")) == 250, what="250 answers")
        versions = station.since(mark, "AUTOPILOT_VERSION")

    assert len({m.get_srcSystem() for m in versions}) == len({m.uid for m in versions}) == 250
    assert statistics.median(bytes(m.uid2).count(0) for m in versions) < 18
    assert station.lost == 0
