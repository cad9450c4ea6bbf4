# SPDX-License-Identifier: MIT
"""Connections of mavloom.mavutil, against pymavlink's on the same bytes."""
import os
import select
import socket
import struct
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import mavloom
from autopilot import Autopilot, Settings
from mavloom import mavutil
from tlogs import frames_of, packer, record
from vehicles import Vehicle, until

DEADLINE_S = 60
T_US = 1_700_000_000_000_000


def write_log(path, frames):
    path.write_bytes(b"".join(struct.pack(">Q", T_US + 1001 * i) + bytes(frame) for i, frame in enumerate(frames)))
    return str(path)


def busy_log(peer, path):
    """Two vehicles, a ground station, a gimbal, batteries, names, parameters, GPS, loss and a duplicate."""
    one, two, station, gimbal = (packer(peer, *source) for source in ((1, 1), (2, 1), (255, 190), (1, 154)))
    beat = peer.MAVLink_heartbeat_message
    battery = lambda i: peer.MAVLink_battery_status_message(i, 0, 0, 0, [1] * 10, 1, 2, 3, 4)  # noqa: E731
    gps = lambda fix, lat: peer.MAVLink_gps_raw_int_message(1, fix, lat, 2, 3, 4, 5, 6, 7, 8)  # noqa: E731
    attitude = lambda t: peer.MAVLink_attitude_message(t, 0.1 * t, 0, 0, 0, 0, 0)  # noqa: E731
    frames = [station.pack(beat(6, 8, 0, 0, 4, 3)), one.pack(attitude(1)), one.pack(gps(1, 5)), two.pack(attitude(9)),
              one.pack(beat(2, 3, 81, 5, 4, 3)), gimbal.pack(beat(26, 8, 0, 0, 4, 3)), one.pack(gps(3, 6)),
              one.pack(battery(1)), one.pack(battery(0)), one.pack(gps(3, 7)),
              one.pack(peer.MAVLink_named_value_float_message(1, b"speed", 1.5)),
              two.pack(beat(1, 12, 157, 0x04040000, 4, 3)),
              one.pack(peer.MAVLink_param_value_message(b"P", 1.5, 9, 1, 0)),
              one.pack(attitude(2)), one.pack(beat(2, 3, 209, 4, 4, 3))]
    frames.append(frames[-1])
    one.mav.seq += 5
    return write_log(path, [*frames, one.pack(attitude(3)), two.pack(attitude(4)), one.pack(battery(1))])


def state_of(log):
    return (log.target_system, log.target_component, log.flightmode, log.mav_type, log.base_mode, log.mav_count,
            log.mav_loss, dict(sorted(log.last_seq.items())), log.uptime, log.timestamp, log.motors_armed(),
            round(log.packet_loss(), 9), list(log.messages),
            # pymavlink has the first battery in the place of the second one, until it has read both.
            {key: str(value) for key, value in log.messages.items() if key != "MAV" and "BATTERY" not in key},
            {system: (state.flightmode, state.armed, state.mav_type) for system, state in log.sysid_state.items()},
            log.params, log.percent)


# ---- recordings

def test_a_recording_is_read_as_pymavlink_reads_it(peer, their_mavutil, tmp_path):
    path = busy_log(peer, tmp_path / "x.tlog")
    theirs, ours = their_mavutil.mavlink_connection(path), mavutil.mavlink_connection(path)
    assert state_of(ours)[:-1] == state_of(theirs)[:-1]  # percent is of no message yet
    assert (ours.name_to_id, ours.id_to_name) == (theirs.name_to_id, theirs.id_to_name)
    while True:
        their, our = theirs.recv_msg(), ours.recv_msg()
        if their is None:
            break
        assert (str(our), our._timestamp, our._link, our.get_msgbuf()) == (
            str(their), their._timestamp, their._link, their.get_msgbuf())
        assert state_of(ours) == state_of(theirs)
    assert our is None and ours.percent == 100
    assert ours.flightmode_list() == theirs.flightmode_list()


@pytest.mark.parametrize("reads", [0, 5, 100])
def test_the_list_of_flight_modes_reads_the_whole_recording_and_rewinds_it(reads, peer, their_mavutil, tmp_path):
    path, found = busy_log(peer, tmp_path / "x.tlog"), []
    for module in (their_mavutil, mavutil):
        log = module.mavlink_connection(path)
        for _ in range(reads):
            log.recv_msg()
        found.append((log._count, log.flightmode_list(), dict(log.params), log.flightmode, str(log.recv_match()),
                      log.flightmode_list(), str(log.recv_match())))
    assert found[0] == found[1] and found[1][2] == {"P": 1.5}


