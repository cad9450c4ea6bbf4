# SPDX-License-Identifier: MIT
"""mavutil.mavlink, its messages and MAVLink, against the module that pymavlink's generator makes of our definitions."""
import copy
import fnmatch
import inspect
import io
import json
import math
import pickle
import random
import struct
import time
import weakref

import numpy as np
import pytest
from pymavlink import mavutil as theirs

import mavloom
import pymavlink_vectors as vectors
from mavloom import mavutil
from tlogs import packer


@pytest.fixture(scope="module")
def mavlink():
    return mavutil._current.module_of(mavloom.Dialect(), 2)


def same(ours, theirs):
    if isinstance(theirs, list):
        return len(ours) == len(theirs) and all(map(same, ours, theirs))
    return ours == theirs or isinstance(theirs, float) and math.isnan(theirs) and math.isnan(ours)


# ---- the module

def test_constants_are_those_of_pymavlink(mavlink, peer):
    wanted = {name: value for name, value in vars(peer).items() if isinstance(value, int) and not name.startswith("_")}
    assert len(wanted) > 3000
    assert {name: getattr(mavlink, name, None) for name in wanted} == wanted
    assert set(wanted) <= set(dir(mavlink))


def test_old_names_of_vehicle_types(mavlink):
    import pymavlink.dialects.v20.ardupilotmega as real
    types = {name: value for name, value in vars(real).items() if name.startswith("MAV_TYPE_VTOL_")}
    assert types["MAV_TYPE_VTOL_QUADROTOR"] == 20
    assert {name: getattr(mavlink, name, None) for name in types} == types


def test_the_old_name_of_items(mavlink):
    """pymavlink makes it when a connection is opened."""
    assert mavlink.MAVLink_waypoint_message is mavlink.MAVLink_mission_item_message


def test_enums_are_those_of_pymavlink(mavlink, peer):
    assert set(mavlink.enums) == set(peer.enums) and len(mavlink.enums) == len(peer.enums)
    for name, entries in peer.enums.items():
        assert {number: entry.name for number, entry in entries.items()} == {
            number: entry.name for number, entry in mavlink.enums[name].items()}, name
    assert mavlink.enums["MAV_CMD"][16].name == "MAV_CMD_NAV_WAYPOINT" and "NO_SUCH" not in mavlink.enums
    with pytest.raises(KeyError):
        mavlink.enums["NO_SUCH"]


def test_an_unknown_name_of_the_module(mavlink):
    with pytest.raises(AttributeError, match="no MAV_CMD_NAV_WAYPOINTT; did you mean MAV_CMD_NAV_WAYPOINT?"):
        mavlink.MAV_CMD_NAV_WAYPOINTT
    for name in ("MAVLink_nosuch_message", "MAVLink_HEARTBEAT_message"):
        with pytest.raises(AttributeError):
            getattr(mavlink, name)


CLASS_ATTRIBUTES = ("id", "msgname", "fieldnames", "ordered_fieldnames", "fieldtypes", "fielddisplays_by_name",
                    "fieldenums_by_name", "fieldunits_by_name", "native_format", "orders", "lengths", "array_lengths",
                    "crc_extra", "instance_field", "instance_offset")


def test_every_class_has_pymavlinks_attributes(mavlink, peer):
    assert set(mavlink.mavlink_map) == set(peer.mavlink_map)
    for number, their in peer.mavlink_map.items():
        our = mavlink.mavlink_map[number]
        assert our is getattr(mavlink, their.__name__) and our.__name__ == their.__name__
        for name in CLASS_ATTRIBUTES:
            if name == "fieldtypes":  # mavgen has a type of its own for HEARTBEAT.mavlink_version
                assert our.fieldtypes == [kind.replace("_mavlink_version", "") for kind in their.fieldtypes]
            else:
                assert getattr(our, name) == getattr(their, name), (number, name)
        assert our.unpacker.size == their.unpacker.size
        assert inspect.getfullargspec(our.__init__).args == inspect.getfullargspec(their.__init__).args


