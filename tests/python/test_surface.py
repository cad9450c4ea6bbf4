# SPDX-License-Identifier: MIT
"""The package as interpreters, notebooks and editors show it, and misuse that its objects refuse."""
import inspect
import os
import pathlib
import re
import struct
import subprocess
import sys
import time
import warnings

import pytest

import mavloom
from mavloom import mavutil, mavwp
from places import ROOT
from tlogs import frames_of
from vehicles import DEADLINE_S, Vehicle, until

SURROGATE = "a\ud800b"


@pytest.fixture
def link():
    with mavloom.connect("udpin://127.0.0.1:0") as opened:
        yield opened


@pytest.fixture
def vehicle(peer, link):
    made = Vehicle(peer, link.port)
    yield made
    made.socket.close()


# ---- signatures, lists of names, texts

def test_link_stats_has_every_counter_of_a_link_and_of_an_endpoint():
    """The page's lists are compared with a router's reports by test_route_guide.py."""
    page = (ROOT / "docs/guide/route.md").read_text()
    counters = set()
    for kind in ("endpoint", "gone"):
        counters |= set(re.findall(r"`(\w+)`", re.search(rf"^\| `{kind}` \|(.*)\|$", page, re.M)[1]))
    other_names = {"repeated": "duplicate", "frames_not_sent": "not_sent"}

    assert len(counters) >= 30
    assert {other_names.get(name, name) for name in counters} - set(dir(mavloom.LinkStats)) == \
        {"endpoint", "scheme", "rcvbuf", "queued"}


def public_callables():
    for name in mavloom.__all__:
        thing = getattr(mavloom, name)
        if callable(thing):
            yield name, thing
        if inspect.isclass(thing):
            yield from ((f"{name}.{key}", value) for key, value in vars(thing).items()
                        if not key.startswith("_") and callable(value))
    yield from ((f"mavutil.{name}", thing) for name, thing in vars(mavutil).items()
                if callable(thing) and not name.startswith("_")
                and getattr(thing, "__module__", "").startswith("mavloom"))


def test_everything_public_has_a_signature():
    found = {name: inspect.signature(thing) for name, thing in public_callables()}
    assert len(found) > 150
    assert list(found["Dialect.encode"].parameters) == ["self", "message", "source_system", "source_component",
                                                        "frame_seq", "frame_version", "fields"]
    assert str(inspect.signature(mavloom.Parser().feed)).startswith("(data")
    assert found["read"].parameters["system"].kind is inspect.Parameter.KEYWORD_ONLY
    assert found["RingWriter"].parameters["capacity"].default == 8 << 20
    assert found["Parser"].parameters["dialect"].default is None


def test_names_of_messages_are_listed(link):
    assert {"heartbeat_send", "attitude_encode", "srcSystem"} <= set(dir(link.mav))
    assert list(inspect.signature(link.mav.heartbeat_send).parameters) == [
        "type", "autopilot", "base_mode", "custom_mode", "system_status", "mavlink_version"]
    assert {"heartbeat_send", "srcSystem"} <= set(dir(mavutil.mavlink.MAVLink(None)))


def test_newest_messages_are_completed(link, vehicle):
    vehicle.send(vehicle.heartbeat(), vehicle.attitude(1))
    until(lambda: link.stats.frames_in == 2)
    assert link.messages._ipython_key_completions_() == ["HEARTBEAT", "ATTITUDE"]
    assert repr(link.messages) == "<newest messages of system 1: HEARTBEAT, ATTITUDE>"


def test_objects_are_shown(link, vehicle, flight, tmp_path):
    vehicle.send(vehicle.heartbeat())
    beat = link.recv(DEADLINE_S)
    assert repr(link) == f"<Link {link.name}: 1 peer, 1 frame in, 0 out, vehicle 1/1>"
    assert "<td>frames_in</td><td>1</td>" in link._repr_html_() and "<td>1/1</td>" in link._repr_html_()
    assert "<td>MAV_TYPE_QUADROTOR</td>" in beat._repr_html_()
    assert repr(link.mav) == f"<Sender of {link.name}: 255/193, next seq 0>"
    assert repr(link.subscribe()) == "<Subscription: 0 missed>"
    log = mavloom.read(flight)
    log.recv()
    assert repr(log).startswith(f"<Recording {flight}: ") and repr(log).endswith(" records read>")
    log.close()
    assert repr(log) == f"<Recording {flight}, closed>"
    with mavloom.write(tmp_path / "x.tlog") as writer:
        writer.write(beat)
        assert repr(writer) == f"<RecordingWriter {tmp_path / 'x.tlog'}: 1 record>"
    assert repr(link.vehicle(1)) == f"<Vehicle 1/1 on {link.name}: Mode(0x00000000), disarmed>"
    assert repr(link.vehicle(1).mission) == "<Mission of system 1>"