def test_counters_and_times_can_be_set(peer, their_mavutil, tmp_path):
    path, found = busy_log(peer, tmp_path / "x.tlog"), []
    for module in (their_mavutil, mavutil):
        log, states = module.mavlogfile(path), []
        for number in range(19):
            log.recv_msg()
            if number == 8:
                log.mav_loss = log.mav_count = 0
                log.timestamp = 5.0
                states.append(log.timestamp)
            states.append((log.mav_count, log.mav_loss, round(log.packet_loss(), 9)))
        found.append([*states, log.timestamp])
    assert found[0] == found[1] and 5.0 in found[1]


def test_the_target_of_parameters(peer, their_mavutil, tmp_path):
    path, found = busy_log(peer, tmp_path / "x.tlog"), []
    for module in (their_mavutil, mavutil):
        log = module.mavlogfile(path)
        log.recv_match(type="PARAM_VALUE")
        states = [(log.param_sysid, log.sysid)]
        for name, value in (("target_component", 3), ("target_system", 7), ("target_component", 1), ("sysid", 1)):
            setattr(log, name, value)
            states.append((log.param_sysid[1], log.sysid, log.target_system, log.target_component))
        found.append(states)
    assert found[0] == found[1]


def test_messages_are_added_to_a_dictionary_with_their_instances(peer, their_mavutil, tmp_path):
    path, found = busy_log(peer, tmp_path / "x.tlog"), []
    for module in (their_mavutil, mavutil):
        log, messages = module.mavlogfile(path), {}
        while (message := log.recv_msg()) is not None:
            module.add_message(messages, message.get_type(), message)
        battery = messages["BATTERY_STATUS"]
        found.append(({key: str(message) for key, message in messages.items()}, str(battery[0]), str(battery[1]),
                      messages["NAMED_VALUE_FLOAT"]["speed"].value))
    assert found[0] == found[1] and "BATTERY_STATUS[1]" in found[1][0]


def test_ids_of_numpy(peer, tmp_path):
    log = mavutil.mavlink_connection(busy_log(peer, tmp_path / "x.tlog"), source_system=np.uint8(7),
                                     source_component=np.int64(8))
    log.target_system = np.uint8(2)
    assert (log.mav.srcSystem, log.mav.srcComponent, log.target_system) == (7, 8, 2)
    assert {type(number) for number in (log.source_system, log.target_system)} == {int}


def test_the_version_is_that_of_the_environment(peer, their_mavutil, tmp_path):
    path, found = busy_log(peer, tmp_path / "x.tlog"), []
    for module in (their_mavutil, mavutil):
        os.environ.pop("MAVLINK20", None)
        module.set_dialect("ardupilotmega")
        states = [(module.mavlink10(), module.mavlink20())]
        module.mavlink_connection(path).recv_msg()
        states.append((module.mavlink10(), module.mavlink20(), os.environ.get("MAVLINK20")))
        module.set_dialect("ardupilotmega")
        states.append(module.mavlink.WIRE_PROTOCOL_VERSION)
        os.environ.pop("MAVLINK20", None)
        module.set_dialect("ardupilotmega")
        found.append([*states, module.mavlink.WIRE_PROTOCOL_VERSION])
    assert found[0] == found[1] == [(True, False), (True, True, "1"), "2.0", "1.0"]


def test_the_addresses_of_tcp(their_mavutil):
    with socket.create_server(("127.0.0.1", 0)) as server:
        device = f"tcp:127.0.0.1:{server.getsockname()[1]}"
        theirs, ours = their_mavutil.mavlink_connection(device), mavutil.mavlink_connection(device)
        assert ours.address == theirs.address == device
        theirs.close()
        ours.close()
    with mavutil.mavlink_connection("tcpin:127.0.0.1:0") as server:
        assert server.address == "tcpin:127.0.0.1:0"


