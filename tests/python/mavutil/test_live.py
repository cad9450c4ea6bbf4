# SPDX-License-Identifier: MIT
"""Opening live connections of mavloom.mavutil, and what they count, against pymavlink's."""
import contextlib
import os
import select
import shutil
import socket
import subprocess
import sys
import threading
import time
import tty

import pytest

import mavloom
from mavloom import mavutil
from places import free_port
from tlogs import packer
from vehicles import Vehicle, until

DEADLINE_S = 60


@pytest.fixture(params=["pymavlink", "mavloom"])
def module(request, their_mavutil):
    return mavutil if request.param == "mavloom" else their_mavutil


# ---- TCP

@pytest.mark.parametrize("tries, options", [
    (3, {}), (1, {"retries": 1}), (1, {"retries": 0}), (1, {"retries": -1}), (3, {"autoreconnect": True}),
    (5, {"retries": 5, "reconnect_delay": 0.25})])
def test_a_server_that_never_comes_is_tried_as_often_as_by_pymavlink(tries, options, module, monkeypatch, capsys):
    pauses = []
    monkeypatch.setattr(time, "sleep", pauses.append)
    with pytest.raises(ConnectionRefusedError):
        module.mavlink_connection(f"tcp:127.0.0.1:{free_port(socket.SOCK_STREAM)}", **options)
    assert pauses == [options.get("reconnect_delay", 1)] * (tries - 1)
    assert capsys.readouterr().out == "[Errno 111] Connection refused sleeping\n" * (tries - 1)


def test_a_server_that_comes_later_is_reached(module, monkeypatch):
    port, pauses = free_port(socket.SOCK_STREAM), []
    with contextlib.ExitStack() as servers:
        def begin_to_listen(pause):
            pauses.append(pause)
            if len(pauses) == 2:
                servers.enter_context(socket.create_server(("127.0.0.1", port)))
        monkeypatch.setattr(time, "sleep", begin_to_listen)
        module.mavlink_connection(f"tcp:127.0.0.1:{port}").close()
    assert pauses == [1, 1]


@pytest.mark.parametrize("pause", [-1, float("nan"), float("inf"), "1"])
def test_pauses_that_are_none(pause):
    with pytest.raises(mavloom.UsageError, match="reconnect_delay: .* is not a number of seconds"):
        mavutil.mavlink_connection(f"tcp:127.0.0.1:{free_port(socket.SOCK_STREAM)}", reconnect_delay=pause)


# ---- strings

@pytest.mark.parametrize("listening, sending", [
    ("udpin::{}", "udpout:127.0.0.1:{}"), (":{}", "udpout::{}"), ("udp::{}", "udpout:localhost:{}"),
    ("tcpin::{}", "tcp:127.0.0.1:{}"), ("tcpin::{}", "tcp::{}")])
def test_a_port_alone_is_a_place(listening, sending, module):
    port = free_port(socket.SOCK_STREAM if listening.startswith("tcpin") else socket.SOCK_DGRAM)
    listener = module.mavlink_connection(listening.format(port))
    sender = module.mavlink_connection(sending.format(port), source_system=7)
    if listening.startswith("tcpin"):
        until(lambda: (sender.mav.heartbeat_send(6, 8, 0, 0, 0), listener.recv_msg())[1] is not None)
    sender.mav.heartbeat_send(6, 8, 0, 0, 0)
    assert listener.recv_match(type="HEARTBEAT", blocking=True, timeout=DEADLINE_S).get_srcSystem() == 7
    sender.close()
    listener.close()


def test_a_port_alone_is_one_of_pymavlinks_group():
    port = free_port()
    for text, place in ((f"mcast:{port}", f"239.255.145.50:{port}"), ("mcast:", "239.255.145.50:14550"),
                        (f"mcast:239.1.1.1:{port}", f"239.1.1.1:{port}")):
        connection = mavutil.mavlink_connection(text)
        assert connection.link.name == f"udpmcast://{place}"
        connection.close()