def test_no_public_object_has_the_text_of_object(link, flight):
    conn = mavutil.mavlink_connection(str(flight))
    things = [conn.mav, conn.mav.signing, mavwp.MAVWPLoader(), mavutil.periodic_event(5), link,
              link.mav, link.stats, link.messages, link.subscribe(), link.vehicle(1), link.vehicle(1).params,
              link.vehicle_async(1), mavloom.read(flight), mavloom.read(flight).stats, mavloom.Parser(),
              mavloom.Dialect(), mavloom.Dialect()["HEARTBEAT"], mavloom.columns(flight, "RPM"),
              conn]
    assert not [repr(thing) for thing in things if " object at 0x" in repr(thing)]


# ---- what is refused, and its text

def test_unknown_attributes_cannot_be_set(link):
    for thing in (link, link.mav):
        with pytest.raises(AttributeError, match="no attribute 'target'"):
            thing.target = 3


@pytest.mark.parametrize("call", [
    lambda link: mavloom.read(SURROGATE), lambda link: mavloom.columns(SURROGATE, "ATTITUDE"),
    lambda link: mavloom.tables([SURROGATE]), lambda link: mavloom.write(SURROGATE),
    lambda link: mavloom.Dialect(SURROGATE), lambda link: mavloom.connect(SURROGATE),
    lambda link: mavloom.connect(f"udpin://{SURROGATE}:1"), lambda link: mavloom.RingReader(SURROGATE),
    lambda link: mavloom.RingWriter(SURROGATE), lambda link: mavloom.remove_ring(SURROGATE),
    lambda link: link.send(SURROGATE), lambda link: link.send("STATUSTEXT", text=SURROGATE),
    lambda link: link.recv_match(type=SURROGATE), lambda link: link.latest(SURROGATE),
    lambda link: link.record(SURROGATE), lambda link: link.vehicle(1).command(SURROGATE),
    lambda link: mavutil.mavlink_connection(SURROGATE + ".tlog"),
    lambda link: mavutil.evaluate_condition(SURROGATE + "(", {})])
def test_lone_surrogates_are_usage_errors(call, link):
    with pytest.raises((mavloom.UsageError, mavloom.NotFoundError)):
        call(link)


@pytest.mark.parametrize("call, text", [
    (lambda flight: mavloom.connect(None), r'takes an endpoint such as "udpin://0.0.0.0:14550", not None'),
    (lambda flight: mavloom.connect("udpin://127.0.0.1:0", source_component=0), "source_component: 0 is out of range"),
    (lambda flight: mavloom.connect("udpin://127.0.0.1:0", source_system=0), "source_system: 0 is out of range"),
    (lambda flight: mavloom.columns(None, "ATTITUDE"), "a recording is given by its path"),
    (lambda flight: mavloom.read("a\0b"), "cannot be the path of a file")])
def test_texts_say_what_is_wrong(call, text, flight):
    with pytest.raises(mavloom.UsageError, match=text):
        call(flight)


def test_a_message_states_how_to_change_it():
    message = mavloom.Dialect().message("ATTITUDE", roll=0.5)
    with pytest.raises(AttributeError, match=r"make a new one: msg.dialect.message\(msg, roll=...\)"):
        message.roll = 1
    assert message.dialect.message(message, roll=0.25).roll == 0.25


# ---- sending

def received(vehicle, count):
    """The next messages, however many a datagram has."""
    messages = []
    while len(messages) < count:
        messages += vehicle.receive()
    return messages


def test_the_heartbeat_has_its_version(link, vehicle):
    vehicle.send(vehicle.heartbeat())
    until(lambda: link.stats.peers == 1)
    link.send("HEARTBEAT", type=6, autopilot=8)
    link.mav.heartbeat_send(6, 8, 0, 0, 4)
    link.send("HEARTBEAT", type=6, mavlink_version=0)
    assert [m.mavlink_version for m in received(vehicle, 3)] == [3, 3, 0]


