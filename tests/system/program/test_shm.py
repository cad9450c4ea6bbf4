# SPDX-License-Identifier: MIT
"""mavloom shm, and rings whose writers and readers are killed.
ring_tool (tests/tools) writes and reads records that it can check."""
import contextlib
import ctypes
import json
import os
import pathlib
import re
import shutil
import signal
import stat
import subprocess
import time
import uuid

import pytest

import harness

SHM = pathlib.Path("/dev/shm")
MIN_RECORD_BYTES = 24  # its header
short = pytest.mark.short


@pytest.fixture
def ring():
    """A name of a ring that nobody else has, and nothing left of it."""
    name = f"system-{os.getpid()}-{uuid.uuid4().hex[:8]}"
    yield name
    for suffix in ("", ".stat"):
        with contextlib.suppress(OSError):
            (SHM / f"mavloom.{name}{suffix}").unlink()


def path_of(name):
    return SHM / f"mavloom.{name}"


@pytest.fixture(scope="session")
def ring_tool():
    path = pathlib.Path(os.environ.get("MAVLOOM_RING_TOOL",
                                       harness.program_path().parent.parent / "tests" / "bin" / "ring_tool"))
    assert path.is_file(), f"{path} is missing: build the target ring_tool, or name it in MAVLOOM_RING_TOOL"
    return path


@pytest.fixture
def start(ring_tool):
    """start("write", name, ...) -> harness.Running of ring_tool, killed at the end of the test."""
    running = []

    def call(*words):
        running.append(harness.Running([ring_tool, *words], env=harness.environment()))
        return running[-1]
    yield call
    harness.end(running)


@pytest.fixture
def tool(ring_tool):
    def call(*words):
        done = subprocess.run([str(ring_tool), *map(str, words)], capture_output=True, text=True,
                              timeout=harness.DEFAULT_TIMEOUT_S)
        return harness.Finished(words, done.returncode, done.stdout, done.stderr)
    return call


def stat_of(run, name):
    done = run("shm", "stat", name, "--json")
    assert done.status == 0, done
    return json.loads(done.stdout)


def write(run, name, text, *options):
    done = run("shm", "write", name, "--capacity", "64k", *options, input=text)
    assert done.status == 0, done
    return done


def read_all(run, name, *options):
    return run("shm", "read", name, "--from", "oldest", "--drain", *options)


# ---- the command

@short
def test_what_is_written_is_read(run, ring):
    said = write(run, ring, "one\n\nthree", "--link", "7", "--kind", "300", "--verdict", "2")
    assert f"{ring}: 3 records, 8 bytes written" in said.stderr

    assert read_all(run, ring, "--data").stdout == "one\n\nthree\n"
    records = [json.loads(line) for line in read_all(run, ring, "--json").lines]
    assert [bytes.fromhex(record["hex"]) for record in records] == [b"one", b"", b"three"]
    assert [record["sequence"] for record in records] == [0, 1, 2]
    assert [record["position"] for record in records] == [0, 32, 56]
    assert all((r["link"], r["kind"], r["verdict"], r["missed"]) == (7, 300, 2, 0) for r in records)
    assert records[2]["length"] == 5 and records[0]["time_ns"] > 1_700_000_000_000_000_000
    assert "link 7 kind 300 verdict 2  3 bytes  6f6e65" in read_all(run, ring).lines[0]


@short
def test_hexadecimal_lines(run, ring):
    write(run, ring, "00ff0A\n\n", "--hex")
    assert [json.loads(line)["hex"] for line in read_all(run, ring, "--json").lines] == ["00ff0a", ""]
    wrong = run("shm", "write", ring, "--capacity", "64k", "--hex", input="00\n0x\n")
    assert wrong.status == 3 and "line 2: expected pairs of hexadecimal digits" in wrong.stderr


