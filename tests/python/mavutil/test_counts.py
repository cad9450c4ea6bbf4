# SPDX-License-Identifier: MIT
"""The counters and the state of connections of mavloom.mavutil, against pymavlink's on the same bytes."""
import copy
import os
import pickle
import struct

import pytest

import mavloom
from mavloom import mavutil
from tlogs import packer
from vehicles import Vehicle

DEADLINE_S = 60
T_US = 1_700_000_000_000_000
KEY = bytes(range(32))


@pytest.fixture(params=["pymavlink", "mavloom"])
def module(request, their_mavutil):
    return mavutil if request.param == "mavloom" else their_mavutil


def write_log(path, frames):
    path.write_bytes(b"".join(struct.pack(">Q", T_US + 1000 * i) + bytes(frame) for i, frame in enumerate(frames)))
    return str(path)


def three_frames(peer):
    sender = packer(peer)
    battery = peer.MAVLink_battery_status_message
    return [sender.pack(m) for m in (peer.MAVLink_heartbeat_message(2, 3, 81, 4, 4, 3),
                                     battery(0, 0, 0, 200, [1] * 10, 1, 1, 1, 50),
                                     battery(1, 0, 0, 200, [1] * 10, 1, 1, 1, 50))]


# ---- totals

def damaged(frame):
    return frame[:-1] + bytes([frame[-1] ^ 1])


@pytest.mark.parametrize("hooked", [False, True])
def test_the_totals_of_a_recording(hooked, module, peer, tmp_path):
    frames = three_frames(peer)
    frames[1] = damaged(frames[1])
    log = module.mavlogfile(write_log(tmp_path / "x.tlog", frames))
    if hooked:
        log.message_hooks.append(lambda connection, message: None)
    assert len(list(iter(log.recv_msg, None))) == 3
    totals = log.mav.total_packets_received, log.mav.total_bytes_received, log.mav.total_receive_errors
    assert totals == (3, sum(map(len, frames)), 1)
    log.mav.total_packets_received = log.mav.total_bytes_received = 0
    assert (log.mav.total_packets_received, log.mav.total_bytes_received) == (0, 0)


def test_the_totals_of_a_file_without_times(module, peer, tmp_path):
    frames = three_frames(peer)
    path = tmp_path / "x.raw"
    path.write_bytes(b"".join([frames[0], b"xyz", *frames[1:]]))
    log = module.mavlink_connection(str(path), notimestamps=True)
    assert len(list(iter(log.recv_msg, None))) == 4
    assert (log.mav.total_packets_received, log.mav.total_bytes_received) == (4, path.stat().st_size)
    assert log.mav.total_receive_errors == 1


def test_the_totals_of_a_live_connection(module, peer):
    connection = module.mavlink_connection("udpin:127.0.0.1:0")
    vehicle = Vehicle(peer, connection.port.getsockname()[1])
    frames = three_frames(peer)
    for frame in frames:
        vehicle.socket.send(frame)
    for _ in frames:
        assert connection.recv_match(blocking=True, timeout=DEADLINE_S) is not None
    totals = connection.mav.total_packets_received, connection.mav.total_bytes_received
    connection.port.close()
    assert totals == (3, sum(map(len, frames)))


# ---- signatures

def signed(peer, *messages):
    sender = packer(peer)
    sender.mav.signing.secret_key, sender.mav.signing.sign_outgoing, sender.mav.signing.timestamp = KEY, True, 2**40
    return [sender.pack(message) for message in messages]


def signing_counts(mav):
    signing = mav.signing
    return (signing.sig_count, signing.goodsig_count, signing.badsig_count, signing.unsigned_count,
            signing.reject_count, mav.total_receive_errors, mav.total_packets_received)


@pytest.mark.parametrize("key", [None, KEY, bytes(32)])
def test_signatures_are_counted_as_by_pymavlink(key, peer):
    beat, attitude = peer.MAVLink_heartbeat_message(2, 3, 81, 4, 4, 3), peer.MAVLink_attitude_message(*[0] * 7)
    stream = [*signed(peer, beat, attitude), packer(peer).pack(beat), packer(peer).pack(attitude)]
    found = []
    for module in (peer, mavutil.mavlink):
        mav = module.MAVLink(None, 1, 1)
        mav.robust_parsing = True
        mav.signing.secret_key = key
        mav.signing.allow_unsigned_callback = lambda mav, message_id: message_id == 0
        types = [message.get_type() for frame in stream for message in mav.parse_buffer(frame)]
        found.append((types, signing_counts(mav)))
    assert found[0] == found[1]


def test_sent_signatures_are_not_counted(peer):
    for module in (peer, mavutil.mavlink):
        mav = module.MAVLink(type("File", (), {"write": lambda self, buf: None})(), 1, 1)
        mav.signing.secret_key, mav.signing.sign_outgoing, mav.protocol_marker = KEY, True, 0xfd
        mav.heartbeat_send(2, 3, 81, 4, 4, 3)
        assert (mav.total_packets_sent, mav.signing.sig_count) == (1, 0)


# ---- messages that a program posts