@pytest.mark.parametrize("selection", [
    {"type": "ATTITUDE"}, {"type": ["HEARTBEAT", "PARM"]}, {"type": {"BATTERY_STATUS"}},
    {"condition": "ATTITUDE.roll>0.15"}, {"type": "HEARTBEAT", "condition": "HEARTBEAT.custom_mode==4"},
    {"condition": "MAV.flightmode=='GUIDED'"}, {"condition": "HOME.lat==6 and MAV.armed"}, {"type": "MODE"},
    {"condition": "NO_SUCH.field>1"}, {"type": ["ATTITUDE"], "condition": "ATTITUDE.time_boot_ms in (2,4)"}])
def test_messages_are_selected_as_by_pymavlink(selection, peer, their_mavutil, tmp_path):
    path = busy_log(peer, tmp_path / "x.tlog")
    found = []
    for module in (their_mavutil, mavutil):
        log = module.mavlink_connection(path)
        found.append([str(message) for message in iter(lambda: log.recv_match(**selection), None)])
    assert found[0] == found[1]


def test_a_program_may_set_any_attribute_of_a_message(peer, tmp_path):
    battery = peer.MAVLink_battery_status_message
    frames = [packer(peer).pack(battery(i, 0, 0, 0, [1] * 10, 1, 2, 3, 4)) for i in (0, 1)]
    log = mavutil.mavlogfile(write_log(tmp_path / "x.tlog", frames))
    log.recv_msg()._instances = [1]
    assert log.recv_msg()[1].id == 1 and "BATTERY_STATUS[1]" in log.sysid_state[1].messages


def test_each_call_has_its_own_filter(flight):
    """In pymavlink the types of the first call stay in force, and messages are skipped."""
    log = mavutil.mavlink_connection(str(flight))
    for name in ("ATTITUDE", "SYS_STATUS", "ATTITUDE", "HEARTBEAT"):
        assert log.recv_match(type=name).get_type() == name
    log.rewind()
    assert log.recv_msg() is not None and log.percent == 0


def test_hooks_and_callbacks_see_every_message(peer, tmp_path):
    log = mavutil.mavlink_connection(busy_log(peer, tmp_path / "x.tlog"))
    hooked, called = [], []
    log.message_hooks.append(lambda conn, message: hooked.append((conn is log, message.get_type())))
    log.mav.set_callback(lambda message, *args, **more: called.append((args, more)), 5, six=6)
    while log.recv_match(type="BATTERY_STATUS") is not None:
        pass
    assert len(hooked) == len(called) == 19 and hooked[0] == (True, "HEARTBEAT") and called[0] == ((5,), {"six": 6})


def test_a_damaged_recording_gives_bad_data_with_its_reason(flight, their_mavutil, tmp_path):
    frames = [frame for _, frame in frames_of(flight)][:50]
    frames[7] = frames[7][:15] + bytes([frames[7][15] ^ 1]) + frames[7][16:]
    path = write_log(tmp_path / "x.tlog", frames)
    found = []
    for module in (their_mavutil, mavutil):
        log = module.mavlink_connection(path)
        found.append([(m.get_type(), str(m), bytes(m.get_msgbuf()), m._timestamp) for m in iter(log.recv_msg, None)])
    assert found[0] == found[1]
    assert [one[0] for one in found[1]].index("BAD_DATA") == 7


def test_junk_between_records_and_a_cut_end(peer, tmp_path):
    good = [packer(peer).pack(peer.MAVLink_attitude_message(i, 0, 0, 0, 0, 0, 0)) for i in range(2)]
    path = tmp_path / "x.tlog"
    time_of = lambda i: struct.pack(">Q", T_US + i)  # noqa: E731
    path.write_bytes(time_of(0) + good[0] + b"hello world" + time_of(1) + good[1] + time_of(2) + good[0][:9])
    found = list(iter(mavutil.mavlink_connection(str(path)).recv_msg, None))
    assert [m.get_type() for m in found] == ["ATTITUDE", "BAD_DATA", "ATTITUDE"]
    assert (bytes(found[1].data), found[1].reason) == (b"hello world", "Bad prefix")


