# SPDX-License-Identifier: MIT
"""mavloom.connect("shm://NAME"): a ring as a link, and its router's inlet.
"Row N": the wishes listed in docs/guide/python.md."""
import contextlib
import os
import pathlib
import socket
import sys
import threading
import uuid

import pytest

import harness
import mavloom
from places import PROGRAM
from vehicles import DEADLINE_S, Vehicle, until

KIB = 1024
# The verdict byte of docs/formats/ring.md.
FORWARDED, DUPLICATE, UNCHECKED, GOOD = 1, 5, 16, 32


@pytest.fixture
def ring():
    """A name of a ring that nobody else has, and nothing left of it."""
    name = f"link-{os.getpid()}-{uuid.uuid4().hex[:8]}"
    yield name
    for suffix in ("", ".stat"):
        pathlib.Path(f"/dev/shm/mavloom.{name}{suffix}").unlink(missing_ok=True)


@pytest.fixture
def writer(ring):
    with mavloom.RingWriter(ring, capacity=64 * KIB) as made:
        yield made


def beat(number, **options):
    return mavloom.Dialect().encode("HEARTBEAT", custom_mode=number, frame_seq=number % 256, **options)


def numbers(link, count):
    return [link.recv(timeout=DEADLINE_S).custom_mode for _ in range(count)]


def test_records_are_messages_with_their_time_link_and_verdict(ring, writer):
    writer.write(beat(1), time_ns=1_700_000_000_000_000_123, link=7, kind=1, verdict=FORWARDED)
    writer.write(beat(2), time_ns=5_000, link=8, kind=1, verdict=DUPLICATE)
    writer.write(beat(3), link=8)  # without a kind
    writer.write(b"of another kind", kind=300)
    writer.write(b"\x55" * 30, kind=1)
    with mavloom.connect(f"shm://{ring}?from=oldest") as link:
        first, second, third = (link.recv(timeout=DEADLINE_S) for _ in range(3))
        assert ((first.frame, first.time_ns, first.link_name, first.verdict)
                == (beat(1), 1_700_000_000_000_000_123, f"shm://{ring}/7", "forwarded"))
        assert (second.custom_mode, second.time_ns, second.link_name,
                second.verdict) == (2, 5_000, f"shm://{ring}/8", "duplicate")
        assert ((third.custom_mode, third.link_name, third.verdict, third.signature)
                == (3, f"shm://{ring}/8", None, "none"))
        assert link.latest("HEARTBEAT").custom_mode == 3 and first.link != second.link == third.link
        until(lambda: link.stats.junk_bytes == 30)
        stats = link.stats
        assert (stats.frames_in, stats.bytes_in, stats.other_kinds, stats.bad_records, stats.lapped,
                stats.peers) == (3, 3 * len(beat(1)), 1, 1, 0, 0)
        assert [(s.link_name, s.sys, s.comp, s.received, s.lost) for s in stats.sources] == [
            (f"shm://{ring}/7", 255, 193, 1, 0), (f"shm://{ring}/8", 255, 193, 2, 0)]
        assert (link.name, link.port) == (f"shm://{ring}", 0)


def test_row_23_the_verdict_on_a_signature_is_the_routers(ring, writer, tmp_path):
    key = tmp_path / "key"
    key.write_text("07" * 32)
    key.chmod(0o600)
    with (mavloom.connect("udpin://127.0.0.1:0") as far,
          mavloom.connect(f"udpout://127.0.0.1:{far.port}?sign={key}") as signer):
        signer.send("HEARTBEAT")
        signed = far.recv(timeout=DEADLINE_S).frame
    for verdict in (FORWARDED | GOOD, FORWARDED | UNCHECKED, 0):
        writer.write(signed, kind=1, verdict=verdict)
    with mavloom.connect(f"shm://{ring}?from=oldest") as link:
        assert [(m.signature, m.get_signed()) for m in (link.recv(timeout=DEADLINE_S) for _ in range(3))] == [
            ("good", True), ("unchecked", False), ("unchecked", False)]


def test_it_begins_with_the_newest_record(ring, writer):
    writer.write(beat(1), kind=1)
    with mavloom.connect(f"shm://{ring}") as link:
        writer.write(beat(2), kind=1)
        assert numbers(link, 1) == [2]
        assert link.recv(timeout=0) is None