@short
def test_the_next_writer_carries_on_and_another_capacity_starts_over(run, ring):
    write(run, ring, "a\n")
    write(run, ring, "b\n")
    assert read_all(run, ring, "--data").lines == ["a", "b"]
    assert run("shm", "write", ring, "--capacity", "128k", input="c\n").status == 0
    assert read_all(run, ring, "--data").lines == ["c"]
    assert stat_of(run, ring)["capacity"] == 131072
    assert run("shm", "write", ring, input="d\n").status == 0
    assert read_all(run, ring, "--data").lines == ["c", "d"], "without a capacity the ring is taken as it is"


@short
def test_a_drain_of_no_ring_ends(run, ring):
    done = read_all(run, ring)
    assert done.status == 1 and f"there is no ring {ring}" in done.stderr


@short
def test_a_record_that_is_too_long_is_named(run, ring):
    done = run("shm", "write", ring, "--capacity", "64k", input="fits\n" + "x" * 20_000 + "\n")
    assert done.status == 3 and "line 2: over 16360 bytes, the longest record that this ring takes" in done.stderr
    assert read_all(run, ring, "--data").lines == ["fits"]


@short
def test_list_and_stat(run, spawn, ring):
    write(run, ring, "x\n")
    assert f"{ring}  64 KiB, no writer, 0 readers, 1 record\n" in run("shm", "list").stdout
    reader = spawn("shm", "read", ring, "--lossless")
    harness.wait_for(lambda: stat_of(run, ring)["readers"], what="the reader")
    status = stat_of(run, ring)
    assert (status["name"], status["path"], status["mode"], status["records"],
            status["bytes"]) == (ring, str(path_of(ring)), "0600", 1, 32)
    assert not status["writer_alive"] and status["writers"] == 1 and status["full"] == "wait"
    assert status["readers"][0]["pid"] == reader.pid and status["readers"][0]["lossless"]
    assert status["readers"][0]["program"] == "mavloom"
    assert ring in [json.loads(line)["name"] for line in run("shm", "list", "--json").lines]
    assert f"process {reader.pid}, lossless" in run("shm", "stat", ring).stdout
    assert reader.stop().status == 130
    assert stat_of(run, ring)["readers"] == []


@short
def test_a_reader_waits_for_a_ring_and_states_what_there_is(run, spawn, ring):
    reader = spawn("shm", "read", ring, "--data", "--count", "2")
    reader.wait_output(f"there is no ring {ring}; .*waiting for it", stream="err")
    write(run, ring, "one\n")
    reader.wait_output("^one$", stream="out")
    write(run, ring, "two\n")
    done = reader.wait()
    assert done.status == 0 and done.stdout == "one\ntwo\n", done


@short
def test_a_reader_continues_when_the_ring_is_removed_and_comes_back(run, spawn, ring):
    write(run, ring, "one\n")
    reader = spawn("shm", "read", ring, "--data", "--from", "oldest")
    reader.wait_output("^one$", stream="out")
    assert run("shm", "remove", ring).status == 0
    assert not path_of(ring).exists()
    write(run, ring, "two\n")
    reader.wait_output("^two$", stream="out")
    path_of(ring).unlink()  # by hand
    write(run, ring, "three\n")
    reader.wait_output("^three$", stream="out")
    assert reader.stop(signal.SIGTERM).status == 143


@short
def test_a_time_ends_while_there_are_records(run, start, ring):
    """The writer never pauses, so the reader never waits: only its time can end it."""
    writer = start("write", ring, "0", "evict")
    writer.wait_output("ready")
    done = run("shm", "read", ring, "--json", "--from", "oldest", "--for", "100ms")
    assert done.status in (0, 4), done  # 4: the writer was faster
    last = json.loads(done.lines[-1])["sequence"]
    harness.wait_for(lambda: stat_of(run, ring)["records"] > last + 1, what="records after the reader's last")


@short
def test_a_drain_ends_when_the_ring_is_removed(run, spawn, ring):
    writer = spawn("shm", "write", ring, "--capacity", "64k", stdin=subprocess.PIPE)
    writer.process.stdin.write(b"one\n")
    writer.process.stdin.flush()
    harness.wait_for(lambda: path_of(ring).exists() and stat_of(run, ring)["records"] == 1, what="the record")
    reader = spawn("shm", "read", ring, "--data", "--from", "oldest", "--drain")
    reader.wait_output("^one$", stream="out")
    assert run("shm", "remove", "--force", ring).status == 0
    assert reader.wait().status == 0