def test_a_recording_that_grows_is_followed(peer, their_mavutil, tmp_path):
    records = [record(packer(peer).pack(peer.MAVLink_attitude_message(i, 0, 0, 0, 0, 0, 0)), i) for i in range(30)]
    path = tmp_path / "x.tlog"
    cuts = [b"".join(records[:10]), b"".join(records[10:15]) + records[15][:20], records[15][20:] + records[16]]
    found = []
    for module in (their_mavutil, mavutil):
        path.write_bytes(b"")
        log, numbers = module.mavlogfile(str(path)), []
        for part in cuts[:1] if module is their_mavutil else cuts:  # pymavlink loses the record that was cut
            with path.open("ab") as out:
                out.write(part)
            numbers.append([m.time_boot_ms for m in iter(log.recv_msg, None)])
        found.append(numbers)
    assert found[0] == found[1][:1] and found[1] == [[*range(10)], [*range(10, 15)], [15, 16]]
    for part, kinds in ((b"hello world", ["BAD_DATA"]), (records[18], ["ATTITUDE"])):
        path.write_bytes(path.read_bytes() + part)
        assert [m.get_type() for m in iter(log.recv_msg, None)] == kinds
    log.stop_on_EOF = False
    threading.Timer(0.1, lambda: path.write_bytes(path.read_bytes() + records[17])).start()
    assert log.recv_match(type="ATTITUDE", blocking=True, timeout=DEADLINE_S).time_boot_ms == 17
    assert log.recv_match(type="ATTITUDE", blocking=True, timeout=0.1) is None and log.recv_match() is None


def test_a_file_without_times(peer, their_mavutil, tmp_path):
    frames = [packer(peer).pack(peer.MAVLink_attitude_message(i * 100, 0, 0, 0, 0, 0, 0)) for i in range(5)]
    path = tmp_path / "x.raw"
    path.write_bytes(b"".join([*frames[:3], b"xyz", *frames[3:]]))
    found = []
    for module in (their_mavutil, mavutil):
        log = module.mavlink_connection(str(path), notimestamps=True)
        found.append([str(m) for m in iter(log.recv_msg, None)])
    assert found[0] == found[1] and len(found[0]) == 6
    with pytest.raises(mavloom.InputError, match="is a MAVLink stream without times"):
        mavutil.mavlink_connection(str(path))


def test_a_recording_is_written(peer, tmp_path):
    path = tmp_path / "raw"
    log = mavutil.mavlogfile(path, write=True)
    log.mav.heartbeat_send(1, 2, 3, 4, 5)
    log.close()
    log = mavutil.mavlogfile(path, append=True)
    log.mav.heartbeat_send(1, 2, 3, 4, 5)
    with pytest.raises(mavloom.UsageError, match="is being written"):
        log.recv_msg()
    log.close()
    assert [m.get_type() for m in peer.MAVLink(None).parse_buffer(path.read_bytes())] == ["HEARTBEAT"] * 2


@pytest.mark.parametrize("name, start, text", [
    ("flight.bin", b"\xa3\x95\x80\x80\x59", "a DataFlash log of ArduPilot, not a tlog: read it with pymavlink"),
    ("flight.ulg", b"ULog\x01\x12\x35\x01", "a ULog of PX4, not a tlog: read it with pyulog"),
    ("flight.tlog.gz", b"\x1f\x8b\x08\0\0\0", "a gzip file, not a tlog: unpack it first, with gunzip"),
    ("flight.pcap", b"\xd4\xc3\xb2\xa1\2\0", "a pcap capture, not a tlog: extract the UDP payloads")])
def test_other_kinds_of_logs_are_refused_by_name(name, start, text, tmp_path):
    path = tmp_path / name
    path.write_bytes(start + bytes(100))
    for call in (mavutil.mavlink_connection, mavloom.read, mavloom.tables,
                 lambda file: mavloom.columns(file, "ATTITUDE")):
        with pytest.raises(mavloom.InputError, match=text):
            call(str(path))


# ---- live connections

def speaker(connection, peer, **source):
    return Vehicle(peer, connection.link.port, **source)


def test_the_first_version_2_message_changes_what_is_sent(peer):
    """As in pymavlink: MAVLink 1 until the vehicle speaks MAVLink 2, then sequence numbers begin again."""
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0")
    assert (connection.WIRE_PROTOCOL_VERSION, mavutil.mavlink.WIRE_PROTOCOL_VERSION) == ("1.0", "1.0")
    vehicle = speaker(connection, peer)
    vehicle.socket.send(bytes(vehicle.heartbeat().pack(vehicle.sender.mav, force_mavlink1=True)))
    assert connection.wait_heartbeat(timeout=DEADLINE_S) is not None and not connection.mavlink20()
    connection.mav.heartbeat_send(6, 8, 0, 0, 0)
    assert vehicle.socket.recv(999)[0] == 0xfe
    vehicle.send(vehicle.heartbeat())
    assert connection.wait_heartbeat(timeout=DEADLINE_S) is not None and connection.mavlink20()
    assert mavutil.mavlink.WIRE_PROTOCOL_VERSION == "2.0"
    connection.mav.heartbeat_send(6, 8, 0, 0, 0)
    frame = vehicle.socket.recv(999)
    assert (frame[0], frame[4], frame[5], frame[6]) == (0xfd, 0, 255, 0)
    connection.close()