def test_row_5_a_lossy_link_learns_what_it_missed(ring, writer):
    """By the ring's writer (`lapped`), and by this link's own buffer (`missed`)."""
    written = 20_000
    with mavloom.connect(f"shm://{ring}?from=oldest", buffer=64 * KIB) as link:
        for number in range(written):
            writer.write(beat(number), kind=1)
        until(lambda: link.stats.frames_in + link.stats.lapped == written)
        found = []
        while (message := link.recv(timeout=0)) is not None:
            found.append(message.custom_mode)
        assert len(found) + link.stats.missed + link.stats.lapped == written
        assert found == sorted(set(found)) and found[-1] == written - 1  # what the writer overtook lies in between


def test_row_5_a_lossless_link_holds_the_writer(ring, writer):
    """However slow the link's reader is: ring and buffer hold a tenth of what comes."""
    written = 20_000
    with mavloom.connect(f"shm://{ring}?lossless=true", buffer=64 * KIB) as link:
        thread = threading.Thread(target=lambda: [writer.write(beat(number), kind=1) for number in range(written)],
                                  daemon=True)
        thread.start()
        until(lambda: link.stats.frames_in > 0)
        assert numbers(link, written) == list(range(written))
        thread.join(DEADLINE_S)
        assert (link.stats.lapped, link.stats.missed, link.stats.lost) == (0, 0, 0)


def test_row_22_the_next_writer_starts_over_and_the_sums_stay(ring):
    with mavloom.connect(f"shm://{ring}?from=oldest") as link:
        for numbers_written in ((0, 3), (77, 80)):
            with mavloom.RingWriter(ring, capacity=64 * KIB) as writer:
                for number in numbers_written:
                    writer.write(beat(number), link=1, kind=1)
                assert numbers(link, 2) == list(numbers_written)
        source, = link.stats.sources
        assert (source.received, source.lost, source.resync, link.stats.lost, link.stats.resync) == (4, 4, 0, 4, 0)


def test_row_26_a_link_that_is_closed_lets_go(ring):
    with mavloom.RingWriter(ring, capacity=64 * KIB, full="drop_newest") as writer:
        link = mavloom.connect(f"shm://{ring}?lossless=true", buffer=64 * KIB)
        while writer.write(beat(0), kind=1):
            pass
        link.close()
        assert all(writer.write(beat(0), kind=1) for _ in range(10_000))
        with pytest.raises(mavloom.ClosedError):
            link.recv()
        assert link.stats.frames_in > 0
        mavloom.connect(f"shm://{ring}").close()  # the name is free again


def test_a_ring_that_is_not_there_is_waited_for(ring):
    with pytest.raises(mavloom.NotFoundError, match=ring):
        mavloom.connect(f"shm://{ring}?required=true")
    with mavloom.connect(f"shm://{ring}") as link:
        assert link.recv(timeout=0.05) is None
        assert link.send("HEARTBEAT") == 0 and link.stats.no_peer == 1
        with mavloom.RingWriter(ring, capacity=64 * KIB) as writer:
            writer.write(beat(1), kind=1)
            assert numbers(link, 1) == [1]


def test_a_name_of_a_link_is_given_once(ring, writer):
    with mavloom.connect(f"shm://{ring}?name=second") as first:
        with pytest.raises(ValueError, match="two endpoints are named"):
            mavloom.connect(f"shm://{ring}?name=second")
        with mavloom.connect(f"shm://{ring}") as second:
            writer.write(beat(4), kind=1)
            assert numbers(first, 1) == numbers(second, 1) == [4]


def test_what_continues_into_another_ring_keeps_its_verdict(ring, writer):
    writer.write(beat(1), time_ns=77_000, kind=1, verdict=DUPLICATE)
    with (mavloom.connect(f"shm://{ring}?from=oldest") as link,
          mavloom.RingWriter(f"{ring}-2", capacity=64 * KIB) as copy):
        until(lambda: link.stats.frames_in == 1)
        assert link.pump(copy, timeout=0) == 1
        with mavloom.RingReader(f"{ring}-2", start="oldest") as reader:
            record = reader.read(timeout=0)
            assert (bytes(record.data), record.time_ns, record.verdict) == (beat(1), 77_000, DUPLICATE)
        copy.close(remove=True)


