# SPDX-License-Identifier: MIT
"""A program's own classes of connections, its hooks and its files, with mavloom.mavutil and with pymavlink."""
import io
import os
import socket
import struct
import tty

import pytest

import mavloom
from mavloom import mavutil
from tlogs import packer, write
from vehicles import Vehicle

DEADLINE_S = 60


@pytest.fixture(params=["pymavlink", "mavloom"])
def module(request, their_mavutil):
    return mavutil if request.param == "mavloom" else their_mavutil


def messages_of(peer):
    return (peer.MAVLink_heartbeat_message(2, 3, 81, 4, 4, 3), peer.MAVLink_attitude_message(1, 0.5, 0, 0, 0, 0, 0),
            peer.MAVLink_heartbeat_message(2, 3, 81, 5, 4, 3))


# ---- classes

def memory_class(module):
    class Memory(module.mavfile):
        """As DroneKit's programs have it."""

        def __init__(self, data):
            self.data, self.sent = data, []
            module.mavfile.__init__(self, None, "memory", source_component=191, input=False)

        def recv(self, n=None):
            n = self.mav.bytes_needed() if n is None else n
            found, self.data = self.data[:n], self.data[n:]
            return found

        def write(self, buf):
            self.sent.append(bytes(buf))
    return Memory


def test_a_class_with_recv_and_write_of_its_own(module, peer):
    sender = packer(peer)
    frames = [sender.pack(message) for message in messages_of(peer)]
    connection = memory_class(module)(frames[0] + b"xy" + frames[1] + frames[2])
    connection.setup_signing(bytes(32), sign_outgoing=False, allow_unsigned_callback=lambda mav, message_id: True)
    hooked, called = [], []
    connection.message_hooks.append(lambda conn, message: hooked.append(message.get_type()))
    connection.mav.set_callback(lambda message: called.append(message.get_type()))
    attitude = connection.recv_match(type="ATTITUDE", blocking=True, timeout=DEADLINE_S)
    assert (attitude.roll, connection.target_system, connection.flightmode) == (0.5, 1, "GUIDED")
    assert connection.recv_msg().custom_mode == 5 and connection.recv_msg() is None
    assert hooked == called == ["HEARTBEAT", "BAD_DATA", "ATTITUDE", "HEARTBEAT"]
    assert (connection.mav.total_packets_received, connection.mav.total_receive_errors) == (4, 1)
    assert connection.mav.signing.unsigned_count == 3 and connection.mavlink20()
    connection.mav.heartbeat_send(6, 8, 0, 0, 0)
    sent = peer.MAVLink(None).parse_buffer(connection.sent[0])[0]
    assert (sent.get_srcSystem(), sent.get_srcComponent()) == (255, 191)


def test_a_class_with_recv_msg_of_its_own(module, peer):
    """As DroneKit's connection on a UDP port with several vehicles."""
    class Udp(module.mavfile):
        def __init__(self):
            self.port = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            self.port.bind(("127.0.0.1", 0))
            self.port.setblocking(False)
            module.mavfile.__init__(self, self.port.fileno(), "own", source_system=250, input=True)

        def recv(self, n=None):
            try:
                return self.port.recv(65535)
            except BlockingIOError:
                return ""

        def recv_msg(self):
            self.pre_message()
            data = self.recv()
            if len(data) > 0 and self.first_byte:
                self.auto_mavlink_version(data)
            message = self.mav.parse_char(data)
            if message is not None:
                self.post_message(message)
            return message

    connection = Udp()
    vehicle = Vehicle(peer, connection.port.getsockname()[1])
    vehicle.send(*messages_of(peer))
    assert connection.recv_match(type="ATTITUDE", blocking=True, timeout=DEADLINE_S).roll == 0.5
    assert connection.wait_heartbeat(timeout=DEADLINE_S).custom_mode == 5
    assert connection.recv_match(blocking=True, timeout=0.05) is None and not connection.select(0)
    assert connection.fd == connection.port.fileno() and connection.mav_count == 3
    connection.port.close()


def test_a_class_without_methods_states_what_it_lacks():
    connection = mavutil.mavfile(None, "nothing")
    with pytest.raises(mavloom.UsageError, match="nothing: mavfile has no method recv"):
        connection.recv_msg()
    with pytest.raises(mavloom.UsageError, match="nothing: nothing can be sent here"):
        connection.mav.heartbeat_send(6, 8, 0, 0, 0)


# ---- hooks

def test_idle_hooks_run_in_blocking_calls_only(module):
    connection, calls = module.mavlink_connection("udpin:127.0.0.1:0"), []

    def poll(conn):
        calls.append(conn)
        conn.recv_match()
    connection.idle_hooks.append(poll)
    assert connection.recv_match(type="ATTITUDE") is None and not calls
    assert connection.recv_match(type="ATTITUDE", blocking=True, timeout=0.2) is None and calls
    connection.port.close()


# ---- files

def test_a_file_of_the_programs_own_records_a_recording(module, peer, tmp_path):
    """pymavlink writes the present time, Mavloom that of the message."""
    sender = packer(peer)
    frames = [sender.pack(message) for message in messages_of(peer)]
    log = module.mavlogfile(str(write(tmp_path / "x.tlog", frames)))
    log.recv_msg()
    log.logfile, log.logfile_raw = io.BytesIO(), io.BytesIO()
    while log.recv_msg() is not None:
        pass
    recorded = log.logfile.getvalue()
    log.close()
    assert log.logfile_raw.getvalue() == b"".join(frames[1:])
    assert recorded[8:8 + len(frames[1])] == frames[1] and recorded[16 + len(frames[1]):] == frames[2]
    assert struct.unpack(">Q", recorded[:8])[0] & 3 == 0


@pytest.fixture
def serial_line():
    """(our end, the device's name)"""
    ends = []

    def opened():
        ours, theirs = os.openpty()
        ends.extend([ours, theirs])
        tty.setraw(ours)
        tty.setraw(theirs)
        return ours, os.ttyname(theirs)
    yield opened
    for end in ends:
        os.close(end)


def test_another_connection_does_not_take_bytes_that_are_no_message(peer, tmp_path):
    frames = [packer(peer).pack(message) for message in messages_of(peer)]
    frames[1] = frames[1][:-1] + bytes([frames[1][-1] ^ 1])
    log, to = mavutil.mavlogfile(str(write(tmp_path / "x.tlog", frames))), memory_class(mavutil)(b"")
    log.logfile_raw = to
    assert [message.get_type() for message in iter(log.recv_msg, None)] == ["HEARTBEAT", "BAD_DATA", "HEARTBEAT"]
    assert to.sent == [frames[0], frames[2]]


def test_a_connection_takes_the_bytes_of_another_one(serial_line, module, peer):
    """A bridge between two devices in one line: what one receives, the other one sends."""
    (near, near_name), (far, far_name) = serial_line(), serial_line()
    source, to = (module.mavlink_connection(name, baud=57600) for name in (near_name, far_name))
    source.logfile_raw = to
    frame = packer(peer).pack(messages_of(peer)[0])
    os.write(near, frame)
    assert source.recv_match(type="HEARTBEAT", blocking=True, timeout=DEADLINE_S) is not None
    passed = b""
    while len(passed) < len(frame):
        passed += os.read(far, 999)
    assert passed == frame
    source.close()
    to.mav.heartbeat_send(6, 8, 0, 0, 0)  # is still open
    assert os.read(far, 999)
    to.close()