@short
def test_a_lapped_reader_ends_with_status_4(run, start, spawn, ring):
    """The reader is stopped while the writer evicts everything that was there."""
    writer = start("write", ring, "0", "evict")
    writer.wait_output("ready")
    reader = spawn("shm", "read", ring, "--from", "oldest", "--json", "--count", "50000")
    reader.wait_output("sequence", stream="out")
    reader.send(signal.SIGSTOP)
    before = stat_of(run, ring)
    lap = before["capacity"] // MIN_RECORD_BYTES
    harness.wait_for(lambda: stat_of(run, ring)["records"] > before["records"] + lap, what="a lap")
    reader.send(signal.SIGCONT)
    done = reader.wait(timeout=120)
    records = [json.loads(line) for line in done.lines]
    missed = sum(record["missed"] for record in records)
    assert done.status == 4, done.stderr
    assert records[-1]["sequence"] - records[0]["sequence"] + 1 == len(records) + missed - records[0]["missed"]
    assert missed > 0 and f"{missed} missed" in done.stderr


@short
def test_remove_spares_a_ring_in_use_unless_forced(run, spawn, ring):
    writer = spawn("shm", "write", ring, "--capacity", "64k", stdin=subprocess.PIPE)
    harness.wait_for(lambda: path_of(ring).exists() and stat_of(run, ring)["writer_pid"] == writer.pid,
                     what="the writer")
    done = run("shm", "remove", ring)
    assert done.status == 1
    assert (f"ring {ring} is in use by process {writer.pid}, which writes it; "
            "--force removes it anyway") in done.stderr
    assert run("shm", "remove", "--force", ring).status == 0
    assert not path_of(ring).exists()
    writer.process.stdin.write(b"lost\n")
    writer.process.stdin.flush()
    ended = writer.wait()
    assert ended.status == 1 and "the ring was removed" in ended.stderr


@short
def test_a_second_writer_is_refused_with_the_first_ones_pid(run, spawn, ring):
    first = spawn("shm", "write", ring, "--capacity", "64k", stdin=subprocess.PIPE)
    harness.wait_for(lambda: path_of(ring).exists() and stat_of(run, ring)["writer_pid"] == first.pid,
                     what="the writer")
    second = run("shm", "write", ring, input="x\n")
    assert second.status == 1 and f"ring {ring} already has a writer, process {first.pid}" in second.stderr
    assert first.stop().status == 130
    assert stat_of(run, ring)["writer_pid"] == 0 and not stat_of(run, ring)["writer_alive"]


@short
def test_remove_at_the_end(run, ring):
    write(run, ring, "x\n", "--remove")
    assert not path_of(ring).exists()


# ---- wrong use and bad input

@short
@pytest.mark.parametrize("words", [("stat",), ("read",), ("write",), ("remove",)])
@pytest.mark.parametrize("name", ["a/b", "../etc", "a b", "x" * 65])
def test_a_name_that_is_none(run, words, name):
    done = run("shm", *words, name, input="")
    assert done.status == 2 and "is not a valid ring name: use 1 to 64 letters, digits, _ and -" in done.stderr, done
    assert len(done.stderr.splitlines()) == 1


@short
@pytest.mark.parametrize("options", [("--capacity", "1000"), ("--capacity", "96k"), ("--mode", "rw"),
                                     ("--mode", "0400"), ("--full", "maybe"), ("--kind", "70000")])
def test_options_that_are_wrong(run, ring, options):
    done = run("shm", "write", ring, *options, input="x\n")
    assert done.status == 2, done
    assert not path_of(ring).exists()


