# SPDX-License-Identifier: MIT
"""examples/pipeline: Python hears MAVLink and fills a ring, the relay reads the ring and sends to a ground station,
whose answers go back the same way. The frames are a recorded flight's, and those of a recorded session with a ground
station."""
import contextlib
import os
import pathlib
import signal
import socket
import subprocess
import sys
import uuid

import pytest

import frames
import harness
from recorded_px4 import PARAMETERS, SESSION, VEHICLE, RecordedPx4, Station
from places import PROGRAM, ROOT

SCRIPT = ROOT / "examples" / "pipeline" / "run.sh"


def udp():
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8 << 20)
    sock.bind(("127.0.0.1", 0))
    sock.settimeout(harness.DEFAULT_TIMEOUT_S)
    return sock


@pytest.fixture
def ground():
    with udp() as sock:
        yield sock


@pytest.fixture
def port():
    with udp() as sock:
        return sock.getsockname()[1]


@pytest.fixture
def ring():
    name = f"pipeline-{os.getpid()}-{uuid.uuid4().hex[:8]}"
    yield name
    left = sorted(path.name for path in pathlib.Path("/dev/shm").glob(f"mavloom.{name}*"))
    for path in left:
        pathlib.Path("/dev/shm", path).unlink(missing_ok=True)
    assert left == []


@pytest.fixture
def start(child_environment):
    processes = []

    def call(*words, **environment):
        processes.append(harness.Running(words, env={**child_environment, **environment}, start_new_session=True))
        return processes[-1]
    yield call
    for process in processes:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.process.pid, signal.SIGKILL)
    harness.end(processes)


class Pipeline:
    def __init__(self, start, ring, port, ground):
        self.start, self.ring, self.to, self.ground = start, ring, ("127.0.0.1", port), ground
        self.vehicle, self.beats = udp(), frames.heartbeats(1 << 20)

    def hear(self):
        process = self.start(sys.executable, "-m", "mavloom.hear", f"udpin://127.0.0.1:{self.to[1]}", "--ring",
                             self.ring)
        process.wait_output("writing to ring", stream="err")
        return process

    def relay(self):
        return self.start(PROGRAM, "relay", f"shm://{self.ring}", "--to",
                          f"udpout://127.0.0.1:{self.ground.getsockname()[1]}")

    def passes(self):
        """Heartbeats until one arrives: what is sent before both are up is heard by nobody."""
        self.ground.settimeout(0.2)

        def one():
            beat = next(self.beats)
            self.vehicle.sendto(beat, self.to)
            with contextlib.suppress(TimeoutError):
                return beat in self.ground.recv(65536)
        harness.wait_for(one, what="a frame to come through")


@pytest.fixture
def pipeline(start, ring, port, ground):
    made = Pipeline(start, ring, port, ground)
    yield made
    made.vehicle.close()


@pytest.mark.parametrize("first", ["hear", "relay"])
@pytest.mark.parametrize("number, status", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_it_begins_and_ends_in_any_order_and_leaves_nothing(pipeline, first, number, status):
    order = ["hear", "relay"] if first == "hear" else ["relay", "hear"]
    running = {name: getattr(pipeline, name)() for name in order}
    pipeline.passes()
    ends = [running[name].stop(number) for name in order]

    assert [done.status for done in ends] == [status, status], ends


@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGKILL])
def test_the_relay_waits_while_the_writer_is_gone_and_continues_when_it_is_back(pipeline, how):
    first, relay = pipeline.hear(), pipeline.relay()
    pipeline.passes()
    first.send(how)
    first.process.wait()
    again = pipeline.start(sys.executable, "-m", "mavloom.hear", f"udpin://127.0.0.1:{pipeline.to[1]}", "--ring",
                           pipeline.ring)
    again.wait_output("writing to ring", stream="err")
    pipeline.passes()

    assert relay.alive
    assert again.stop().status == 130 and relay.stop().status == 130


def test_a_killed_relay_delays_nobody(pipeline):
    hear, relay = pipeline.hear(), pipeline.relay()
    pipeline.passes()
    relay.send(signal.SIGKILL)
    relay.process.wait()
    relay = pipeline.relay()
    pipeline.passes()

    assert hear.stop().status == 130 and relay.stop().status == 130


# ---- the way back

