# SPDX-License-Identifier: MIT
"""mavloom.read() against pymavlink's reader on the recorded flight and on damaged files.
"Row N": the wishes listed in docs/guide/python.md."""
import contextlib
import fcntl
import json
import math
import os
import pty
import re
import signal
import struct
import subprocess
import sys
import termios
import threading
import time

import pytest

import mavloom
from places import PROGRAM
from tlogs import FIRST_TIME_US, frames_of, packer, record, write

FRAMES = 40_087


def equal(ours, theirs):
    if isinstance(theirs, list):
        return len(ours) == len(theirs) and all(map(equal, ours, theirs))
    return ours == theirs or (isinstance(theirs, float) and math.isnan(theirs) and math.isnan(ours))


def test_every_message_and_value_is_pymavlinks(flight, peer):
    """Every message equals that of pymavlink."""
    mav = peer.MAVLink(None)
    mav.robust_parsing = True
    count = 0
    log = mavloom.read(flight)
    for (time_us, frame), ours in zip(frames_of(flight), log, strict=True):
        theirs = mav.parse_char(frame)
        assert ours.time_ns == time_us * 1000 and ours._timestamp == time_us * 1e-6
        assert (ours.name, ours.sys, ours.comp, ours.header.seq, ours.header.frame) == (
            theirs.get_type(), theirs.get_srcSystem(), theirs.get_srcComponent(), theirs.get_seq(), frame)
        for name, value in theirs.to_dict().items():
            if name != "mavpackettype":
                assert equal(ours[name], value), (ours, name, value)
        count += 1
    assert count == FRAMES == log.stats.records
    assert (log.stats.junk_bytes, log.stats.record_bytes, log.percent) == (0, flight.stat().st_size, 100.0)


def test_row_13_to_json_is_the_programs_line(flight):
    lines = subprocess.run([PROGRAM, "listen", str(flight), "--json", "-q"], capture_output=True,
                           check=True).stdout.decode().splitlines()
    assert [message.to_json() for message in mavloom.read(str(flight))] == lines


def test_example_7_counts_heartbeats(flight):
    log = mavloom.read(flight)
    n = sum(1 for m in log if m.name == "HEARTBEAT")
    mine = [frame for _, frame in frames_of(flight) if frame[7:10] == b"\0\0\0"]
    assert n == len(mine) > 100
    assert log.stats.junk_bytes == 0


def test_a_damaged_file_continues_behind_the_damage(flight, tmp_path):
    whole = list(frames_of(flight))[:2000]
    records = [record(frame, i) for i, (_, frame) in enumerate(whole)]
    damaged = bytearray(records[500])
    damaged[20] ^= 0xff
    path = tmp_path / "x.tlog"
    path.write_bytes(b"".join([*records[:500], bytes(damaged), *records[501:1500], b"\x55" * 100, *records[1500:],
                               records[7][:11]]))

    log = mavloom.read(path)

    assert [m.header.frame for m in log] == [frame for i, (_, frame) in enumerate(whole) if i != 500]
    assert (log.stats.junk_bytes, log.stats.damaged_places) == (len(damaged) + 100 + 11, 3)


def test_row_1_a_file_never_makes_one_wait(flight, tmp_path):
    (tmp_path / "empty.tlog").write_bytes(b"")
    log = mavloom.read(tmp_path / "empty.tlog")
    assert log.recv_match(blocking=True, timeout=None) is None
    assert log.recv_match(type="ATTITUDE", blocking=True, timeout=1000) is None
    assert (log.recv(), log.percent) == (None, 100.0)