@short
def test_lines_that_a_full_ring_does_not_take(run, spawn, ring):
    write(run, ring, "first\n")
    reader = spawn("shm", "read", ring, "--from", "oldest", "--lossless", "--data")
    reader.wait_output("^first$", stream="out")
    reader.send(signal.SIGSTOP)
    done = run("shm", "write", ring, "--full", "drop_newest", input=("x" * 1000 + "\n") * 100)
    stat = stat_of(run, ring)
    os.kill(reader.pid, signal.SIGCONT)
    assert done.status == 4 and 0 < stat["dropped"] < 100, done
    assert done.stderr == (f"mavloom: {ring}: {100 - stat['dropped']} records, {(100 - stat['dropped']) * 1000} bytes "
                           f"written, {stat['dropped']} not\n")


@short
def test_absent_rings(run, ring):
    for words in (("stat", ring), ("remove", ring)):
        done = run("shm", *words)
        assert done.status == 1 and f"there is no ring {ring}; " in done.stderr


def damage(path, offset, content):
    with open(path, "r+b") as file:
        file.seek(offset)
        file.write(content)


@short
@pytest.mark.parametrize("make, text", [
    (lambda path: damage(path, 0, b"X"), "is not a Mavloom ring"),
    (lambda path: damage(path, 8, b"\x07\0\x03\0"), "is a ring of version 7.3; this program supports 1.0"),
    (lambda path: damage(path, 12, b"\x01\x02\x03\x04"), "another byte order"),
    (lambda path: os.truncate(path, 5000), "truncated"),
    (lambda path: os.truncate(path, 0), "truncated"),
    (lambda path: os.truncate(path, 40_000), "truncated"),
    (lambda path: path.write_bytes(os.urandom(81_920)), "is not a Mavloom ring"),
    (lambda path: damage(path, 128, b"\xff" * 8), "damaged"),
])
def test_files_that_are_no_rings(run, ring, make, text):
    write(run, ring, "x\n" * 10)
    make(path_of(ring))
    for words in (("read", ring, "--from", "oldest", "--drain"), ("write", ring, "--capacity", "64k")):
        done = run("shm", *words, input="x\n")
        assert done.status == 3 and text in done.stderr, done
    listed = run("shm", "list")
    assert listed.status == 0 and text in next(line for line in listed.lines if line.startswith(ring))
    assert run("shm", "remove", ring).status == 0
    assert not path_of(ring).exists()


@short
def test_the_numbers_of_a_damaged_ring_are_not_shown(run, ring):
    write(run, ring, "x\n" * 10)
    damage(path_of(ring), 128, b"\xff" * 16)  # its end, and the number of records
    assert f"{ring}  64 KiB, no writer, 0 readers, damaged\n" in run("shm", "list").stdout
    assert run("shm", "stat", ring).stdout.splitlines() == [f"{ring}  64 KiB, no writer, 0 readers, damaged",
                                                            f"  {path_of(ring)}, 0600, {path_of(ring).owner()}"]
    assert stat_of(run, ring)["damaged"]


@short
def test_damage_behind_good_records(run, ring):
    write(run, ring, "good\nbad\n")
    damage(path_of(ring), 16384 + 32, b"\xff\xff\xff\x7f")
    done = read_all(run, ring, "--data")
    assert done.status == 3 and done.stdout == "good\n" and "is damaged" in done.stderr


# ---- users, space

def as_nobody(*command):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, user=65534, group=65534,
                          extra_groups=[], timeout=harness.DEFAULT_TIMEOUT_S)


@short
@pytest.mark.skipif(os.geteuid() != 0, reason="another user needs root")
def test_another_user(run, program, ring):
    if as_nobody(program, "--version").returncode != 0:
        pytest.skip(f"others may not run {program}")
    write(run, ring, "x\n")
    done = as_nobody(program, "shm", "read", ring)
    assert done.returncode == 1 and "Permission denied; it belongs to root, mode 0600" in done.stderr, done
    done = as_nobody(program, "shm", "remove", ring)
    assert done.returncode == 1 and "Operation not permitted; it belongs to root" in done.stderr, done
    os.chmod(path_of(ring), 0o644)
    done = as_nobody(program, "shm", "read", ring, "--from", "oldest", "--drain", "--data")
    assert (done.returncode, done.stdout) == (0, "x\n"), done


