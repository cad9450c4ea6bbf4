# SPDX-License-Identifier: MIT
"""Dialect and Message against pymavlink, generated from the same definitions.
"Row N" is a row of the wish list in docs/guide/python.md."""
import copy
import json
import math
import pickle
import subprocess
import sys

import pytest

import mavloom
import pymavlink_vectors as vectors
from mavloom import enums, messages
from tlogs import packer


@pytest.fixture(scope="module")
def dialect():
    return mavloom.Dialect()


def same(ours, theirs):
    if isinstance(theirs, list):
        return isinstance(ours, list) and len(ours) == len(theirs) and all(map(same, ours, theirs))
    if isinstance(theirs, float) and math.isnan(theirs):
        return isinstance(ours, float) and math.isnan(ours)
    return type(ours) is type(theirs) and ours == theirs


def expected_text(raw):
    return raw.rstrip(b"\0").decode("utf-8", "replace")


# ---- row 28: every message, both directions, as attributes

@pytest.mark.parametrize("case", vectors.CASES)
def test_row_28_every_message_is_encoded_and_decoded_as_pymavlink_does(dialect, peer, case):
    sender = packer(peer, 7, 42)
    for identifier, message_class in peer.mavlink_map.items():
        values = vectors.values_of(message_class, case)
        theirs = sender.pack(vectors.message_of(message_class, values))
        name = message_class.msgname

        ours = dialect.encode(name, source_system=7, source_component=42, frame_seq=theirs[4], **values)
        assert ours == theirs, (name, case)

        message = dialect.decode(theirs)
        assert (message.name, message.header.id, message.sys, message.comp) == (name, identifier, 7, 42)
        for field in vectors.fields_of(message_class):
            value = expected_text(values[field.name]) if field.is_text else values[field.name]
            assert same(message[field.name], value), (name, field.name, case)
            if not hasattr(mavloom.Message, field.name):
                assert same(getattr(message, field.name), value), (name, field.name, case)


def test_row_10_mavlink_1_is_decoded_and_encoded_too(dialect, peer_v1):
    sender = packer(peer_v1)
    for message_class in peer_v1.mavlink_map.values():
        values = vectors.values_of(message_class, "typical")
        theirs = sender.pack(vectors.message_of(message_class, values))

        message = dialect.decode(theirs)
        assert message.header.version == 1
        assert dialect.encode(message) == theirs
        assert dialect.encode(message_class.msgname, source_system=1, source_component=1, frame_seq=theirs[2],
                              frame_version=1, **values) == theirs
    with pytest.raises(ValueError, match="MAVLink 1 allows at most 255"):
        dialect.encode("ODOMETRY", frame_version=1)


HEADER = ("frame", "id", "seq", "version")


def test_fields_that_have_the_name_of_an_attribute(dialect):
    """`msg.seq` of a MISSION_REQUEST was the frame's number, and an upload loop sent the wrong waypoints."""
    hidden = {field.name for name in dialect.message_names for field in dialect[name].fields
              if hasattr(mavloom.Message, field.name)}
    assert hidden == {"name", *HEADER}

    message = dialect.message("MISSION_ITEM_INT", seq=500, frame="MAV_FRAME_GLOBAL_INT")
    assert (message["seq"], message["frame"], "seq" in message, message.header.seq) == (500, 5, True, 0)
    assert message.header.frame == message.get_msgbuf() == dialect.encode(message)
    for name in ("seq", "frame", "".join(("s", "eq"))):  # the last one is not interned
        with pytest.raises(AttributeError, match=rf'write msg\["{name}"\] for the field, msg\.header\.{name} for'):
            getattr(message, name)
    assert (message.id, message.version) == (message.header.id, message.header.version) == (73, 2)

    named = dialect.message("NAMED_VALUE_FLOAT", name="speed")
    assert (named.name, named["name"], named.header.name) == ("NAMED_VALUE_FLOAT", "speed", "NAMED_VALUE_FLOAT")