@pytest.mark.parametrize("how", ["by hand", "by the script"])
def test_a_ground_station_completes_everything(start, ring, port, how):
    """Every parameter, a mission upload and an arming, by pymavlink at one end with the recorded PX4 at the other.
    Nothing is asked for twice."""
    station = Station("udpin:127.0.0.1:0")
    listen, to = f"udpin://127.0.0.1:{port}", f"udpout://127.0.0.1:{station.connection.port.getsockname()[1]}"
    if how == "by hand":
        running = [start(PROGRAM, "relay", f"shm://{ring}", "--to", to),
                   start(sys.executable, "-m", "mavloom.hear", listen, "--ring", ring)]
    else:
        running = [start(SCRIPT, MAVLOOM_PROGRAM=str(PROGRAM), PYTHON=sys.executable, LISTEN=listen, RING=ring, TO=to)]
    running[-1].wait_output("writing to ring", stream="err")
    with RecordedPx4(port) as vehicle:
        station.wait_vehicle()
        parameters = station.fetch_parameters()
        mission, result = station.upload_mission(), station.arm()
    station.close()
    ends = [process.stop() for process in running]

    assert sorted(parameters) == [*range(PARAMETERS), 65535]
    assert mission == (0, 6) and result == 0 and vehicle.unanswered == []
    assert [done.status for done in ends] == [130] * len(running)
    assert "without a peer" not in ends[-1].stderr and "lost before" not in ends[-1].stderr, ends[-1]


def test_a_recorded_session_passes_both_ways_byte_for_byte(pipeline):
    hear, relay = pipeline.hear(), pipeline.relay()
    pipeline.passes()
    pipeline.ground.settimeout(harness.DEFAULT_TIMEOUT_S)
    pipeline.vehicle.settimeout(harness.DEFAULT_TIMEOUT_S)
    pipeline.vehicle.sendto(last := next(pipeline.beats), pipeline.to)
    got = b""
    while not got.endswith(last):
        got, relay_address = pipeline.ground.recvfrom(65536)
    records = [frame for _, frame in frames.read_tlog(SESSION)]
    at_ground, at_vehicle = b"", b""
    for begin in range(0, len(records), 64):
        some = records[begin:begin + 64]
        for frame in some:
            if frame[5] == VEHICLE:
                pipeline.vehicle.sendto(frame, pipeline.to)
            else:
                pipeline.ground.sendto(frame, relay_address)
        want = b"".join(records[:begin + 64])
        there = sum(len(frame) for frame in records[:begin + 64] if frame[5] == VEHICLE)
        while len(at_ground) < there:
            at_ground += pipeline.ground.recv(65536)
        while len(at_vehicle) < len(want) - there:
            at_vehicle += pipeline.vehicle.recv(65536)

    assert at_ground == b"".join(frame for frame in records if frame[5] == VEHICLE)
    assert at_vehicle == b"".join(frame for frame in records if frame[5] != VEHICLE)
    assert hear.stop().status == 130 and relay.stop().status == 130


def test_what_readers_send_goes_to_every_peer(pipeline):
    hear, relay = pipeline.hear(), pipeline.relay()
    pipeline.passes()
    with udp() as second:
        second.sendto(next(frames.heartbeats(1, system=2)), pipeline.to)
        got = b""
        while frames.split_frames(got)[-1:] != [next(frames.heartbeats(1, system=2))]:
            got, relay_address = pipeline.ground.recvfrom(65536)
        answer = next(frames.heartbeats(1, system=255, component=190))
        pipeline.ground.sendto(answer, relay_address)
        pipeline.vehicle.settimeout(harness.DEFAULT_TIMEOUT_S)
        assert (pipeline.vehicle.recv(65536), second.recv(65536)) == (answer, answer)
    assert "1 sent by readers of the ring" in hear.stop().stderr
    relay.stop()


def test_an_answer_for_nobody_is_counted_and_reported_once(start, ring, port, child_environment):
    hear = start(sys.executable, "-m", "mavloom.hear", f"udpin://127.0.0.1:{port}", "--ring", ring)
    hear.wait_output("writing to ring", stream="err")
    answers = pathlib.Path(os.environ.get("TMPDIR", "/tmp"), f"{ring}-answers.tlog")
    frames.write_tlog(answers, list(enumerate(frames.heartbeats(3, system=255, component=190))))
    try:
        for _ in range(2):
            subprocess.run([PROGRAM, "replay", answers, "--to", f"shm://{ring}", "--speed", "max"], check=True,
                           env=child_environment, capture_output=True)
            hear.wait_output(".* has no peer: frames that readers of the ring send", stream="err")
    finally:
        answers.unlink()
    done = hear.stop()

    assert done.stderr.count("has no peer") == 1
    assert "6 sent by readers of the ring; 6 of these without a peer" in done.stderr