def test_row_1_the_deadline_holds_for_a_pipe(tmp_path):
    path = tmp_path / "pipe"
    os.mkfifo(path)
    beat = mavloom.Dialect().encode("HEARTBEAT", custom_mode=7)
    log = mavloom.read(path)
    assert log.recv(timeout=0.05) is None  # nobody has it open to write
    with open(os.open(path, os.O_RDWR), "wb", buffering=0) as pipe:
        for ask in (lambda: log.recv(timeout=0.05), lambda: log.recv(timeout=0),
                    lambda: log.recv_match(type="HEARTBEAT", blocking=True, timeout=0.05)):
            assert ask() is None
        for number in range(3):
            pipe.write(record(beat, number))
        assert log.recv_match(type="ATTITUDE", timeout=0) is None
        pipe.write(record(beat, 3)[:12])
        assert log.recv(timeout=0.05) is None
        pipe.write(record(beat, 3)[12:])
        assert log.recv(timeout=60).custom_mode == 7
    assert log.recv(timeout=60) is None and log.stats.records == 4


def test_a_time_out_makes_recv_match_wait_for_a_pipe(tmp_path):
    path = tmp_path / "pipe"
    os.mkfifo(path)
    log, beat = mavloom.read(path), record(mavloom.Dialect().encode("HEARTBEAT"), 1)
    with open(os.open(path, os.O_RDWR), "wb", buffering=0) as pipe:
        for options in ({}, {"blocking": False}, {"blocking": False, "timeout": 60}, {"timeout": 0}):
            assert log.recv_match(type="HEARTBEAT", **options) is None
        for options in ({"timeout": 60}, {"blocking": True, "timeout": 60}, {"blocking": True}):
            timer = threading.Timer(0.1, pipe.write, (beat,))
            timer.start()
            assert log.recv_match(type="HEARTBEAT", **options).name == "HEARTBEAT"
            timer.join()


def test_row_1_the_deadline_holds_for_a_condition_that_is_slow(flight):
    assert mavloom.read(flight).recv_match(condition=lambda _: time.sleep(0.005), blocking=True, timeout=0.3) is None


def test_row_1_a_poll_looks_at_all_of_a_file(flight):
    log = mavloom.read(flight)
    assert log.recv_match(condition=lambda m: m.sys == -1, timeout=0) is None
    assert log.percent == 100