def test_every_method_has_pymavlinks_parameters(mavlink, peer):
    ours, theirs = mavlink.MAVLink(None), peer.MAVLink(None)
    for number, cls in peer.mavlink_map.items():
        for verb in ("send", "encode"):
            name = f"{cls.msgname.lower()}_{verb}"
            assert list(inspect.signature(getattr(ours, name)).parameters) == list(
                inspect.signature(getattr(theirs, name)).parameters), name
    assert "attitude_send" in dir(ours)
    with pytest.raises(AttributeError, match="nosuch_send"):
        ours.nosuch_send


# ---- messages

@pytest.mark.parametrize("case", vectors.CASES)
def test_every_message_is_packed_and_decoded_as_by_pymavlink(case, mavlink, peer):
    sender, theirs = mavlink.MAVLink(None, srcSystem=7, srcComponent=42), packer(peer, 7, 42)
    parser, their_parser = mavlink.MAVLink(None), peer.MAVLink(None)
    for number, their_class in peer.mavlink_map.items():
        values = vectors.values_of(their_class, case)
        frame = theirs.pack(vectors.message_of(their_class, values))
        our = mavlink.mavlink_map[number](**values)
        sender.seq = frame[4]
        assert our.pack(sender) == frame == bytes(our.get_msgbuf()), their_class.msgname
        decoded, their = parser.decode(frame), their_parser.decode(bytearray(frame))
        for field in vectors.fields_of(their_class):
            if field.type != "char" or field.array_length:  # pymavlink has bytes for a single character
                assert same(getattr(decoded, field.name), getattr(their, field.name)), (their_class.msgname, field)
            if field.is_text and field.array_length:
                assert getattr(decoded, f"_{field.name}_raw") == getattr(their, f"_{field.name}_raw").rstrip(b"\0")
        assert (decoded.get_type(), decoded.get_msgId(), decoded.get_seq(), decoded.get_srcSystem(),
                decoded.get_srcComponent(), decoded.get_crc(), decoded.get_signed(), decoded.get_link_id()) == (
            their.get_type(), their.get_msgId(), their.get_seq(), their.get_srcSystem(), their.get_srcComponent(),
            their.get_crc(), their.get_signed(), their.get_link_id())
        if "TEST_TYPES" not in their.get_type() and "ARRAY_TEST_5" != their.get_type():
            assert str(decoded) == str(their) and decoded.to_json() == their.to_json()
            assert list(decoded.to_dict()) == list(their.to_dict())
        assert vars(decoded.get_header()) == vars(their.get_header())
        assert isinstance(decoded, getattr(mavlink, f"MAVLink_{their.get_type().lower()}_message"))


def test_fields_come_before_everything_else(mavlink):
    """A mission upload that reads msg.seq must not get the frame's sequence number."""
    request = mavlink.MAVLink_mission_request_message(1, 2, 17)
    item = mavlink.MAVLink_mission_item_int_message(1, 2, 3, 6, 16, 0, 1, 0, 0, 0, 0, 1, 2, 3)
    battery = mavlink.MAVLink_battery_status_message(5, *[0] * 3, [0] * 10, *[0] * 4)
    value = mavlink.MAVLink_named_value_float_message(0, b"speed", 1)
    control = mavlink.MAVLink_change_operator_control_message(1, 0, 9, b"key")
    assert (request.seq, item.seq, item.frame, battery.id, value.name, control.version) == (17, 3, 6, 5, "speed", 9)
    assert (request.get_seq(), battery.get_msgId(), type(battery).id, item.name) == (0, 147, 147, "MISSION_ITEM_INT")
    fields = {name for number, cls in mavlink.mavlink_map.items() for name in cls.fieldnames}
    assert {"seq", "id", "name", "frame", "version"} <= fields
    methods = {name for name in dir(mavlink.MAVLink_message) if not name.startswith("_")} - {"id", "name"}
    assert fields & methods == set()


def test_the_dict_of_a_changed_message_is_pymavlinks(mavlink, peer):
    frame = packer(peer, 1, 2).pack(peer.MAVLink_battery_status_message(5, *[0] * 3, [7] * 10, *[0] * 5))
    ours, theirs = mavlink.MAVLink(None).decode(frame), peer.MAVLink(None).decode(bytearray(frame))
    before = ours.to_dict()
    for message in (ours, theirs):
        message.voltages, message.mavpackettype, message.mine = [1, 2], "other", "x"
    assert list(ours.to_dict().items()) == list(theirs.to_dict().items())
    assert ours.to_dict()["voltages"] == [1, 2] and before["voltages"] == [7] * 10
    assert list(mavlink.MAVLink(None).decode(frame).to_dict().items()) == list(before.items())