def test_programs_are_refused_and_executable_recordings_are_read(tmp_path, flight):
    script, log = tmp_path / "sim", tmp_path / "log"
    script.write_text("#!/bin/sh\n")
    log.write_bytes(flight.read_bytes()[:4096])
    for path in (script, log):
        path.chmod(0o755)
    for path in (script, "/bin/ls"):
        with pytest.raises(mavloom.UsageError, match="programs are not started here: start it yourself"):
            mavutil.mavlink_connection(path)
    assert mavutil.mavlink_connection(log).recv_msg() is not None


def test_a_host_that_does_not_exist_is_an_error(module):
    for text in ("nohost.invalid:14550", "udpin:nohost.invalid:14550"):
        with pytest.raises(socket.gaierror):
            module.mavlink_connection(text)


def test_a_folder_is_refused_by_name(tmp_path):
    with pytest.raises(mavloom.SystemFailure, match="is a folder, neither") as caught:
        mavutil.mavlink_connection(tmp_path)
    assert caught.value.errno == 21


# ---- waiting

@pytest.mark.parametrize("call", [lambda c: c.recv_match(blocking=True, timeout=float("nan")),
                                  lambda c: c.wait_heartbeat(timeout=float("nan")), lambda c: c.select(float("nan"))])
def test_times_that_are_none_are_refused(call, module):
    connection = module.mavlink_connection(f"udpin:127.0.0.1:{free_port()}")
    with pytest.raises(ValueError):
        call(connection)
    connection.close()


def test_a_descriptor_is_ready_only_while_messages_wait(module, peer):
    port = free_port()
    connection, vehicle = module.mavlink_connection(f"udpin:127.0.0.1:{port}"), Vehicle(peer, port)
    for burst in (1, 3, 1):
        for _ in range(burst):
            vehicle.send(vehicle.heartbeat())
        for _ in range(burst):
            assert select.select([connection.fd], [], [], DEADLINE_S)[0]
            assert connection.recv_msg().get_type() == "HEARTBEAT"
        assert not select.select([connection.fd], [], [], 0.05)[0]
    connection.close()


def test_an_idle_link_is_not_ready(module, peer):
    port = free_port()
    connection, vehicle = module.mavlink_connection(f"udpin:127.0.0.1:{port}"), Vehicle(peer, port)
    assert not connection.select(0) and not connection.select(0.01)
    for _ in range(2):
        vehicle.send(vehicle.heartbeat())
        assert connection.select(DEADLINE_S) and connection.select(0)
        assert connection.recv_msg().get_type() == "HEARTBEAT"
        assert not connection.select(0)
    connection.close()


def test_endless_time_outs(peer):
    """pymavlink raises OverflowError."""
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0")
    vehicle = Vehicle(peer, connection.link.port)
    vehicle.send(vehicle.heartbeat(), vehicle.attitude(1))
    assert connection.select(float("inf"))
    assert connection.recv_match(type="ATTITUDE", blocking=True, timeout=float("inf")) is not None
    connection.close()


def test_the_progress_of_opening_a_recording(module, flight):
    percents = []
    module.mavlink_connection(str(flight), progress_callback=percents.append)
    assert percents == list(range(1, 101))


# ---- several connections on one UDP port

@pytest.mark.parametrize("kind", ["udpin", "udp"])
def test_a_function_may_open_a_port_again_without_closing_it(kind, module, peer):
    """The newest connection receives, as with pymavlink's sockets."""
    port, left_open = free_port(), []

    def wait_for_a_heartbeat():
        connection = module.mavlink_connection(f"{kind}:127.0.0.1:{port}")
        left_open.append(connection)
        vehicle = Vehicle(peer, port)
        vehicle.send(vehicle.heartbeat())
        return connection.wait_heartbeat(timeout=DEADLINE_S)
    try:
        assert all(wait_for_a_heartbeat() is not None for _ in range(3))
    finally:
        for connection in left_open:
            connection.close()


def test_a_port_of_another_program_is_in_use(module):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        with pytest.raises(OSError) as caught:
            module.mavlink_connection(f"udpin:127.0.0.1:{other.getsockname()[1]}")
    assert caught.value.errno == 98


# ---- programs that a UDP port has heard

