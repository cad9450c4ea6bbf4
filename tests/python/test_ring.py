# SPDX-License-Identifier: MIT
"""RingWriter, RingReader and mavloom.hear, beside the program's `mavloom shm`.

test_row_N_... covers row N of the table in docs/guide/python.md. Some rows are tested elsewhere, or not only here:

    3.4, 3.6  a writer killed at each step of a commit   tests/system/program/test_shm.py, test_a_writer_killed_at_*
    3.8       across PID namespaces                      tests/system/program/test_shm.py, test_locks_are_seen_from_*
    3.11      `shm remove` names the owner               tests/system/program/test_shm.py, test_another_user
    3.15      counts only; what it costs the others in time is for measurements, not for tests
    3.18      all schedules of a few operations          tests/unit/shm/ring_schedules_test.cpp
              threads under ThreadSanitizer              tests/unit/shm/ring_threads_test.cpp
    3.21      the thread behind descriptors by itself    tests/unit/shm/ring_waiter_test.cpp
"""
import array
import asyncio
import concurrent.futures
import contextlib
import ctypes
import gc
import io
import json
import os
import pathlib
import random
import signal
import socket
import stat
import struct
import selectors
import subprocess
import sys
import threading
import time
import uuid

import numpy
import pytest

import mavloom
from places import PROGRAM, free_port
from tlogs import frames_of

DEADLINE_S = 60
SHM = pathlib.Path("/dev/shm")
KIB = 1024
as_root = pytest.mark.skipif(os.geteuid() != 0, reason="needs root")
NOBODY = 65534


def path_of(name, suffix=""):
    return SHM / f"mavloom.{name}{suffix}"


@pytest.fixture
def ring():
    """A name of a ring that nobody else has, and nothing left of it."""
    name = f"python-{os.getpid()}-{uuid.uuid4().hex[:8]}"
    yield name
    for suffix in ("", ".stat"):
        path_of(name, suffix).unlink(missing_ok=True)


@pytest.fixture
def writer(ring):
    with mavloom.RingWriter(ring, capacity=64 * KIB) as made:
        yield made


@pytest.fixture
def start(child_environment):
    """start(code, *arguments) -> a Python process with mavloom imported, killed at the end of the test."""
    processes = []

    def call(code, *words, **options):
        head = "import gc, os, signal, sys, threading, time\nimport mavloom\nring = sys.argv[1]\n"
        processes.append(subprocess.Popen([sys.executable, "-c", head + code, *map(str, words)], text=True,
                                          start_new_session=True, env={**child_environment, "PYTHONWARNINGS": "ignore"},
                                          stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                          **options))
        return processes[-1]
    yield call
    for process in processes:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


def ended(process):
    """(status, stdout, stderr) of a process at its end."""
    out, talk = process.communicate(timeout=DEADLINE_S)
    return process.returncode, out, talk


def until(condition):
    end = time.monotonic() + DEADLINE_S
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.005)


def program(*words, **options):
    done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=DEADLINE_S, **options)
    assert done.returncode == 0, done
    return done.stdout


def status_of(name):
    """Returns the output of `mavloom shm stat`."""
    return json.loads(program("shm", "stat", name, "--json"))


def fill(writer, count=10, first=0):
    """Records "n" with n as their time."""
    for number in range(first, first + count):
        writer.write(b"%d" % number, time_ns=number)


def numbers(records):
    return [int(bytes(record.data)) for record in records]


# ---- one process: what is written is read

def test_what_a_record_contains(writer, ring):
    reader = mavloom.RingReader(ring)
    before = time.time_ns()
    assert writer.write(b"now") is True
    for number, data in enumerate((b"bytes", bytearray(b"bytearray"), memoryview(b"a view")[2:],
                                   numpy.arange(3, dtype="<u2"), b"")):
        writer.write(data, time_ns=-number, link=2**32 - 1, kind=2**16 - 1, verdict=255)
    now = reader.read()
    assert (now.data, now.link, now.kind, now.verdict, now.position) == (b"now", 0, 0, 0, 0)
    assert before <= now.time_ns <= time.time_ns()
    rest = [reader.read(0) for _ in range(5)]
    assert [r.data for r in rest] == [b"bytes", b"bytearray", b"view", b"\0\0\1\0\2\0", b""]
    assert all((r.time_ns, r.link, r.kind, r.verdict) == (-i, 2**32 - 1, 2**16 - 1, 255) for i, r in enumerate(rest))
    assert [r.position for r in rest] == [32, 64, 104, 136, 168]
    assert all(rest)  # also the empty one
    assert reader.read(0) is None and now.data == b"now"  # a copy
    assert (writer.records, writer.dropped, reader.missed) == (6, 0, 0)


@pytest.mark.parametrize("lossless", [False, True])
def test_newest_and_oldest(writer, ring, lossless):
    fill(writer, 3)
    newest, oldest = (mavloom.RingReader(ring, lossless=lossless, start=start) for start in ("newest", "oldest"))
    fill(writer, 3, first=3)
    writer.close()
    assert numbers(newest) == [3, 4, 5] and numbers(oldest) == [0, 1, 2, 3, 4, 5]


@pytest.mark.parametrize("lossless", [False, True])
def test_batches_are_sequences(writer, ring, lossless):
    reader = mavloom.RingReader(ring, lossless=lossless)
    fill(writer, 1500)
    sizes, found = [], []
    for batch in reader.batches(timeout=0):
        sizes.append(len(batch))
        found += numbers(batch)
        assert int(bytes(batch[-1].data)) == found[-1] == int(bytes(batch[len(batch) - 1].data))
        with pytest.raises(IndexError):
            batch[len(batch)]
        batch.release()
        batch.release()
        with pytest.raises(ValueError, match="released"):
            _ = batch[0].data
        assert batch[0].time_ns == found[-len(batch)]
    assert found == list(range(1500)) and max(sizes) > 100 and reader.missed == 0


@pytest.mark.parametrize("call", ["next(mavloom.RingReader.batches(42))",
                                  "next(mavloom.RingReader.__new__(mavloom.RingReader).batches(0))",
                                  "next(type(reader.batches()).__new__(type(reader.batches())))"])
def test_batches_of_what_is_no_open_reader_are_a_type_error(writer, ring, start, call):
    process = start(f"""
reader = mavloom.RingReader(ring)
try:
    {call}
except TypeError:
    print("refused")
""", ring)
    assert ended(process)[:2] == (0, "refused\n")


def test_batches_keep_their_reader_and_no_more(writer, ring):
    """The time-out is a number from the call on, and the garbage collector sees the reader."""
    reader = mavloom.RingReader(ring)
    for wrong, error in ((float("nan"), ValueError), ("1", TypeError), ([], TypeError)):
        with pytest.raises(error):
            reader.batches(wrong)
    batches = reader.batches(timeout=0)
    assert reader in gc.get_referents(batches)
    fill(writer, 3)
    del reader
    gc.collect()
    assert [numbers(batch) for batch in batches] == [[0, 1, 2]]


def test_a_wait_ends_in_time_or_with_the_writer(writer, ring):
    reader = mavloom.RingReader(ring)
    assert reader.read(timeout=0) is None and reader.read(timeout=0.01) is None
    assert list(reader.batches(timeout=0.01)) == []
    threading.Timer(0.02, writer.write, [b"late"]).start()
    assert reader.read().data == b"late"
    threading.Timer(0.02, writer.close).start()
    assert reader.read() is None and not reader.writer_alive and list(reader) == [] and reader.read(timeout=1e9) is None
    with mavloom.RingWriter(ring, capacity=64 * KIB) as second:
        assert not second.created and reader.writer_alive and not reader.removed
        second.write(b"more")
        assert reader.read().data == b"more"
    with pytest.raises(ValueError, match="NaN"):
        reader.read(float("nan"))


# ---- views: rows 3.16 and 3.17

LOOKS = {
    "data": lambda record: record.data,
    "memoryview": memoryview,
    "slice": lambda record: record.data[1:3],
    "cast": lambda record: record.data.cast("b"),
    "iterator": lambda record: iter(record.data),
    "frombuffer of the record": lambda record: numpy.frombuffer(record, "u1"),
    "frombuffer": lambda record: numpy.frombuffer(record.data, "u1"),
    "slice of an array": lambda record: numpy.frombuffer(record.data, "u1")[2:],
    "asarray": lambda record: numpy.asarray(record.data),
    "ndarray": lambda record: numpy.ndarray(4, "u1", buffer=record.data),
    "ndarray of a slice": lambda record: numpy.ndarray(2, "u1", buffer=record.data[2:]),
}
# Parts of b"abcd" that some looks see; the others see all of it.
PARTS = {"slice": b"bc", "slice of an array": b"cd", "ndarray of a slice": b"cd"}


@pytest.fixture
def held(writer, ring):
    reader = mavloom.RingReader(ring, lossless=True)
    for _ in range(4):
        writer.write(b"abcd")
    return reader


def test_an_exception_on_its_way_is_not_replaced_by_one_about_views(held, writer):
    with pytest.raises(KeyError, match="mine"), held:
        seen = memoryview(held.read(0))
        raise KeyError("mine")
    assert bytes(seen) == b"abcd"
    seen.release()
    with pytest.raises(BufferError), held:
        seen = memoryview(held.read(0))
    seen.release()


@pytest.mark.parametrize("dtype", [object, [("a", "O")], [("a", "f4"), ("b", [("c", "O")])]], ids=str)
def test_no_dtype_makes_objects_of_what_a_ring_holds(ring, writer, dtype):
    for lossless in (False, True):
        with mavloom.RingReader(ring, lossless=lossless, start="oldest") as reader:
            writer.write(bytes(numpy.dtype(dtype).itemsize))
            batch = next(reader.batches(timeout=0))
            with pytest.raises(ValueError, match="a ring holds bytes"):
                batch.array(dtype)


@pytest.mark.parametrize("dtype", [object, [("O", "f4"), ("b", [("c", "O")])]], ids=str)
def test_objects_are_no_bytes(writer, dtype):
    with_time = numpy.zeros(2, [("t", "M8[s]"), ("o", "O")])  # of which numpy knows no format
    for data in (numpy.zeros(3, dtype), memoryview(numpy.zeros(3, dtype)), with_time, with_time[0],
                 numpy.zeros(1, [("a:b", "O")]), (ctypes.py_object * 2)(1, 2)):
        with pytest.raises(ValueError, match="Python objects"):
            writer.write(data)
    assert writer.records == 0


@pytest.mark.parametrize("values", [numpy.arange(3), numpy.zeros((2, 3), [("O", "f4"), ("bO", "u1")]),
                                    numpy.array(["2026-11-23", "1970-01-01"], "M8[s]"), array.array("d", [1, 2]),
                                    memoryview(numpy.float32([1, 2])), numpy.float64(7), (ctypes.c_uint16 * 2)(1, 2)],
                         ids=lambda value: type(value).__name__)
def test_whatever_has_a_contiguous_buffer_is_written(writer, ring, values):
    with mavloom.RingReader(ring, start="oldest") as reader:
        writer.write(values)
        assert reader.read(0).data == (values.tobytes() if hasattr(values, "tobytes") else bytes(values))


