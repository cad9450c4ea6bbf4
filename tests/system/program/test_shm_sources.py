# SPDX-License-Identifier: MIT
"""shm://NAME in listen, record and relay, and as a destination.
ring_tool (tests/tools) writes the records, with the times and links of the recording."""
import contextlib
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import tempfile
import threading
import time
import uuid

import pytest
from pymavlink import mavutil

import frames
import harness

SHM = pathlib.Path("/dev/shm")
short = pytest.mark.short


@pytest.fixture
def ring():
    """A name of a ring that nobody else has, and nothing left of it."""
    name = f"sources-{os.getpid()}-{uuid.uuid4().hex[:8]}"
    yield name
    for suffix in ("", ".stat"):
        with contextlib.suppress(OSError):
            (SHM / f"mavloom.{name}{suffix}").unlink()


@pytest.fixture
def feed():
    """feed(ring, policy="wait", capacity=65536, names={}) -> a writer of the ring; killed at the end of the test."""
    path = pathlib.Path(os.environ.get("MAVLOOM_RING_TOOL",
                                       harness.program_path().parent.parent / "tests" / "bin" / "ring_tool"))
    assert path.is_file(), f"{path} is missing: build the target ring_tool, or name it in MAVLOOM_RING_TOOL"
    writers = []

    class Writer(harness.Running):
        def write(self, records):
            """[(Unix microseconds, bytes)], [(Unix microseconds, bytes, link)] or [(Unix microseconds, bytes,
            "LINK/KIND/VERDICT")]."""
            lines = [f"{time_us * 1000} {(link or [0])[0]} {data.hex()}\n" for time_us, data, *link in records]
            self.process.stdin.write("".join(lines).encode())
            self.process.stdin.flush()

        def finish(self):
            self.process.stdin.close()
            done = self.wait()
            assert done.status == 0, done

        def kill_now(self):
            self.process.kill()
            self.process.wait()

    def start(ring, policy="wait", capacity=65536, names=()):
        words = [f"{link}={name}" for link, name in dict(names).items()]
        writers.append(Writer([path, "feed", ring, policy, capacity, *words], env=harness.environment(),
                              stdin=subprocess.PIPE))
        writers[-1].wait_output("ready")
        return writers[-1]
    yield start
    for writer in writers:
        with contextlib.suppress(OSError):
            writer.kill()


@pytest.fixture
def inlet(ring):
    """The router's side of the ring's inlet: inlet() -> a bound Unix datagram socket."""
    path, sockets = harness.RUN / f"{ring}.in", []

    def open_it():
        path.unlink(missing_ok=True)
        sockets.append(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM))
        sockets[-1].bind(str(path))
        sockets[-1].settimeout(harness.DEFAULT_TIMEOUT_S)
        return sockets[-1]
    yield open_it
    for sock in sockets:
        sock.close()
    path.unlink(missing_ok=True)


@pytest.fixture(scope="module")
def flight():
    return frames.read_tlog(harness.DATA / "px4_gcs_flight.tlog")


@pytest.fixture
def sink(udp_socket):
    return udp_socket()


def stat_of(run, ring):
    done = run("shm", "stat", ring, "--json")
    return json.loads(done.stdout) if done.status == 0 else None


def wait_readers(run, ring, count=1):
    harness.wait_for(lambda: len((stat_of(run, ring) or {"readers": []})["readers"]) == count,
                     what=f"{count} readers of {ring}")


def wait_written(run, ring, count):
    harness.wait_for(lambda: stat_of(run, ring)["records"] == count, what=f"{count} records in {ring}")


def receive(sock, size):
    """`size` bytes, and not one more."""
    got = bytearray()
    while len(got) < size:
        got += sock.recv(65536)
    assert len(got) == size
    return bytes(got)


def bytes_of(records):
    return b"".join(data for _, data, *_ in records)


def heartbeat(**what):
    return next(frames.heartbeats(1, **what))


def numbered(count, first=0):
    """Frames whose number stands in them and in their sequence."""
    return [(1_700_000_000_000_000 + n, heartbeat(sequence=n % 256)) for n in range(first, first + count)]


def stats_of(done):
    return json.loads(done.lines[-1])["stats"]