def test_nobody_is_forgotten_by_default(module):
    """pymavlink's sockets keep each address for ever."""
    connection = module.mavlink_connection("udpin:127.0.0.1:0")
    if module is mavutil:
        assert "&trusted=true&idle=1000h" in connection.url
    else:
        assert connection.timeout == 0
    connection.port.close()


@pytest.mark.parametrize("timeout, idle", [(5, "5000ms"), (0.25, "250ms"), (0, "1000h"), (-1, "1000h")])
@pytest.mark.parametrize("kind", ["udp", "udpin", "udpbcast"])
def test_the_timeout_is_that_of_the_endpoint(kind, timeout, idle):
    connection = mavutil.mavlink_connection(f"{kind}:127.0.0.1:{free_port()}", udp_timeout=timeout)
    assert connection.url.endswith(f"&trusted=true&idle={idle}")
    connection.close()


def test_a_silent_program_is_forgotten_while_another_one_speaks(module, peer):
    connection = module.mavlink_connection(f"udpin:127.0.0.1:{free_port()}", udp_timeout=0.3)
    silent, other = (Vehicle(peer, connection.port.getsockname()[1], system=system) for system in (1, 2))
    silent.send(silent.heartbeat())
    assert connection.wait_heartbeat(timeout=DEADLINE_S) is not None
    connection.mav.heartbeat_send(6, 8, 0, 0, 0)
    assert silent.receive()
    silent.socket.settimeout(0.1)

    def is_forgotten():
        other.send(other.heartbeat())
        connection.wait_heartbeat(timeout=DEADLINE_S)
        connection.mav.heartbeat_send(6, 8, 0, 0, 0)
        try:
            return not silent.receive()
        except TimeoutError:
            return True
    until(is_forgotten)
    assert other.receive()
    connection.port.close()


# Prints how many of 50 messages get to a program on another address that spoke once.
LISTENER = """
import socket, subprocess
import pymavlink.dialects.v20.common as peer
from mavloom import mavutil
for words in ("link set lo up", "address add 10.1.1.1/32 dev lo", "address add 10.1.1.2/32 dev lo"):
    subprocess.run(["ip", *words.split()], check=True)
connection = mavutil.mavlink_connection("udpin:0.0.0.0:14550")
listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
listener.bind(("10.1.1.2", 0))
beat = peer.MAVLink_heartbeat_message(2, 3, 81, 4, 4, 3).pack(peer.MAVLink(None, 1, 1))
listener.sendto(beat, ("10.1.1.1", 14550))
connection.wait_heartbeat(timeout=60)
for _ in range(50):
    connection.mav.heartbeat_send(6, 8, 0, 0, 0)
connection.close()
listener.setblocking(False)
count = 0
try:
    while listener.recv(999):
        count += 1
except BlockingIOError:
    print(count)
"""


@pytest.mark.skipif(os.geteuid() != 0 or not shutil.which("unshare") or not shutil.which("ip"),
                    reason="addresses of its own need root, unshare and ip")
def test_a_program_that_spoke_once_gets_everything(child_environment):
    done = subprocess.run(["unshare", "--net", sys.executable, "-c", LISTENER], env=child_environment,
                          capture_output=True, text=True, timeout=DEADLINE_S)
    if "unshare" in done.stderr:
        pytest.skip(done.stderr)
    assert (done.stdout, done.stderr) == ("50\n", "")


# ---- slow serial lines

def test_sending_waits_for_a_slow_serial_line(module, peer):
    """Telemetry that was sent more than a second ago is not dropped."""
    ours, device = os.openpty()
    for end in (ours, device):
        tty.setraw(end)
    connection = module.mavlink_connection(os.ttyname(device), baud=57600)
    frames = 6000  # more bytes than the kernel keeps

    def send():
        for number in range(frames):
            connection.mav.attitude_send(number, 0, 0, 0, 0, 0, 0)
    threading.Thread(target=send, daemon=True).start()
    time.sleep(1.5)
    parser, got = peer.MAVLink(None), []
    while len(got) < frames:
        got += parser.parse_buffer(os.read(ours, 4096)) or []
    assert [message.time_boot_ms for message in got] == list(range(frames))
    connection.close()
    os.close(ours)
    os.close(device)