def test_the_source_of_a_link_can_be_changed(link, vehicle):
    vehicle.send(vehicle.heartbeat())
    until(lambda: link.stats.peers == 1)
    link.mav.srcSystem, link.mav.srcComponent, link.mav.seq = 42, 7, 250
    for _ in range(2):
        link.send("HEARTBEAT")
    sent = [(m.get_srcSystem(), m.get_srcComponent(), m.get_seq()) for m in received(vehicle, 2)]
    assert sent == [(42, 7, 250), (42, 7, 251)]
    assert (link.mav.srcSystem, link.mav.srcComponent, link.mav.seq) == (42, 7, 252)
    for name, value in (("srcSystem", 0), ("srcComponent", 256), ("srcComponent", 0), ("seq", -1)):
        with pytest.raises(mavloom.UsageError, match="out of range"):
            setattr(link.mav, name, value)


# ---- writing recordings

def test_a_recording_is_written_and_read(flight, tmp_path):
    with mavloom.write(tmp_path / "copy.tlog") as copy:
        for message in mavloom.read(flight):
            copy.write(message)
        assert copy.records == 40087
    assert (tmp_path / "copy.tlog").read_bytes() == flight.read_bytes()
    with pytest.raises(mavloom.ClosedError):
        copy.write(message)
    with mavloom.write(tmp_path / "copy.tlog") as again:  # the other one keeps its bytes
        again.write(message.frame, time_ns=5_000_000)
    assert (tmp_path / "copy.tlog").read_bytes() == struct.pack(">Q", 5000) + message.frame
    assert (tmp_path / "copy.tlog.1").read_bytes() == flight.read_bytes()


def test_only_whole_frames_are_written(tmp_path):
    with mavloom.write(tmp_path / "x.tlog") as log:
        for wrong in (b"", b"abc", mavloom.Dialect().encode("HEARTBEAT")[:-1]):
            with pytest.raises(mavloom.InputError):
                log.write(wrong)
        with pytest.raises(TypeError):
            log.write("HEARTBEAT")
    assert (tmp_path / "x.tlog").read_bytes() == b""


def test_messages_of_mavutil_are_written(flight, tmp_path):
    log = mavutil.mavlink_connection(str(flight))
    with mavloom.write(tmp_path / "x.tlog") as out:
        for _ in range(10):
            out.write(log.recv_msg())
        with pytest.raises(mavloom.UsageError, match="was not packed or sent yet"):
            out.write(mavutil.mavlink.MAVLink_heartbeat_message(1, 2, 3, 4, 5, 3))
    assert list(frames_of(tmp_path / "x.tlog")) == list(frames_of(flight))[:10]


def test_a_link_is_recorded(link, vehicle, tmp_path):
    with link.record(tmp_path / "x.tlog") as recorder:
        assert repr(recorder) == f"<LinkRecorder {tmp_path / 'x.tlog'}: 0 frames>"
        for i in range(100):
            vehicle.send(vehicle.attitude(i))
            until(lambda: link.stats.frames_in == i + 1)
    assert [m.time_boot_ms for m in mavloom.read(tmp_path / "x.tlog")] == list(range(100))
    vehicle.send(vehicle.attitude(100))
    until(lambda: link.stats.frames_in == 101)
    assert len(list(frames_of(tmp_path / "x.tlog"))) == 100


def test_a_recording_ends_with_its_link(peer, tmp_path):
    link = mavloom.connect("udpin://127.0.0.1:0")
    recorder = link.record(tmp_path / "x.tlog")
    vehicle = Vehicle(peer, link.port)
    vehicle.send(vehicle.heartbeat(), vehicle.attitude(1))
    until(lambda: link.stats.frames_in == 2)
    link.close()
    recorder.close()
    assert [m.name for m in mavloom.read(tmp_path / "x.tlog")] == ["HEARTBEAT", "ATTITUDE"]
    vehicle.socket.close()


LEFT_OPEN = """import mavloom, socket, sys, time
link = mavloom.connect("udpin://127.0.0.1:0")
recorder = link.record(sys.argv[1])
count = int(sys.argv[2])
with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as far:
    for i in range(count):
        far.sendto(mavloom.Dialect().encode("ATTITUDE", time_boot_ms=i, yawspeed=1), ("127.0.0.1", link.port))
        while link.stats.frames_in <= i:
            time.sleep(0.001)
print("heard", flush=True)
"""