@short
def test_the_mode_of_a_new_ring(run, ring):
    write(run, ring, "x\n", "--mode", "0640")
    assert stat.S_IMODE(path_of(ring).stat().st_mode) == 0o640


@short
@pytest.mark.skipif(os.geteuid() != 0 or not shutil.which("unshare"), reason="a small /dev/shm needs root and unshare")
def test_a_full_dev_shm(program):
    script = ('mount -t tmpfs -o size=1m none /dev/shm && "$0" shm write big --capacity 8M </dev/null; '
              'echo "status $?"; ls -A /dev/shm; '
              'echo x | "$0" shm write small --capacity 64k; echo "status $?"; '
              'echo y | "$0" shm write small --capacity 8M; echo "status $?"; '
              '"$0" shm read small --from oldest --drain --data')
    done = subprocess.run(["unshare", "--mount", "sh", "-c", script, str(program)], capture_output=True, text=True,
                          timeout=harness.DEFAULT_TIMEOUT_S)
    if "status" not in done.stdout:
        pytest.skip(f"no mount namespace here: {done.stderr.strip()}")
    # a ring stays until its successor has room
    assert done.stdout.split("\n") == ["status 1", "status 0", "status 1", "x", ""], done
    assert ("cannot create /dev/shm/mavloom.big of 8404992 bytes: No space left on device; "
            "/dev/shm has 1048576 bytes free") in done.stderr


# ---- killed, at any moment

@short
def test_a_writer_killed_at_each_step_of_a_commit(tool, run, ring):
    """From the claim to behind the commit, over padding and marks: what was committed is there, whole and in order, and
    the next writer carries on."""
    committed = 0
    for step in range(0, 150, 3):
        died = tool("die", ring, step % 7, step)
        assert died.status == -signal.SIGKILL, died
        held = json.loads(tool("check", ring).stdout)
        end = held["first"] + held["count"]
        assert end >= committed + step % 7, (step, held)
        committed = end
    assert stat_of(run, ring)["records"] == committed


def write_for_a_while_and_be_killed(start, rng, ring):
    writer = start("write", ring, "0", "evict")
    writer.wait_output("ready")
    time.sleep(rng.random() * 0.01)  # chooses the instant; no verdict depends on it
    writer.kill()


def kill_rounds(tool, start, rng, ring, rounds):
    committed = 0
    for _ in range(rounds):
        write_for_a_while_and_be_killed(start, rng, ring)
        checked = tool("check", ring)
        assert checked.status == 0, checked
        held = json.loads(checked.stdout)
        assert held["first"] + held["count"] >= committed
        committed = held["first"] + held["count"]


@short
def test_a_writer_killed_at_random_instants(tool, start, rng, ring):
    kill_rounds(tool, start, rng, ring, 10)


@pytest.mark.long
@pytest.mark.timeout(600)
def test_a_writer_killed_at_a_thousand_random_instants(tool, start, rng, ring):
    kill_rounds(tool, start, rng, ring, 1000)


@short
def test_readers_outlive_writers_that_are_killed(start, rng, ring):
    first = start("write", ring, "0", "evict")
    first.wait_output("ready")
    readers = [start("read", ring, kind, "0") for kind in ("lossy", "lossless", "polling")]
    for reader in readers:
        reader.wait_output("ready")
    first.kill()
    for _ in range(5):
        write_for_a_while_and_be_killed(start, rng, ring)
    assert all(reader.alive for reader in readers), [reader.stderr for reader in readers]
    last = start("write", ring, "2000", "evict")
    assert last.wait().status == 0
    assert all(reader.alive for reader in readers), [reader.stderr for reader in readers]