def test_version_1_messages_have_no_extension_fields(peer, peer_v1, tmp_path):
    v1 = packer(peer_v1).pack(peer_v1.MAVLink_gps_raw_int_message(1, 3, 2, 2, 3, 4, 5, 6, 7, 8))
    v2 = packer(peer).pack(peer.MAVLink_gps_raw_int_message(1, 3, 2, 2, 3, 4, 5, 6, 7, 8, 99))
    first, second = iter(mavutil.mavlink_connection(write_log(tmp_path / "x.tlog", [v1, v2])).recv_msg, None)
    assert "alt_ellipsoid" not in first.to_dict() and first.alt_ellipsoid == 0
    assert second.to_dict()["alt_ellipsoid"] == 99


def test_a_source_that_was_set_stays_when_the_vehicle_speaks_version_2(peer):
    """pymavlink sends with the first source again."""
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0")
    connection.mav.srcSystem, connection.mav.srcComponent = 42, 43
    vehicle = speaker(connection, peer)
    vehicle.send(vehicle.heartbeat())
    assert connection.wait_heartbeat(timeout=DEADLINE_S) is not None and connection.mavlink20()
    connection.mav.heartbeat_send(6, 8, 0, 0, 0)
    assert tuple(vehicle.socket.recv(999)[5:7]) == (42, 43)
    connection.close()


def test_source_and_sequence_change_what_is_sent(peer):
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0", source_system=7, source_component=8)
    vehicle = speaker(connection, peer)
    vehicle.send(vehicle.heartbeat())
    connection.wait_heartbeat(timeout=DEADLINE_S)
    connection.mav.srcSystem, connection.mav.srcComponent, connection.mav.seq = 42, 43, 200
    for _ in range(2):
        connection.mav.heartbeat_send(6, 8, 0, 0, 0)
    frames = [vehicle.socket.recv(999) for _ in range(2)]
    assert [tuple(frame[4:7]) for frame in frames] == [(200, 42, 43), (201, 42, 43)]
    assert connection.mav.seq == 202 and connection.mav.total_packets_sent == 2
    connection.close()


def test_timeouts_hold(peer):
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0")
    assert connection.recv_match(type="HEARTBEAT", blocking=True, timeout=0.2) is None
    assert connection.wait_heartbeat(timeout=0.1) is None
    assert connection.recv_match(type="HEARTBEAT") is None and connection.recv_msg() is None
    assert connection.recv_match(type="HEARTBEAT", timeout=3600) is None  # only `blocking` makes it wait
    vehicle = speaker(connection, peer)
    threading.Timer(0.1, lambda: vehicle.send(vehicle.heartbeat())).start()
    assert connection.wait_heartbeat(timeout=DEADLINE_S) is not None  # the call does not end before
    idle = []
    connection.idle_hooks.append(idle.append)
    assert connection.recv_match(blocking=True, timeout=0.2) is None
    assert idle and idle[0] is connection
    connection.close()


def test_a_timeout_holds_while_other_messages_arrive(peer):
    connection, seen = mavutil.mavlink_connection("udpin:127.0.0.1:0"), []
    vehicle = speaker(connection, peer)

    def send_another(*_):
        seen.append(1)
        assert len(seen) < 100_000, "the time-out does not hold"
        vehicle.send(vehicle.attitude(1))
        until(lambda: connection.link.stats.frames_in > len(seen))  # so the next read finds it
    vehicle.send(vehicle.attitude(0))
    until(lambda: connection.link.stats.frames_in == 1)
    connection.message_hooks.append(send_another)
    assert connection.recv_match(type="HEARTBEAT", blocking=True, timeout=0.1) is None
    assert seen
    connection.close()


def test_a_timeout_of_zero_looks_at_all_messages_that_wait(peer):
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0")
    vehicle = speaker(connection, peer)
    vehicle.send(*(vehicle.attitude(i) for i in range(100)), vehicle.heartbeat())
    until(lambda: connection.link.stats.frames_in == 101)
    assert connection.recv_match(type="HEARTBEAT", blocking=True, timeout=0) is not None
    connection.close()


