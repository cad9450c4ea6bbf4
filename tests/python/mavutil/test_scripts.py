# SPDX-License-Identifier: MIT
"""Twenty scripts as people write them (tests/python/scripts), run under pymavlink as they are, and under Mavloom with
one line changed. Both must print the same, and send the same frames."""
import contextlib
import re
import shutil
import socket
import threading
import time

import pytest

import both
from autopilot import Autopilot, Settings
from places import ROOT, free_port

SCRIPTS = ROOT / "tests" / "python" / "scripts"


@pytest.fixture(scope="module")
def sides(peer, tmp_path_factory):
    """Folders with the scripts as they are and with the line changed."""
    return both.lay_out(tmp_path_factory.mktemp("scripts"), sorted(SCRIPTS.glob("*.py")), peer)


def run(sides, side, script, *words, environment):
    return both.run(sides[side], script, *words, environment=environment)


def test_there_are_twenty_scripts_and_one_line_of_each_changes(sides):
    scripts = sorted(SCRIPTS.glob("*.py"))
    assert len(scripts) == 20
    for script in scripts:
        before, after = script.read_text().splitlines(), (sides["mavloom"] / script.name).read_text().splitlines()
        assert sum(a != b for a, b in zip(before, after, strict=True)) == 1


# ---- recordings

@pytest.mark.unsanitized
@pytest.mark.parametrize("script", ["log_to_csv", "log_numpy", "log_pandas", "log_statistics", "log_modes",
                                    "log_battery", "log_split"])
def test_scripts_that_read_a_recording(script, sides, flight, tmp_path, child_environment):
    shutil.copy(flight, tmp_path / "flight.tlog")
    theirs, ours = (run(sides, side, script, tmp_path / "flight.tlog", environment=child_environment)
                    for side in both.SIDES)
    assert ours == theirs
    assert len(theirs.splitlines()) >= 1


# ---- vehicles

def with_vehicle(sides, side, script, peer, environment, link="udpin", settings=None, words=(), meanwhile=None,
                 prepare=None):
    """Runs a script beside a vehicle. Returns what it printed, and the frames that it sent."""
    port = free_port()
    with Autopilot(peer, settings, connect_to=("127.0.0.1", port) if link == "udpin" else None,
                   tcp=link == "tcp") as vehicle:
        if prepare is not None:
            prepare(vehicle)
        address = f"{link}:127.0.0.1:{port if link == 'udpin' else vehicle.port}"
        with contextlib.ExitStack() as stack:
            if meanwhile is not None:
                stack.enter_context(meanwhile(vehicle))
            printed = run(sides, side, script, address, *words, environment=environment)
        return printed, settle(vehicle)


def settle(vehicle):
    """The frames received, once no more arrive: the script's last ones may be on their way."""
    count = -1
    while count != len(vehicle.received):
        count = len(vehicle.received)
        time.sleep(0.15)
    return list(vehicle.received)


def compare(script, sides, peer, environment, **options):
    theirs, their_frames = with_vehicle(sides, "pymavlink", script, peer, environment, **options)
    ours, our_frames = with_vehicle(sides, "mavloom", script, peer, environment, **options)
    assert ours == theirs
    assert [frame.hex() for frame in our_frames] == [frame.hex() for frame in their_frames]
    return theirs, their_frames


@pytest.mark.parametrize("link", ["udpin", "tcp"])
@pytest.mark.parametrize("script", ["live_logger", "params_read", "params_write", "mission_upload", "arm_takeoff",
                                    "rc_override"])
def test_scripts_that_talk_to_an_ardupilot(script, link, sides, peer, child_environment):
    printed, frames = compare(script, sides, peer, child_environment, link=link)
    assert len(printed.splitlines()) >= 3 and len(frames) >= 1


def test_a_mission_is_downloaded(sides, peer, child_environment):
    def prepare(vehicle):
        item = peer.MAVLink_mission_item_int_message
        vehicle.mission = [item(1, 1, i, 3, 16, int(i == 0), 1, 0, 0, 0, 0.5 * i, -353632621 + i, 1491652374, 20.0 + i)
                           for i in range(6)]
    printed, frames = compare("mission_download", sides, peer, child_environment, prepare=prepare)
    assert len(printed.splitlines()) == 7 and len(frames) == 8


@contextlib.contextmanager
def flying(vehicle):
    stop = threading.Event()

    def work():
        while not stop.wait(0.02):
            vehicle.fly()
    thread = threading.Thread(target=work)
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()