@short
def test_the_hold_of_a_killed_reader_is_released(run, start, ring):
    writer = start("write", ring, "0", "wait")
    writer.wait_output("ready")
    for _ in range(3):
        reader = start("read", ring, "lossless", "0")
        reader.wait_output("ready")
        reader.send(signal.SIGSTOP)
        held = stat_of(run, ring)["readers"]
        assert [r["pid"] for r in held] == [reader.pid], "a stopped reader is not dead"
        reader.kill()
        before = stat_of(run, ring)["records"]
        harness.wait_for(lambda: stat_of(run, ring)["records"] > before + 1000, what="the writer to go on")
    assert writer.alive and stat_of(run, ring)["dropped"] == 0


def stopped_reader_holds(run, start, ring, seconds):
    """Silence is never taken for death: the writer waits for a lossless reader that is stopped, and afterwards both
    continue where they were."""
    writer = start("write", ring, "0", "wait")
    writer.wait_output("ready")
    reader = start("read", ring, "lossless", "0")
    reader.wait_output("ready")
    reader.send(signal.SIGSTOP)
    full = 65536 - 2 * 1528  # no room for one of the longest records, with padding before it
    harness.wait_for(lambda: stat_of(run, ring)["readers"][0]["behind_bytes"] >= full, what="a held writer")
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        time.sleep(min(1, seconds / 5))  # how long it is stopped is what is tested
        status = stat_of(run, ring)
        assert (status["evictions"], status["dropped"]) == (0, 0)
        held, = status["readers"]
        assert held["pid"] == reader.pid and held["holds"] and full <= held["behind_bytes"] <= 65536
    reader.send(signal.SIGCONT)
    harness.wait_for(lambda: stat_of(run, ring)["records"] > status["records"] + 1000, what="both to go on")
    status = stat_of(run, ring)
    assert status["evictions"] == 0 and status["readers"][0]["missed"] == 0 and reader.alive and writer.alive


@short
def test_a_stopped_reader_is_not_taken_for_dead(run, start, ring):
    stopped_reader_holds(run, start, ring, 0.5)  # 50 looks of a waiting writer


@pytest.mark.long
def test_a_reader_stopped_for_half_a_minute_is_not_taken_for_dead(run, start, ring):
    stopped_reader_holds(run, start, ring, 30)


def count_of(reader):
    done = reader.wait()
    assert done.status == 0, done
    return json.loads(done.stdout.splitlines()[-1])


@short
def test_lapped_readers_learn_how_many_they_missed(start, ring):
    writer = start("write", ring, "0", "evict")
    writer.wait_output("ready")
    readers = [start("read", ring, kind, "50000") for kind in ("lossy", "lossless", "polling")]
    for reader in readers:
        done = count_of(reader)  # checks each record and each gap itself
        assert done["next"] >= 50_000 and done["delivered"] + done["missed"] <= done["next"]
    assert writer.alive


def follow_numbers(start, ring, count):
    """The payload is the sequence number, so that the reader sees itself how many it missed."""
    writer = start("count", ring)
    writer.wait_output("ready")
    reader = start("follow", ring, str(count))
    done = reader.wait(timeout=3600)
    assert done.status == 0, done
    told = json.loads(done.stdout.splitlines()[-1])
    assert told["missed"] > 0 and told["delivered"] + told["missed"] == told["next"] - told["first"] and writer.alive


@short
def test_lapped_readers_over_a_few_million_records(start, ring):
    follow_numbers(start, ring, 3_000_000)


@pytest.mark.long
@pytest.mark.timeout(4000)
def test_lapped_readers_over_a_thousand_million_records(start, ring):
    follow_numbers(start, ring, 1_000_000_000)


def come_and_go(run, start, rng, ring, rounds, at_once):
    writer = start("write", ring, "0", "evict")
    writer.wait_output("ready")
    running = []
    for _ in range(rounds):
        reader = start("read", ring, rng.choice(["lossy", "lossless", "polling"]), "0")
        running.append(reader)
        if len(running) > at_once:
            gone = running.pop(rng.randrange(len(running)))
            assert gone.alive, gone.stderr
            gone.kill()
    for reader in running:
        reader.wait_output("ready")
        assert reader.alive, reader.stderr
        reader.kill()
    harness.wait_for(lambda: stat_of(run, ring)["readers"] == [], what="all slots to be free")
    assert writer.alive, writer.stderr