def test_a_name_typed_wrong_does_not_wait_for_ever():
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0")
    with pytest.raises(mavloom.UsageError, match="type='ATITUDE': no such message, so this call would wait forever"):
        connection.recv_match(type="ATITUDE", blocking=True)
    assert connection.recv_match(type="ATITUDE", blocking=True, timeout=0.01) is None
    assert connection.recv_match(type="ATITUDE") is None
    connection.close()


def test_the_descriptor_wakes_select(peer):
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0")
    vehicle = speaker(connection, peer)
    for count in range(1, 4):
        threading.Timer(0.05, lambda: vehicle.send(*[vehicle.heartbeat()] * 3)).start()
        found, end = 0, time.monotonic() + DEADLINE_S
        while found < 3 and time.monotonic() < end:
            select.select([connection.fd], [], [], 1)
            while connection.recv_msg() is not None:
                found += 1
        assert found == 3
        assert not connection.select(0.01)
    connection.close()


def test_a_program_may_read_one_message_each_time_the_descriptor_is_readable(peer):
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0")
    vehicle = speaker(connection, peer)
    vehicle.send(*(vehicle.attitude(i) for i in range(5)))
    until(lambda: connection.link.stats.frames_in == 5)  # before the descriptor is first asked for
    sender = threading.Thread(target=lambda: [vehicle.send(vehicle.attitude(i)) for i in range(5, 3000)])
    sender.start()
    found = []
    while len(found) < 3000:
        assert select.select([connection.fd], [], [], DEADLINE_S)[0]
        if (message := connection.recv_msg()) is not None:
            found.append(message.time_boot_ms)
    sender.join()
    assert found == list(range(3000))
    connection.close()


def test_a_program_may_parse_and_post_messages_itself(peer):
    """As MAVProxy does."""
    connection, called, hooked = mavutil.mavlink_connection("udpin:127.0.0.1:0"), [], []
    connection.mav.set_callback(lambda message: called.append(message.get_type()))
    connection.message_hooks.append(lambda conn, message: hooked.append((message.get_type(), conn.flightmode)))
    vehicle = speaker(connection, peer)
    vehicle.send(vehicle.heartbeat(autopilot=3), vehicle.attitude(1))
    until(lambda: connection.link.stats.frames_in == 2)
    data = connection.recv(16 * 1024)
    assert connection.first_byte
    connection.auto_mavlink_version(data)
    assert not connection.first_byte and connection.mavlink20()
    for message in connection.mav.parse_buffer(data):
        connection.post_message(message)
    assert called == ["HEARTBEAT", "ATTITUDE"] and [name for name, _ in hooked] == called
    assert connection.messages["ATTITUDE"].time_boot_ms == 1 and connection.recv(16 * 1024) == b""
    connection.close()


@pytest.mark.parametrize("device, text", [
    ("unix:/run/x", "no Unix stream sockets here"), ("ws:0.0.0.0", "WebSocket ports must be given as host:port"),
    ("csv:x.csv", "CSV files are not read here: use pymavlink's CSVReader"),
    ("x.px4log", "old logs of PX4 are not read here: use pymavlink's DFReader"),
    ("wss:example.org:443", "there is no TLS here: use ws:HOST:PORT to a proxy"),
    ("uds:/run/x", "there are no Unix stream sockets here"), ("sim.elf", "programs are not started here"),
    ("udpin:127.0.0.1", "UDP ports must be given as host:port"), ("tcp:x", "TCP ports must be given as host:port"),
    ("udpin:127.0.0.1:99999", "'99999' is not a port"), ("udpin:h:abc", "'abc' is not a port"),
    ("/dev/ttyX,fast", "/dev/NAME or /dev/NAME,BAUD"), ("", "for example 'udpin:0.0.0.0:14550'")])
def test_strings_without_a_meaning_are_refused_by_name(device, text):
    with pytest.raises(mavloom.UsageError, match=text):
        mavutil.mavlink_connection(device)


def test_a_name_that_is_neither_a_file_nor_a_device():
    for name in ("flight", "COM3", "missing.tlog", "/dev/ttyNOSUCH"):
        with pytest.raises(FileNotFoundError, match=name):
            mavutil.mavlink_connection(name)