def test_example_11_a_forked_child_moves_nothing_in_its_parent(flight, child_environment):
    code = f"""
import mavloom, os, sys
log = mavloom.read({str(flight)!r})
next(log)
pid = os.fork()
left = sum(1 for _ in log)
if pid == 0:
    os._exit(left != {FRAMES - 1})
print(left, os.waitpid(pid, 0)[1])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=child_environment,
                          timeout=60)
    assert (done.stdout, done.stderr) == (f"{FRAMES - 1} 0\n", "")


def test_counters_are_shown(flight):
    log, parser, dialect = mavloom.read(flight), mavloom.Parser(), mavloom.Dialect()
    assert (repr(log.stats), repr(parser)) == ("RecordingStats(all 0)", "Parser(all 0)")
    for _ in log:
        pass
    assert repr(log.stats) == f"RecordingStats(records={FRAMES}, record_bytes={flight.stat().st_size})"
    parser.feed(b"junk" + dialect.encode("HEARTBEAT"))
    assert repr(parser) == "Parser(frames=1, junk_bytes=4)"
    with (mavloom.connect("udpin://127.0.0.1:0") as receiver,
          mavloom.connect(f"udpout://127.0.0.1:{receiver.port}") as sender):
        assert repr(receiver.stats) == "LinkStats(all 0)"
        assert repr(receiver._port) == f"<Port of the Link {receiver.name}>"
        sender.send("HEARTBEAT")
        receiver.recv(timeout=10)
        assert repr(receiver.stats).startswith("LinkStats(peers=1, frames_in=1, bytes_in=21, ")
        assert "received=1)" in repr(receiver.stats)


def test_row_29_types_each_call_with_its_own(flight, peer):
    """pymavlink keeps the first list in force."""
    log = mavloom.read(flight)
    ids = {"ATTITUDE": 30, "HEARTBEAT": 0}
    wanted = iter(frames_of(flight))
    for name in ("ATTITUDE", "HEARTBEAT", "ATTITUDE"):
        expected = next(frame for _, frame in wanted if frame[7] == ids[name] and frame[8:10] == b"\0\0")
        assert log.recv_match(type=[name]).header.frame == expected
    assert log.recv_match(type=("ATTITUDE", "VFR_HUD")).name in ("ATTITUDE", "VFR_HUD")
    assert log.recv_match(type=mavloom.messages.HEARTBEAT).name == "HEARTBEAT"
    assert log.recv_match(type={"HEARTBEAT"}).name == "HEARTBEAT"
    with pytest.raises(ValueError, match="did you mean 'ATTITUDE'"):
        log.recv_match(type="ATITUDE", blocking=True)
    with pytest.raises(TypeError):
        log.recv_match(type=5)


def test_condition_is_called_and_text_is_refused(flight):
    log = mavloom.read(flight)
    found = log.recv_match(type="ATTITUDE", condition=lambda m: m.time_boot_ms > 100_000)
    assert found.time_boot_ms > 100_000
    with pytest.raises(TypeError, match="callable"):
        log.recv_match(condition="ATTITUDE.roll > 1")
    with pytest.raises(ZeroDivisionError):
        log.recv_match(condition=lambda m: 1 // 0)


def test_the_loop_of_pymavlink_users(flight):
    log, count = mavloom.read(flight), 0
    while True:
        m = log.recv_match(type=["GLOBAL_POSITION_INT"])
        if m is None:
            break
        count += 1
    assert count == sum(1 for m in mavloom.read(flight, type="GLOBAL_POSITION_INT"))
    log.rewind()
    assert log.recv().frame == next(frames_of(flight))[1]


def test_row_3_systems_and_components_are_distinguished(flight):
    ground = [m for m in mavloom.read(flight, system=255)]
    assert len(ground) == 113 and {m.comp for m in ground} == {190}
    assert sum(1 for _ in mavloom.read(flight, system=1, component=1)) == FRAMES - 113
    assert mavloom.read(flight).recv_match(type="HEARTBEAT", system=255).sys == 255


def test_row_11_another_dialect(tmp_path, peer):
    (tmp_path / "mine.xml").write_text(
        '<mavlink><messages><message id="61000" name="MINE"><field type="uint16_t" name="a">a</field></message>'
        '</messages></mavlink>')
    mine = mavloom.Dialect(tmp_path / "mine.xml")
    path = write(tmp_path / "x.tlog", [mine.encode("MINE", a=i) for i in range(5)])

    assert [m.a for m in mavloom.read(path, dialect=mine)] == list(range(5))
    log = mavloom.read(path)
    assert [(m.name, m.id) for m in log] == [(None, 61000)] * 5
    assert log.stats.unknown_ids == 5


def test_row_24_times_are_the_recorded_ones(tmp_path):
    path = write(tmp_path / "x.tlog", [mavloom.Dialect().encode("HEARTBEAT")] * 3)
    assert [m.time_ns for m in mavloom.read(path)] == [(FIRST_TIME_US + 1000 * i) * 1000 for i in range(3)]
    message = mavloom.read(path).recv()
    assert (message.link, message.link_name) == (0, f"tlog://{path}")


def test_row_26_closing(flight):
    with mavloom.read(flight) as log:
        assert log.recv() is not None
    log.close()
    with pytest.raises(mavloom.ClosedError):
        log.recv()
    with pytest.raises(mavloom.ClosedError):
        next(log)
    assert log.stats.records > 0


def test_errors_of_the_system_are_named(tmp_path):
    with pytest.raises(FileNotFoundError) as raised:
        mavloom.read(tmp_path / "absent.tlog")
    assert isinstance(raised.value, mavloom.Error) and "absent.tlog" in str(raised.value)
    with pytest.raises(OSError) as raised:
        mavloom.read(tmp_path).recv()
    assert isinstance(raised.value, mavloom.SystemFailure)


def test_row_17_threads_share_a_recording(flight):
    log, found = mavloom.read(flight), []

    def work():
        found.append(sum(1 for _ in log))
    threads = [threading.Thread(target=work, daemon=True) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sum(found) == FRAMES


def test_row_6_the_gil_is_free_while_a_pipe_is_empty(tmp_path):
    """A reader waits in one thread; this one runs on, or nothing would ever be written."""
    path = tmp_path / "pipe"
    os.mkfifo(path)
    frames = [mavloom.Dialect().encode("HEARTBEAT", custom_mode=i) for i in range(3)]
    with open(os.open(path, os.O_RDWR), "wb", buffering=0) as pipe:
        log, found = mavloom.read(path), []
        thread = threading.Thread(target=lambda: [found.append(log.recv()) for _ in frames], daemon=True)
        thread.start()
        for i, frame in enumerate(frames):
            pipe.write(record(frame, i))
        thread.join(60)
    assert [m.custom_mode for m in found] == [0, 1, 2]


def test_ctrl_c_ends_a_wait(tmp_path, child_environment):
    """Ctrl-C raises KeyboardInterrupt, even while the recording is a pipe without data."""
    path = tmp_path / "pipe"
    os.mkfifo(path)
    with open(os.open(path, os.O_RDWR), "wb", buffering=0):
        child = subprocess.Popen([sys.executable, "-c",
                                  f"import mavloom\nlog = mavloom.read({str(path)!r})\nprint('ready', flush=True)\n"
                                  "log.recv()"],
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=child_environment)
        try:
            assert child.stdout.readline() == "ready\n"
            while child.poll() is None:  # a signal may come before the wait does
                child.send_signal(signal.SIGINT)
                try:
                    child.wait(0.2)
                except subprocess.TimeoutExpired:
                    pass
            assert "KeyboardInterrupt" in child.stderr.read()
        finally:
            child.kill()
            child.communicate()


def test_a_signal_handler_may_close_it(tmp_path, child_environment):
    path = tmp_path / "pipe"
    os.mkfifo(path)
    code = (f"import mavloom, signal\nlog = mavloom.read({str(path)!r})\n"
            "signal.signal(signal.SIGALRM, lambda *_: log.close())\n"
            "signal.setitimer(signal.ITIMER_REAL, 0.1, 0.1)\ntry: next(log)\n"
            "except mavloom.ClosedError: print('closed')\n"
            "signal.setitimer(signal.ITIMER_REAL, 0)")  # Python's end takes the handler away
    with open(os.open(path, os.O_RDWR), "wb", buffering=0):
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=child_environment,
                              timeout=60)
    assert (done.returncode, done.stdout, done.stderr) == (0, "closed\n", "")


def test_an_exit_with_all_of_it_open_is_silent(flight, child_environment):
    code = (f"import mavloom\nlog = mavloom.read({str(flight)!r})\nkept = [next(log) for _ in range(1000)]\n"
            "cycle = [log]; cycle.append(cycle)\n"
            "parser = mavloom.Parser()\ndialect = mavloom.Dialect()\nkind = dialect.enum('MAV_TYPE')")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=child_environment)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_no_object_is_left_behind(flight, child_environment):
    code = (f"import mavloom\nmavloom._core.set_leak_warnings(True)\nlog = mavloom.read({str(flight)!r})\n"
            "kept = [next(log) for _ in range(1000)]\n"
            "kept[0].to_dict(); kept[0].dialect.enum('MAV_TYPE'); mavloom.Parser().feed(kept[0].frame)\n"
            f"mavloom.columns({str(flight)!r}, 'ATTITUDE')\n"
            "link = mavloom.connect('udpin://127.0.0.1:0'); link.subscribe('ATTITUDE'); link.close()\n"
            "try: link.recv()\nexcept mavloom.Error as error: pass\ndel log, kept, link\n")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=child_environment)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_json_of_a_message_names_the_link(flight):
    assert json.loads(mavloom.read(flight).recv().to_json())["link"] == f"tlog://{flight}"


def test_packer_and_reader_agree(peer, tmp_path):
    sender = packer(peer, 2, 3)
    path = write(tmp_path / "x.tlog",
                 [sender.pack(peer.MAVLink_heartbeat_message(1, 2, 3, i, 5, 3)) for i in range(300)])
    assert ([(m.seq, m.custom_mode, m.sys, m.comp) for m in mavloom.read(path)]
            == [(i % 256, i, 2, 3) for i in range(300)])


# ---- progress --------------------------------------------------------------------------------------------------------

SLOW_READER = """
import sys, time
import mavloom
recording = mavloom.read(sys.argv[1], **({"progress": True} if sys.argv[2] == "yes" else {}))
for number, message in enumerate(recording):
    if number % 512 == 0:
        time.sleep(0.01)