def test_what_is_not_contiguous_is_refused(writer):
    for data in (numpy.arange(9)[::2], numpy.asfortranarray(numpy.zeros((2, 3)))):
        with pytest.raises((BufferError, ValueError), match="contiguous"):
            writer.write(data)


@pytest.mark.parametrize("look", LOOKS, ids=LOOKS)
def test_row_3_16_and_3_17_whatever_looks_at_a_record_holds_the_reader(held, look):
    seen = LOOKS[look](held.read(0))
    for go_on in (lambda: held.read(0), lambda: held.read(), lambda: next(held), lambda: next(held.batches()),
                  held.close):
        with pytest.raises(BufferError, match="still alive"):
            go_on()
    assert bytes(seen) == PARTS.get(look, b"abcd")
    del seen
    gc.collect()
    assert held.read(0).position == 32
    held.close()


@pytest.mark.parametrize("look", LOOKS.values(), ids=LOOKS)
def test_row_3_16_and_3_17_whatever_looks_at_a_batch_holds_it(held, look):
    batch = next(held.batches())
    seen = look(batch[1])
    for go_on in (batch.release, lambda: held.read(0), held.close):
        with pytest.raises(BufferError, match="still alive"):
            go_on()
    del seen
    gc.collect()
    batch.release()
    assert held.read(0) is None


def test_example_10_a_view_blocks_a_batch(held):
    for batch in held.batches(timeout=0.01):
        view = memoryview(batch[0])
        with pytest.raises(BufferError):
            batch.release()
        assert view == b"abcd" and view.readonly
        view.release()
        batch.release()


def test_row_3_16_what_was_released_raises(held):
    first = held.read(0)
    view = first.data
    view.release()
    held.read(0)
    for look in LOOKS.values():
        with pytest.raises(mavloom.UsageError, match="released"):
            look(first)
    with pytest.raises(ValueError):
        _ = view[0]
    last = held.read(0)
    held.close()
    with pytest.raises(mavloom.UsageError, match="released"):
        _ = last.data
    for call in (held.read, lambda: next(held), lambda: list(held.batches()), lambda: held.holds, lambda: held.removed):
        with pytest.raises(mavloom.ClosedError, match="closed"):
            call()
    held.close()


def test_row_3_16_views_outlive_a_reader_that_is_dropped(writer, ring):
    """They hold the ring as long as they live, and not longer."""
    reader = mavloom.RingReader(ring, lossless=True)
    writer.write(b"abcd")
    view = reader.read(0).data
    del reader
    gc.collect()
    assert view == b"abcd" and [r["holds"] for r in status_of(ring)["readers"]] == [True]
    del view
    assert status_of(ring)["readers"] == []


def test_row_3_16_an_array_that_numpy_takes_from_a_record_itself_reads_no_freed_memory(held):
    """numpy.ndarray(buffer=) gives the buffer back at once and keeps the record only: it cannot be counted, but the
    ring stays mapped."""
    array = numpy.ndarray(4, "u1", buffer=held.read(0))
    held.read(0)
    held.close()
    del held
    gc.collect()
    assert bytes(array) == b"abcd"


def test_numpy_arrays_of_batches(writer, ring):
    """Structured, without a copy where the records lie side by side; a copy where the ring's end lies between."""
    kind = numpy.dtype([("number", "<u8"), ("values", "<f4", 3)])
    readers = [mavloom.RingReader(ring, lossless=lossless) for lossless in (False, True)]
    found, views, sent = ([], []), 0, 0
    for _ in range(40):
        for _ in range(100):
            writer.write(struct.pack("<Q3f", sent, sent, 1, -1))
            sent += 1
        for reader, kept in zip(readers, found):
            batch = next(reader.batches())
            array = batch.array(kind)
            kept += array["number"].tolist()
            assert array["values"].tolist() == [[number, 1, -1] for number in array["number"]]
            assert not array.flags.writeable
            if len(batch) > 1 and array.strides[0] != kind.itemsize:
                views += 1
                with pytest.raises(BufferError):
                    batch.release()
            del array
            batch.release()
            kept += [struct.unpack_from("<Q", record.data)[0] for record in iter(lambda: reader.read(0), None)]
    assert found[0] == found[1] == list(range(sent)) and 20 < views
    writer.write(b"12345678")
    writer.write(b"1234")
    batch = next(readers[0].batches())
    with pytest.raises(ValueError, match="record 1 of the batch has 4 bytes, and the dtype 8"):
        batch.array("u8")


def test_a_batch_ends_with_the_lap_so_that_its_array_is_a_view(writer, ring):
    reader, length, ends = mavloom.RingReader(ring, lossless=True), 1100, 0  # 58 of them a lap
    writer.write(bytes(length))
    reader.read()  # so that a lap ends between two
    for number in range(200):
        sent = [bytes([value]) * length for value in (number, number + 1)]
        for data in sent:
            writer.write(data)
        found, batches = [], 0
        for batch in reader.batches(timeout=0):
            array = batch.array(f"V{length}")
            assert array.base is not None and not array.flags.owndata
            found += [bytes(record) for record in array]
            batches += 1
            del array
            batch.release()
        assert found == sent
        ends += batches == 2
    assert ends == 6


# ---- claims: records that are filled in place

def test_a_claim_is_filled_and_committed(writer, ring):
    reader = mavloom.RingReader(ring)
    before = time.time_ns()
    with writer.claim(4, link=3, kind=300, verdict=2) as view:
        assert (len(view), view.readonly, view.format, reader.read(0)) == (4, False, "B", None)
        view[:] = b"abcd"
    record = reader.read(0)
    assert (record.data, record.link, record.kind, record.verdict) == (b"abcd", 3, 300, 2)
    assert before <= record.time_ns <= time.time_ns()
    with writer.claim(24, time_ns=7) as view:
        numpy.frombuffer(view, "<f8")[:] = 1, 2, 3
    claim = writer.claim(100)
    struct.pack_into("<I", claim.data, 0, 42)
    assert claim.commit(4, time_ns=9) is True
    with writer.claim(0):
        pass
    with writer.claim(10) as view, io.BytesIO(b"12345") as file:
        claim_of_ten = file.readinto(view)
    assert ([(r.data, r.time_ns) for r in (reader.read(0), reader.read(0))]
            == [(struct.pack("<3d", 1, 2, 3), 7), (struct.pack("<I", 42), 9)])
    assert reader.read(0).data == b"" and reader.read(0).data[:claim_of_ten] == b"12345" and writer.records == 5


def test_a_claim_that_is_given_up_writes_nothing(writer, ring):
    reader = mavloom.RingReader(ring)
    with pytest.raises(ZeroDivisionError):
        with writer.claim(4) as view:
            view[:] = b"lost"
            raise ZeroDivisionError
    abandoned = writer.claim(4)
    abandoned.data[:] = b"lost"
    abandoned.abandon()
    abandoned.abandon()
    writer.claim(4)  # dropped
    fill(writer, 1)
    assert numbers([reader.read(0)]) == [0] and reader.read(0) is None
    for call in (abandoned.commit, lambda: abandoned.data):
        with pytest.raises(mavloom.ClosedError, match="over"):
            call()
    with pytest.raises(ValueError):
        view[0] = 1


CLAIM_LOOKS = {
    "slice": lambda view: view[1:3],
    "cast": lambda view: view.cast("b"),
    "frombuffer": lambda view: numpy.frombuffer(view, "u1"),
    "slice of an array": lambda view: numpy.frombuffer(view, "u1")[2:],
    "asarray": lambda view: numpy.asarray(view),
    "ndarray": lambda view: numpy.ndarray(4, "u1", buffer=view),
}


@pytest.mark.parametrize("look", CLAIM_LOOKS, ids=CLAIM_LOOKS)
def test_row_3_16_nothing_writes_into_a_record_that_is_committed(writer, ring, look):
    """Any object made of a claim's view blocks it: until the object is gone, this thread writes neither the record nor
    anything else."""
    reader = mavloom.RingReader(ring)
    claim = writer.claim(4)
    claim.data[:] = b"abcd"
    seen = CLAIM_LOOKS[look](claim.data)
    for go_on in (claim.commit, lambda: writer.write(b"x"), lambda: writer.claim(1), writer.close):
        with pytest.raises(BufferError, match="still alive|is open"):
            go_on()
    assert reader.read(0) is None and bytes(seen) == PARTS.get(look, b"abcd")
    del seen
    assert claim.commit() and reader.read(0).data == b"abcd"
    claim = writer.claim(4)
    seen = CLAIM_LOOKS[look](claim.data)
    claim.abandon()
    with pytest.raises(BufferError, match="is open"):
        writer.write(b"x")
    del seen
    assert writer.write(b"x")


def test_row_3_16_a_view_that_outlives_its_claim_keeps_the_room(writer, ring):
    reader = mavloom.RingReader(ring)
    with pytest.raises(BufferError, match="still alive"):
        with writer.claim(4) as view:
            array = numpy.frombuffer(view, "u1")
    gc.collect()
    with pytest.raises(BufferError, match="is open"):
        writer.write(b"x")
    array[:] = 7
    del array
    fill(writer, 1)
    assert numbers(iter(lambda: reader.read(0), None)) == [0]
    name = writer.name
    claim = writer.claim(4)
    writer.close()
    with pytest.raises(mavloom.ClosedError, match="over"):
        claim.commit()
    with mavloom.RingWriter(name, capacity=64 * KIB) as second:
        view = second.claim(4).data
        with pytest.raises(BufferError):
            second.close()
        del view
        fill(second, 1)


def test_row_29_a_claim_of_what_does_not_fit_is_a_value_error(writer):
    for length in (-1, 16361, 2**64):
        with pytest.raises(ValueError, match=f"length: {length} is out of range, 0 to 16360"):
            writer.claim(length)
    with writer.claim(16360):
        pass
    claim = writer.claim(4)
    for length in (-1, 5, 2**64):
        with pytest.raises(ValueError, match=f"length: {length} is out of range, 0 to 4"):
            claim.commit(length)
    with pytest.raises(ValueError, match="link"):
        writer.claim(4, link=-1)
    assert claim.commit() and writer.records == 2


def test_a_claim_in_a_full_ring_is_dropped_or_waits(ring):
    with (mavloom.RingWriter(ring, capacity=64 * KIB, full="drop_newest") as writer,
          mavloom.RingReader(ring, lossless=True) as reader):
        taken = []
        for number in range(200):
            claim = writer.claim(1000)
            claim.data[:] = bytes([number]) * 1000
            taken.append(claim.commit())
        found = [bytes(record.data) for record in iter(lambda: reader.read(0), None)]
        assert found == [bytes([number]) * 1000 for number in range(200) if taken[number]]
        assert taken.count(False) == writer.dropped > 100
    with mavloom.RingWriter(ring, capacity=64 * KIB) as writer, mavloom.RingReader(ring, lossless=True) as reader:
        def write():
            for number in range(200):
                with writer.claim(1000) as view:
                    view[:] = bytes([number]) * 1000
        thread = threading.Thread(target=write, daemon=True)
        thread.start()
        assert ([bytes(reader.read(DEADLINE_S).data) for _ in range(200)]
                == [bytes([number]) * 1000 for number in range(200)])
        thread.join()