def test_keywords(recwarn):
    with pytest.raises(mavloom.UsageError, match="no dialect 'nosuch'"):
        mavutil.mavlink_connection("udpin:127.0.0.1:0", dialect="nosuch")
    with pytest.raises(mavloom.UsageError, match="source_system: 300 is out of range"):
        mavutil.mavlink_connection("udpin:127.0.0.1:0", source_system=300)
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0", baud=57600, autoreconnect=True, robust_parsing=False,
                                            dialect="ardupilotmega", use_native=True, retries=1, force_connected=True,
                                            udp_timeout=5, reconnect_delay=2, notimestamps=False, zero_time_base=True)
    connection.close()
    assert not recwarn
    with pytest.warns(UserWarning, match="has no keyword 'colour'; it is ignored, as by pymavlink"):
        mavutil.mavlink_connection("udpin:127.0.0.1:0", colour=5).close()


@pytest.mark.parametrize("name, text", [
    ("reconnect", "the link's own thread connects"), ("skip_to_type", "recordings are read in C\\+\\+"),
    ("data_map", "recordings are read in C\\+\\+"), ("destination_addr", "use udpout:HOST:PORT"),
    ("no_such", "'mavudp' object has no attribute 'no_such'")])
def test_attributes_without_a_meaning_name_what_to_use(name, text):
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0")
    with pytest.raises(AttributeError, match=text):
        getattr(connection, name)
    with pytest.raises(AttributeError, match="a connection's port has no baudrate"):
        connection.port.baudrate
    assert connection.port.getsockname() == ("127.0.0.1", connection.link.port)
    connection.close()


@pytest.mark.parametrize("name, text", [
    ("mavuds", "use tcp:HOST:PORT"),
    ("mavchildexec", "start the program yourself"), ("MavlinkSerialPort", "SERIAL_CONTROL"),
    ("no_such", "has no attribute 'no_such'")])
def test_names_of_the_module_without_a_meaning_name_what_to_use(name, text):
    assert not hasattr(mavutil, name)
    with pytest.raises(AttributeError, match=text):
        getattr(mavutil, name)


def test_only_whole_frames_are_sent(peer):
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0")
    vehicle = speaker(connection, peer)
    vehicle.send(vehicle.heartbeat())
    connection.wait_heartbeat(timeout=DEADLINE_S)
    frames = [packer(peer, 9, 9).pack(vehicle.attitude(i)) for i in range(2)]
    connection.write(b"".join(frames))
    assert [vehicle.socket.recv(999) for _ in frames] == frames
    with pytest.raises(mavloom.UsageError, match=r"sends whole MAVLink frames, not b'reboot -b"):
        connection.write(b"reboot -b\n")
    with pytest.raises(mavloom.InputError, match="wrong checksum"):
        connection.write(frames[0][:-1] + b"\0")
    connection.close()
    connection.mav.heartbeat_send(6, 8, 0, 0, 0)  # pymavlink ignores it too
    with pytest.raises(mavloom.ClosedError):
        connection.recv_msg()


def test_a_live_connection_is_recorded(peer, tmp_path):
    """pymavlink records nothing on UDP links."""
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0")
    connection.setup_logfile(tmp_path / "x.tlog")
    connection.setup_logfile_raw(tmp_path / "x.raw")
    vehicle = speaker(connection, peer)
    vehicle.send(*[vehicle.attitude(i) for i in range(5)])
    for _ in range(5):
        connection.recv_match(blocking=True, timeout=DEADLINE_S)
    connection.close()
    assert [m.time_boot_ms for m in mavloom.read(tmp_path / "x.tlog")] == list(range(5))
    assert len(mavloom.Parser().feed((tmp_path / "x.raw").read_bytes())) == 5


# ---- signing

KEY = bytes(range(32))