def test_attributes_can_be_set(mavlink):
    sender = mavlink.MAVLink(None, srcSystem=1, srcComponent=2)
    message = mavlink.MAVLink(None).decode(mavlink.MAVLink_attitude_message(1, 2, 3, 4, 5, 6, 7).pack(sender))
    message.roll, message.mine, message._timestamp = 9.5, "x", 12.0
    assert (message.roll, message.to_dict()["roll"], message.mine, message._timestamp) == (9.5, 9.5, "x", 12.0)
    assert "roll : 9.5" in str(message) and message.__dict__["mine"] == "x" and vars(message)["pitch"] == 3
    assert mavlink.MAVLink(None).decode(message.pack(sender)).roll == 9.5
    del message.mine
    with pytest.raises(AttributeError):
        message.mine
    with pytest.raises(AttributeError):
        del message.mine
    with pytest.raises(AttributeError, match="did you mean 'roll'"):
        message.rol
    assert getattr(message, "".join(("pi", "tch"))) == 3.0 and not hasattr(message, "time_usec")
    assert {"roll", "get_type", "pack"} <= set(dir(message))


def test_text(mavlink, peer):
    """As in pymavlink, text ends at the first NUL, each byte above 127 is U+FFFD, and text that is too long is cut."""
    sender = mavlink.MAVLink(None)
    for given in (b"h\xc3\xb6he\0abc", b"\xff\xfeA", b"x" * 80, b"", bytearray(b"ab")):
        ours = sender.decode(mavlink.MAVLink_statustext_message(6, given).pack(sender))
        frame = packer(peer, 0, 0).pack(peer.MAVLink_statustext_message(6, bytes(given)))
        their = peer.MAVLink(None).decode(bytearray(frame))
        assert (ours.text, ours._text_raw) == (their.text, their._text_raw.rstrip(b"\0"))
    message = mavlink.MAVLink_statustext_message(6, "höhe")  # pymavlink takes bytes only
    assert message.text == "höhe" and sender.decode(message.pack(sender))._text_raw == "höhe".encode()
    message = mavlink.MAVLink_statustext_message(6, b"one\xff")
    assert (message.text, message._text_raw) == ("one\ufffd", b"one\xff")
    message.text = "two"
    assert sender.decode(message.pack(sender)).text == "two"
    with pytest.raises(mavloom.UsageError, match="cannot be encoded as UTF-8"):
        mavlink.MAVLink_statustext_message(6, "\udc80").pack(sender)


@pytest.mark.parametrize("values", [[1] * 12, tuple(range(12)), np.arange(12), bytes(range(12)), range(11),
                                    [*range(10), "x"]])
def test_arrays_that_are_too_long_are_cut(values, mavlink, peer):
    packed = [module.MAVLink_battery_status_message(0, 0, 0, 200, values, 1, 1, 1, 50).pack(module.MAVLink(None))
              for module in (peer, mavlink)]
    assert bytes(packed[0]) == packed[1]
    with pytest.raises(mavloom.UsageError, match="expected 10 elements, not 9"):
        mavlink.MAVLink_battery_status_message(0, 0, 0, 200, values[:9], 1, 1, 1, 50).pack(mavlink.MAVLink(None))


@pytest.mark.parametrize("values", [(1.5, 0, 0, 0, 0), (300, 0, 0, 0, 0), (None, 0, 0, 0, 0), ("x", 0, 0, 0, 0),
                                    (2**70, 0, 0, 0, 0), ([1], 0, 0, 0, 0)])
def test_values_that_cannot_be_packed(values, mavlink):
    message = mavlink.MAVLink_heartbeat_message(*values, 3)
    with pytest.raises(mavloom.UsageError, match=r"HEARTBEAT\.type"):
        message.pack(mavlink.MAVLink(None))
    with pytest.raises(TypeError, match="missing 4 required positional arguments"):
        mavlink.MAVLink_heartbeat_message(1, 2)