# ---- record

@pytest.mark.parametrize("before", [True, False], ids=["before the writer", "after the writer"])
def test_a_recording_of_a_ring_is_the_recording_that_was_written(run, spawn, feed, ring, flight, tmp_path, before):
    out, source = tmp_path / "out.tlog", f"shm://{ring}?lossless=true&from=oldest"
    if before:
        recorder = spawn("record", source, "-o", out, "--count", len(flight))
        recorder.wait_output(f"there is no ring {ring}")
        feed(ring, capacity=1 << 20).write(flight)
    else:
        writer = feed(ring, capacity=1 << 23)
        writer.write(flight)
        writer.finish()
        recorder = spawn("record", source, "-o", out, "--count", len(flight))
    assert recorder.wait().status == 0
    assert out.read_bytes() == (harness.DATA / "px4_gcs_flight.tlog").read_bytes()

    log, count = mavutil.mavlink_connection(str(out)), 0
    while message := log.recv_msg():
        count += message.get_type() != "BAD_DATA"
    assert count == len(flight)


# ---- relay

@short
def test_a_relay_that_waited_for_the_ring_sends_all_of_it(run, spawn, feed, ring, sink, flight):
    relay = spawn("relay", f"shm://{ring}", "--to", f"udpout://127.0.0.1:{sink.getsockname()[1]}")
    relay.wait_output(f"there is no ring {ring}")
    writer = feed(ring, capacity=1 << 20)  # what is written until the relay sees the ring must fit
    writer.write(flight[:3000])
    assert receive(sink, len(bytes_of(flight[:3000]))) == bytes_of(flight[:3000])
    wait_readers(run, ring)
    writer.write(flight[3000:])  # more than the ring: it is held, not overwritten
    assert receive(sink, len(bytes_of(flight[3000:]))) == bytes_of(flight[3000:])
    done = relay.stop()
    assert done.status == 130 and "missed" not in done.stderr and f"there is no ring {ring}" in done.stderr


@short
def test_a_relay_takes_what_is_written_after_it_started_or_all_on_request(run, spawn, feed, ring, sink, flight):
    to = f"udpout://127.0.0.1:{sink.getsockname()[1]}"
    writer = feed(ring)
    writer.write(flight[:100])
    wait_written(run, ring, 100)
    newest = spawn("relay", f"shm://{ring}", "--to", to)
    wait_readers(run, ring)
    assert stat_of(run, ring)["readers"][0]["lossless"]
    writer.write(flight[100:200])
    assert receive(sink, len(bytes_of(flight[100:200]))) == bytes_of(flight[100:200])
    assert newest.stop().status == 130
    oldest = spawn("relay", f"shm://{ring}?from=oldest&lossless=false", "--to", to)
    assert receive(sink, len(bytes_of(flight[:200]))) == bytes_of(flight[:200])
    assert not stat_of(run, ring)["readers"][0]["lossless"]
    assert oldest.stop().status == 130