def test_signed_both_ways(peer, their_mavutil):
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0", source_system=255)
    connection.setup_signing(KEY, sign_outgoing=True, initial_timestamp=2**47, link_id=3)
    vehicle = speaker(connection, peer)
    vehicle.send(vehicle.heartbeat())  # unsigned
    message = connection.recv_match(type="BAD_DATA", blocking=True)
    assert (message.get_type(), message.reason) == ("BAD_DATA", "Invalid signature")
    assert connection.mav.signing.reject_count == 1
    signing = vehicle.sender.mav.signing
    signing.secret_key, signing.sign_outgoing, signing.timestamp, signing.link_id = KEY, True, 2**47, 5
    vehicle.send(vehicle.heartbeat())
    message = connection.recv_match(type="HEARTBEAT", blocking=True, timeout=DEADLINE_S)
    assert (message.get_signed(), message.get_link_id(), connection.mav.signing.goodsig_count) == (True, 5, 1)
    vehicle.socket.send(bytes(message.get_msgbuf()))  # a replay
    assert connection.recv_match(blocking=True, timeout=DEADLINE_S).get_type() == "BAD_DATA"

    connection.mav.heartbeat_send(6, 8, 0, 0, 0)
    receiver = peer.MAVLink(None)
    receiver.signing.secret_key = KEY
    (sent,) = receiver.parse_buffer(vehicle.socket.recv(999))
    assert (sent.get_type(), sent.get_signed(), sent.get_link_id()) == ("HEARTBEAT", True, 3)
    connection.disable_signing()
    connection.mav.heartbeat_send(6, 8, 0, 0, 0)
    assert vehicle.socket.recv(999)[2] == 0
    vehicle.sender.mav.signing.sign_outgoing = False
    vehicle.send(vehicle.heartbeat())
    assert connection.recv_match(blocking=True, timeout=DEADLINE_S).get_type() == "HEARTBEAT"
    connection.close()


def test_the_callback_lets_unsigned_messages_pass(peer):
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0")
    asked = []
    connection.setup_signing(KEY, allow_unsigned_callback=lambda mav, number: asked.append(number) or number == 30)
    vehicle = speaker(connection, peer)
    vehicle.send(vehicle.attitude(1), vehicle.heartbeat())
    assert [connection.recv_match(blocking=True, timeout=DEADLINE_S).get_type() for _ in range(2)] == ["ATTITUDE",
                                                                                                       "BAD_DATA"]
    assert asked == [30, 0]
    with pytest.raises(mavloom.UsageError, match="has 32 bytes, not 3"):
        connection.setup_signing(b"abc")
    connection.close()


# ---- services that the scripts do not call

def test_positions_and_modes(peer, capsys):
    connection = mavutil.mavlink_connection("udpin:127.0.0.1:0")
    with Autopilot(peer, Settings(), connect_to=("127.0.0.1", connection.link.port)) as stub:
        connection.wait_heartbeat(timeout=DEADLINE_S)
        connection.set_mode("NOPE")
        assert capsys.readouterr().out == "Unknown mode 'NOPE'\n"
        done = threading.Event()
        places = []
        thread = threading.Thread(target=lambda: (places.append(connection.location(relative_alt=True)), done.set()))
        thread.start()
        until(lambda: stub.fly() or done.is_set())
        thread.join()
        assert str(places[0]) == "lat=-35.363262,lon=149.165237,alt=10.5" and places[0].heading == 270
    connection.close()


def test_links_of_ours_and_several_vehicles(peer):
    connection = mavutil.mavlink_connection("udpin://127.0.0.1:0")
    one, two = (Vehicle(peer, connection.link.port, system=system) for system in (1, 2))
    one.send(one.heartbeat(2, 3))
    connection.wait_heartbeat(timeout=DEADLINE_S)
    two.send(two.heartbeat(1, 3), two.attitude(5, 0.5))
    connection.recv_match(type="ATTITUDE", blocking=True, timeout=DEADLINE_S)
    assert connection.target_system == 1 and "ATTITUDE" not in connection.messages
    connection.target_system = 2
    assert connection.messages["ATTITUDE"].roll == 0.5 and connection.mav_type == 1
    with pytest.raises(mavloom.UsageError, match="target_system: 256 is not a system id"):
        connection.target_system = 256
    connection.close()


def test_a_link_that_is_left_open_ends_quietly(child_environment):
    code = ("import os, sys\nfrom mavloom import mavutil\nimport mavloom\nmavloom._core.set_leak_warnings(True)\n"
            "c = mavutil.mavlink_connection('udpin:127.0.0.1:0'); c.mav.heartbeat_send(6, 8, 0, 0, 0)\n"
            "log = mavutil.mavlink_connection(sys.argv[1]); m = log.recv_match(type='BATTERY_STATUS'); print(m.id)\n")
    flight = os.path.join(os.path.dirname(__file__), "..", "..", "data", "px4_gcs_flight.tlog")
    done = subprocess.run([sys.executable, "-c", code, flight], env=child_environment, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "0\n", "")