def test_every_message_has_its_fields_as_attributes_or_refuses_to_guess(dialect):
    for name in dialect.message_names:
        message = dialect.message(name)
        for field in dialect[name].fields:
            if field.name in HEADER:
                with pytest.raises(AttributeError, match=rf"{name} has a field '{field.name}'"):
                    getattr(message, field.name)
            elif field.name != "name":
                assert same(getattr(message, field.name), message[field.name])
        assert message.header.id == dialect[name].id


def test_the_header_has_our_names_and_pymavlinks(dialect):
    header = dialect.decode(dialect.encode("HEARTBEAT", source_system=7, source_component=8, frame_seq=9)).header
    assert (header.name, header.id, header.sys, header.comp, header.seq, header.version) == ("HEARTBEAT", 0, 7, 8, 9, 2)
    assert (header.msgId, header.srcSystem, header.srcComponent, header.mlen) == (0, 7, 8, 9)
    assert repr(header) == "<Header of HEARTBEAT: id=0, sys=7, comp=8, seq=9, version=2>"


def test_attributes_and_keys_can_be_listed_and_completed(dialect):
    message = dialect.message("MISSION_ITEM_INT")
    assert {"param1", "x", "seq", "sys", "to_dict", "header"} <= set(dir(message))
    assert message.keys() == message._ipython_key_completions_() == [f.name for f in dialect["MISSION_ITEM_INT"].fields]
    assert dict(message)["x"] == 0


def test_messages_cannot_be_changed(dialect):
    message = dialect.message("ATTITUDE", roll=0.5)
    with pytest.raises(AttributeError, match=r"messages cannot be changed; make a new one: .*\(msg, roll=\.\.\.\)"):
        message.roll = 1
    with pytest.raises(AttributeError, match="no attribute 'colour' can be set"):
        message.colour = 1
    with pytest.raises(AttributeError, match="cannot be changed"):
        del message.roll
    assert message.dialect.message(message, roll=1).roll == 1


# ---- row 12: text

@pytest.mark.parametrize("given, shown", [("höhe 10°", "höhe 10°"), (b"\xff\xfeA", "\ufffd\ufffdA"), ("", ""),
                                          ("a\0b", "a\0b"), ("x" * 50, "x" * 50)])
def test_row_12_text_in_and_out(dialect, given, shown):
    message = dialect.decode(dialect.encode("STATUSTEXT", severity=6, text=given))

    assert message.text == shown
    assert message.raw("text") == (given.encode() if isinstance(given, str) else given).ljust(50, b"\0")
    assert dialect.encode(message) == message.header.frame


def test_row_12_text_that_is_too_long_is_refused(dialect):
    with pytest.raises(ValueError, match=r"STATUSTEXT\.text: a text of 60 bytes is too long; at most 50 fit"):
        dialect.encode("STATUSTEXT", text="x" * 60)
    with pytest.raises(ValueError, match=r"STATUSTEXT\.text: a text of 51 bytes"):
        dialect.encode("STATUSTEXT", text="x" * 49 + "ö")


# ---- row 14: values

def test_row_14_arrays_from_any_sequence_or_buffer(dialect):
    import array

    import numpy
    values = [0.5, -1.25, 3.0, 4.5]
    frames = {dialect.encode("ATTITUDE_TARGET", q=q)
              for q in (values, tuple(values), numpy.array(values), numpy.float32(values), array.array("d", values))}
    assert len(frames) == 1
    assert dialect.decode(frames.pop()).q == values
    data = bytes(range(110))
    assert {tuple(dialect.decode(dialect.encode("GPS_INJECT_DATA", data=d)).data)
            for d in (data, bytearray(data), numpy.frombuffer(data, "u1"))} == {
        tuple(data)}