@short
def test_readers_come_and_go(run, start, rng, ring):
    come_and_go(run, start, rng, ring, 20, 6)


@pytest.mark.long
@pytest.mark.timeout(600)
def test_64_readers_come_and_go(run, start, rng, ring):
    come_and_go(run, start, rng, ring, 400, 64)


@short
@pytest.mark.skipif(os.geteuid() != 0 or not shutil.which("unshare"),
                    reason="another PID namespace needs root and unshare")
def test_locks_are_seen_from_another_pid_namespace(run, start, program, ring):
    writer = start("write", ring, "0", "evict")
    writer.wait_output("ready")
    inside = ["unshare", "--pid", "--fork", str(program), "shm"]
    listed = subprocess.run([*inside, "stat", ring, "--json"], capture_output=True, text=True,
                            timeout=harness.DEFAULT_TIMEOUT_S)
    if listed.returncode != 0 and "unshare" in listed.stderr:
        pytest.skip(f"no PID namespace here: {listed.stderr.strip()}")
    assert json.loads(listed.stdout)["writer_alive"]
    writer.kill()
    listed = subprocess.run([*inside, "stat", ring, "--json"], capture_output=True, text=True,
                            timeout=harness.DEFAULT_TIMEOUT_S)
    assert not json.loads(listed.stdout)["writer_alive"]


# ---- the format page

@short
def test_the_example_of_the_format_page(run, ring):
    page = (harness.ROOT / "docs/formats/ring.md").read_text()
    dump = re.findall(r"^(\d{5})  ((?:[0-9a-f]{2} ?| )+)", page, re.MULTILINE)
    expected = bytearray(b"".join(bytes.fromhex(content) for _, content in dump))
    assert [int(offset) for offset, _ in dump] == [16384, 16400, 16416, 16432] and len(expected) == 56
    assert expected[16:24] == (1_700_000_000_000_000_123).to_bytes(8, "little")
    write(run, ring, "hello\n", "--link", "7", "--kind", "1", "--verdict", "2")
    write(run, ring, "\n")
    found = path_of(ring).read_bytes()
    expected[16:24] = found[16400:16408]  # the times are now
    expected[48:56] = found[16432:16440]
    assert found[16384:16440] == expected


@short
def test_identity_and_control_words_are_where_the_format_page_has_them(run, spawn, ring):
    write(run, ring, "one\ntwo\n", "--full", "evict")
    reader = spawn("shm", "read", ring, "--from", "oldest", "--lossless", "--data")
    reader.wait_output("^two$", stream="out")
    harness.wait_for(lambda: stat_of(run, ring)["readers"][0]["behind_records"] == 0, what="the reader's position")
    found = path_of(ring).read_bytes()
    word = lambda offset, size=8: int.from_bytes(found[offset:offset + size], "little")
    assert found[:8] == b"MVLRING\0" and (word(8, 2), word(10, 2), word(12, 4)) == (1, 0, 0x01020304)
    assert (word(16), word(24, 4), word(28, 4)) == (65536, 16384, 64) and len(found) == 16384 + 65536
    assert (word(64, 4), word(68, 4), word(80), word(88), word(96)) == (0, 2, 1, 0, 0)
    assert (word(128), word(136)) == (64, 2), "tail and number of records"
    assert word(256) == 1024, "announced up to the end of the first sixty-fourth"
    assert (word(264), word(272), word(396, 4)) == (1, 1, 0), "slot 0 holds; not retired"
    assert (word(1024), word(1032)) == (0, 0), "the first mark"
    assert (word(4096), word(4104), word(4112)) == (64, 2, 0), "position, sequence, missed of the reader in slot 0"
    assert (word(4160, 4), word(4164, 4)) == (reader.pid, 1) and found[4176:4192] == b"mavloom".ljust(16, b"\0")