def test_an_answer_to_a_vehicle_that_is_gone_is_counted_and_reported_once(pipeline):
    hear, relay = pipeline.hear(), pipeline.relay()
    pipeline.passes()
    pipeline.vehicle.sendto(last := next(pipeline.beats), pipeline.to)
    got = b""
    while not got.endswith(last):
        got, relay_address = pipeline.ground.recvfrom(65536)
    pipeline.vehicle.close()
    answers = frames.heartbeats(1 << 20, system=255, component=190)

    def told():
        pipeline.ground.sendto(next(answers), relay_address)
        return "frames that readers of the ring send to it are refused" in hear.stderr
    harness.wait_for(told, what="the refusal to be told")
    done = hear.stop()

    assert done.stderr.count("send to it are refused") == 1 and "refused by a peer that is gone" in done.stderr
    relay.stop()


def test_a_second_hear_is_refused_with_the_first_ones_process(start, ring, port):
    first = start(sys.executable, "-m", "mavloom.hear", f"udpin://127.0.0.1:{port}", "--ring", ring)
    first.wait_output("writing to ring", stream="err")
    second = start(sys.executable, "-m", "mavloom.hear", "udpin://127.0.0.1:0", "--ring", ring).wait()
    router = start(PROGRAM, "route", "udpin://127.0.0.1:1", "--ring", ring).wait()

    assert second.status == router.status == 1
    for refused in (second, router):
        assert f"ring {ring} already has a writer, process {first.pid}" in refused.stderr
    first.stop()


def test_an_inlet_that_somebody_serves_is_refused_with_its_process(start, ring):
    place = harness.RUN / f"{ring}.in"
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as other:
        other.bind(str(place))
        done = start(sys.executable, "-m", "mavloom.hear", "udpin://127.0.0.1:0", "--ring", ring).wait()
    place.unlink()

    assert done.status == 1 and f"{ring}.in is already served by process {os.getpid()}" in done.stderr


# ---- examples/pipeline/run.sh

def test_the_script_passes_a_recorded_flight_byte_for_byte(start, ring, port, ground, flight):
    sent = [frame for _, frame in frames.read_tlog(flight)][:8000]
    part = pathlib.Path(os.environ.get("TMPDIR", "/tmp"), f"{ring}.tlog")
    frames.write_tlog(part, [(1_700_000_000_000_000 + 1000 * i, frame) for i, frame in enumerate(sent)])
    try:
        script = start(SCRIPT, part, MAVLOOM_PROGRAM=str(PROGRAM), PYTHON=sys.executable,
                       LISTEN=f"udpin://127.0.0.1:{port}", RING=ring,
                       TO=f"udpout://127.0.0.1:{ground.getsockname()[1]}", SPEED="4")
        size, got = sum(map(len, sent)), b""
        while len(got) < size:
            got += ground.recv(65536)
        done = script.wait()
    finally:
        part.unlink()

    assert done.status == 0, done
    assert got == b"".join(sent)


def test_the_script_ends_when_the_port_is_taken(start, ring, ground, flight):
    with udp() as taken:
        script = start(SCRIPT, flight, MAVLOOM_PROGRAM=str(PROGRAM), PYTHON=sys.executable,
                       LISTEN=f"udpin://127.0.0.1:{taken.getsockname()[1]}", RING=ring,
                       TO=f"udpout://127.0.0.1:{ground.getsockname()[1]}")
        done = script.wait()

    assert done.status == 1 and "in use" in done.stderr, done


def test_the_script_ends_with_ctrl_c_at_its_terminal(start, ring, port, ground):
    """A signal to all of its processes: the relay ends, mavloom.hear was started to ignore it, and the script ends
    that, which still prints its summary."""
    script = start(SCRIPT, MAVLOOM_PROGRAM=str(PROGRAM), PYTHON=sys.executable, LISTEN=f"udpin://127.0.0.1:{port}",
                   RING=ring, TO=f"udpout://127.0.0.1:{ground.getsockname()[1]}")
    script.wait_output("writing to ring", stream="err")
    os.killpg(script.pid, signal.SIGINT)
    done = script.wait()

    assert done.status == 130 and "0 frames heard" in done.stderr, done


@pytest.mark.parametrize("number, status", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_the_script_ends_with_a_signal(start, ring, port, ground, number, status):
    script = start(SCRIPT, MAVLOOM_PROGRAM=str(PROGRAM), PYTHON=sys.executable, LISTEN=f"udpin://127.0.0.1:{port}",
                   RING=ring, TO=f"udpout://127.0.0.1:{ground.getsockname()[1]}")
    script.wait_output("writing to ring", stream="err")
    done = script.stop(number)

    assert done.status == status, done