@pytest.mark.parametrize("name, fields, text", [
    ("STATUSTEXT", {"severity": 300}, r"STATUSTEXT\.severity: 300 is out of range, 0 to 255"),
    ("HEARTBEAT", {"custom_mode": 10**5000},
     r"HEARTBEAT\.custom_mode: a number with thousands of digits is out of range"),
    ("STATUSTEXT", {"severity": -1}, r"STATUSTEXT\.severity: -1 is out of range, 0 to 255"),
    ("ATTITUDE", {"time_boot_ms": 2**70}, r"ATTITUDE\.time_boot_ms: 1180591620717411303424 is out of range"),
    ("ATTITUDE", {"time_boot_ms": 1.5}, r"ATTITUDE\.time_boot_ms: 1\.5 is not a whole number"),
    ("ATTITUDE", {"roll": 1e300}, r"ATTITUDE\.roll: 1e\+300 is out of range of a 32-bit float"),
    ("ATTITUDE", {"roll": "much"}, r"ATTITUDE\.roll: expected a number, not text"),
    ("ATTITUDE", {"roll": None}, r"ATTITUDE\.roll: expected a number, not None"),
    ("ATTITUDE", {"rol": 1}, r"did you mean 'roll'"),
    ("ATTITUDE_TARGET", {"q": [1, 2, 3]}, r"ATTITUDE_TARGET\.q: expected 4 elements, not 3"),
    ("ATTITUDE_TARGET", {"q": 1}, r"ATTITUDE_TARGET\.q: expected a sequence of 4 numbers, not 1"),
    ("HEARTBEAT", {"type": "MAV_TYPE_QUADROTO"}, r"did you mean 'MAV_TYPE_QUADROTOR'"),
    ("STATUSTEXT", {"text": 5}, r"STATUSTEXT\.text: expected str or bytes, not 5"),
])
def test_row_14_what_does_not_fit_is_a_value_error_with_names(dialect, name, fields, text):
    with pytest.raises(ValueError, match=text) as raised:
        dialect.encode(name, **fields)
    assert isinstance(raised.value, mavloom.UsageError) and isinstance(raised.value, mavloom.Error)


def test_names_of_enum_entries_are_values(dialect):
    message = dialect.message("HEARTBEAT", type="MAV_TYPE_QUADROTOR",
                              base_mode="MAV_MODE_FLAG_SAFETY_ARMED|MAV_MODE_FLAG_GUIDED_ENABLED",
                              autopilot=enums.MAV_AUTOPILOT.MAV_AUTOPILOT_PX4)
    assert (message.type, message.base_mode, message.autopilot) == (2, 136, 12)


@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError, ZeroDivisionError])
def test_errors_of_a_value_itself_are_passed_on(dialect, error):
    class Value:
        def __float__(self):
            raise error

        def __iter__(self):
            raise error
    with pytest.raises(error):
        dialect.encode("ATTITUDE", roll=Value())
    with pytest.raises(error):
        dialect.encode("ATTITUDE_TARGET", q=Value())


# ---- row 29: names

@pytest.mark.parametrize("number", [2**32 + 30, -1, 2**70, 2**32 - 1])
def test_a_number_that_no_message_has(dialect, number):
    assert dialect[30].name == "ATTITUDE" and number not in dialect
    with pytest.raises(ValueError, match=f"no message has id {number}"):
        dialect[number]


def test_enums_and_messages_are_there_after_import(child_environment):
    code = "import mavloom\nmavloom.enums.MAV_TYPE, mavloom.messages.ATTITUDE"
    subprocess.run([sys.executable, "-c", code], check=True, env=child_environment)


def test_row_29_unknown_names_end_at_once_with_the_nearest(dialect):
    with pytest.raises(ValueError, match="'ATITUDE', did you mean 'ATTITUDE'"):
        dialect["ATITUDE"]
    with pytest.raises(ValueError, match="'ATITUDE', did you mean 'ATTITUDE'"):
        dialect.encode("ATITUDE")
    with pytest.raises(ValueError, match="did you mean 'MAV_TYPE'"):
        dialect.enum("MAV_TIPE")
    message = dialect.message("ATTITUDE")
    with pytest.raises(AttributeError, match="did you mean 'roll'"):
        message.rol
    with pytest.raises(ValueError, match="did you mean 'roll'"):
        message["rol"]
    assert not hasattr(message, "__array__")
    assert getattr(message, "".join(["ro", "ll"])) == 0.0


@pytest.mark.parametrize("argument, value, limits",
                         [("source_system", 256, "0 to 255"), ("source_component", -1, "0 to 255"),
                          ("frame_seq", 2**64, "0 to 255"), ("frame_version", 3, "1 to 2")])