def test_a_message_is_noted_once(module, peer, tmp_path):
    """As by programs that call post_message() with what recv_msg() has returned."""
    log, hooked = module.mavlogfile(write_log(tmp_path / "x.tlog", three_frames(peer))), []
    log.message_hooks.append(lambda connection, message: hooked.append(message.get_type()))
    message = log.recv_msg()
    for _ in range(2):
        log.post_message(message)
    assert (log.mav_count, log.mav_loss, hooked) == (1, 0, ["HEARTBEAT"])


def test_a_message_that_the_program_made_is_among_those_of_system_0(module, peer, tmp_path):
    log = module.mavlogfile(write_log(tmp_path / "x.tlog", three_frames(peer)))
    made = module.mavlink
    for message in (made.MAVLink_attitude_message(7, 1, 0, 0, 0, 0, 0),
                    made.MAVLink_battery_status_message(3, 0, 0, 200, [1] * 10, 1, 1, 1, 50),
                    made.MAVLink_heartbeat_message(2, 3, 81, 4, 4, 3)):
        log.post_message(message)
    messages = log.sysid_state[0].messages
    assert messages["ATTITUDE"].time_boot_ms == 7 and messages["BATTERY_STATUS[3]"].id == 3
    assert messages["BATTERY_STATUS"][3].current_battery == 1 and "HEARTBEAT" in messages
    assert (log.mav_count, log.target_system, log.flightmode) == (3, 0, "GUIDED")


# ---- instances

SECOND = "BATTERY_STATUS[1].battery_remaining > 0"


@pytest.mark.parametrize("opened", ["mavlogfile", "mavmmaplog"])
def test_a_condition_on_an_instance_is_false_until_it_has_arrived(opened, module, peer, tmp_path):
    log = getattr(module, opened)(write_log(tmp_path / "x.tlog", three_frames(peer)))
    found = iter(lambda: log.recv_match(type="BATTERY_STATUS", condition=SECOND), None)
    assert [message.id for message in found] == [1]


def test_an_index_that_is_too_large_gives_none(module):
    assert module.evaluate_expression("x[9] > 1", {"x": [1]}) is None
    assert module.evaluate_condition("x[9] > 1", {"x": [1]}) is False


# ---- times

@pytest.mark.parametrize("make, uptime", [
    (lambda peer: peer.MAVLink_system_time_message(1, 7000), 7.0),
    (lambda peer: peer.MAVLink_named_value_int_message(2500, b"x", 1), 2.5),
    (lambda peer: peer.MAVLink_vision_position_estimate_message(4_000_000, 0, 0, 0, 0, 0, 0), 4.0),
    (lambda peer: peer.MAVLink_heartbeat_message(2, 3, 81, 4, 4, 3), 0.0)])
def test_the_uptime_is_read_wherever_the_clock_is_in_a_message(make, uptime, module, peer, tmp_path):
    log = module.mavlogfile(write_log(tmp_path / "x.tlog", [packer(peer).pack(make(peer))]))
    log.recv_msg()
    assert log.uptime == uptime


def pickled(message):
    return pickle.loads(pickle.dumps(message))


def copied_by(module):  # pickle does not find the module that pymavlink's generator made
    return (copy.copy, copy.deepcopy, pickled) if module is mavutil else (copy.copy, copy.deepcopy)


def test_bad_data_keeps_its_time_and_attributes_when_it_is_copied(module, peer, tmp_path):
    log = module.mavlogfile(write_log(tmp_path / "x.tlog", [*three_frames(peer), damaged(three_frames(peer)[0])]))
    bad = log.recv_match(type="BAD_DATA")
    bad.seen = 5
    for made in [copied(bad) for copied in copied_by(module)]:
        assert (made.get_type(), made.data, made.reason, made.seen) == ("BAD_DATA", bad.data, bad.reason, 5)
        assert made._timestamp == bad._timestamp == (T_US + 3000) * 1e-6


# ---- files without times

def attitudes(peer, count):
    sender = packer(peer)
    return b"".join(sender.pack(peer.MAVLink_attitude_message(i, 0, 0, 0, 0, 0, 0)) for i in range(count))


def test_a_file_without_times_is_read_again_from_its_first_byte(peer, tmp_path):
    (tmp_path / "x.raw").write_bytes(attitudes(peer, 3000))  # more than is read at once
    log = mavutil.mavlink_connection(str(tmp_path / "x.raw"), notimestamps=True)
    for _ in range(2):
        assert [log.recv_msg().time_boot_ms for _ in range(2000)] == list(range(2000))
        log.rewind()
    assert log.recv_msg().time_boot_ms == 0 and log.mav.total_receive_errors == 0


def test_a_file_without_times_changes_the_version(module, peer, tmp_path):
    (tmp_path / "x.raw").write_bytes(attitudes(peer, 1))
    log = module.mavlink_connection(str(tmp_path / "x.raw"), notimestamps=True)
    log.recv_msg()
    assert log.mavlink20()


def test_a_file_without_times_is_closed(peer, tmp_path):
    (tmp_path / "x.raw").write_bytes(attitudes(peer, 3))
    log = mavutil.mavlink_connection(str(tmp_path / "x.raw"), notimestamps=True)
    log.recv_msg()
    log.close()
    descriptors = [os.path.realpath(f"/proc/self/fd/{fd}") for fd in os.listdir("/proc/self/fd")]
    assert str(tmp_path / "x.raw") not in descriptors
    with pytest.raises(mavloom.ClosedError, match="the recording is closed"):
        log.recv_msg()