assert number == 40086
recording.rewind()
assert next(iter(recording)).name
print(recording.summary().frames)
"""


def all_that_was_written(terminal):
    """The kernel may pass it on in pieces."""
    seen = b""
    with open(terminal, "rb", buffering=0) as file, contextlib.suppress(OSError):  # EIO: the end
        while piece := file.read(1 << 16):
            seen += piece
    return seen.decode()


def text_on_terminal(flight, progress, environment):
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 60, 0, 0))
    with subprocess.Popen([sys.executable, "-c", SLOW_READER, flight, progress], stdout=subprocess.PIPE, stderr=theirs,
                          env=environment, text=True) as process:
        os.close(theirs)
        seen = all_that_was_written(ours)
        assert process.stdout.read() == "40087\n", seen
    return seen


def test_progress_is_shown_on_a_terminal_if_it_is_asked_for(flight, child_environment):
    seen = text_on_terminal(flight, "yes", child_environment)
    lines = [line.rstrip() for line in seen.split("\r") if line.strip()]
    assert lines and all(re.fullmatch(r" *\d+ %  \d+ frames  .*00:0\d.*left", line) for line in lines), seen
    assert max(map(len, lines)) < 60 and re.search(r"\r +\r$", seen), "the line fits, and is erased at the end"
    assert text_on_terminal(flight, "no", child_environment) == ""


def test_progress_off_a_terminal_is_silent(flight, child_environment):
    done = subprocess.run([sys.executable, "-c", SLOW_READER, flight, "yes"], capture_output=True, text=True,
                          env=child_environment, check=True)
    assert done.stderr == ""
    assert mavloom.read(flight, progress=True).summary().frames == 40087  # under pytest, whose stderr is no file


SLOW_COLUMNS = """
import os, sys, threading, time
import mavloom
flight, pipe, what = sys.argv[1:]
os.mkfifo(pipe)
def write():
    with open(flight, "rb") as file, open(pipe, "wb") as out:
        records = file.read()
        for _ in range(5):  # 11 MB
            out.write(records)
            time.sleep(0.2)
threading.Thread(target=write).start()
if what == "columns":
    print(len(mavloom.columns(pipe, "ATTITUDE", progress=True)) // 5)
else:
    print(len(mavloom.tables(pipe, progress=True)["ATTITUDE"]) // 5)
"""


@pytest.mark.parametrize("what", ["columns", "tables"])
def test_columns_show_progress_on_a_terminal(flight, child_environment, tmp_path, what):
    ours, theirs = pty.openpty()
    done = subprocess.run([sys.executable, "-c", SLOW_COLUMNS, flight, tmp_path / "pipe", what], stdout=subprocess.PIPE,
                          stderr=theirs, env=child_environment, text=True, check=True)
    os.close(theirs)
    seen = all_that_was_written(ours)
    assert int(done.stdout) == len(mavloom.columns(flight, "ATTITUDE"))
    assert re.search(r"\r *\d+ frames", seen) and re.search(r"\r +\r$", seen), seen