def test_an_exit_keeps_a_recording_that_is_left_open(tmp_path, child_environment):
    done = subprocess.run([sys.executable, "-c", LEFT_OPEN, tmp_path / "x.tlog", "300"], capture_output=True, text=True,
                          env=child_environment)
    assert (done.returncode, done.stdout, done.stderr) == (0, "heard\n", "")
    assert [m.time_boot_ms for m in mavloom.read(tmp_path / "x.tlog")] == list(range(300))


def test_an_exit_waits_for_a_disk_that_is_slow(tmp_path, child_environment):
    fifo = tmp_path / "slow"  # holds 64 kB, less than the recording
    os.mkfifo(fifo)
    with subprocess.Popen([sys.executable, "-c", LEFT_OPEN, fifo, "2000"], stdout=subprocess.PIPE, text=True,
                          env=child_environment) as child, open(fifo, "rb") as disk:
        assert child.stdout.readline() == "heard\n"
        time.sleep(0.5)  # so slow is the disk: a Python that does not wait for it has ended by then
        (tmp_path / "x.tlog").write_bytes(disk.read())
    assert [m.time_boot_ms for m in mavloom.read(tmp_path / "x.tlog")] == list(range(2000))


@pytest.mark.parametrize("replaced", [False, True])
def test_a_recorder_whose_file_goes_reports_it_and_begins_another(link, vehicle, tmp_path, replaced):
    path = tmp_path / "x.tlog"
    continued = tmp_path / "x_2.tlog" if replaced else path
    with pytest.warns(RuntimeWarning, match=r"x\.tlog was removed or replaced; a new file begins"), \
            link.record(path) as recorder:
        vehicle.send(vehicle.attitude(1))
        until(lambda: recorder.frames == 1)
        path.unlink()
        if replaced:
            path.write_bytes(b"")
        until(lambda: recorder.notices and continued.exists())  # without further frames
        vehicle.send(vehicle.attitude(2))
        until(lambda: recorder.frames == 2)
    assert [m.time_boot_ms for m in mavloom.read(continued)] == [2]
    assert path.exists() and (not replaced or path.read_bytes() == b"")


@pytest.mark.parametrize("replaced", [False, True])
def test_a_writer_whose_file_goes_reports_it_and_begins_another(tmp_path, replaced):
    path = tmp_path / "x.tlog"
    continued = tmp_path / "x_2.tlog" if replaced else path
    frames = [mavloom.Dialect().encode("ATTITUDE", time_boot_ms=i) for i in range(3)]
    with mavloom.write(path) as log:
        log.write(frames[0])
        log.flush()
        path.unlink()
        if replaced:
            path.write_bytes(b"")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            until(lambda: (log.write(frames[1]), caught)[1])
        assert f"{path} was removed or replaced; a new file begins" in str(caught[0].message)
        log.write(frames[2])
    times = [m.time_boot_ms for m in mavloom.read(continued)]
    assert times[0] == 1 and times[-1] == 2 and 0 not in times
    assert path.exists() and (not replaced or path.read_bytes() == b"")


def test_a_writer_whose_file_went_at_the_end_keeps_what_it_buffers(tmp_path):
    path = tmp_path / "x.tlog"
    log = mavloom.write(path)
    log.write(mavloom.Dialect().encode("ATTITUDE", time_boot_ms=7))
    path.unlink()
    with pytest.warns(RuntimeWarning, match="was removed or replaced"):
        log.close()
    assert log.records == 1 and [m.time_boot_ms for m in mavloom.read(path)] == [7]


def test_a_writer_whose_file_went_after_the_last_flush_reports_it(tmp_path):
    path = tmp_path / "x.tlog"
    log = mavloom.write(path)
    log.write(mavloom.Dialect().encode("ATTITUDE", time_boot_ms=7))
    log.flush()
    path.unlink()
    with pytest.warns(RuntimeWarning, match="was removed or replaced before it was complete"):
        log.close()
    assert not path.exists()


def test_times_before_1970_are_refused(flight, tmp_path):
    """A tlog has no sign: -1 was stored as 0."""
    with mavloom.write(tmp_path / "x.tlog") as out:
        with pytest.raises(mavloom.UsageError, match="time_ns: -1 is out of range, 0 to"):
            out.write(mavloom.read(flight).recv(), time_ns=-1)
        assert out.records == 0