def test_messages_are_copied_pickled_and_compared(mavlink):
    sender = mavlink.MAVLink(None, srcSystem=3)
    message = mavlink.MAVLink(None).decode(mavlink.MAVLink_attitude_message(1, 2, 3, 4, 5, 6, 7).pack(sender))
    message.extra = [1]
    bad = mavlink.MAVLink_bad_data(b"abc", "Bad prefix")
    for make in (copy.copy, copy.deepcopy, lambda m: pickle.loads(pickle.dumps(m))):
        again = make(message)
        assert again == message and type(again) is type(message) and again.extra == [1] and again is not message
        assert (again.get_srcSystem(), again._timestamp) == (3, message._timestamp)
        assert (make(bad).data, make(bad).reason) == (b"abc", "Bad prefix")
    other = copy.copy(message)
    other.roll = 1
    assert other != message and message != 5 and not message == None  # noqa: E711
    with pytest.raises(TypeError, match="unhashable"):
        hash(message)
    assert weakref.ref(message)() is message


def test_messages_in_cycles_are_collected(mavlink):
    import gc
    message = mavlink.MAVLink_heartbeat_message(1, 2, 3, 4, 5, 6)
    message.me, watch = message, weakref.ref(message)
    del message
    gc.collect()
    assert watch() is None


def test_a_dialect_of_ones_own(tmp_path):
    xml = tmp_path / "mine.xml"
    xml.write_text('<mavlink><enums><enum name="MY"><entry name="MY_ONE" value="1"/></enum></enums><messages>'
                   '<message id="61000" name="MINE"><field type="uint16_t" name="a">a</field></message></messages>'
                   '</mavlink>')
    before = mavutil.mavlink
    try:
        mavutil.set_dialect(str(xml))
        assert mavutil.mavlink.MY_ONE == 1 and mavutil.current_dialect == str(xml)
        message = mavutil.mavlink.MAVLink_mine_message(513)
        sender = mavutil.mavlink.MAVLink(None)
        sender.protocol_marker = 0xfd
        assert sender.decode(message.pack(sender)).a == 513
        assert pickle.loads(pickle.dumps(message)).a == 513
    finally:
        mavutil._current.use(before)
        mavutil.current_dialect = "all"


