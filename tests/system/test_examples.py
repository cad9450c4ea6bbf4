# SPDX-License-Identifier: MIT
"""The files of examples/: each is a good configuration, and does what its comments say, on free ports in a copy."""
import re
import select
import threading
import time

import pytest

import frames
import harness
from frames import mavlink

pytestmark = pytest.mark.short

EXAMPLES = sorted((harness.ROOT / "examples").glob("*.toml"))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_an_example_is_a_good_configuration(run, path):
    done = run("check", path)

    assert done.status == 0, done


class Stub:
    """A program behind a UDP socket that answers from a thread of its own. `heard`: every frame that arrived from anybody."""

    def __init__(self, sock):
        self.sock, self.heard, self.partner = sock, [], None
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._loop, daemon=True)
        self._thread.start()

    def heard_ids(self, system=None):
        parser = mavlink.MAVLink(None)
        decoded = [parser.decode(bytearray(frame)) for frame in list(self.heard)]
        return {m.get_msgId() for m in decoded if system in (None, m.get_srcSystem())}

    def _loop(self):
        beat_due = 0
        while not self._over.is_set():
            if select.select([self.sock], [], [], 0.05)[0]:
                self.hear(*self.sock.recvfrom(65536))
            if time.monotonic() >= beat_due:
                self.beat()
                beat_due = time.monotonic() + 0.05

    def hear(self, datagram, _):
        self.heard += frames.split_frames(datagram)

    def beat(self):
        pass

    def close(self):
        self._over.set()
        self._thread.join()


class Px4(Stub):
    """Sends to the ground station's usual port until somebody speaks to it; whoever that is first is its only partner from then on."""

    def __init__(self, sock, ground_port):
        self.ground, self.sequence, self.strangers = ("127.0.0.1", ground_port), 0, 0
        super().__init__(sock)

    def hear(self, datagram, sender):
        self.partner = self.partner or sender
        if sender != self.partner:
            self.strangers += 1
            return
        super().hear(datagram, sender)

    def beat(self):
        beat = next(frames.heartbeats(1, sequence=self.sequence))
        attitude = frames.attitude(sequence=(self.sequence + 1) % 256)
        self.sequence = (self.sequence + 2) % 256
        self.sock.sendto(beat + attitude, self.partner or self.ground)


class Qgc(Stub):
    """Answers whoever speaks to it with its heartbeat and a command for the vehicle."""

    def __init__(self, sock):
        self.sender = frames.sender(255, 190)
        super().__init__(sock)

    def hear(self, datagram, sender):
        super().hear(datagram, sender)
        if self.partner is None:
            self.partner = sender
        for message in (mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3),
                        mavlink.MAVLink_command_long_message(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0)):
            self.sock.sendto(message.pack(self.sender), sender)
            self.sender.seq = (self.sender.seq + 1) % 256


HEARTBEAT, ATTITUDE, COMMAND_LONG = 0, 30, 76


@pytest.fixture
def bridge(tmp_path, udp_socket, udp_port):
    """px4-qgc.toml on other ports: (file, {"px4": socket, ...}, the router's own port)."""
    sockets = {port: udp_socket() for port in (18570, 14550, 5058)}
    ports = {port: sock.getsockname()[1] for port, sock in sockets.items()}
    ports[5057] = udp_port()
    text = (harness.ROOT / "examples" / "px4-qgc.toml").read_text()
    text, replaced = re.subn(r"(?<=127\.0\.0\.1:)\d+(?=\")", lambda match: str(ports[int(match[0])]), text)
    assert replaced == 4
    (tmp_path / "px4-qgc.toml").write_text(text)
    return tmp_path / "px4-qgc.toml", {"px4": sockets[18570], "qgc": sockets[14550], "copy": sockets[5058]}, ports[5057]


@pytest.fixture
def stubs(bridge):  # ends the stubs before bridge's sockets
    made = []

    def make(stub):
        made.append(stub)
        return stub
    yield make
    for stub in made:
        stub.close()


def start(spawn, file, own_port):
    router = spawn("route", "--config", file, "--name", f"px4-qgc-{own_port}")
    router.wait_output("px4: up")
    return router


def test_px4_qgc_router_is_first_and_everybody_gets_everything(spawn, stubs, bridge, wait_for):
    file, sockets, own_port = bridge
    start(spawn, file, own_port)
    px4 = stubs(Px4(sockets["px4"], sockets["qgc"].getsockname()[1]))
    wait_for(lambda: px4.partner, what="a frame for PX4")
    assert px4.partner == ("127.0.0.1", own_port)
    qgc, copy = stubs(Qgc(sockets["qgc"])), stubs(Stub(sockets["copy"]))

    wait_for(lambda: COMMAND_LONG in px4.heard_ids(255), what="the ground station's command at the vehicle")
    wait_for(lambda: qgc.heard_ids(1) >= {HEARTBEAT, ATTITUDE}, what="the vehicle's telemetry at the ground station")
    wait_for(lambda: copy.heard_ids(1) >= {HEARTBEAT, ATTITUDE} and COMMAND_LONG in copy.heard_ids(255),
             what="both directions at the copy")
    assert px4.partner == ("127.0.0.1", own_port)


def test_px4_qgc_a_ground_station_that_was_there_before_the_router_spoke_gets_px4_alone(spawn, stubs, bridge, wait_for):
    """What the file warns of, and the cure that it names."""
    file, sockets, own_port = bridge
    qgc = stubs(Qgc(sockets["qgc"]))
    px4 = stubs(Px4(sockets["px4"], sockets["qgc"].getsockname()[1]))
    wait_for(lambda: px4.partner, what="a frame for PX4")
    assert px4.partner == sockets["qgc"].getsockname()
    start(spawn, file, own_port)
    wait_for(lambda: px4.strangers, what="the router's heartbeat at PX4")
    assert qgc.partner == sockets["px4"].getsockname()

    px4.close()
    qgc.close()
    while select.select([sockets["px4"]], [], [], 0)[0]:  # a PX4 that is started again has a new socket
        sockets["px4"].recv(65536)
    again = stubs(Px4(sockets["px4"], sockets["qgc"].getsockname()[1]))
    wait_for(lambda: again.partner, what="a partner")
    assert again.partner == ("127.0.0.1", own_port)


def test_px4_qgc_the_router_that_is_started_again_is_still_the_partner(spawn, stubs, bridge, wait_for):
    file, sockets, own_port = bridge
    first = start(spawn, file, own_port)
    px4 = stubs(Px4(sockets["px4"], sockets["qgc"].getsockname()[1]))
    wait_for(lambda: px4.partner, what="a frame for PX4")
    first.kill()
    start(spawn, file, own_port)
    qgc = stubs(Qgc(sockets["qgc"]))

    wait_for(lambda: ATTITUDE in qgc.heard_ids(1) and COMMAND_LONG in px4.heard_ids(255), what="both directions")
    assert px4.strangers == 0