@pytest.mark.parametrize("call, text", [
    (lambda link: link.subscribe(system="x"), "system: an integer, not 'x'"),
    (lambda link: link.recv_match(component=1.5), r"component: an integer, not 1\.5"),
    (lambda link: link.latest("ATTITUDE", system=1.5), r"system: an integer, not 1\.5"),
    (lambda link: setattr(link.mav, "srcSystem", "x"), "source_system: an integer, not 'x'"),
    (lambda link: setattr(link.mav, "seq", None), "seq.*: an integer, not None"),
    (lambda link: mavloom.connect("udpin://127.0.0.1:0", buffer="x"), "buffer: an integer, not 'x'"),
    (lambda link: mavloom.connect("udpin://127.0.0.1:0", version=None), "version: an integer, not None"),
    (lambda link: mavloom.Dialect().encode("HEARTBEAT", frame_seq="x"), "frame_seq: an integer, not 'x'")])
def test_arguments_that_are_no_integers_are_named(call, text):
    with mavloom.connect("udpin://127.0.0.1:0") as link, pytest.raises(TypeError, match=f"^{text}$"):
        call(link)


@pytest.mark.parametrize("call, text", [
    (lambda link: link.send(None), "send() takes (message: str | Message, /, **fields: Any), not (None)"),
    (lambda link: link.forward(None), "forward() takes (message: Message | Buffer, /), not (None)"),
    (lambda link: mavloom.RingReader(5), "RingReader() takes (name: str, *, "),
    (lambda link: mavloom.RingReader("x", lossless="a", start=3), "'newest', foreign: bool = False), "
     "not (str, lossless=str, start=int)"),
    (lambda link: mavloom.remove_ring(b"x"), "remove_ring() takes (name: str), not (bytes)"),
    (lambda link: mavloom.rings("x"), "rings() takes (), not (str)"),
    (lambda link: mavloom.Dialect().decode(), "decode() takes (frame: Buffer, time_ns: int = 0), not ()")])
def test_arguments_of_a_wrong_type_or_number_get_one_plain_line(call, text, link):
    with pytest.raises(TypeError) as caught:
        call(link)
    assert text in str(caught.value) and "\n" not in str(caught.value)


def test_what_is_no_ring_is_named():
    with mavloom.connect("udpin://127.0.0.1:0") as link:
        with pytest.raises(mavloom.UsageError, match=r"serve_inlet\(\) takes the name of a ring, not 5"):
            link.serve_inlet(5)
        with pytest.raises(mavloom.UsageError, match=r"pump\(\) takes a RingWriter, not 'px4'"):
            link.pump("px4")


# ---- files of other formats

@pytest.mark.parametrize("start, text", [
    (b"\xa3\x95\x80\x80\x59FMT", "a DataFlash log of ArduPilot"), (b"ULog\x01\x12\x35\x01", "a ULog of PX4"),
    (b"\x1f\x8b\x08\x00", "a gzip file"), (b"\xd4\xc3\xb2\xa1\x02\x00", "a pcap capture"),
    (b"SQLite format 3\0\x10\0", "an SQLite database"), (b"\x89HDF\r\n\x1a\n\0", "an HDF5 file"),
    (b'[{"time": 1}' + b',{"time": 2}' * 400 + b"]", "JSON"), (b"time,roll\r\n" + b"1,2\r\n" * 1000, "text")])
def test_files_of_other_formats_are_refused_by_name(start, text, tmp_path):
    path = pathlib.Path(tmp_path / "log")
    path.write_bytes(start + bytes(1000))
    for read in (mavloom.read, mavloom.tables, lambda path: mavloom.columns(path, "ATTITUDE")):
        with pytest.raises(mavloom.InputError, match=f"{path} is {text}, not a tlog: "):
            read(path)


@pytest.mark.parametrize("content, text", [
    (b"a,b\n1,2\n", "is text, not a tlog"), (b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 8, "begins a MAVLink record"),
    (bytes(5000), "begins a MAVLink record")])
def test_a_file_without_a_record_is_refused(content, text, tmp_path):
    path = tmp_path / "log"
    path.write_bytes(content)
    for read in (lambda path: list(mavloom.read(path)), mavloom.tables, lambda path: mavloom.columns(path, "ATTITUDE")):
        with pytest.raises(mavloom.InputError, match=text):
            read(path)