def test_definitions_that_change(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("ONE", "THREE"):
        (tmp_path / "mine.xml").write_text(
            f'<mavlink><enums><enum name="MY"><entry name="MY_{name}" value="1"/></enum></enums><messages>'
            f'<message id="61000" name="MINE"><field type="uint16_t" name="{name}">a</field></message></messages>'
            '</mavlink>')
        mavutil.set_dialect("mine.xml")
        assert getattr(mavutil.mavlink, f"MY_{name}") == 1
        message = mavutil.mavlink.MAVLink_mine_message(7)
        assert pickle.loads(pickle.dumps(message)).to_dict() == {"mavpackettype": "MINE", name: 7}


def test_fields_with_names_that_python_does_not_allow(tmp_path):
    xml = tmp_path / "mine.xml"
    fields = "".join(f'<field type="uint8_t" name="{name}">a</field>' for name in ("from", "1st", "None"))
    xml.write_text(f'<mavlink><messages><message id="61000" name="MINE">{fields}</message><message id="61001" '
                   'name="OWN"><field type="uint8_t" name="self">a</field></message></messages></mavlink>')
    dialect = mavloom.Dialect(xml)
    link = mavloom.connect("udpin://127.0.0.1:0", dialect=dialect)
    assert repr(link.mav.mine_encode) == "<mine_encode(from_=0, _1st=0, None_=0)>"
    assert link.mav.mine_encode(1, 2, 3).to_dict() == link.mav.mine_encode(**{"from": 1, "1st": 2, "None": 3}).to_dict()
    link.close()
    module = mavutil._current.module_of(dialect, 2)
    message = module.MAVLink(None).mine_encode(1, 2, None_=3)
    assert (getattr(message, "from"), getattr(message, "1st"), getattr(message, "None")) == (1, 2, 3)
    assert module.MAVLink_mine_message(from_=1, _1st=2, None_=3).to_dict() == message.to_dict()
    assert module.MAVLink(None).own_encode(self_=4).self == 4


def test_pymavlinks_dialect_modules():
    from mavloom.dialects.v10 import common as one
    from mavloom.dialects.v20 import ardupilotmega as two
    import mavloom.dialects.v20.all as three
    assert two is three and one.WIRE_PROTOCOL_VERSION == "1.0" and two.WIRE_PROTOCOL_VERSION == "2.0"
    sent = []

    class File:
        write = sent.append
    for module in (one, two):
        module.MAVLink(File, 1, 2).heartbeat_send(1, 2, 3, 4, 5)
    assert [(frame[0], frame[-3]) for frame in sent] == [(0xfe, 3), (0xfd, 3)]


# ---- MAVLink

def test_the_fields_of_mavlink(mavlink, peer):
    sent = []

    class File:
        write = sent.append
    called = []
    for module in (mavlink, peer):
        mav = module.MAVLink(File, srcSystem=5, srcComponent=6)
        mav.set_send_callback(lambda message, *args: called.append((message.get_type(), args)), 7)
        assert mav.heartbeat_send(1, 2, 3, 4, 5) is None
        mav.heartbeat_send(1, 2, 3, 4, 5, force_mavlink1=True)
        mav.send(module.MAVLink_attitude_message(1, 2, 3, 4, 5, 6, 7))
        called.append((mav.seq, mav.total_packets_sent, mav.total_bytes_sent))
        encoded = mav.heartbeat_encode(1, 2, 3, 4, 5)
        assert (encoded.mavlink_version, encoded.get_msgbuf()) == (3, b"")
    assert sent[:3] == [bytes(frame) for frame in sent[3:]] and called[:4] == called[4:]
    with pytest.raises(mavloom.UsageError, match="send\\(\\) takes a message"):
        mavlink.MAVLink(File).send("HEARTBEAT")


def test_messages_of_pymavlinks_own_modules_are_sent(mavlink, peer):
    """A script may keep pymavlink's mavwp beside our mavutil."""
    sent = []

    class File:
        write = sent.append
    mav = mavlink.MAVLink(File, srcSystem=5, srcComponent=6)
    mav.send(peer.MAVLink_heartbeat_message(1, 2, 3, 4, 5, 3))
    assert mavlink.MAVLink(None).decode(sent[0]).get_srcSystem() == 5


@pytest.mark.parametrize("chunk", [1, 3, 17, 10_000])
def test_a_stream_is_parsed_as_by_pymavlink(chunk, mavlink, peer):
    sender = packer(peer)
    frames = [sender.pack(peer.MAVLink_attitude_message(i, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6)) for i in range(6)]
    frames[2] = frames[2][:12] + bytes([frames[2][12] ^ 1]) + frames[2][13:]
    stream = b"".join([b"junk", *frames[:4], b"?", *frames[4:]])
    found = []
    for module in (mavlink, peer):
        mav = module.MAVLink(None)
        mav.robust_parsing = True
        messages = []
        for at in range(0, len(stream), chunk):
            messages += mav.parse_buffer(stream[at:at + chunk]) or []
        joined = []
        for message in messages:  # pymavlink cuts junk where the chunks are cut
            reason = getattr(message, "reason", None)
            if reason == "Bad prefix" and joined and joined[-1][0] == reason:
                joined[-1] = (reason, joined[-1][1] + bytes(message.data))
            else:
                joined.append((reason, bytes(message.get_msgbuf())))
        found.append(joined)
    assert found[0] == found[1]


@pytest.mark.parametrize("chunk", [1, 3, 20, 60, 200])
@pytest.mark.parametrize("start", [b"", b"junk"])
def test_a_frame_within_a_frame_is_part_of_it(start, chunk, mavlink, peer):
    inner = packer(peer, 9, 9).pack(peer.MAVLink_heartbeat_message(2, 3, 81, 4, 4, 3))
    filled = list(inner.ljust(128, b"\7"))
    outer = packer(peer).pack(peer.MAVLink_tunnel_message(0, 0, 0, 128, filled))
    stream, found = start + outer + inner, []
    for module in (peer, mavlink):
        mav = module.MAVLink(None)
        mav.robust_parsing = True
        messages = [message for at in range(0, len(stream), chunk)
                    for message in mav.parse_buffer(stream[at:at + chunk]) or []]
        found.append([bytes(message.get_msgbuf()) for message in messages if message.get_type() != "BAD_DATA"])
    assert found[0] == found[1] == [outer, inner]


def test_junk_is_returned_before_the_frame_behind_it_is_whole(mavlink, peer):
    frame = packer(peer).pack(peer.MAVLink_heartbeat_message(1, 2, 3, 4, 5, 3))
    for module in (peer, mavlink):
        mav = module.MAVLink(None)
        mav.robust_parsing = True
        assert bytes(mav.parse_char(b"junk" + frame[:5]).data) == b"junk"
        assert mav.parse_char(frame[5:]).get_type() == "HEARTBEAT"


def test_errors_and_bad_data(mavlink, peer):
    frame = packer(peer).pack(peer.MAVLink_heartbeat_message(1, 2, 3, 4, 5, 3))
    wrong = frame[:-1] + bytes([frame[-1] ^ 1])
    for data, text in ((b"x", "invalid MAVLink prefix '120'"), (wrong, "invalid MAVLink CRC in msgID 0 0x")):
        with pytest.raises(mavlink.MAVError, match=text):
            mavlink.MAVLink(None).parse_char(data)
    mav = mavlink.MAVLink(None)
    mav.robust_parsing = True
    assert (mav.parse_char(wrong).get_type(), mav.total_receive_errors) == ("BAD_DATA", 1)
    mav = mavlink.MAVLink(None)
    assert mav.parse_char(frame[:5]) is None and (mav.buf_len(), mav.bytes_needed()) == (5, 16)
    assert mav.parse_char(frame[5:]).get_type() == "HEARTBEAT" and mav.parse_buffer(b"") is None
    for data, text in ((frame[:-1], "Got 8 expected 9, msgId=0 headerlen=10"), (wrong, "invalid MAVLink CRC"),
                       (b"", "no bytes"), (b"x" * 20, "invalid MAVLink prefix '0x78'"),
                       (frame + b"x", "Got 10 expected 9"), (b"\xfd", "1 bytes are not a frame")):
        with pytest.raises(mavlink.MAVError, match=text):
            mavlink.MAVLink(None).decode(data)
    assert issubclass(mavlink.MAVError, mavloom.Error) and mavutil.MAVError is mavlink.MAVError


def test_signatures(mavlink, peer):
    key, frames = bytes(range(32)), []
    for module in (mavlink, peer):
        mav = module.MAVLink(None, srcSystem=1, srcComponent=1)
        mav.signing.secret_key, mav.signing.sign_outgoing = key, True
        mav.signing.link_id, mav.signing.timestamp = 7, 2**47
        frames.append([bytes(module.MAVLink_attitude_message(1, 2, 3, 4, 5, 6, 7).pack(mav)) for _ in range(3)])
    assert frames[0] == frames[1]
    for forged in (frames[0][0][:-1] + b"\0", frames[0][0][:-9] + b"\1" + frames[0][0][-8:]):
        receiver = mavlink.MAVLink(None)
        receiver.signing.secret_key, receiver.robust_parsing = key, True
        assert receiver.parse_char(forged).get_type() == "BAD_DATA" and receiver.signing.badsig_count == 1
        assert receiver.parse_char(frames[0][0]).get_signed()  # the forged one locked nobody out


def test_the_checksum(mavlink, peer):
    for data in (b"", b"123456789", "text", [1, 2, 3]):
        assert mavlink.x25crc(data).crc == peer.x25crc(data).crc


# ---- functions beside

def test_modes(peer):
    for kind in range(50):
        assert mavutil.mode_mapping_byname(kind) == theirs.mode_mapping_byname(kind)
        for autopilot, base, custom in ((3, 81, 4), (3, 1, 77), (3, 0, 5), (12, 157, 0x04040000), (12, 1, 0x00070000),
                                        (12, 1, 0x09040000), (8, 192, 0)):
            beat = peer.MAVLink_heartbeat_message(kind, autopilot, base, custom, 4, 3)
            assert mavutil.mode_string_v10(beat) == theirs.mode_string_v10(beat)
    for name in ("mode_mapping_apm", "mode_mapping_acm", "mode_mapping_rover", "mode_mapping_tracker",
                 "mode_mapping_sub", "mode_mapping_blimp", "px4_map", "mainstate_mapping_px4", "AP_MAV_TYPE_MODE_MAP",
                 "auto_mode_flags", "dump_message_unit_decoder", *(n for n in dir(theirs) if n.startswith("PX4_"))):
        ours, wanted = getattr(mavutil, name), getattr(theirs, name)
        assert ours == (wanted if not isinstance(wanted, dict) else {
            key: tuple(value) if isinstance(value, list) else value for key, value in wanted.items()}), name
    for number in (0, 3, 5, 99):
        assert (mavutil.mode_string_apm(number), mavutil.mode_string_acm(number), mavutil.mode_string_px4(number)) == (
            theirs.mode_string_apm(number), theirs.mode_string_acm(number), theirs.mode_string_px4(number))


def test_small_helpers():
    event = mavutil.periodic_event(1000)
    assert event.force() is None and event.trigger() and not mavutil.periodic_event(0.1).trigger()
    for value in ("a", b"ab\n", bytearray(b"a\x01"), "\x7f", b"\x80"):
        assert mavutil.all_printable(value) == theirs.all_printable(value)
    assert str(mavutil.location(1, 2, 3, 4)) == str(theirs.location(1, 2, 3, 4))
    assert mavutil.u_ord("a") == mavutil.u_ord(97) == 97
    with pytest.raises(AttributeError, match="HEARTBEAT.type is not a bitmask"):
        mavutil.decode_bitmask("HEARTBEAT", "type", 3)


@pytest.mark.parametrize("preferred", [["*"], ["*ACM*", "*3D*"], ["*none*"]])
def test_serial_devices_are_found_as_by_pymavlink(preferred, monkeypatch):
    devices = ["/dev/ttyS0", "/dev/ttyUSB0", "/dev/ttyACM0", "/dev/serial/by-id/usb-3D_Robotics-if00"]
    monkeypatch.setattr("glob.glob", lambda pattern: fnmatch.filter(devices, pattern))
    found = [[str(port) for port in module.auto_detect_serial(preferred)] for module in (theirs, mavutil)]
    assert found[0] == found[1] != []


@pytest.mark.parametrize("zone", ["UTC", "Asia/Tokyo", "America/St_Johns"])
def test_the_verbose_form_has_local_times_and_the_link_of_the_signature(zone, mavlink, peer, their_mavutil,
                                                                        monkeypatch):
    monkeypatch.setenv("TZ", zone)
    time.tzset()
    sender, found = peer.MAVLink(None, 1, 1), []
    plain = bytes(peer.MAVLink_system_time_message(1700000000123456, 5).pack(sender))
    sender.signing.secret_key, sender.signing.sign_outgoing, sender.signing.link_id = bytes(32), True, 7
    signed = bytes(peer.MAVLink_system_time_message(1700000000123456, 5).pack(sender))
    for module, definitions in ((their_mavutil, peer), (mavutil, mavlink)):
        receiver, text = definitions.MAVLink(None), io.StringIO()
        receiver.signing.secret_key, receiver.signing.allow_unsigned_callback = bytes(32), lambda *_: True
        for frame in (plain, signed):
            message = receiver.decode(bytearray(frame))
            message._timestamp, message._link = 1700000000.25, 3
            module.dump_message_verbose(text, message)
        found.append(text.getvalue())
    monkeypatch.undo()
    time.tzset()
    assert found[0] == found[1] and "(signed=Yes; out-link=7)" in found[1]


OWN = """<mavlink><enums><enum name="MYF" bitmask="true"><entry name="MYF_A" value="1"/><entry name="MYF_B" value="2"/>
</enum><enum name="MYE"><entry name="MYE_ONE" value="1"/></enum></enums><messages><message id="61000" name="MINE">
<field type="uint16_t" name="e" enum="MYE">a</field>
<field type="uint16_t" name="f" enum="MYF" display="bitmask">a</field></message></messages></mavlink>"""


def test_the_verbose_form_of_a_message_of_ones_own_definitions(tmp_path):
    (tmp_path / "own.xml").write_text(OWN)
    mavutil.set_dialect(str(tmp_path / "own.xml"))
    text = io.StringIO()
    mavutil.dump_message_verbose(text, mavutil.mavlink.MAVLink_mine_message(1, 2))
    assert text.getvalue().splitlines()[1:] == ["    e: 1 (MYE_ONE)", "    f: 0x2 (2)",
                                                "      ! MYF_A", "        MYF_B"]
    bits = mavutil.decode_bitmask("MINE", "f", 2)
    assert [(bit.name, bit.value) for bit in bits][:2] == [("MYF_A", False), ("MYF_B", True)]


def test_quaternions():
    from pymavlink.quaternion import QuaternionBase as Theirs
    from mavloom.quaternion import Quaternion, QuaternionBase
    random.seed(7)
    for _ in range(200):
        euler = [random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3)]
        other = [random.uniform(-1, 1) for _ in range(3)]
        ours, their = QuaternionBase(euler), Theirs(euler)
        assert ours.q == pytest.approx(their.q) and ours.euler == pytest.approx(euler)
        assert ours.dcm.ravel() == pytest.approx(their.dcm.ravel())
        assert QuaternionBase(ours.dcm).close(ours) and QuaternionBase(ours) == ours == Quaternion(list(ours.q))
        assert (ours * QuaternionBase(other)).q == pytest.approx((their * Theirs(other)).q)
        assert (ours / QuaternionBase(other)).q == pytest.approx((their / Theirs(other)).q)
        assert ours.transform([1, 2, 3]) == pytest.approx(their.transform([1, 2, 3]))
        assert ours.inversed.q == pytest.approx(their.inversed.q) and ours[1] == ours.q[1] and len(ours) == 4
    assert repr(QuaternionBase()) == "QuaternionBase([1, 0, 0, 0])" and QuaternionBase() != QuaternionBase([1, 0, 0])
    with pytest.raises(TypeError, match="an attitude is a quaternion"):
        QuaternionBase([1, 2])


