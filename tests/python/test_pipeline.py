# SPDX-License-Identifier: MIT
"""examples/pipeline: Python hears MAVLink and fills a ring, the relay reads the ring and sends to a ground station. The frames are a recorded flight's."""
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
        process = self.start(sys.executable, "-m", "mavloom.hear", f"udpin://127.0.0.1:{self.to[1]}", "--ring", self.ring)
        process.wait_output("writing to ring", stream="err")
        return process

    def relay(self):
        return self.start(PROGRAM, "relay", f"shm://{self.ring}", "--to", f"udpout://127.0.0.1:{self.ground.getsockname()[1]}")

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
def test_the_relay_waits_while_the_writer_is_gone_and_goes_on_when_it_is_back(pipeline, how):
    first, relay = pipeline.hear(), pipeline.relay()
    pipeline.passes()
    first.send(how)
    first.process.wait()
    again = pipeline.start(sys.executable, "-m", "mavloom.hear", f"udpin://127.0.0.1:{pipeline.to[1]}", "--ring", pipeline.ring)
    again.wait_output("writing to ring", stream="err")
    pipeline.passes()

    assert relay.alive
    assert again.stop().status == 130 and relay.stop().status == 130


def test_a_killed_relay_holds_nobody_up(pipeline):
    hear, relay = pipeline.hear(), pipeline.relay()
    pipeline.passes()
    relay.send(signal.SIGKILL)
    relay.process.wait()
    relay = pipeline.relay()
    pipeline.passes()

    assert hear.stop().status == 130 and relay.stop().status == 130


def test_the_script_passes_a_recorded_flight_byte_for_byte(start, ring, port, ground, flight):
    sent = [frame for _, frame in frames.read_tlog(flight)][:8000]
    part = pathlib.Path(os.environ.get("TMPDIR", "/tmp"), f"{ring}.tlog")
    frames.write_tlog(part, [(1_700_000_000_000_000 + 1000 * i, frame) for i, frame in enumerate(sent)])
    try:
        script = start(SCRIPT, part, MAVLOOM_PROGRAM=str(PROGRAM), PYTHON=sys.executable, LISTEN=f"udpin://127.0.0.1:{port}", RING=ring,
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
        script = start(SCRIPT, flight, MAVLOOM_PROGRAM=str(PROGRAM), PYTHON=sys.executable, LISTEN=f"udpin://127.0.0.1:{taken.getsockname()[1]}", RING=ring,
                       TO=f"udpout://127.0.0.1:{ground.getsockname()[1]}")
        done = script.wait()

    assert done.status == 1 and "in use" in done.stderr, done


def test_the_script_ends_with_ctrl_c_at_its_terminal(start, ring, port, ground):
    """A signal to all of its processes: the relay ends, mavloom.hear was started to ignore it, and the script ends that, which still says what it heard."""
    script = start(SCRIPT, MAVLOOM_PROGRAM=str(PROGRAM), PYTHON=sys.executable, LISTEN=f"udpin://127.0.0.1:{port}", RING=ring,
                   TO=f"udpout://127.0.0.1:{ground.getsockname()[1]}")
    script.wait_output("writing to ring", stream="err")
    os.killpg(script.pid, signal.SIGINT)
    done = script.wait()

    assert done.status == 130 and "0 frames heard" in done.stderr, done


@pytest.mark.parametrize("number, status", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_the_script_ends_with_a_signal(start, ring, port, ground, number, status):
    script = start(SCRIPT, MAVLOOM_PROGRAM=str(PROGRAM), PYTHON=sys.executable, LISTEN=f"udpin://127.0.0.1:{port}", RING=ring,
                   TO=f"udpout://127.0.0.1:{ground.getsockname()[1]}")
    script.wait_output("writing to ring", stream="err")
    done = script.stop(number)

    assert done.status == status, done
