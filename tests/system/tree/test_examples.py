# SPDX-License-Identifier: MIT
"""The files of examples/: each is a good configuration, and does what its comments promise, on free ports in a copy."""
import re
import select
import threading
import time

import pytest

import frames
import harness
from frames import mavlink
from pymavlink import mavutil

pytestmark = pytest.mark.short

EXAMPLES = sorted((harness.ROOT / "examples").glob("*.toml"))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_an_example_is_a_good_configuration(run, path):
    done = run("check", path)

    assert done.status == 0, done


class Stub:
    """A program behind a UDP socket that answers from a thread of its own.
    `heard`: every frame that arrived from anybody."""

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
    """Sends to the ground station's usual port until it is spoken to;
    the first speaker is its only partner from then on."""

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
    """Answers every sender with its heartbeat and a command for the vehicle."""

    def __init__(self, sock, system=255):
        self.sender = frames.sender(system, 190)
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


def on_free_ports(name, free, folder):
    """A copy of the example, with `free` = {port of the example: port to use} in the place of all its ports."""
    text, replaced = re.subn(r"(?<=127\.0\.0\.1:)\d+(?=\")", lambda match: str(free[int(match[0])]),
                             (harness.ROOT / "examples" / name).read_text())
    assert replaced == len(free)
    (folder / name).write_text(text)
    return folder / name


@pytest.fixture
def bridge(tmp_path, udp_socket, udp_port):
    """px4-qgc.toml on other ports: (file, {"px4": socket, ...}, the router's own port)."""
    sockets = {port: udp_socket() for port in (18570, 14550, 5058)}
    own = udp_port()
    file = on_free_ports("px4-qgc.toml", {port: sock.getsockname()[1] for port, sock in sockets.items()} | {5057: own},
                         tmp_path)
    return file, {"px4": sockets[18570], "qgc": sockets[14550], "copy": sockets[5058]}, own


@pytest.fixture
def stubs(udp_socket):  # ends the stubs before their sockets
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
    """The trouble that the file warns of, and the cure that it gives."""
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


def test_px4_with_two_stations_and_sdks(spawn, stubs, tmp_path, udp_socket, udp_port, tcp_port, wait_for):
    px4_socket, first_socket, second_socket = udp_socket(), udp_socket(), udp_socket()
    own, sdk_port = udp_port(), tcp_port()
    file = on_free_ports("px4-two-stations.toml",
                         {18570: px4_socket.getsockname()[1], 5057: own, 14550: first_socket.getsockname()[1],
                                                   14551: second_socket.getsockname()[1], 5760: sdk_port}, tmp_path)
    start(spawn, file, own)
    px4 = stubs(Px4(px4_socket, first_socket.getsockname()[1]))
    first, second = stubs(Qgc(first_socket)), stubs(Qgc(second_socket, 254))
    sdks = [mavutil.mavlink_connection(f"tcp:127.0.0.1:{sdk_port}", source_system=system, source_component=191)
            for system in (201, 202)]
    heard = [sdk.wait_heartbeat(timeout=harness.DEFAULT_TIMEOUT_S) for sdk in sdks]
    for sdk in sdks:
        sdk.mav.command_long_send(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0)

    assert {message.get_srcSystem() for message in heard} <= {1, 254, 255}, "the router's heartbeat is 255/191"
    assert all((message.get_srcSystem(), message.get_srcComponent()) != (255, 191) for message in heard)
    for station in (first, second):
        wait_for(lambda station=station: station.heard_ids(1) >= {HEARTBEAT, ATTITUDE},
                 what="the vehicle's telemetry at a ground station")
    for system in (255, 254, 201, 202):
        wait_for(lambda system=system: COMMAND_LONG in px4.heard_ids(system),
                 what=f"the command of {system} at the vehicle")
    wait_for(lambda: HEARTBEAT in second.heard_ids(255) and HEARTBEAT in first.heard_ids(254),
             what="each other's heartbeats")
    assert px4.partner == ("127.0.0.1", own)
    for sdk in sdks:
        sdk.close()


def test_two_vehicles_do_not_hear_each_other(spawn, tmp_path, udp_socket, udp_port, wait_for):
    first, second, ground = udp_socket(), udp_socket(), udp_socket()
    ports = {14541: udp_port(), 14542: udp_port(), 14550: ground.getsockname()[1]}
    router = spawn("route", "--config", on_free_ports("two-vehicles.toml", ports, tmp_path), "--name",
                   f"two-vehicles-{ports[14541]}")
    router.wait_output("vehicle2: listening")
    for sock, system, port in ((first, 1, ports[14541]), (second, 2, ports[14542]), (first, 1, ports[14541])):
        sock.sendto(frames.attitude(system=system), ("127.0.0.1", port))
    heard = b""
    while {frame[5] for frame in frames.split_frames(heard)} != {1, 2}:
        heard += (got := ground.recvfrom(65536))[0]
    station = frames.sender(255, 190)
    everybody = mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3).pack(station)
    ground.sendto(everybody, got[1])
    arrived = [sock.recv(65536) for sock in (first, second)]
    to_second = mavlink.MAVLink_command_long_message(2, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0).pack(frames.sender(255, 190, 1))
    ground.sendto(to_second, got[1])

    assert arrived == [everybody, everybody], "and none of the other vehicle's telemetry before it"
    assert second.recv(65536) == to_second