def test_closing_ends_the_wait_of_a_sender():
    ours, device = os.openpty()
    for end in (ours, device):
        tty.setraw(end)
    connection = mavutil.mavlink_connection(os.ttyname(device))
    ended = threading.Event()

    def send():
        while not connection._closed:
            connection.mav.statustext_send(6, b"x" * 50)
        ended.set()
    threading.Thread(target=send, daemon=True).start()
    until(lambda: connection.link._port.queued_bytes > 4096)
    connection.close()
    assert ended.wait(DEADLINE_S)
    os.close(ours)
    os.close(device)


# ---- the native link

def test_the_link_of_a_connection_returns_native_messages(peer):
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0")
    vehicle = Vehicle(peer, connection.link.port)
    messages = connection.link.subscribe("HEARTBEAT")
    vehicle.send(peer.MAVLink_heartbeat_message(2, 3, 81, 4, 4, 3))
    read = connection.wait_heartbeat(timeout=DEADLINE_S)
    latest, subscribed = connection.link.latest("HEARTBEAT"), messages.recv(timeout=DEADLINE_S)
    assert isinstance(read, mavutil.mavlink.MAVLink_message)
    assert type(latest) is type(subscribed) is mavloom.Message and latest["custom_mode"] == subscribed.custom_mode == 4
    own = [connection.link.recv(timeout=DEADLINE_S), connection.link.recv(timeout=0)]
    assert type(own[0]) is mavloom.Message and own[1] is None and connection.link.stats.missed == 0
    assert latest.link_name == subscribed.link_name and latest.link_name
    assert connection.link.vehicle(system=1).mode == "GUIDED"
    vehicle.send(vehicle.heartbeat())
    assert type(connection.link.wait_heartbeat(timeout=DEADLINE_S)) is mavloom.Message
    assert connection.link.forward(latest) == 1 and vehicle.receive()[0].custom_mode == 4
    connection.close()


# ---- damage

def damaged(frame):
    return frame[:-1] + bytes([frame[-1] ^ 1])


def test_damaged_frames_are_counted(module, peer):
    """pymavlink also returns them as BAD_DATA."""
    port = free_port()
    connection, vehicle = module.mavlink_connection(f"udpin:127.0.0.1:{port}"), Vehicle(peer, port)
    beat = packer(peer).pack(vehicle.heartbeat())
    for frame in (beat, damaged(beat), damaged(beat), beat):
        vehicle.socket.send(frame)
    for _ in range(2):
        assert connection.recv_match(type="HEARTBEAT", blocking=True, timeout=DEADLINE_S) is not None
    until(lambda: connection.mav.total_receive_errors >= 2)
    assert connection.mav.total_receive_errors == 2
    connection.mav.total_receive_errors = 0
    assert connection.mav.total_receive_errors == 0
    assert connection.recv_match(type="BAD_DATA", blocking=True, timeout=0.01) is None
    connection.close()


def frame_of(peer, message_id):
    """A MAVLink 2 frame of a message that has no definition here, but has one at its sender."""
    body = bytes([2, 0, 0, 1, 1, 1]) + message_id.to_bytes(3, "little") + b"\1\2"
    crc_extra = 77
    return b"\xfd" + body + peer.x25crc(body + bytes([crc_extra])).crc.to_bytes(2, "little")


def test_messages_without_definition_can_be_waited_for(module, peer):
    port = free_port()
    connection, vehicle = module.mavlink_connection(f"udpin:127.0.0.1:{port}"), Vehicle(peer, port)
    strange = frame_of(peer, 54321)
    vehicle.send(vehicle.heartbeat())
    vehicle.socket.send(strange)
    found = connection.recv_match(type=["UNKNOWN_54321", "UNKNOWN_x"], blocking=True, timeout=DEADLINE_S)
    assert (found.get_type(), bytes(found.get_msgbuf())) == ("UNKNOWN_54321", strange)
    assert connection.recv_match(type="UNKNOWN_54322") is None
    connection.close()