@short
def test_a_killed_writer_is_waited_for_and_the_next_one_carries_on(run, spawn, feed, ring, sink, flight):
    writer = feed(ring)
    relay = spawn("relay", f"shm://{ring}", "--to", f"udpout://127.0.0.1:{sink.getsockname()[1]}")
    wait_readers(run, ring)
    for begin in range(0, 900, 300):
        part = flight[begin:begin + 300]
        writer.write(part)
        assert receive(sink, len(bytes_of(part))) == bytes_of(part)
        writer.kill_now()
        relay.wait_output("(it has no writer; waiting for one[^$]*){%d}" % (begin // 300 + 1))
        writer = feed(ring)
    done = relay.stop()
    assert done.status == 130 and "missed" not in done.stderr and "900 frames in" in done.stderr


@short
def test_a_removed_ring_is_drained_and_the_next_one_of_its_name_read_from_its_oldest(run, spawn, feed, ring, sink,
                                                                                     flight):
    first = feed(ring)
    relay = spawn("relay", f"shm://{ring}", "--to", f"udpout://127.0.0.1:{sink.getsockname()[1]}")
    wait_readers(run, ring)
    relay.send(signal.SIGSTOP)
    first.write(flight[:50])
    wait_written(run, ring, 50)
    assert run("shm", "remove", ring, "--force").status == 0
    second = feed(ring)
    second.write(flight[50:80])
    wait_written(run, ring, 30)
    relay.send(signal.SIGCONT)
    assert receive(sink, len(bytes_of(flight[:80]))) == bytes_of(flight[:80])
    assert relay.stop().status == 130


@short
def test_a_killed_relay_lets_go_of_the_writer(run, spawn, feed, ring, sink):
    writer, records = feed(ring), numbered(4000)  # 64 KiB hold about 1,300
    relay = spawn("relay", f"shm://{ring}", "--to", f"udpout://127.0.0.1:{sink.getsockname()[1]}")
    wait_readers(run, ring)
    relay.send(signal.SIGSTOP)
    writing = threading.Thread(target=writer.write, args=(records,))
    writing.start()
    held = harness.wait_for(lambda: (n := stat_of(run, ring)["records"]) > 500 and n == stat_of(run, ring)["records"]
                            and n, what="a held writer")
    assert held < 4000
    relay.process.kill()
    writing.join(harness.DEFAULT_TIMEOUT_S)
    writer.finish()
    assert stat_of(run, ring)["records"] == 4000
    again = spawn("relay", f"shm://{ring}?from=oldest", "--to", f"udpout://127.0.0.1:{sink.getsockname()[1]}", "--json")
    again.wait_output("it has no writer")
    done = again.stop()
    assert done.status == 130 and stats_of(done)["totals"]["lapped"] == 0


# ---- lossy readers

@short
def test_a_lapped_listener_learns_exactly_what_it_missed(run, spawn, feed, ring):
    writer = feed(ring)
    listener = spawn("listen", f"shm://{ring}", "--json", "--stats")
    wait_readers(run, ring)
    for begin in range(0, 10_000, 5_000):
        listener.send(signal.SIGSTOP)
        writer.write(numbered(5_000, begin))
        wait_written(run, ring, begin + 5_000)
        listener.send(signal.SIGCONT)
        harness.wait_for(lambda: stat_of(run, ring)["readers"][0]["behind_records"] == 0, what="the listener")
    done = listener.stop()
    totals = stats_of(done)["totals"]
    assert done.status == 130 and totals["lapped"] > 0
    assert totals["frames"] + totals["lapped"] == 10_000
    assert totals["frames"] == len(done.lines) - 1
    # Records that the ring lost do not count as loss of the link, though sequence numbers are missing.
    assert [source["lost"] for source in stats_of(done)["sources"]] == [0]


@short
def test_the_end_of_listen_reports_what_was_missed(run, spawn, feed, ring):
    writer = feed(ring)
    listener = spawn("listen", f"shm://{ring}")
    wait_readers(run, ring)
    listener.send(signal.SIGSTOP)
    writer.write(numbered(5000))
    wait_written(run, ring, 5000)
    listener.send(signal.SIGCONT)
    harness.wait_for(lambda: stat_of(run, ring)["readers"][0]["behind_records"] == 0, what="the listener")
    done = listener.stop()
    missed = int(re.search(r"lapped: (\d+) records missed in the ring", done.stderr)[1])
    assert missed + len(done.lines) == 5000


@short
def test_what_was_overwritten_before_the_waiting_reader_saw_the_ring_counts_as_missed(spawn, feed, ring):
    listener = spawn("listen", f"shm://{ring}", "--json", "--stats")
    listener.wait_output(f"there is no ring {ring}")
    listener.send(signal.SIGSTOP)
    writer = feed(ring)
    writer.write(numbered(5000))
    writer.finish()
    listener.send(signal.SIGCONT)
    listener.wait_output("it has no writer")
    totals = stats_of(listener.stop())["totals"]
    assert totals["lapped"] > 0 and totals["frames"] + totals["lapped"] == 5000


@short
def test_a_relay_whose_hold_was_removed_counts_what_it_missed(run, spawn, feed, ring, sink):
    writer = feed(ring, policy="evict")
    relay = spawn("relay", f"shm://{ring}", "--to", f"udpout://127.0.0.1:{sink.getsockname()[1]}", "--json")
    wait_readers(run, ring)
    relay.send(signal.SIGSTOP)
    writer.write(numbered(5000))
    wait_written(run, ring, 5000)
    relay.send(signal.SIGCONT)
    harness.wait_for(lambda: stat_of(run, ring)["readers"][0]["behind_records"] == 0, what="the relay")
    stats = stats_of(relay.stop())
    assert stats["totals"]["lapped"] > 0 and stats["edit"]["frames"] + stats["totals"]["lapped"] == 5000


@short
def test_a_small_buffer_makes_a_lossless_ring_wait(run, spawn, feed, ring, tmp_path):
    """Records of very many frames each, more than the buffer has room for."""
    writer, out, records = feed(ring, capacity=1 << 20), tmp_path / "out.tlog", numbered(20_000)
    recorder = spawn("record", f"shm://{ring}?lossless=true", "-o", out, "--buffer", "64k")
    wait_readers(run, ring)
    for begin in range(0, len(records), 1000):
        writer.write([(records[begin][0], bytes_of(records[begin:begin + 1000]))])
    wait_written(run, ring, 20)
    harness.wait_for(lambda: stat_of(run, ring)["readers"][0]["behind_records"] == 0, what="the recorder")
    done = recorder.stop()
    assert done.status == 130 and "not handed on" not in done.stderr
    assert b"".join(frame for _, frame in frames.read_tlog(out)) == bytes_of(records)


# ---- what stands in records

@short
def test_links_have_the_names_of_the_counter_page(run, spawn, feed, ring):
    writer = feed(ring, names={3: "udpin://0.0.0.0:14540#10.0.0.7:5000"})
    listener = spawn("listen", f"shm://{ring}", "--json", "--count", "3")
    wait_readers(run, ring)
    writer.write([(1_700_000_000_123_456, frames.attitude(), 3), (1_700_000_000_200_000, frames.attitude(), 4),
                  (1_700_000_000_300_000, frames.attitude(), 3)])
    heard = [json.loads(line) for line in listener.wait().lines]
    assert [h["link"] for h in heard] == ["udpin://0.0.0.0:14540#10.0.0.7:5000", f"shm://{ring}/4",
                                          "udpin://0.0.0.0:14540#10.0.0.7:5000"]
    assert [h["time_us"] for h in heard] == [1_700_000_000_123_456, 1_700_000_000_200_000, 1_700_000_000_300_000]


@short
def test_the_next_writer_gives_links_other_numbers(run, spawn, feed, ring):
    writer = feed(ring, names={1: "radio", 2: "usb"})
    listener = spawn("listen", f"shm://{ring}", "--json", "--count", "4")
    wait_readers(run, ring)
    writer.write([(1_700_000_000_000_000, frames.attitude(), 1), (1_700_000_000_000_001, frames.attitude(), 2)])
    harness.wait_for(lambda: len(listener.stdout.splitlines()) == 2, what="the first writer's frames")
    listener.send(signal.SIGSTOP)  # it never sees the ring without a writer
    writer.kill_now()
    feed(ring, names={1: "usb", 2: "wifi"}).write([(1_700_000_000_000_002, frames.attitude(), 1),
                                                   (1_700_000_000_000_003, frames.attitude(), 2)])
    wait_written(run, ring, 4)
    listener.send(signal.SIGCONT)
    assert [json.loads(line)["link"] for line in listener.wait().lines] == ["radio", "usb", "usb", "wifi"]


@short
def test_the_page_of_a_killed_writer_names_no_links_of_the_next(run, spawn, feed, ring):
    writer = feed(ring, names={1: "radio"})
    writer.kill_now()
    feed(ring).write([(1_700_000_000_000_000, frames.attitude(), 1)])
    wait_written(run, ring, 1)
    done = run("listen", f"shm://{ring}?from=oldest", "--json", "--count", "1")
    assert [json.loads(line)["link"] for line in done.lines] == [f"shm://{ring}/1"]


@short
def test_records_that_are_no_frames_are_counted_and_never_passed(run, spawn, feed, ring, sink):
    good = [heartbeat(sequence=n) for n in range(5)]
    bad = bytearray(good[4])
    bad[-1] ^= 1
    writer = feed(ring)
    relay = spawn("relay", f"shm://{ring}", "--to", f"udpout://127.0.0.1:{sink.getsockname()[1]}", "--json")
    wait_readers(run, ring)
    records = [b"hello", good[0][:-3], good[0] + good[1] + good[2], bytes(bad), good[3], b"\xfd" * 40]
    writer.write([(1_700_000_000_000_000, data) for data in records])
    assert receive(sink, len(b"".join(good[:4]))) == b"".join(good[:4])
    wait_written(run, ring, len(records))
    done = relay.stop()
    totals = stats_of(done)["totals"]
    assert (totals["bad_records"], totals["crc_error"]) == (4, 1)
    assert totals["junk_bytes"] == 5 + len(good[0]) - 3 + len(bad) + 40
    assert "bad_records: 4 records in the ring without a whole valid frame" in done.stderr


# ---- waiting, and ends

@short
@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("command", ["listen", "record", "relay"])
def test_a_wait_for_a_ring_ends_on_request(spawn, ring, tmp_path, command, end):
    rest = {"listen": [], "record": ["-o", tmp_path / "x.tlog"], "relay": ["--to", "udpout://127.0.0.1:9"]}[command]
    waiting = spawn(command, f"shm://{ring}", *rest)
    waiting.wait_output(f"there is no ring {ring}")
    assert waiting.stop(end).status == 128 + end
    assert not list(SHM.glob(f"*{ring}*"))


@short
def test_an_absent_ring_is_reported_in_one_line_with_the_existing_rings(run, feed, ring):
    feed(f"{ring}-b")
    try:
        done = run("listen", f"shm://{ring}", "--for", "300ms")
        assert done.status == 0
        lines = done.stderr.splitlines()
        assert len(lines) == 1 and f"there is no ring {ring}" in lines[0] and f"{ring}-b" in lines[0]
        assert lines[0].endswith("waiting for it")
    finally:
        assert run("shm", "remove", f"{ring}-b", "--force").status == 0


@short
def test_count_ends_it_while_the_writer_continues(run, spawn, feed, ring):
    writer = feed(ring)
    listener = spawn("listen", f"shm://{ring}", "--json", "--count", "10")
    wait_readers(run, ring)
    writer.write(numbered(11))
    done = listener.wait()
    assert done.status == 0 and len(done.lines) == 10 and writer.alive


@short
def test_several_rings_and_a_socket_are_served_together(run, spawn, feed, ring, udp_port):
    port, other = udp_port(), f"{ring}-b"
    one, two = feed(ring), feed(other)
    try:
        listener = spawn("listen", f"shm://{ring}", f"shm://{other}", f"udpin://127.0.0.1:{port}", "--json", "--count",
                         "30")
        wait_readers(run, ring)
        wait_readers(run, other)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
            for n in range(10):  # each alone: any of them wakes a sleeping reader
                one.write(numbered(1, n))
                harness.wait_for(lambda n=n: len(listener.stdout.splitlines()) == 3 * n + 1, what="the first ring")
                two.write(numbered(1, n))
                harness.wait_for(lambda n=n: len(listener.stdout.splitlines()) == 3 * n + 2, what="the second ring")
                sock.sendto(heartbeat(sequence=n), ("127.0.0.1", port))
                harness.wait_for(lambda n=n: len(listener.stdout.splitlines()) == 3 * n + 3, what="the socket")
        links = [json.loads(line)["link"] for line in listener.wait().lines]
        assert links[:2] == [f"shm://{ring}/0", f"shm://{other}/0"] and links[2].startswith("udpin://")
    finally:
        assert run("shm", "remove", other, "--force").status == 0


# ---- damage

@short
def test_records_of_other_kinds_are_skipped(run, spawn, feed, ring):
    writer = feed(ring)
    listener = spawn("listen", f"shm://{ring}", "--json", "--stats", "--count", "2")
    wait_readers(run, ring)
    tagged = [(b"own bytes", "0/300/0"), (heartbeat(), "0/2/0"), (heartbeat(sequence=1), "0/1/1"),
              (heartbeat(sequence=2), "0/0/0")]
    writer.write([(1_700_000_000_000_000, data, tags) for data, tags in tagged])
    done = listener.wait()
    assert done.status == 0 and len(done.lines) == 3
    totals = stats_of(done)["totals"]
    assert [totals[name] for name in ("frames", "other_kinds", "bad_records", "junk_bytes")] == [2, 2, 0, 0]


@short
def test_a_relay_leaves_out_what_the_router_marked_as_copy_or_echo(run, spawn, feed, ring, sink):
    """Verdicts by docs/formats/ring.md: 1 forwarded, 4 rate limited, 5 copy, 6 echo, 7 unknown target;
    bits 4 and 5 the signature."""
    writer = feed(ring)
    relay = spawn("relay", f"shm://{ring}", "--to", f"udpout://127.0.0.1:{sink.getsockname()[1]}", "--json")
    listener = spawn("listen", f"shm://{ring}", "--json", "--count", "8")
    wait_readers(run, ring, 2)
    verdicts = [1, 5, 4, 6, 5 + 16, 7, 0, 1]
    records = [(1_700_000_000_000_000, heartbeat(sequence=n), f"0/1/{verdict}") for n, verdict in enumerate(verdicts)]
    writer.write(records)
    wanted = bytes_of([record for record, verdict in zip(records, verdicts) if verdict % 16 not in (5, 6)])
    assert receive(sink, len(wanted)) == wanted
    assert len(listener.wait().lines) == 8
    assert stats_of(relay.stop())["totals"]["copies"] == 3


@short
def test_an_echo_in_a_ring_is_no_loss(run, spawn, feed, ring):
    """The numbers of what comes back are old: sequence 200, then 3 again, would be a loss of 197."""
    writer = feed(ring)
    listener = spawn("listen", f"shm://{ring}", "--json", "--count", "6", "--stats")
    wait_readers(run, ring)
    told = [(0, 1), (1, 1), (200, 6), (2, 1), (90, 6), (3, 1)]
    writer.write([(1_700_000_000_000_000, heartbeat(sequence=sequence), f"0/1/{verdict}")
                  for sequence, verdict in told])
    stats = stats_of(listener.wait())
    assert stats["totals"]["frames"] == 6
    assert [(source["lost"], source["late"], source["resync"]) for source in stats["sources"]] == [(0, 0, 0)]


@short
def test_random_bytes_under_the_name_are_reported_and_waited_out(spawn, feed, ring, rng):
    path = SHM / f"mavloom.{ring}"
    path.write_bytes(rng.randbytes(16384 + 65536))
    listener = spawn("listen", f"shm://{ring}", "--json", "--count", "3")
    listener.wait_output(f"mavloom.{ring}: is not a Mavloom ring; trying again")
    path.unlink()
    feed(ring).write(numbered(3))
    done = listener.wait()
    assert done.status == 0 and len(done.lines) == 3 and done.stderr.count("trying again") == 1


@short
def test_damage_below_a_reader_is_reported_and_another_ring_read(run, spawn, feed, ring, rng):
    path = SHM / f"mavloom.{ring}"
    writer = feed(ring)
    listener = spawn("listen", f"shm://{ring}?lossless=true", "--json")
    wait_readers(run, ring)
    listener.send(signal.SIGSTOP)
    writer.write(numbered(500))
    wait_written(run, ring, 500)
    with path.open("r+b") as file:
        file.seek(16384 + 40)
        file.write(rng.randbytes(4000))
    listener.send(signal.SIGCONT)
    listener.wait_output(f"shm://{ring}: the ring is damaged")
    writer.kill_now()
    path.unlink()
    feed(ring).write(numbered(7))
    harness.wait_for(lambda: len(listener.stdout.splitlines()) >= 7, what="the new ring")
    done = listener.stop()
    assert done.status == 130 and done.stderr.count("damaged") == 1


# ---- the inlet

@short
def test_each_frame_is_a_datagram_to_the_inlet_and_each_sender_an_address(run, inlet, ring, flight, tmp_path):
    sock, got = inlet(), []
    tlog = frames.write_tlog(tmp_path / "part.tlog", flight[:8])
    for _ in range(2):
        assert run("replay", tlog, "--to", f"shm://{ring}", "--speed", "max").status == 0
        got += [sock.recvfrom(65536) for _ in range(8)]
    assert [data for data, _ in got] == [data for _, data in flight[:8]] * 2
    senders = [address for _, address in got]
    assert len(set(senders[:8])) == 1 and len(set(senders)) == 2 and all(senders)


def test_a_full_inlet_is_waited_for(spawn, inlet, ring, flight, tmp_path):
    sock = inlet()
    tlog = frames.write_tlog(tmp_path / "part.tlog", flight[:2000])
    replay = spawn("replay", tlog, "--to", f"shm://{ring}?queue_age=1h", "--speed", "max")
    got = [sock.recv(65536) for _ in range(2000)]
    assert got == [data for _, data in flight[:2000]]
    done = replay.wait()
    assert done.status == 0 and "2000 frames" in done.stderr


@short
def test_an_inlet_that_goes_and_comes_back(spawn, inlet, ring, udp_port):
    port = udp_port()
    relay = spawn("relay", f"udpin://127.0.0.1:{port}", "--to", f"shm://{ring}", "--json")
    relay.wait_output(rf"shm://{ring}: cannot send to .*{ring}\.in: .*; trying again")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as vehicle:
        for _ in range(2):
            sock = inlet()
            sock.settimeout(0.05)

            def arrives(sock=sock):
                vehicle.sendto(heartbeat(), ("127.0.0.1", port))
                with contextlib.suppress(socket.timeout):
                    return sock.recv(65536)
            assert harness.wait_for(arrives, what="a frame at the inlet") == heartbeat()
            sock.close()
    done = relay.stop()
    sums = stats_of(done)["destinations"][0]
    assert done.status == 130 and sums["frames"] >= 2


@short
def test_an_inlet_that_was_created_again_while_nothing_was_sent_misses_nothing(spawn, inlet, ring, udp_port):
    """The sender notices by its first frame that the router went, and finds the next one at once."""
    first, port = inlet(), udp_port()
    relay = spawn("relay", f"udpin://127.0.0.1:{port}", "--to", f"shm://{ring}", "-v")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as vehicle:
        first.settimeout(0.05)

        def arrives():  # once the relay listens
            vehicle.sendto(heartbeat(), ("127.0.0.1", port))
            with contextlib.suppress(socket.timeout):
                return first.recv(65536)
        assert harness.wait_for(arrives, what="a frame at the inlet") == heartbeat()
        first.close()
        (harness.RUN / f"{ring}.in").unlink()
        again = inlet()
        sent = [heartbeat(sequence=number) for number in range(1, 11)]
        for frame in sent:
            vehicle.sendto(frame, ("127.0.0.1", port))
            time.sleep(0.01)  # each a turn of the relay's
        assert [again.recv(65536) for _ in sent] == sent
    assert relay.stop().status == 130


@short
def test_that_a_writer_was_killed_is_reported_once(run, spawn, feed, ring, sink):
    """Although frames that go the other way wake the reader again and again."""
    writer = feed(ring)
    relay = spawn("relay", f"shm://{ring}", "--to", f"udpout://127.0.0.1:{sink.getsockname()[1]}")
    wait_readers(run, ring)
    writer.write(numbered(1))
    _, relay_address = sink.recvfrom(65536)
    writer.kill_now()
    relay.wait_output("it has no writer; waiting for one", stream="err")
    for number in range(100):
        sink.sendto(heartbeat(system=255, component=190, sequence=number), relay_address)
        time.sleep(0.01)  # each a turn of the relay's
    assert relay.stop().stderr.count("it has no writer") == 1


@short
def test_an_inlet_is_found_where_it_is_not_where_the_sender_could_make_one(spawn, ring, udp_port):
    port = udp_port()
    with tempfile.TemporaryDirectory() as run, contextlib.ExitStack() as closing:
        vehicle = closing.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        router = closing.enter_context(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM))
        router.settimeout(0.05)
        place = pathlib.Path(run, "mavloom", f"{ring}.in")
        relay = spawn("relay", f"udpin://127.0.0.1:{port}", "--to", f"shm://{ring}",
                      env={"MAVLOOM_RUN": None, "XDG_RUNTIME_DIR": run})
        relay.wait_output(rf"cannot send to .*{place}: No such file or directory; trying again")
        assert not os.listdir(run)
        place.parent.mkdir()
        router.bind(str(place))

        def arrives():
            vehicle.sendto(heartbeat(), ("127.0.0.1", port))
            with contextlib.suppress(socket.timeout):
                return router.recv(65536)
        assert harness.wait_for(arrives, what="a frame at the inlet") == heartbeat()
        assert relay.stop().status == 130


@short
@pytest.mark.parametrize("signed", [False, True], ids=["unsigned", "signed"])
def test_what_a_destination_answers_goes_to_the_inlet_and_does_not_come_back(run, spawn, feed, inlet, ring, sink,
                                                                             tmp_path, signed):
    router, writer = inlet(), feed(ring)
    key = tmp_path / "key"
    assert run("key", "new", key).status == 0
    relay = spawn("relay", f"shm://{ring}" + f"?sign={key}" * signed, "--to",
                  f"udpout://127.0.0.1:{sink.getsockname()[1]}", "--json")
    wait_readers(run, ring)
    writer.write(numbered(1))
    _, relay_address = sink.recvfrom(65536)
    answers = [heartbeat(system=255, component=190, sequence=n % 256) for n in range(2000)]
    for begin in range(0, len(answers), 50):
        sink.sendto(b"".join(answers[begin:begin + 50]), relay_address)
    heard = [router.recvfrom(65536) for _ in answers]
    assert signed or [data for data, _ in heard] == answers
    # A router writes what it hears at the inlet into the ring, on a link that it calls by the sender's address.
    address = heard[0][1]
    writer.kill_now()
    writer = feed(ring, names={1: "radio", 7: f"shm://{ring}#@{address[1:].decode()}", 8: f"shm://{ring}#@another"})
    last = [(1_700_000_000_000_000, answers[0], 8), (1_700_000_000_000_000, numbered(1, 1)[0][1], 1)]
    writer.write([(1_700_000_000_000_000, data, 7) for data, _ in heard] + last)
    assert receive(sink, len(bytes_of(last))) == bytes_of(last)
    done = relay.stop()
    assert stats_of(done)["totals"]["echo"] == len(answers)


@short
def test_answers_without_an_inlet_are_counted(run, spawn, feed, ring, sink):
    writer = feed(ring)
    relay = spawn("relay", f"shm://{ring}", "--to", f"udpout://127.0.0.1:{sink.getsockname()[1]}", "--json")
    wait_readers(run, ring)
    writer.write(numbered(1))
    _, relay_address = sink.recvfrom(65536)
    sink.sendto(heartbeat(system=255, component=190), relay_address)
    relay.wait_output(rf"shm://{ring}: no program serves the inlet of this ring", stream="err")
    sink.sendto(heartbeat(system=255, component=190, sequence=1), relay_address)
    done = relay.stop()
    assert stats_of(done)["edit"]["unheard_answers"] == 2
    assert done.stderr.count("no program serves") == 1 and "trying again" not in done.stderr


# ---- wrong use

@short
@pytest.mark.parametrize("words, said", [
    (["replay", "shm://a", "--to", "udpout://127.0.0.1:9"], "replay reads a .tlog file"),
    (["route", "udpin://127.0.0.1:14999", "shm://a"], "a ring is not an endpoint of a router"),
    (["relay", "shm://a", "--to", "shm://a"], "would send the ring its own records"),
    (["relay", "udpin://127.0.0.1:0", "--to", "shm://a?lossless=true"], "'lossless' applies to a ring that is read"),
    (["relay", "udpin://127.0.0.1:0", "--to", "shm://a?from=oldest"], "'from' applies to a ring that is read"),
    (["listen", "shm://a?in_allow=ATTITUDE"], "in_allow= applies only to mavloom route"),
    (["listen", "shm://a?verify=key"], "set verify= at the endpoint that receives the frames"),
    (["listen", "shm://a", "shm://a"], "two endpoints are named shm://a"),
], ids=lambda value: " ".join(value) if isinstance(value, list) else "")
def test_what_makes_no_sense_is_refused(run, words, said):
    done = run(*words)
    assert done.status == 2 and said in done.stderr