def test_row_29_a_number_that_does_not_fit_is_a_value_error(dialect, argument, value, limits):
    with pytest.raises(mavloom.UsageError, match=f"^{argument}: {value} is out of range, {limits}$"):
        dialect.encode("HEARTBEAT", **{argument: value})
    for wrong in (1.0, "1"):
        with pytest.raises(TypeError):
            dialect.encode("HEARTBEAT", **{argument: wrong})


def test_row_29_a_time_that_does_not_fit_is_a_value_error(dialect):
    frame = dialect.encode("HEARTBEAT")
    for call in (dialect.decode, mavloom.Parser().feed):
        with pytest.raises(mavloom.UsageError, match=f"time_ns: {2**63} is out of range"):
            call(frame, time_ns=2**63)
    assert dialect.decode(frame, time_ns=-2**63).time_ns == -2**63


# ---- row 16: ids without definition

def test_row_16_unknown_id_keeps_its_header_and_bytes(dialect, tmp_path):
    xml = tmp_path / "mine.xml"
    xml.write_text('<mavlink><messages><message id="61000" name="MINE"><field type="uint16_t" name="a">a</field>'
                   '</message></messages></mavlink>')
    frame = mavloom.Dialect(xml).encode("MINE", a=513, source_system=9, source_component=8, frame_seq=7)

    message = dialect.decode(frame)

    assert (message.name, message.get_type(), message.id, message.sys, message.comp,
            message.seq) == (None, "UNKNOWN_61000", 61000, 9, 8, 7)
    assert ((message.frame, message.get_payload(), message.to_dict())
            == (frame, b"\x01\x02", {"mavpackettype": "UNKNOWN_61000"}))
    assert json.loads(message.to_json())["payload_hex"] == "0102"
    with pytest.raises(AttributeError):
        message.a
    with pytest.raises(ValueError, match="has no definition"):
        message["a"]


# ---- row 11: dialects side by side

def test_row_11_two_dialects_in_one_process(tmp_path):
    made = []
    for number, field in enumerate(('type="uint16_t" name="key_id"', 'type="float" name="level"')):
        (tmp_path / f"{number}.xml").write_text(
            f'<mavlink><messages><message id="61000" name="SECURE_PAYLOAD"><field {field}>x</field></message>'
            '</messages></mavlink>')
        made.append(mavloom.Dialect(tmp_path / f"{number}.xml"))
    first, second = made

    raw = first.encode("SECURE_PAYLOAD", key_id=7)
    assert first.decode(raw).key_id == 7
    with pytest.raises(ValueError, match="SECURE_PAYLOAD: wrong checksum"):
        second.decode(raw)
    assert second.decode(second.encode("SECURE_PAYLOAD", level=0.5)).level == 0.5
    assert mavloom.Dialect().decode(raw).name is None
    assert "ATTITUDE" in first and 30 in first and 61000 in first and 61000 not in mavloom.Dialect()


def test_error_in_a_definition_names_file_and_line(tmp_path):
    (tmp_path / "bad.xml").write_text('<mavlink>\n<messages>\n<message id="x" name="MINE"/></messages></mavlink>')
    with pytest.raises(mavloom.InputError, match=r"bad\.xml:3"):
        mavloom.Dialect(tmp_path / "bad.xml")
    with pytest.raises(FileNotFoundError) as raised:
        mavloom.Dialect(tmp_path / "absent.xml")
    assert isinstance(raised.value, mavloom.Error) and raised.value.errno == 2


@pytest.mark.parametrize("cut", [0, 1, 5, 8, 20, 39])
def test_bytes_that_are_no_frame_are_refused(dialect, cut):
    frame = dialect.encode("ATTITUDE", roll=1, yawspeed=2)
    with pytest.raises(mavloom.InputError):
        dialect.decode(frame[:cut])
    with pytest.raises(mavloom.InputError):
        dialect.decode(bytes([*frame[:cut], frame[cut] ^ 0x55, *frame[cut + 1:]]))
    assert dialect.decode(memoryview(bytearray(frame))).roll == 1


# ---- row 25: enums and editors