def test_missions_in_files(tmp_path, mavlink, monkeypatch):
    monkeypatch.delenv("MAVLINK20", raising=False)  # other tests set it after pymavlink chose its module
    from pymavlink import mavwp as their_mavwp
    from mavloom import mavwp
    loader = mavwp.MAVWPLoader(1, 1)
    for i in range(4):
        loader.add_latlonalt(47.1 + i, 8.5, 20 + i)
    loader.insert(1, copy.copy(loader.wp(3)), "again")
    loader.remove(loader.item(0))
    assert [w.seq for w in loader.wpoints] == [0, 1, 2, 3] and loader.count() == len(loader) == 4
    loader.save(tmp_path / "x.txt")
    theirs_loader, again = their_mavwp.MAVWPLoader(), mavwp.MAVWPLoader()
    assert theirs_loader.load(str(tmp_path / "x.txt")) == again.load(tmp_path / "x.txt") == 4
    for i in range(4):
        assert all(getattr(again.wp(i), name) == pytest.approx(getattr(theirs_loader.wp(i), name))
                   for name in ("seq", "frame", "command", "param1", "x", "y", "z", "autocontinue"))
    for text, reason in (("hello", "first line must be"), ("QGC WPL 110\n1 2 3", r":2: an item has 12 values, not 3"),
                         ("QGC WPL 110\n" + "x " * 12, ":2: invalid literal")):
        (tmp_path / "bad.txt").write_text(text)
        with pytest.raises(mavwp.MAVWPError, match=reason):
            again.load(tmp_path / "bad.txt")
    with pytest.raises(mavwp.MAVWPError, match="there is no item 9"):
        again.set(again.wp(0), 9)
    for change in (lambda: again.add(again.wp(0)), lambda: again.insert(0, again.wp(1)),
                   lambda: again.remove(again.wp(2)), lambda: again.set(again.wp(1), 1), again.reindex, again.clear):
        again.last_change = 0.0
        change()
        assert again.last_change > 0  # MAVProxy looks at it


def test_json_of_nan_is_pymavlinks(mavlink):
    text = mavlink.MAVLink_param_value_message(b"P", math.nan, 9, 1, 0).to_json()
    assert "NaN" in text and math.isnan(json.loads(text)["param_value"])
    assert struct.calcsize(mavlink.MAVLink_heartbeat_message.unpacker.format) == 9