def test_a_ring_is_not_filled_with_itself(ring, writer):
    writer.write(beat(1), kind=1)
    with mavloom.connect(f"shm://{ring}?from=oldest") as link:
        with pytest.raises(ValueError, match="filled with its own records"):
            link.pump(writer, timeout=0)


@pytest.mark.parametrize("options", ["", "?name=other"])
def test_hear_does_not_fill_a_ring_with_itself(ring, writer, child_environment, options):
    """Refused before anything is announced, and the ring stays as it is."""
    writer.write(beat(1), kind=1)
    writer.close()
    done = harness.Running([sys.executable, "-m", "mavloom.hear", f"shm://{ring}{options}", "--ring", ring],
                           env=child_environment).wait()
    assert (done.status, done.stderr) == (2, f"mavloom.hear: this link reads ring {ring}, so the ring would be "
                                             "filled with its own records\n"), done
    assert ring in mavloom.rings()


@pytest.fixture
def router(ring):
    port = harness.free_port(socket.SOCK_DGRAM)
    running = harness.Running([str(PROGRAM), "route", f"udpin://127.0.0.1:{port}?name=uav", "--ring", ring])
    until(pathlib.Path(f"/dev/shm/mavloom.{ring}").exists)
    yield port
    harness.end([running])


def test_a_router_is_heard_and_sent_to(ring, router, peer):
    """Links have the router's names; what is sent arrives at the vehicle, and does not come back."""
    vehicle = Vehicle(peer, router)
    with mavloom.connect(f"shm://{ring}?from=oldest", source_system=200, source_component=1) as link:
        def heard():
            with contextlib.suppress(ConnectionRefusedError):  # the ring is there before the port
                vehicle.send(vehicle.heartbeat())
            return link.recv(timeout=0.05)
        until(heard)
        message = link.latest("HEARTBEAT")
        assert message.link_name.startswith("uav#127.0.0.1:") and (message.sys, message.verdict) == (1, "nowhere")
        assert link.send("COMMAND_LONG", target_system=1, target_component=1, command=400) == 1
        got, = vehicle.receive()
        assert (got.get_type(), got.command, got.get_srcSystem(),
                got.get_srcComponent()) == ("COMMAND_LONG", 400, 200, 1)
        until(lambda: link.stats.echo == 1)
        assert link.latest("COMMAND_LONG") is None
        assert (link.stats.peers, link.stats.frames_out) == (1, 1)
    vehicle.socket.close()


def test_links_of_a_ring_that_are_forgotten_are_no_peers_and_keep_their_sums(ring, writer):
    count = 8300
    frame = beat(1)
    with mavloom.connect(f"shm://{ring}?lossless=true") as link:
        for number in range(count):
            writer.write(frame, link=number + 1, kind=1)
        until(lambda: link.stats.frames_in == count)
        stats = link.stats
        assert (link.send("HEARTBEAT"), stats.peers) == (0, 0)
        assert sum(source.received for source in stats.sources) == count


def test_links_have_names_however_many_came_before(ring, writer):
    with mavloom.connect(f"shm://{ring}?lossless=true") as link:
        frame, count = beat(1), 66_000
        writing = threading.Thread(target=lambda: [writer.write(frame, link=number + 1, kind=1)
                                                   for number in range(count)])
        writing.start()
        found = [link.recv(timeout=DEADLINE_S) for _ in range(count)]
        writing.join()
        assert (found[0].link_name, found[-1].link_name) == (f"shm://{ring}/1", f"shm://{ring}/{count}")


def test_several_links_read_one_ring(ring, writer):
    with mavloom.connect(f"shm://{ring}") as one, mavloom.connect(f"shm://{ring}") as other:
        writer.write(beat(5), link=1, kind=1)
        assert (numbers(one, 1), numbers(other, 1)) == ([5], [5]) and one.name == other.name == f"shm://{ring}"
        with (mavloom.connect(f"shm://{ring}?name=a"),
              pytest.raises(mavloom.UsageError, match="two endpoints are named a")):
            mavloom.connect(f"shm://{ring}?name=a")