def test_row_25_enums_are_int_enums_and_flags(dialect):
    import enum
    assert issubclass(enums.MAV_TYPE, enum.IntEnum) and enums.MAV_TYPE.MAV_TYPE_QUADROTOR == 2
    assert issubclass(enums.MAV_MODE_FLAG, enum.IntFlag) and enums.MAV_MODE_FLAG(136).value == 136
    assert dialect.enum("MAV_TYPE") is enums.MAV_TYPE
    assert dialect.enums["MAV_CMD"][16].name == "MAV_CMD_NAV_WAYPOINT"
    with pytest.raises(AttributeError):
        enums.MAV_TIPE
    for name in dialect.enum_names:
        assert len(dialect.enum(name).__members__) > 0, name


def test_row_25_a_class_for_each_message(dialect):
    message = dialect.message("ATTITUDE", roll=0.5)
    assert isinstance(message, messages.ATTITUDE) and not isinstance(message, messages.HEARTBEAT)
    assert "ATTITUDE" in dir(messages)


# ---- habits

def test_pymavlinks_names_give_what_pymavlink_gives(dialect, peer):
    sender = packer(peer, 3, 4)
    sender.mav.seq = 250
    frame = sender.pack(peer.MAVLink_battery_status_message(1, 2, 3, -4, list(range(10)), 5, 6, 7, -1))
    theirs = peer.MAVLink(None).parse_char(frame)

    ours = dialect.decode(frame, time_ns=1_500_000_000_000_000_000)

    for method in ("get_type", "get_msgId", "get_srcSystem", "get_srcComponent", "get_seq", "get_fieldnames",
                   "get_signed", "to_dict"):
        assert getattr(ours, method)() == getattr(theirs, method)(), method
    assert ours.get_msgbuf() == bytes(theirs.get_msgbuf()) == frame
    for name in ("mlen", "seq", "srcSystem", "srcComponent", "msgId", "incompat_flags", "compat_flags"):
        assert getattr(ours.get_header(), name) == getattr(theirs.get_header(), name), name
    assert ours.fieldunits_by_name == theirs.fieldunits_by_name
    assert ours.fieldenums_by_name == theirs.fieldenums_by_name
    assert str(ours) == str(theirs)
    assert (ours._timestamp, ours._link) == (1.5e9, 0)
    assert ours.get_payload() == frame[10:10 + frame[1]]


def test_messages_are_values(dialect):
    message = dialect.message("ATTITUDE", roll=float("nan"))
    for other in (copy.copy(message), copy.deepcopy(message), pickle.loads(pickle.dumps(message)),
                  dialect.decode(message.frame)):
        assert other == message and hash(other) == hash(message) and other.name == "ATTITUDE"
    assert message != dialect.message("ATTITUDE", roll=1) and message != "ATTITUDE"
    assert len({message, dialect.decode(message.frame)}) == 1
    with pytest.raises(AttributeError):
        message.name = "x"
    with pytest.raises(TypeError):
        mavloom.Message()
    with pytest.raises(TypeError):
        mavloom.Message.__new__(mavloom.Message).name


def test_pickled_messages_keep_time_link_and_dialect(tmp_path):
    (tmp_path / "mine.xml").write_text(
        '<mavlink><messages><message id="61000" name="MINE"><field type="uint16_t" name="a">a</field></message>'
        '</messages></mavlink>')
    mine = mavloom.Dialect(tmp_path / "mine.xml")
    message = pickle.loads(pickle.dumps(mine.decode(mine.encode("MINE", a=3), time_ns=5)))
    assert (message.a, message.time_ns, message.dialect.path) == (3, 5, str(tmp_path / "mine.xml"))


# ---- row 13: JSON

def strict(line):
    def refuse(token):
        raise AssertionError(f"{token} is no JSON")
    return json.loads(line, parse_constant=refuse)