def test_a_copter_is_guided(sides, peer, child_environment):
    printed, frames = compare("guided_goto", sides, peer, child_environment, meanwhile=flying)
    assert "lat=-35.363262,lon=149.165237,alt=594.5" in printed and len(frames) == 8


def test_a_px4_is_controlled_offboard(sides, peer, child_environment):
    printed, frames = compare("offboard_px4", sides, peer, child_environment, settings=Settings(px4=True))
    assert "OFFBOARD True" in printed and len(frames) == 22


def test_heartbeats_are_sent_by_a_thread(sides, peer, child_environment):
    printed, frames = compare("heartbeat_monitor", sides, peer, child_environment)
    assert "alive: 5 1 MAV_TYPE_QUADROTOR True True" in printed and len(frames) == 10


# ---- bridges

class Broker(threading.Thread):
    """Keeps the bytes of one client."""

    def __init__(self):
        super().__init__(daemon=True)
        self.listener, self.data = socket.create_server(("127.0.0.1", 0)), b""
        self.start()

    def run(self):
        with self.listener, self.listener.accept()[0] as client:
            while part := client.recv(65536):
                self.data += part


def test_a_bridge_to_mqtt_publishes_the_same(sides, peer, child_environment):
    sent = []
    for side in both.SIDES:
        broker = Broker()
        printed, frames = with_vehicle(sides, side, "mqtt_bridge", peer, child_environment,
                                       words=[f"127.0.0.1:{broker.listener.getsockname()[1]}"])
        broker.join(60)
        sent.append((printed, frames, broker.data))
    assert sent[0] == sent[1]
    assert sent[0][2].count(b"vehicle/1/") == 30


class WebSocketClient(threading.Thread):
    """Reads what the script serves, from the handshake to the end."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.port, self.data = port, b""

    def run(self):
        for _ in range(1000):
            with contextlib.suppress(ConnectionRefusedError):
                self.socket = socket.create_connection(("127.0.0.1", self.port))
                break
            threading.Event().wait(0.05)
        self.socket.sendall(b"GET / HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                            b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n")
        while part := self.socket.recv(65536):
            self.data += part
        self.socket.close()


def test_a_bridge_to_web_sockets_streams_the_same(sides, peer, child_environment):
    sent = []
    for side in both.SIDES:
        client = WebSocketClient(free_port(socket.SOCK_STREAM))
        client.start()
        printed, frames = with_vehicle(sides, side, "websocket_asyncio", peer, child_environment, words=[client.port])
        client.join(60)
        sent.append((printed, frames, client.data))
    assert sent[0] == sent[1]
    assert b"s3pPLMBiTxaQ9kYGzzhZRbK+xOo=" in sent[0][2] and sent[0][2].count(b'"mavpackettype": "ATTITUDE"') == 20


class Station(threading.Thread):
    """A ground station that sends three commands through the relay, and keeps what it hears. It sends each command
    after the answer to the one before, so the relay has forwarded two answers when it ends."""

    def __init__(self, peer):
        super().__init__(daemon=True)
        self.peer, self.heard = peer, []
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(60)
        self.port = self.socket.getsockname()[1]
        self.start()

    def run(self):
        mav = self.peer.MAVLink(None, srcSystem=255, srcComponent=190)
        with contextlib.suppress(OSError):
            while True:
                data, address = self.socket.recvfrom(65536)
                self.heard.append(data)
                if mav.seq < 3 and (len(self.heard) == 5 or is_ack(data)):
                    message = self.peer.MAVLink_command_long_message(1, 1, 31010, 0, mav.seq, 0, 0, 0, 0, 0, 7)
                    self.socket.sendto(bytes(message.pack(mav)), address)
                    mav.seq += 1


def is_ack(frame):
    return int.from_bytes(frame[7:10], "little") == 77


def contents(frames):
    """The frames without their sequence numbers and checksums. How many of each there are depends on the time."""
    return {frame[:4] + frame[5:-2] for frame in frames}


def test_a_relay_forwards_the_same(sides, peer, child_environment):
    results = []
    for side in both.SIDES:
        station = Station(peer)
        printed, frames = with_vehicle(sides, side, "relay", peer, child_environment,
                                       words=[f"127.0.0.1:{station.port}"])
        station.socket.close()
        heard = list(station.heard)
        assert [frame[4] for frame in heard] == [(heard[0][4] + i) % 256 for i in range(len(heard))]
        results.append((printed, frames, contents(heard)))
    assert results[0] == results[1]
    assert "True 3" in results[0][0] and len(results[0][1]) == 3 and len(results[0][2]) == 2