@pytest.mark.parametrize("full", ["wait", "evict"])
def test_row_17_claims_of_several_threads_take_turns(ring, full):
    threads, count = 8, 300
    with mavloom.RingWriter(ring, capacity=8 << 20, full=full) as writer, mavloom.RingReader(ring) as reader:
        def write(thread):
            for number in range(count):
                with writer.claim(8) as view:
                    struct.pack_into("<I", view, 0, thread)
                    if number % 50 == 0:
                        time.sleep(0.0001)  # the others come by
                    struct.pack_into("<I", view, 4, number)
                writer.write(struct.pack("<II", thread, number))
        workers = [threading.Thread(target=write, args=[thread], daemon=True) for thread in range(threads)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join(DEADLINE_S)
        found = [struct.unpack("<II", record.data) for record in iter(lambda: reader.read(0), None)]
        assert [[n for t, n in found if t == thread]
                for thread in range(threads)] == [[n for n in range(count) for _ in "ab"]] * threads


def test_example_10_a_writer_that_is_killed_while_it_fills_a_claim(writer, ring, start):
    writer.close()
    reader = mavloom.RingReader(ring, lossless=True)
    for _ in range(3):
        process = start("""
writer = mavloom.RingWriter(ring, capacity=1 << 16)
writer.write(b"whole")
claim = writer.claim(1000)
claim.data[:] = b"x" * 1000
os.kill(os.getpid(), signal.SIGKILL)
""", ring)
        assert ended(process)[0] == -signal.SIGKILL
    assert [bytes(record.data) for record in reader] == [b"whole"] * 3


def test_example_11_a_claim_at_a_fork_and_at_the_exit(ring, start):
    process = start("""
mavloom._core.set_leak_warnings(True)
writer, reader = mavloom.RingWriter(ring, capacity=1 << 16), mavloom.RingReader(ring)
claim = writer.claim(4)
pid = os.fork()
if pid == 0:
    for call in (lambda: claim.data, claim.commit, lambda: writer.claim(1)):
        try:
            call()
        except mavloom.ClosedError as error:
            assert "before fork" in str(error)
        else:
            os._exit(1)
    del claim
    sys.exit(0)
claim.data[:] = b"abcd"
claim.commit()
print(os.waitpid(pid, 0)[1], reader.read(0).data)
left, view = writer.claim(4), writer
view = left.data
around = [left]
around.append(around)
""", ring)
    assert ended(process) == (0, "0 b'abcd'\n", "")
    with mavloom.RingWriter(ring, capacity=64 * KIB) as second:
        fill(second, 1)


# ---- errors

class Index:
    def __init__(self, number):
        self._number = number

    def __index__(self):
        return self._number


def test_row_29_what_is_given_wrong_is_a_value_error(writer, ring):
    with pytest.raises(ValueError, match="16361 bytes: a record of ring .* has at most 16360"):
        writer.write(bytes(writer.longest + 1))
    writer.write(bytes(writer.longest))
    for options, what in (({"link": -1}, "link: -1 is out of range, 0 to 4294967295"), ({"kind": 65536}, "0 to 65535"),
                          ({"verdict": 256}, "0 to 255"), ({"link": 2**64}, "link: 18446744073709551616 is"),
                          ({"time_ns": 2**63}, "time_ns: 9223372036854775808 is out of range, -9223372036854775808 to"),
                          ({"kind": 10**5000}, "kind: a number with thousands of digits is"),
                          ({"kind": Index(70000)}, "kind: 70000 is")):
        with pytest.raises(ValueError, match=what):
            writer.write(b"", **options)
    for options in ({"link": 1.0}, {"kind": "1"}, {"time_ns": b"1"}):
        with pytest.raises(TypeError):
            writer.write(b"", **options)
    with pytest.raises(TypeError, match="bytes-like"):
        writer.write("text")
    for name in ("a/b", "", "x" * 65, "ü", "..", "a b", "a\0b"):
        for call in (mavloom.RingWriter, mavloom.RingReader, mavloom.remove_ring):
            with pytest.raises(mavloom.UsageError, match="is not a valid ring name"):
                call(name)
    for options, what in (({"capacity": 100_000}, "power of two"),
                          ({"capacity": -1}, "capacity: -1 is out of range, 65536 to 68719476736"),
                          ({"capacity": 2**64}, "capacity: 18446744073709551616 is"),
                          ({"full": "wiat"}, "did you mean 'wait'"), ({"mode": 0o060}, "let the owner read"),
                          ({"mode": -1}, "mode: -1")):
        with pytest.raises(ValueError, match=what):
            mavloom.RingWriter(ring + "x", **options)
    with pytest.raises(ValueError, match="newest or oldest"):
        mavloom.RingReader(ring, start="now")
    assert writer.records == 1 and not path_of(ring + "x").exists()


def test_two_writers_the_second_is_refused_with_the_first_ones_process(writer, ring):
    with pytest.raises(OSError, match=f"ring {ring} already has a writer, process {os.getpid()}") as raised:
        mavloom.RingWriter(ring, capacity=64 * KIB)
    assert isinstance(raised.value, mavloom.Error)
    refused = subprocess.run([PROGRAM, "shm", "write", ring], input="", capture_output=True, text=True)
    assert refused.returncode == 1 and f"process {os.getpid()}" in refused.stderr
    process = subprocess.Popen([PROGRAM, "shm", "write", ring + "b", "--remove"], stdin=subprocess.PIPE)
    with process:
        until(lambda: ring + "b" in mavloom.rings() and status_of(ring + "b")["writer_pid"] == process.pid)
        with pytest.raises(mavloom.Error, match=f"process {process.pid}"):
            mavloom.RingWriter(ring + "b")


def test_row_3_20_an_absent_ring_is_named_beside_those_that_are_there(writer, ring):
    for call in (mavloom.RingReader, mavloom.remove_ring):
        with pytest.raises(FileNotFoundError, match=rf"there is no ring {ring}x; there (is|are) .*{ring}") as raised:
            call(ring + "x")
        assert isinstance(raised.value, mavloom.NotFoundError)
    assert ring in mavloom.rings()


def with_version(major, minor):
    return lambda data: data[:8] + struct.pack("<HH", major, minor) + data[12:]


@pytest.mark.parametrize("change, what", [
    (with_version(2, 7), r"version 2\.7; this program supports 1\.0"),
    (lambda data: data[:12] + data[12:16][::-1] + data[16:], "another byte order"),
    (lambda data: data[:30_000], "truncated ring: 30000 bytes instead of 81920"),
    (lambda data: data[:100], "truncated: 100 bytes"),
    (lambda data: b"", "truncated: 0 bytes"),
    (lambda data: random.Random(1).randbytes(len(data)), "not a Mavloom ring"),
    (lambda data: data[:16] + struct.pack("<Q", 65537) + data[24:], "damaged"),
    (lambda data: data[:128] + random.Random(2).randbytes(len(data) - 128), "damaged"),
], ids=["version", "byte order", "shorter", "short", "empty", "random", "sizes", "contents"])
def test_rows_3_3_3_5_and_3_19_what_is_no_ring_of_this_version_is_named_and_stays(writer, ring, change, what):
    fill(writer)
    writer.close()
    wrong = change(path_of(ring).read_bytes())
    path_of(ring).unlink()
    path_of(ring).write_bytes(wrong)
    for call in (lambda: mavloom.RingReader(ring, start="oldest", lossless=True).read(0),
                 lambda: mavloom.RingReader(ring).read(0)):
        with pytest.raises(mavloom.InputError, match=what):
            call()
    head = path_of(ring).read_bytes()[:64]
    assert head == wrong[:64] and path_of(ring).stat().st_size == len(wrong)
    mavloom.remove_ring(ring)
    assert not path_of(ring).exists()


def test_row_3_3_another_size_is_another_file_and_readers_of_the_old_one_are_notified(writer, ring):
    reader = mavloom.RingReader(ring, lossless=True)
    fill(writer, 3)
    writer.close()
    before = path_of(ring).stat()
    with path_of(ring).open("rb") as old, mavloom.RingWriter(ring, capacity=128 * KIB) as larger:
        fill(larger, 1, first=3)
        assert larger.created and path_of(ring).stat().st_ino != before.st_ino
        assert os.fstat(old.fileno()).st_size == before.st_size
        assert numbers(reader) == [0, 1, 2] and reader.removed  # iteration ends, for nothing comes there any more
        with mavloom.RingReader(ring, start="oldest") as again:
            assert numbers([again.read(0)]) == [3]


def test_row_3_4_creators_that_are_killed_leave_no_ring_or_a_whole_one(ring, start):
    process = start("""
import random
rng = random.Random(6)
for number in range(150):
    pid = os.fork()
    if pid == 0:
        mavloom.RingWriter(ring, capacity=1 << 20)
        time.sleep(3600)
    time.sleep(rng.random() * 0.003)
    os.kill(pid, signal.SIGKILL)
    os.waitpid(pid, 0)
    try:
        with mavloom.RingReader(ring, start="oldest") as reader:
            assert reader.read() is None
        found = True
    except mavloom.NotFoundError as error:
        assert "there is no ring" in str(error)
        found = False
    with mavloom.RingWriter(ring, capacity=1 << 20) as writer:
        assert writer.created or found
        writer.close(remove=True)
    print(int(found), end="")
""", ring)
    status, out, talk = ended(process)
    assert (status, talk, len(out)) == (0, "", 150)
    assert [path.name for path in SHM.iterdir() if ring in path.name] == []


def test_damage_under_a_reader_is_an_error(writer, ring):
    reader, lossless = mavloom.RingReader(ring), mavloom.RingReader(ring, lossless=True)
    fill(writer)
    with path_of(ring).open("r+b") as file:
        file.seek(16384)
        file.write(struct.pack("<i", 2**30))
    for each in (reader, lossless):
        with pytest.raises(mavloom.InputError, match=f"ring {ring} is damaged"):
            each.read(0)
        with pytest.raises(mavloom.InputError, match=f"ring {ring} is damaged"):
            next(each.batches())


@as_root
def test_row_3_2_a_small_shared_memory_is_an_error_with_the_numbers(start, ring):
    process = start("""
try:
    mavloom.RingWriter(ring, capacity=8 << 20)
except OSError as error:
    import errno
    assert isinstance(error, mavloom.Error) and error.errno == errno.ENOSPC
    print(error, os.listdir("/dev/shm"))
mavloom.RingWriter(ring, capacity=1 << 18).write(b"fits")
""", ring, preexec_fn=private_shared_memory)
    status, out, talk = ended(process)
    assert (status, talk) == (0, "") and f"{(8 << 20) + 16384} bytes" in out and f"{1 << 20} bytes free" in out
    assert "[]" in out


def private_shared_memory():
    """A /dev/shm of 1 MiB for this process."""
    libc = ctypes.CDLL(None, use_errno=True)
    assert libc.unshare(0x00020000) == 0  # CLONE_NEWNS
    assert libc.mount(b"none", b"/", None, 0x4000 | 0x40000, None) == 0  # MS_REC | MS_PRIVATE
    assert libc.mount(b"tmpfs", b"/dev/shm", b"tmpfs", 0, b"size=1m") == 0


# ---- permissions

def test_row_3_13_the_umask_does_not_count(ring):
    before = os.umask(0o077)
    try:
        with mavloom.RingWriter(ring, capacity=64 * KIB, mode=0o660):
            assert stat.S_IMODE(path_of(ring).stat().st_mode) == 0o660
    finally:
        os.umask(before)


AS_NOBODY = f"os.setgroups([]); os.setgid({NOBODY}); os.setuid({NOBODY})\n"


@as_root
def test_rows_3_11_and_3_12_another_users_ring_is_opened_and_not_removed(start, ring):
    """Opened without O_CREAT, which the system may refuse there (fs.protected_regular); removed by its owner only."""
    mavloom.RingWriter(ring, capacity=64 * KIB, mode=0o666).close()
    process = start(AS_NOBODY + """
with mavloom.RingWriter(ring, capacity=1 << 16) as writer:
    writer.write(b"of another user")
for call in (mavloom.remove_ring, lambda name: mavloom.RingWriter(name, capacity=1 << 17)):
    try:
        call(ring)
    except PermissionError as error:
        assert isinstance(error, mavloom.Error) and "belongs to root" in str(error), error
    else:
        sys.exit("allowed")
""", ring)
    assert ended(process) == (0, "", "") and path_of(ring).exists()
    refusal = "users other than its owner may write .*mode 0666.*foreign"
    with pytest.raises(mavloom.PermissionDeniedError, match=refusal):
        mavloom.RingReader(ring, start="oldest")
    with mavloom.connect(f"shm://{ring}?from=oldest") as link:
        assert link.recv(timeout=0.1) is None and link.stats.bad_records == 0  # it did not read that record
    with mavloom.RingReader(ring, start="oldest", foreign=True) as reader:
        assert reader.read(0).data == b"of another user"


OPENS_RINGS = """
print("ready", flush=True)
for _ in range(20_000):
    for kind in (mavloom.RingReader, mavloom.RingWriter):
        try:
            kind(ring).close()
        except mavloom.Error:
            pass
"""
READS_PAGES = """
with mavloom.connect(f"shm://{ring}") as link, mavloom.RingWriter(ring) as writer:
    print("ready", flush=True)
    for number in range(20_000):
        writer.write(b"record", kind=1, link=number)
        link.recv(timeout=0)
"""


@as_root
@pytest.mark.parametrize("suffix, code", [("", OPENS_RINGS), (".stat", READS_PAGES)])
def test_a_file_of_another_user_that_shrinks_meanwhile_ends_no_process(start, ring, suffix, code):
    """Without foreign=True, nothing in it is read, so its owner cannot end this process by SIGBUS."""
    mavloom.RingWriter(ring).close()
    path = path_of(ring, suffix)
    path.write_bytes(path_of(ring).read_bytes())
    os.chown(path, NOBODY, NOBODY)
    size = path.stat().st_size
    process = start(code, ring)
    assert process.stdout.readline() == "ready\n"
    while process.poll() is None:
        os.truncate(path, 0)
        os.truncate(path, size)
    assert ended(process) == (0, "", "")


@as_root
def test_row_3_23_a_reader_without_write_permission_polls_and_changes_nothing(start, ring):
    with mavloom.RingWriter(ring, capacity=64 * KIB, mode=0o644) as writer:
        process = start(AS_NOBODY + """
reader = mavloom.RingReader(ring)
try:
    mavloom.RingReader(ring, lossless=True)
except PermissionError as error:
    print(error, flush=True)
print(*(int(reader.read().data) for _ in range(100)))
""", ring)
        assert "belongs to root, mode 0644" in process.stdout.readline()
        assert status_of(ring)["readers"] == []
        fill(writer, 100)
        assert ended(process) == (0, " ".join(map(str, range(100))) + "\n", "")


# ---- C++ and Python, both directions

def test_example_10_python_writes_and_the_program_reads(writer, ring):
    rng = random.Random(3)
    sent = [(rng.randbytes(rng.randrange(300)), rng.randrange(2**62), rng.randrange(2**32), rng.randrange(2**16),
             rng.randrange(256)) for _ in range(200)]
    for data, time_ns, link, kind, verdict in sent:
        writer.write(data, time_ns=time_ns, link=link, kind=kind, verdict=verdict)
    writer.close()
    found = [json.loads(line) for line in program("shm", "read", ring, "--from", "oldest", "--drain",
                                                  "--json").splitlines()]
    assert [(bytes.fromhex(r["hex"]), r["time_ns"], r["link"], r["kind"], r["verdict"]) for r in found] == sent
    with mavloom.RingReader(ring, start="oldest") as reader:
        assert [r.position for r in reader] == [r["position"] for r in found]


@pytest.mark.parametrize("lossless", [False, True])
def test_example_10_the_program_writes_and_python_reads(writer, ring, lossless):
    writer.close()
    reader = mavloom.RingReader(ring, lossless=lossless)
    lines = [f"line {number} {'x' * (number % 200)}" for number in range(5000)]
    process = subprocess.Popen([PROGRAM, "shm", "write", ring, "--capacity", "64k", "--link", "7", "--kind", "300",
                                "--verdict", "2"], stdin=subprocess.PIPE, text=True,
                               stderr=subprocess.DEVNULL)
    until(lambda: reader.writer_alive)
    feeder = threading.Thread(target=process.communicate, args=["\n".join(lines) + "\n"])
    feeder.start()
    found = []
    for batch in reader.batches():
        found += [bytes(record.data).decode() for record in batch]
        assert all((r.link, r.kind, r.verdict) == (7, 300, 2) for r in batch)
    feeder.join()
    assert len(found) + reader.missed == len(lines)
    assert found == lines if lossless else set(found) <= set(lines)


# ---- losses that are reported

def test_row_5_a_lapped_reader_learns_how_many_it_missed(writer, ring):
    reader, sent, found = mavloom.RingReader(ring), 0, []
    for _ in range(50):
        fill(writer, 4000, first=sent)
        sent += 4000
        for _ in range(100):
            found.append(int(reader.read(0).data))
            assert found[-1] == len(found) - 1 + reader.missed
    found += numbers(iter(lambda: reader.read(0), None))
    assert len(found) + reader.missed == sent and reader.missed > sent / 2 and found == sorted(set(found))


def test_what_a_full_ring_does_not_take_is_counted(ring):
    with mavloom.RingWriter(ring, capacity=64 * KIB, full="drop_newest") as writer:
        reader = mavloom.RingReader(ring, lossless=True)
        taken = [writer.write(b"x" * 1000) for _ in range(200)]
        assert taken.count(True) == len(list(iter(lambda: reader.read(0), None)))
        assert taken.count(False) == writer.dropped == status_of(ring)["dropped"] > 100
        assert writer.write(b"again") and reader.read(0).data == b"again"


def test_row_3_15_one_who_is_stopped_under_evict_hurts_nobody_else(ring, start):
    with mavloom.RingWriter(ring, capacity=64 * KIB, full="evict") as writer:
        stopped, other = mavloom.RingReader(ring, lossless=True), mavloom.RingReader(ring, lossless=True)
        fill(writer, 1)
        record, view = (lambda r: (r, r.data))(stopped.read(0))
        found, sent = [], 1
        assert stopped.holds and view == b"0"
        while stopped.holds:
            fill(writer, 100, first=sent)
            sent += 100
            found += numbers(iter(lambda: other.read(0), None))
        assert found == list(range(sent)) and other.missed == 0 and writer.dropped == 0
        with pytest.raises(mavloom.Error, match="evicted this reader"):
            _ = record.data
        del view
        late = numbers(iter(lambda: stopped.read(0), None))
        assert late[-1] == sent - 1 and late[0] == stopped.missed + 1 and len(late) + 1 + stopped.missed == sent


# ---- kills: rows 3.6, 3.9, 3.10, 3.14

FORK_WRITERS = """
import random
generations, rng = int(sys.argv[2]), random.Random(4)
def write_for_ever(generation):
    writer = mavloom.RingWriter(ring, capacity=1 << 16)
    number = 0
    while True:
        writer.write(f"{generation} {number} ".encode() + bytes([number % 256]) * (number * 7 % 400))
        number += 1
for generation in range(generations):
    pid = os.fork()
    if pid == 0:
        write_for_ever(generation)
    time.sleep(rng.random() * 0.004)
    os.kill(pid, signal.SIGKILL)
    assert os.waitpid(pid, 0)[1] == signal.SIGKILL
"""


def check_generation(data, last):
    """A record of FORK_WRITERS is whole and the next one; (generation, number)."""
    generation, number, rest = bytes(data).split(b" ", 2)
    generation, number = int(generation), int(number)
    assert rest == bytes([number % 256]) * (number * 7 % 400)
    assert number == (last[1] + 1 if generation == last[0] else 0) and generation >= last[0]
    return generation, number


@pytest.mark.parametrize("kills", [150, pytest.param(1000, marks=pytest.mark.long)])
def test_rows_3_4_and_3_6_writers_that_are_killed(writer, ring, start, kills):
    """At any instant, without anything removed between them: what they committed comes whole and in order, the next one
    carries on."""
    writer.close()
    with mavloom.RingReader(ring, lossless=True) as reader:
        process = start(FORK_WRITERS, ring, kills)
        last, count = (-1, -1), 0
        running = True
        while running:
            running = process.poll() is None
            for record in iter(lambda: reader.read(0), None):
                last = check_generation(record.data, last)
                count += 1
            time.sleep(0.0005)
        assert ended(process) == (0, "", "")
        assert last[0] > kills // 2 and count > kills and reader.missed == 0
        with mavloom.RingWriter(ring, capacity=64 * KIB) as next_writer:
            next_writer.write(b"the end")
            assert reader.read().data == b"the end"
    assert [path.name for path in SHM.iterdir() if ring in path.name] == [path_of(ring).name]


def test_rows_3_8_and_3_14_lossless_readers_that_are_killed_let_go(writer, ring, start):
    for _ in range(5):
        process = start("""
reader = mavloom.RingReader(ring, lossless=True)
print("open", flush=True)
view = reader.read().data
print(bytes(view).decode(), flush=True)
time.sleep(3600)
""", ring)
        assert process.stdout.readline() == "open\n"
        writer.write(b"held")
        assert process.stdout.readline() == "held\n"
        threading.Timer(0.02, process.kill).start()
        for _ in range(100):
            writer.write(bytes(2000))  # three times the ring: waits until the kill
        assert process.wait(DEADLINE_S) == -signal.SIGKILL
    assert status_of(ring)["readers"] == [] and writer.dropped == 0


def test_example_10_the_program_is_killed_while_it_reads(writer, ring):
    """Between its read and its release: it holds the ring, and prints to a pipe that nobody empties."""
    for _ in range(5):
        process = subprocess.Popen([PROGRAM, "shm", "read", ring, "--lossless"], stdout=subprocess.PIPE)
        with process:
            until(lambda: [r["pid"] for r in status_of(ring)["readers"]] == [process.pid])
            threading.Timer(0.1, process.kill).start()
            for _ in range(1000):
                writer.write(bytes(2000))
    assert writer.records == 5000 and writer.dropped == 0 and status_of(ring)["readers"] == []


def test_example_10_the_program_is_killed_while_it_writes(writer, ring):
    writer.close()
    rng = random.Random(5)
    with mavloom.RingReader(ring, lossless=True) as reader:
        for _ in range(20):
            process = subprocess.Popen([PROGRAM, "shm", "write", ring, "--capacity", "64k"], stdin=subprocess.PIPE,
                                       stderr=subprocess.DEVNULL)
            feeder = threading.Thread(target=feed, args=[process.stdin], daemon=True)
            feeder.start()
            until(lambda: reader.writer_alive)
            found = [int(bytes(reader.read(DEADLINE_S).data).rstrip(b"."))]
            threading.Timer(rng.random() * 0.01, process.kill).start()
            for record in reader:
                number, dots = bytes(record.data).split(b".", 1)
                assert dots == b"." * (int(number) % 50)
                found.append(int(number))
            assert process.wait(DEADLINE_S) == -signal.SIGKILL and found == list(range(len(found))) and found
            feeder.join()
        with mavloom.RingWriter(ring, capacity=64 * KIB) as following:
            following.write(b"on")
            assert reader.read().data == b"on" and not following.created


def feed(pipe):
    """Numbered lines until nobody takes them."""
    with contextlib.suppress(OSError), pipe:
        for number in range(10**9):
            pipe.write(b"%d.%s\n" % (number, b"." * (number % 50)))


@pytest.mark.parametrize("seconds", [0.5, pytest.param(30, marks=pytest.mark.long)])
def test_row_3_9_a_stopped_reader_is_not_dead(ring, start, seconds):
    with mavloom.RingWriter(ring, capacity=64 * KIB, full="drop_newest") as writer:
        process = start("""
reader = mavloom.RingReader(ring, lossless=True)
print("open", flush=True)
print(len(list(reader)))
""", ring)
        assert process.stdout.readline() == "open\n"
        process.send_signal(signal.SIGSTOP)
        until(lambda: pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()[0] == "T")
        taken = sum(writer.write(bytes(1000)) for _ in range(100))
        time.sleep(seconds)
        assert not writer.write(bytes(1000)) and [r["pid"] for r in status_of(ring)["readers"]] == [process.pid]
        process.send_signal(signal.SIGCONT)
        until(lambda: status_of(ring)["readers"][0]["behind_records"] == 0)
        writer.close()
        assert ended(process) == (0, f"{taken}\n", "")


def test_row_3_10_a_forked_child_keeps_neither_lock(ring, start):
    process = start("""
writer, reader = mavloom.RingWriter(ring, capacity=1 << 16), mavloom.RingReader(ring, lossless=True)
writer.write(b"x")
view = reader.read().data
if os.fork() == 0:
    print(os.getpid(), flush=True)  # by the child: its fork() is over, which closes the locks' descriptors there
time.sleep(3600)
""", ring)
    child = int(process.stdout.readline())
    process.kill()
    assert process.wait(DEADLINE_S) == -signal.SIGKILL
    os.kill(child, 0)
    with mavloom.RingWriter(ring, capacity=64 * KIB) as writer:
        for _ in range(100):
            writer.write(bytes(2000))
        assert status_of(ring)["readers"] == [] and writer.records == 101
    os.kill(child, 0)


def test_row_3_7_files_that_somebody_removes(writer, ring):
    reader = mavloom.RingReader(ring, lossless=True)
    fill(writer, 5)
    path_of(ring, ".stat").write_bytes(b"")
    path_of(ring).unlink()
    fill(writer, 5, first=5)
    assert writer.removed and reader.removed and numbers(reader.read(0) for _ in range(10)) == list(range(10))
    writer.close(remove=True)
    assert reader.read() is None
    with mavloom.RingWriter(ring, capacity=64 * KIB) as second:
        assert second.created and not second.removed
        second.write(b"new")
        assert reader.read(0) is None
        with mavloom.RingReader(ring, start="oldest") as again:
            assert again.read(0).data == b"new"


def test_removing(writer, ring):
    reader = mavloom.RingReader(ring)
    fill(writer, 3)
    path_of(ring, ".stat").write_bytes(b"")
    mavloom.remove_ring(ring)
    assert ring not in mavloom.rings() and not path_of(ring, ".stat").exists()
    assert numbers(reader) == [0, 1, 2] and reader.removed and writer.removed
    with pytest.raises(mavloom.ClosedError, match="removed or replaced: open it again"):
        writer.write(b"x")
    other = mavloom.RingWriter(ring, capacity=128 * KIB)
    other.close(remove=True)
    other.close(remove=True)
    other.close()
    assert not path_of(ring).exists()


def test_removing_by_a_writer_that_left_the_ring_is_refused(writer, ring):
    """It may be another writer's by then."""
    writer.close()
    writer.close()
    with mavloom.RingWriter(ring, capacity=64 * KIB):
        with pytest.raises(mavloom.ClosedError,
                           match=f"{ring} was closed and kept the ring; remove it with remove_ring"):
            writer.close(remove=True)
    assert path_of(ring).exists()
    mavloom.remove_ring(ring)


# ---- exits and forks: rows 3.1 and 3.22

EXITS = """
import multiprocessing
kinds = {
    "end": lambda reader: None,
    "sys.exit": lambda reader: sys.exit(0),
    "os._exit": lambda reader: os._exit(0),
    "exception": lambda reader: 1 / 0,
    "SIGTERM": lambda reader: os.kill(os.getpid(), signal.SIGTERM),
    "SIGKILL": lambda reader: os.kill(os.getpid(), signal.SIGKILL),
    "abort": lambda reader: os.abort(),
    "global": lambda reader: setattr(sys, "kept", reader),
    "cycle": lambda reader: cycle(reader),
    "closed": lambda reader: reader.close(),
    "waiting": lambda reader: threading.Thread(target=reader.read, daemon=True).start(),
}
def cycle(reader):
    around = [reader]
    around.append(around)
sys.stderr = open(os.devnull, "w")
for number in range(110):
    pid = os.fork()
    if pid == 0:
        reader = mavloom.RingReader(ring, lossless=number // len(kinds) % 2 == 0, start="oldest")
        view = reader.read(0).data if number % 3 == 0 else None
        if view is not None and number % len(kinds) == 9:
            view = None
        list(kinds.values())[number % len(kinds)](reader)
        sys.exit(0)
    os.waitpid(pid, 0)
    print(number, flush=True)
    sys.stdin.readline()
"""


def test_row_3_1_exits_of_every_kind_leave_the_ring_in_use(writer, ring, start):
    reader = mavloom.RingReader(ring)
    process = start(EXITS, ring)
    writer.write(b"first")
    assert reader.read().data == b"first"
    for number in range(110):
        assert process.stdout.readline() == f"{number}\n", ended(process)
        for _ in range(40):  # the ring, and a quarter: nobody holds it any more
            writer.write(b"%d" % number + bytes(2000))
            assert reader.read().data == b"%d" % number + bytes(2000)
        process.stdin.write("\n")
        process.stdin.flush()
    assert process.wait(DEADLINE_S) == 0 and path_of(ring).exists()
    assert [r["pid"] for r in status_of(ring)["readers"]] == [os.getpid()]


@pytest.mark.parametrize("leaks", [False, True], ids=["", "told of leaks"])
def test_row_3_22_and_example_11_an_exit_with_all_of_it_open_is_silent(ring, start, leaks):
    process = start(f"""
if {leaks}:
    mavloom._core.set_leak_warnings(True)
writer = mavloom.RingWriter(ring, capacity=1 << 16)
lossless, lossy = mavloom.RingReader(ring, lossless=True), mavloom.RingReader(ring)
for _ in range(5):
    writer.write(b"abcd")
record = lossless.read()
batches = lossy.batches()
batch = next(batches)
around = [writer, lossless, lossy, batches, batch]
around.append(around)
class Holder: pass
holder = Holder()
holder.reader, holder.itself = mavloom.RingReader(ring), holder
if not {leaks}:
    view, array = record.data, batch.array("S4")
    for work in (lossy.read, lambda: list(holder.reader), lambda: [writer.write(bytes(1000)) for _ in range(1000)]):
        threading.Thread(target=work, daemon=True).start()
""", ring)
    assert ended(process) == (0, "", "")
    left = status_of(ring)
    assert (left["readers"], left["writer_alive"], left["writer_pid"]) == ([], False, 0), "closed, as by close()"


@pytest.mark.parametrize("looks", [False, True], ids=["", "looked at"])
def test_row_3_22_an_exit_with_a_claim_in_hand_writes_nothing(ring, start, looks):
    """A view that outlives the interpreter keeps the writer open, whose end then looks like a kill."""
    process = start(f"""
writer = mavloom.RingWriter(ring, capacity=1 << 16)
writer.write(b"abcd")
claim = writer.claim(8)
if {looks}:
    claim.data[:] = bytes(8)
begun = threading.Event()
threading.Thread(target=lambda: (claim, begun.set(), writer.write(b"never")), daemon=True).start()
assert begun.wait(60)
""", ring)
    assert ended(process) == (0, "", "")
    left = status_of(ring)
    assert (left["records"], left["writer_alive"], left["writer_pid"] != 0) == (1, False, looks)
    with mavloom.RingWriter(ring, capacity=64 * KIB) as writer:
        writer.write(b"next")
    with mavloom.RingReader(ring, start="oldest") as reader:
        assert [record.data for record in reader] == [b"abcd", b"next"]


def test_example_11_a_forked_child_is_refused_and_the_parent_untouched(ring, start):
    process = start("""
writer, reader = mavloom.RingWriter(ring, capacity=1 << 16), mavloom.RingReader(ring, lossless=True)
lossy = mavloom.RingReader(ring)
batches = reader.batches()
for number in range(3):
    writer.write(b"%d" % number)
batch = next(batches)
for gone in (lossy.read, lambda: list(lossy)):
    threading.Thread(target=gone, daemon=True).start()
pid = os.fork()
if pid == 0:
    for call in (reader.read, lambda: next(batches), lambda: next(reader), lambda: reader.read(0),
                 lambda: lossy.read(0), lambda: reader.writer_alive, batch.release,
                 lambda: writer.write(b"x"), lambda: writer.records, lambda: writer.removed):
        try:
            call()
        except mavloom.ClosedError as error:
            assert "before fork" in str(error)
        else:
            os._exit(1)
    writer.close(remove=True)
    reader.close()
    with mavloom.RingReader(ring, start="oldest") as own:
        assert own.read(0).data == b"0"
    del batch, batches, writer, reader, lossy
    gc.collect()
    sys.exit(0)
print(os.waitpid(pid, 0)[1], [int(bytes(r.data)) for r in batch])
batch.release()
writer.write(b"on")
print(bytes(reader.read(0).data), writer.removed)
""", ring)
    assert ended(process) == (0, "0 [0, 1, 2]\nb'on' False\n", "")


def test_row_3_10_a_forked_child_does_not_look_through_its_parents_records(ring, start):
    """The hold on them is the parent's: once it let go, other bytes stand there. Copies are the child's own."""
    process = start("""
import numpy
writer, lossy = mavloom.RingWriter(ring, capacity=1 << 16), mavloom.RingReader(ring)
one, many = mavloom.RingReader(ring, lossless=True), mavloom.RingReader(ring, lossless=True)
for _ in range(3):
    writer.write(b"abcd")
record, batch, copy, copies = one.read(), next(many.batches()), lossy.read(), next(lossy.batches())
pid = os.fork()
if pid == 0:
    for look in (lambda: record.data, lambda: memoryview(record), lambda: numpy.frombuffer(record, "S4"),
                 lambda: batch[1].data, lambda: batch.array("S4")):
        try:
            look()
        except mavloom.ClosedError as error:
            assert "before fork" in str(error)
        else:
            os._exit(1)
    assert copy.data == copies[0].data == b"abcd" and copies.array("S4").tolist() == [b"abcd"] * 2
    sys.exit(0)
print(os.waitpid(pid, 0)[1], bytes(record.data), batch.array("S4").tolist())
""", ring)
    assert ended(process) == (0, "0 b'abcd' [b'abcd', b'abcd', b'abcd']\n", "")


WAITS = ["reader.read()", "next(reader)", "list(lossy)", "next(lossy.batches())", "next(reader.batches(1e6))",
         "list(iter(lambda: writer.write(bytes(1000)), None))"]


@pytest.mark.parametrize("wait", WAITS)
def test_example_11_ctrl_c_ends_a_wait(ring, start, wait):
    process = start(f"""
writer = mavloom.RingWriter(ring, capacity=1 << 16)
reader, lossy = mavloom.RingReader(ring, lossless=True), mavloom.RingReader(ring)
print("ready", flush=True)
{wait}
""", ring)
    assert process.stdout.readline() == "ready\n"
    process.send_signal(signal.SIGINT)
    _, _, talk = ended(process)
    assert "KeyboardInterrupt" in talk


SIGNALLED = """
import ctypes
class Raised(Exception):
    pass
raise_signal = ctypes.PyDLL(None)["raise"]  # keeps the GIL, as signal.raise_signal does not
def handler(*_):
    for record in HANDLER:
        taken.append(int(bytes(record.data)))
    raise Raised
signal.signal(signal.SIGUSR1, handler)
sys.setswitchinterval(DEADLINE)  # whoever reads gets the GIL back when the signal is there, and not before
writer, reader = mavloom.RingWriter(ring, capacity=1 << 16), mavloom.RingReader(ring, lossless=sys.argv[2] == "True")
reads = threading.Event()
def write():
    reads.wait()
    for number in range(0, 90, 3):
        time.sleep(0.005)
        for each in range(number, number + 3):
            writer.write(b"%d" % each)
        end = time.monotonic() + 0.005
        while time.monotonic() < end:
            pass
        raise_signal(signal.SIGUSR1)
    writer.close()
taken, raised = [], 0
thread = threading.Thread(target=write)
thread.start()
reads.set()
while True:
    try:
        records = READ
    except Raised:
        raised += 1
        continue
    if not records:
        break
    taken += [int(bytes(record.data)) for record in records]
thread.join()
print(raised > 0, taken == list(range(90)), reader.missed)
"""


@pytest.mark.parametrize("lossless", [False, True])
@pytest.mark.parametrize("read", ["[*filter(None, [reader.read()])]", "[*filter(None, [next(reader, None)])]",
                                  "next(reader.batches(), ())",
                                  "next(reader.batches(), ()) if len(taken) % 2 else [*filter(None, [reader.read()])]"])
def test_a_signal_handler_that_raises_costs_no_record(ring, start, read, lossless):
    code = SIGNALLED.replace("HANDLER", "()").replace("READ", read).replace("DEADLINE", str(DEADLINE_S))
    process = start(code, ring, lossless)
    assert ended(process) == (0, "True True 0\n", "")


@pytest.mark.parametrize("lossless", [False, True])
@pytest.mark.parametrize("reads", ["filter(None, [reader.read(0)])", "next(reader.batches(0), ())"])
def test_a_signal_handler_that_reads_the_same_reader_costs_no_record(ring, start, reads, lossless):
    """The records that its caller had already taken come first, once and whole."""
    for read in ("[*filter(None, [reader.read()])]", "next(reader.batches(), ())"):
        code = SIGNALLED.replace("HANDLER", reads).replace("READ", read).replace("DEADLINE", str(DEADLINE_S))
        process = start(code, ring, lossless)
        assert ended(process) == (0, "True True 0\n", "")


# ---- asyncio: rows 19 and 3.21

MANY_TASKS = """
import asyncio
def threads():
    return len(os.listdir("/proc/self/task"))
async def take(reader, count):
    found = []
    async for record in reader:
        found.append(int(bytes(record.data)))
        if len(found) == count:
            return found
async def main():
    before = threads()
    readers = [mavloom.RingReader(ring, lossless=number % 2 == 0 and number < 64) for number in range(200)]
    writer.write(b"0")
    assert all(bytes(reader.read(0).data) == b"0" for reader in readers) and threads() == before
    tasks = [asyncio.create_task(take(reader, 50)) for reader in readers]
    for number in range(1, 51):
        writer.write(b"%d" % number)
        await asyncio.sleep(0.002)
    assert await asyncio.gather(*tasks) == [list(range(1, 51))] * 200
    assert asyncio.get_running_loop()._default_executor is None and threading.active_count() == 1
    return threads() - before
writer = mavloom.RingWriter(ring, capacity=1 << 16)
print(asyncio.run(asyncio.wait_for(main(), 60)))
"""


def test_rows_19_and_3_21_many_tasks_one_thread_and_none_before_somebody_asks(ring, start):
    """64 readers with a slot and 136 that only poll, on one loop."""
    assert ended(start(MANY_TASKS, ring)) == (0, "1\n", "")


@pytest.mark.parametrize("lossless", [False, True])
@pytest.mark.parametrize("batches", [False, True])
def test_row_19_records_come_in_order_while_they_are_written(writer, ring, lossless, batches):
    async def take(reader, count):
        found = []
        if batches:
            async for batch in reader.batches():
                found += numbers(batch)
                if len(found) >= count:
                    return found
        async for record in reader:
            found.append(int(bytes(record.data)))
            if len(found) == count:
                return found

    with mavloom.RingReader(ring, lossless=lossless) as reader:
        thread = threading.Thread(target=lambda: [fill(writer, 100, first) or time.sleep(0.0001)
                                                  for first in range(0, 10_000, 100)])
        thread.start()
        count = 10_000 if lossless else 1
        found = asyncio.run(asyncio.wait_for(take(reader, count), DEADLINE_S))
        thread.join()
        assert found == list(range(found[0], found[0] + len(found))) and len(found) >= count


def test_row_3_21_the_waiter_wakes_the_loop_and_no_timer_does(writer, ring, monkeypatch):
    monkeypatch.setattr("mavloom._async.RING_POLL_S", 1e6)

    async def run():
        reader = mavloom.RingReader(ring)
        records = aiter(reader)
        for number in range(20):
            following = asyncio.create_task(anext(records))
            await asyncio.sleep(0.005)  # asleep by then, or not: both are to work
            await asyncio.to_thread(fill, writer, 1, number)
            assert (await asyncio.wait_for(following, DEADLINE_S)).data == b"%d" % number
    asyncio.run(run())


@as_root
def test_rows_3_21_and_3_23_a_reader_without_write_permission_is_notified_too(start, ring):
    with mavloom.RingWriter(ring, capacity=64 * KIB, mode=0o644) as writer:
        process = start(AS_NOBODY + """
import asyncio
async def main():
    reader, found = mavloom.RingReader(ring), []
    print("open", flush=True)
    async for record in reader:
        found.append(int(record.data))
        if len(found) == 100:
            return found
print(asyncio.run(main()) == list(range(100)))
""", ring)
        assert process.stdout.readline() == "open\n"
        for number in range(100):
            fill(writer, 1, number)
            time.sleep(0.001)
        assert ended(process) == (0, "True\n", "")


@pytest.mark.parametrize("take_away", [mavloom.remove_ring, lambda name: path_of(name).unlink()], ids=["removed", "rm"])
def test_row_19_a_loop_waits_for_the_next_writer_and_ends_with_the_ring(writer, ring, take_away):
    found = []

    async def take():
        async for record in mavloom.RingReader(ring):
            found.append(record.data)

    async def until_found(count):
        while len(found) < count:
            await asyncio.sleep(0.001)

    async def run():
        task = asyncio.create_task(take())
        await asyncio.sleep(0)
        writer.write(b"first")
        writer.close()
        await asyncio.wait_for(until_found(1), DEADLINE_S)
        with mavloom.RingWriter(ring, capacity=64 * KIB) as second:
            second.write(b"second")
            await asyncio.wait_for(until_found(2), DEADLINE_S)
        assert not task.done()
        take_away(ring)
        await asyncio.wait_for(task, DEADLINE_S)
    asyncio.run(run())
    assert found == [b"first", b"second"]


def test_row_19_batches_end_where_nothing_comes_in_time(writer, ring):
    async def run():
        return [numbers(batch) async for batch in mavloom.RingReader(ring, start="oldest").batches(timeout=0.01)]
    fill(writer, 3)
    assert asyncio.run(asyncio.wait_for(run(), DEADLINE_S)) == [[0, 1, 2]]
    writer.close()
    assert asyncio.run(asyncio.wait_for(run(), DEADLINE_S)) == [[0, 1, 2]]


def test_row_19_one_task_waits_on_one_reader_of_a_ring(writer, ring):
    reader = mavloom.RingReader(ring)

    async def first():
        async for record in reader:
            return record.data

    async def run():
        task = asyncio.create_task(first())
        await asyncio.sleep(0.01)
        with pytest.raises(mavloom.UsageError, match="its own"):
            await asyncio.wait_for(first(), DEADLINE_S)
        writer.write(b"x")
        assert await asyncio.wait_for(task, DEADLINE_S) == b"x"
    asyncio.run(run())


def test_row_19_cancel_and_close_of_a_ring(writer, ring):
    """A cancelled task is done as soon as the loop has turned, whatever the ring does."""
    reader = mavloom.RingReader(ring)

    async def take():
        async for _ in reader:
            pass

    async def run():
        task = asyncio.create_task(take())
        await asyncio.sleep(0.01)
        task.cancel()
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        assert task.cancelled()
        task = asyncio.create_task(take())
        await asyncio.sleep(0.01)
        reader.close()
        await asyncio.wait_for(task, DEADLINE_S)
        with pytest.raises(mavloom.ClosedError):
            await take()
    asyncio.run(run())


def test_row_19_a_loop_that_is_closed_first_leaves_the_reader_as_it_is(writer, ring):
    reader = mavloom.RingReader(ring)

    async def take():
        async for record in reader:
            return record.data

    loop = asyncio.new_event_loop()
    loop.set_exception_handler(lambda *_: None)  # of the task that is destroyed while it waits
    task = loop.create_task(take())
    loop.run_until_complete(asyncio.sleep(0.01))
    loop.close()
    del task
    gc.collect()
    fill(writer, 2)
    assert reader.read(0).data == b"0" and asyncio.run(take()) == b"1"
    reader.close()


def test_row_3_17_a_view_that_is_kept_ends_the_loop_with_an_error(held):
    views = []

    async def run():
        async for record in held:
            views.append(record.data)
    with pytest.raises(BufferError, match="still alive"):
        asyncio.run(run())
    views.clear()
    assert held.read(0).position == 32


def test_row_3_21_a_loop_of_ones_own(writer, ring):
    reader, found = mavloom.RingReader(ring), []
    assert reader.poll() is None
    thread = threading.Thread(target=fill, args=[writer, 100])
    with selectors.DefaultSelector() as selector:
        selector.register(reader.event_fd(), selectors.EVENT_READ)
        thread.start()
        while len(found) < 100:
            assert selector.select(DEADLINE_S)
            os.read(reader.event_fd(), 8)
            found += numbers(iter(reader.poll, None))
    thread.join()
    assert found == list(range(100))
    mavloom.remove_ring(ring)
    with pytest.raises(mavloom.ClosedError, match="removed or replaced"):
        reader.poll()


def test_a_read_that_does_not_wait_finds_what_is_there_while_the_descriptors_thread_looks(writer, ring):
    """That thread wakes after some 50 us: what was written is read at many moments around then."""
    reader = mavloom.RingReader(ring)
    reader.event_fd()
    for number in range(30_000):
        assert reader.poll() is None  # the thread waits from here
        writer.write(b"x")
        moment = time.perf_counter_ns() + number % 128 * 1000
        while time.perf_counter_ns() < moment:
            pass
        assert reader.read(0) is not None, number


@pytest.mark.parametrize("leaks", [False, True], ids=["", "told of leaks"])
def test_rows_3_21_and_3_22_an_exit_while_tasks_wait_is_silent(ring, start, leaks):
    process = start(f"""
import asyncio
if {leaks}:
    mavloom._core.set_leak_warnings(True)
writer = mavloom.RingWriter(ring, capacity=1 << 16)
readers = [mavloom.RingReader(ring, lossless=number % 2 == 0) for number in range(4)]
waiting = []
async def take(reader):
    async for record in reader:
        waiting.append(bytes(record.data))
async def main():
    await asyncio.gather(*map(take, readers[:2]))
async def short():
    tasks = [asyncio.create_task(take(reader)) for reader in readers[2:]]
    while len(waiting) < 2:
        writer.write(b"x")
        await asyncio.sleep(0.001)
asyncio.run(short())
if not {leaks}:  # a thread that never ends keeps what it has
    threading.Thread(target=lambda: asyncio.run(main()), daemon=True).start()
    time.sleep(0.01)
""", ring)
    assert ended(process) == (0, "", "")
    left = status_of(ring)
    assert (left["readers"], left["writer_alive"], left["writer_pid"]) == ([], False, 0), "closed, as by close()"


def test_row_3_21_and_example_11_a_forked_child_has_a_waiter_of_its_own(ring, start):
    process = start("""
import asyncio
writer, reader = mavloom.RingWriter(ring, capacity=1 << 16), mavloom.RingReader(ring)
async def take(reader, what):
    async for record in reader:
        assert record.data == what
        return
async def write_and_take(writer, reader, what):
    task = asyncio.create_task(take(reader, what))
    await asyncio.sleep(0.005)
    writer.write(what)
    await asyncio.wait_for(task, 60)
asyncio.run(write_and_take(writer, reader, b"before"))
pid = os.fork()
if pid == 0:
    for call in (reader.event_fd, reader.poll, reader.batches().event_fd, lambda: asyncio.run(take(reader, b"before"))):
        try:
            call()
        except mavloom.ClosedError as error:
            assert "before fork" in str(error)
        else:
            os._exit(1)
    del reader
    gc.collect()
    with mavloom.RingWriter(sys.argv[2], capacity=1 << 16) as own, mavloom.RingReader(sys.argv[2]) as reader:
        asyncio.run(write_and_take(own, reader, b"of the child"))
        own.close(remove=True)
    sys.exit(0)
print(os.waitpid(pid, 0)[1])
asyncio.run(write_and_take(writer, reader, b"after"))
""", ring, ring + "-child")
    assert ended(process) == (0, "0\n", "")


# ---- threads

def test_row_17_any_thread_may_write(writer, ring):
    reader, threads, count = mavloom.RingReader(ring, lossless=True), 8, 2000

    def write(thread):
        for number in range(count):
            writer.write(struct.pack("<II", thread, number))
    workers = [threading.Thread(target=write, args=[thread], daemon=True) for thread in range(threads)]
    for worker in workers:
        worker.start()
    last, found = [-1] * threads, 0
    while found < threads * count:
        record = reader.read(DEADLINE_S)
        thread, number = struct.unpack("<II", record.data)
        assert number == last[thread] + 1
        last[thread] = number
        found += 1
    for worker in workers:
        worker.join()
    assert writer.records == found and reader.read(0) is None


def test_row_17_readers_of_several_threads_take_turns(writer, ring):
    reader, found = mavloom.RingReader(ring), [[] for _ in range(4)]
    threads = [threading.Thread(target=lambda mine=mine: [mine.append(int(record.data)) for record in reader],
                                daemon=True) for mine in found]
    for thread in threads:
        thread.start()
    fill(writer, 1000)
    until(lambda: sum(map(len, found)) == 1000)
    assert reader.read(0) is None and reader.missed == 0
    writer.close()
    for thread in threads:
        thread.join(DEADLINE_S)
    assert sorted(sum(found, [])) == list(range(1000)) and all(mine == sorted(mine) for mine in found)


@pytest.mark.parametrize("batches", [False, True])
def test_row_17_threads_share_a_lossless_reader(writer, ring, batches):
    """Each record is one thread's, whole, whatever the others read meanwhile."""
    reader, found = mavloom.RingReader(ring, lossless=True), [[] for _ in range(4)]

    def take(mine):
        for batch in reader.batches() if batches else ([record] for record in reader):
            for record in batch:
                seen = numpy.frombuffer(record, "u1")
                number = int(bytes(record.data))
                assert bytes(seen) == b"%d" % number
                mine.append(number)
                del seen
    threads = [threading.Thread(target=take, args=[mine], daemon=True) for mine in found]
    for thread in threads:
        thread.start()
    for first in range(0, 4000, 10):
        fill(writer, 10, first)
    until(lambda: sum(map(len, found)) == 4000)
    writer.close()
    for thread in threads:
        thread.join(DEADLINE_S)
    assert sorted(sum(found, [])) == list(range(4000)) and reader.missed == 0
    assert all(mine == sorted(mine) for mine in found)


def in_thread(call):
    """Returns or raises what `call` does, in a thread of its own."""
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        return pool.submit(call).result(DEADLINE_S)


def test_row_17_a_record_outlives_the_reads_of_other_threads(held):
    records = [in_thread(held.read) for _ in range(3)]
    batch = in_thread(lambda: next(held.batches(0)))
    assert held.read(0) is None
    assert [bytes(record.data) for record in (*records, *batch)] == [b"abcd"] * 4
    assert batch.array("S4").tolist() == [b"abcd"]
    assert [record.position for record in records] == [0, 32, 64]
    assert status_of(held.name)["readers"][0]["behind_records"] == 0
    views = [memoryview(record) for record in records]
    held.close()
    assert views == [b"abcd"] * 3


def test_row_17_a_read_waits_for_the_views_of_another_thread(held):
    looking, done = threading.Event(), threading.Event()

    def look():
        view = held.read().data
        looking.set()
        done.wait(DEADLINE_S)
        assert view == b"abcd"
        view.release()
    thread = threading.Thread(target=look, daemon=True)
    thread.start()
    looking.wait(DEADLINE_S)
    for call in (lambda: held.read(0), lambda: held.read(0.02), lambda: next(held.batches(0)), held.close):
        with pytest.raises(BufferError, match="still alive"):
            call()
    threading.Timer(0.02, done.set).start()
    assert held.read().position == 32
    thread.join(DEADLINE_S)


def test_row_17_a_read_does_not_wait_for_a_view_of_its_own_thread(held):
    """It would never end."""
    record = in_thread(held.read)
    view = in_thread(lambda: record.data)
    mine = record.data
    with pytest.raises(BufferError, match="still alive"):
        held.read()
    del view, mine
    assert held.read().position == 32


def test_row_26_a_waiting_reader_wakes_when_it_is_closed(ring):
    writer = mavloom.RingWriter(ring, capacity=64 * KIB)
    reader, full = mavloom.RingReader(ring), mavloom.RingReader(ring, lossless=True)
    raised = []

    def until_closed(call):
        with pytest.raises(mavloom.ClosedError):
            while True:
                call()
        raised.append(call)
    threads = [threading.Thread(target=until_closed, args=[call], daemon=True)
               for call in (lambda: writer.write(bytes(1000)), lambda: reader.read(3600))]
    for thread in threads:
        thread.start()
    until(lambda: status_of(ring)["readers"][1]["behind_bytes"] > 40_000)
    reader.close()
    writer.close()
    for thread in threads:
        thread.join(DEADLINE_S)
    assert len(raised) == 2 and status_of(ring)["writer_pid"] == 0
    full.close()


def test_row_6_other_threads_run_while_one_waits(writer, ring):
    """With the GIL held in `read` nothing would ever be written, and with it held in `write` nothing read."""
    reader = mavloom.RingReader(ring, lossless=True)
    found = []
    thread = threading.Thread(target=lambda: [found.append(len(reader.read().data)) for _ in range(300)], daemon=True)
    thread.start()
    for number in range(300):
        writer.write(bytes(number * 10))
    thread.join(DEADLINE_S)
    assert found == [number * 10 for number in range(300)]


def test_64_readers_come_and_go(ring, start):
    process = start("""
import random
def read(seed):
    rng = random.Random(seed)
    for _ in range(rng.randrange(1, 6)):
        with mavloom.RingReader(ring, lossless=rng.random() < 0.5, start=rng.choice(["newest", "oldest"])) as reader:
            last, missed = None, 0
            for _ in range(rng.randrange(2000)):
                record = reader.read(1)
                if record is None:
                    continue
                number = record.time_ns
                try:
                    data = bytes(record.data)
                    assert not reader.holds or int(data) == number, (data, number)
                except mavloom.Error as error:
                    assert reader.lossless and "evicted this reader" in str(error), error
                gone = reader.missed - missed
                assert last is None or number == last + 1 + gone, (last, number, missed, reader.missed)
                last, missed = number, reader.missed
            record = None
pids = []
for seed in range(64):
    pid = os.fork()
    if pid == 0:
        try:
            read(seed)
        except BaseException as error:
            print(repr(error), file=sys.stderr, flush=True)
            os._exit(1)
        os._exit(0)
    pids.append(pid)
print([os.waitpid(pid, 0)[1] for pid in pids].count(0))
""", ring)
    with mavloom.RingWriter(ring, capacity=1 << 20, full="evict") as writer:
        number = 0
        while process.poll() is None:
            for number in range(number, number + 200):
                writer.write(b"%d" % number, time_ns=number)
            number += 1
            time.sleep(0.001)
        assert ended(process) == (0, "64\n", "")
        until(lambda: status_of(ring)["readers"] == [])


def test_a_65th_lossless_reader_is_refused_and_a_lossy_one_is_not(writer, ring):
    readers = [mavloom.RingReader(ring, lossless=number % 2 == 0) for number in range(64)]
    with pytest.raises(OSError, match="already has 64 readers") as raised:
        mavloom.RingReader(ring, lossless=True)
    assert isinstance(raised.value, mavloom.Error)
    polling = mavloom.RingReader(ring)
    writer.write(b"to all")
    assert [bytes(r.read().data) for r in [*readers, polling]] == [b"to all"] * 65
    readers.pop().close()
    mavloom.RingReader(ring, lossless=True).close()


# ---- links into rings

@pytest.fixture
def frames(flight):
    return [frame for _, frame in frames_of(flight)][:5000]


def send(port, frames):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        for at in range(0, len(frames), 10):
            sock.sendto(b"".join(frames[at:at + 10]), ("127.0.0.1", port))
            if at % 500 == 0:
                time.sleep(0.002)


@pytest.mark.parametrize("verify, verdict", [(False, 0x10), (True, 0x20)])
def test_pump_writes_the_verdicts_that_the_format_requires(ring, tmp_path, verify, verdict):
    key = tmp_path / "link.key"
    key.write_text("07" * 32)
    key.chmod(0o600)
    with (mavloom.RingWriter(ring) as writer,
          mavloom.connect("udpin://127.0.0.1:0" + (f"?verify={key}" if verify else "")) as link,
          mavloom.RingReader(ring) as reader,
          mavloom.connect(f"udpout://127.0.0.1:{link.port}?sign={key}") as signer):
        signer.send("HEARTBEAT")
        until(lambda: link.pump(writer, 0.01))
        record = reader.read(timeout=DEADLINE_S)
        assert (record.kind, record.verdict) == (1, verdict)


def test_pump_moves_frames_byte_for_byte(ring, frames):
    writer = mavloom.RingWriter(ring)
    with mavloom.connect("udpin://127.0.0.1:0") as link, mavloom.RingReader(ring, lossless=True) as reader:
        attitudes = link.subscribe("ATTITUDE")
        before = time.time_ns()
        send(link.port, frames)
        until(lambda: link.stats.frames_in == len(frames))
        found, thread = [], threading.Thread(target=lambda: found.extend((bytes(r.data), r.time_ns, r.link, r.kind,
                                                                          r.verdict) for r in reader), daemon=True)
        thread.start()
        assert link.pump(writer, timeout=0) == len(frames) and link.recv(timeout=0) is None
        assert attitudes.pump(writer, 0) == sum(frame[7:10] == b"\x1e\0\0" for frame in frames)
        writer.close()
        thread.join(DEADLINE_S)
        assert [data for data, *_ in found[:len(frames)]] == frames
        assert all(before < t < time.time_ns() and (kind, verdict) == (1, 0) for _, t, _, kind, verdict in found)
        assert len({link for _, _, link, _, _ in found}) == 1
        assert [data for data, *_ in found[len(frames):]] == [frame for frame in frames if frame[7:10] == b"\x1e\0\0"]
        with pytest.raises(mavloom.ClosedError, match="writer"):
            link.pump(writer, 0)
    with mavloom.RingWriter(ring) as second:
        assert link.pump(second) == 0  # the link is closed: its end


def test_pump_keeps_what_a_full_ring_has_no_room_for(writer, ring, frames):
    with mavloom.connect("udpin://127.0.0.1:0") as link, mavloom.RingReader(ring, lossless=True) as reader:
        send(link.port, frames)
        until(lambda: link.stats.frames_in == len(frames))
        moved, found = 0, []
        while len(found) < len(frames):
            moved += link.pump(writer, 0.001)
            found += [bytes(record.data) for record in iter(lambda: reader.read(0), None)]
            assert moved == len(found)
        assert found == frames and link.stats.missed == 0


@pytest.mark.parametrize("full", ["wait", "drop_newest"])
def test_pump_waits_for_the_claim_of_another_thread(ring, frames, full):
    with (mavloom.RingWriter(ring, full=full) as writer,
          mavloom.connect("udpin://127.0.0.1:0") as link,
          mavloom.RingReader(ring) as reader):
        send(link.port, frames[:100])
        until(lambda: link.stats.frames_in == 100)
        claim = writer.claim(5)
        with pytest.raises(BufferError, match="is open"):
            link.pump(writer, 0)
        moved = []
        thread = threading.Thread(target=lambda: moved.append(link.pump(writer, 0.05)), daemon=True)
        thread.start()
        claim.data[:] = b"claim"
        time.sleep(0.01)  # pump has begun by then, or not: both are to work
        claim.commit()
        thread.join(DEADLINE_S)
        until(lambda: moved.append(link.pump(writer, 0)) or sum(moved) == 100)
        assert [record.data for record in iter(lambda: reader.read(0), None)] == [b"claim", *frames[:100]]
        assert writer.dropped == 0


@pytest.fixture
def hear(child_environment, ring):
    """hear(words) -> a running `python -m mavloom.hear` that listens, and its port.
    Ended before the ring is removed, because it would create the ring again."""
    processes = []

    def call(*words, url=None, **options):
        port = free_port()
        processes.append(subprocess.Popen([sys.executable, "-m", "mavloom.hear", url or f"udpin://127.0.0.1:{port}",
                                           *words], env=child_environment,
                                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options))
        return processes[-1], port
    yield call
    for process in processes:
        process.kill()
        process.communicate()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_hear_writes_what_it_hears_and_takes_its_ring_away(hear, ring, frames, number):
    process, port = hear("--ring", ring)
    assert f"writing to ring {ring}\n" in process.stderr.readline()
    with mavloom.RingReader(ring, lossless=True) as reader:
        send(port, frames)
        assert [bytes(reader.read(DEADLINE_S).data) for _ in frames] == frames
        process.send_signal(number)
        assert ended(process) == (128 + number, "", f"{ring}: {len(frames)} frames heard, {len(frames)} written\n")
        assert reader.read() is None and reader.removed and ring not in mavloom.rings()


def ignoring(*signals):
    """For preexec_fn: as nohup starts a program, or a shell script its background jobs."""
    return lambda: [signal.signal(number, signal.SIG_IGN) for number in signals]


def test_hear_leaves_alone_what_it_was_started_to_ignore(hear, ring, frames):
    process, port = hear("--ring", ring, preexec_fn=ignoring(signal.SIGINT, signal.SIGHUP))
    process.stderr.readline()
    with mavloom.RingReader(ring, lossless=True) as reader:
        for number in (signal.SIGINT, signal.SIGHUP):
            process.send_signal(number)
            for _ in range(3):  # it looks at signals in between
                send(port, frames[:1])
                assert bytes(reader.read(DEADLINE_S).data) == frames[0]
    process.send_signal(signal.SIGTERM)
    assert ended(process) == (143, "", f"{ring}: 6 frames heard, 6 written\n") and not path_of(ring).exists()


def test_hear_removes_the_ring_at_its_end_unless_keep_is_set(hear, ring):
    for words, made_before, stays in (([], True, False), (["--remove"], True, False), (["--keep"], False, True),
                                      (["--keep"], True, True), (["--remove"], False, False),
                                      ([], False, False)):
        if made_before:
            mavloom.RingWriter(ring, capacity=64 * KIB).close()
        elif path_of(ring).exists():
            mavloom.remove_ring(ring)
        process, _ = hear("--ring", ring, "--capacity", "64k", *words)
        assert ("which already existed" in process.stderr.readline()) == made_before
        process.send_signal(signal.SIGINT)
        assert ended(process)[0] == 130 and path_of(ring).exists() == stays


def test_hear_leaves_nothing_when_the_one_before_was_killed(hear, ring):
    killed, _ = hear("--ring", ring)
    killed.stderr.readline()
    killed.kill()
    killed.wait(DEADLINE_S)
    process, _ = hear("--ring", ring)
    assert "which already existed" in process.stderr.readline()
    process.send_signal(signal.SIGTERM)
    assert ended(process)[0] == 143 and not path_of(ring).exists()


def test_hear_touches_no_ring_when_it_cannot_listen(hear, ring):
    mavloom.RingWriter(ring, capacity=64 * KIB).close()
    process, _ = hear("--ring", ring, url="udp://:1")
    assert ended(process)[0] == 2 and path_of(ring).exists()


@pytest.mark.parametrize("take_away", [mavloom.remove_ring, lambda name: path_of(name).unlink()], ids=["removed", "rm"])
def test_hear_creates_a_ring_again_that_somebody_removes(hear, ring, frames, take_away):
    process, port = hear("--ring", ring)
    process.stderr.readline()
    with mavloom.RingReader(ring, lossless=True) as reader:
        send(port, frames[:100])
        assert [bytes(reader.read(DEADLINE_S).data) for _ in range(100)] == frames[:100]
    for again in range(1, 3):
        take_away(ring)
        assert process.stderr.readline() == f"ring {ring} was removed; it is created again\n"
        with mavloom.RingReader(ring, lossless=True) as reader:
            send(port, frames[again * 100:][:100])
            assert [bytes(reader.read(DEADLINE_S).data) for _ in range(100)] == frames[again * 100:][:100]
    process.send_signal(signal.SIGINT)
    assert ended(process) == (130, "", f"{ring}: 300 frames heard, 300 written\n") and not path_of(ring).exists()


def test_hear_reports_what_it_missed(hear, ring, frames):
    process, port = hear("--ring", ring, "--capacity", "64k")
    process.stderr.readline()
    with mavloom.RingReader(ring, lossless=True) as reader:
        send(port, frames[:1000])
        until(lambda: status_of(ring)["readers"][0]["behind_bytes"] > 60_000)
        process.send_signal(signal.SIGINT)
        status, _, talk = ended(process)
        written = len([None for _ in iter(lambda: reader.read(0), None)])
        assert status == 130 and f"; {1000 - written} not written because the ring was full" in talk
        assert 100 < written < 1000


def test_hear_states_what_is_wrong(hear, writer, ring):
    for words, status, what in ((["--ring", ring], 1, f"ring {ring} already has a writer, process {os.getpid()}"),
                                ([], 2, "--ring"), (["--ring", "a/b"], 2, "not a valid ring name"),
                                (["--ring", ring, "--capacity", "8X"], 2, "is not a size"),
                                (["--ring", ring, "--capacity", "100k"], 2, "power of two"),
                                (["--ring", ring, "--mode", "9"], 2, "octal"),
                                (["--ring", ring, "--keep", "--remove"], 2, "not allowed")):
        process, _ = hear(*words)
        found, _, talk = ended(process)
        assert (found, what in talk, "Traceback" in talk) == (status, True, False), talk
    process, _ = hear("--ring", ring + "x", url="udp://:1")
    assert ended(process)[0] == 2 and not path_of(ring + "x").exists()
    path_of(ring + "x").write_bytes(b"text" * 10_000)
    process, _ = hear("--ring", ring + "x")
    found, _, talk = ended(process)
    assert found == 3 and "is not a Mavloom ring" in talk
    path_of(ring + "x").unlink()