def test_an_own_dialect_is_read_once_for_all_messages_of_pickles(tmp_path):
    def write_definition(field):
        (tmp_path / "mine.xml").write_text(
            f'<mavlink><messages><message id="61000" name="MINE"><field type="uint16_t" name="{field}">a</field>'
            '</message></messages></mavlink>')
        return mavloom.Dialect(tmp_path / "mine.xml")

    dialect = write_definition("first")
    pickles = [pickle.dumps(dialect.message("MINE", first=number)) for number in range(100)]
    before = mavloom._pickle.load.cache_info().misses
    assert [pickle.loads(one).first for one in pickles] == list(range(100))
    assert mavloom._pickle.load.cache_info().misses == before + 1

    changed = write_definition("another_name")
    assert pickle.loads(pickle.dumps(changed.message("MINE", another_name=5))).another_name == 5
    assert pickle.loads(pickle.dumps(mavloom.Dialect())).path is None
    gone = pickle.dumps(changed)
    (tmp_path / "mine.xml").unlink()
    with pytest.raises(mavloom.NotFoundError, match="mine.xml"):
        pickle.loads(gone)


def entry(name):
    return (f'<mavlink><enums><enum name="MY"><entry name="MY_{name}" value="1"/></enum></enums><messages>'
            '<message id="61000" name="MINE"><field type="uint16_t" name="a" enum="MY">a</field></message>'
            '</messages></mavlink>')


def test_the_definitions_are_those_of_the_file_that_was_read(tmp_path, monkeypatch):
    """Files of one relative name in two folders, and a file that changes."""
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "mine.xml").write_text(entry(folder))
    made = []
    for folder in ("one", "two", "one"):
        monkeypatch.chdir(tmp_path / folder)
        made.append(mavloom.Dialect("mine.xml"))
    (tmp_path / "one" / "mine.xml").write_text(entry("three"))
    made.append(mavloom.Dialect("mine.xml"))
    assert [list(dialect.enum("MY").__members__) for dialect in made] == [["MY_one"], ["MY_two"], ["MY_one"],
                                                                         ["MY_three"]]
    assert made[0].enum("MY") is made[2].enum("MY") and made[0].enums["MY"][1].name == "MY_one"
    pickled = []
    for folder in ("two", "one"):
        monkeypatch.chdir(tmp_path / folder)
        pickled.append(pickle.loads(pickle.dumps(made[1])))
    assert [dict(dialect.enum("MY").__members__) for dialect in pickled] == [{"MY_two": 1}, {"MY_three": 1}]


def test_row_13_a_strict_parser_reads_every_message(dialect, peer):
    for message_class in peer.mavlink_map.values():
        for case in ("nan", "infinite", "tiny", "maximum"):
            message = dialect.message(message_class.msgname, **vectors.values_of(message_class, case))
            assert strict(message.to_json())["name"] == message_class.msgname


# ---- chunks of a stream: rows 15 and 6

@pytest.mark.parametrize("chunk", [1, 7, 300, 4096])
def test_row_15_damage_is_counted_and_never_raised(dialect, peer, chunk):
    sender = packer(peer)
    frames = [sender.pack(peer.MAVLink_attitude_message(i, i, 0, 0, 0, 0, 0)) for i in range(300)]
    stream = bytearray().join(frame + b"junk" * (i % 3) for i, frame in enumerate(frames))
    at = stream.index(frames[100])
    stream[at + 15] ^= 1

    parser = mavloom.Parser()
    found = [m for i in range(0, len(stream), chunk)
             for m in parser.feed(stream[i:i + chunk], time_ns=i)] + parser.finish()

    assert [m.time_boot_ms for m in found] == [i for i in range(300) if i != 100]
    assert (parser.frames, parser.junk_bytes) == (299, len(stream) - sum(map(len, frames)) + len(frames[100]))
    assert parser.crc_error >= 1


def test_arguments_of_another_type_are_type_errors(dialect):
    for call in (lambda: mavloom.Parser("mine.xml"), lambda: mavloom.Parser(5), lambda: dialect[3.5],
                 lambda: dialect.encode(5), lambda: dialect.decode("text"),
                 lambda: dialect.encode("ATTITUDE", source_system="x"), lambda: mavloom.Dialect(5),
                 lambda: mavloom.read(5)):
        with pytest.raises(TypeError):
            call()


def test_an_uninitialised_object_raises():
    with pytest.raises(TypeError):
        next(mavloom.Recording.__new__(mavloom.Recording))
