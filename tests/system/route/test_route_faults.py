# SPDX-License-Identifier: MIT
"""mavloom route among hostile strangers, stalled clients, full disks, loops, and after being stopped and killed: what
is not hit loses nothing, and what is lost has a name."""
import contextlib
import os
import pathlib
import resource
import shutil
import signal
import socket
import subprocess
import threading
import time

import pytest

import frames
import harness
import routers
from disks import FewFilesDisk, SmallDisk
from routers import Router, TcpEnd, UdpEnd

LOCALHOST = "127.0.0.1"
STRANGER_BYTES = 200


def has_sanitizer(program) -> bool:
    """Its allocator keeps freed memory, so that memory use proves nothing."""
    return any(mark in program.read_bytes() for mark in (b"__asan_init", b"__tsan_init"))


def memory_kib(pid) -> int:
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    return int(next(line.split()[1] for line in status.splitlines() if line.startswith("RssAnon")))


def endpoint(router, label) -> dict:
    return next(e for e in router.stats("endpoint") if e["endpoint"] == label)


def bulk(count, source=(1, 1)) -> list:
    """Telemetry of 280 bytes whose frames are not superseded by newer ones."""
    return [routers.make(frames.mavlink.MAVLink_encapsulated_data_message(i % 65536, os.urandom(252) + b"\x01"), source)
            for i in range(count)]


class Pair:
    """A vehicle on a udpin and a station on a udpout: two good links, that nothing else may disturb."""

    def __init__(self, spawn, *others, options="", **more):
        self.port = routers.udp_port()
        self.vehicle, self.station = UdpEnd((LOCALHOST, self.port)), UdpEnd(label="station")
        query = f"?{options}" if options else ""
        self.router = Router(spawn, f"udpin://{LOCALHOST}:{self.port}{query}",
                             f"udpout://{LOCALHOST}:{self.station.port}?name=station", *others, **more)
        self.first = self.say()
        self.address = self.station.sock.recvfrom(65536)[1]  # of the router's udpout
        self.station.target = self.address

    @property
    def process(self):
        return self.router.process

    def say(self):
        frame = routers.heartbeat()
        self.vehicle.send(frame)
        return frame

    def passes(self, *sent):
        """Byte for byte, in order, and nothing else."""
        for frame in sent:
            self.vehicle.send(frame)
        assert self.station.count(len(sent)) == list(sent)

    def answers(self):
        """The other direction."""
        frame = routers.command((255, 190), (1, 1))
        self.station.send(frame)
        assert self.vehicle.until(frame) is not None

    def close(self):
        self.vehicle.close()
        self.station.close()


@pytest.fixture
def pair(spawn):
    made = []

    def make(*others, **more):
        made.append(Pair(spawn, *others, **more))
        return made[-1]
    yield make
    for one in made:
        one.close()


# ---- strangers -------------------------------------------------------------------------------------------------------

def noise(rng, size) -> bytes:
    """Without the start of a frame: of some ten thousand of them one may end in the right checksum."""
    return rng.randbytes(size).translate(bytes.maketrans(b"\xfd\xfe", b"\x00\x00"))


def garbage(rng) -> bytes:
    """Garbage that resembles frames: beginnings of frames, broken ones, noise."""
    good = routers.attitude((66, 66))
    broken = bytearray(good)
    broken[12] ^= 1 << rng.randrange(8)
    cut = bytearray(good[:-3])
    cut[2] = 0x80  # an undefined flag: else what follows could happen to be the checksum
    return rng.choice([noise(rng, STRANGER_BYTES), bytes(broken), bytes(cut), b"\xfd" * STRANGER_BYTES,
                       b"\xfd\xff" + noise(rng, 20), b""])


def test_garbage_of_a_stranger_harms_nobody(pair, rng):
    net = pair(f"tcpin://{LOCALHOST}:{(port := routers.tcp_port())}?name=tcp")
    stranger = UdpEnd((LOCALHOST, net.port))
    intruder = socket.create_connection((LOCALHOST, port))
    intruder.setblocking(False)
    with contextlib.closing(stranger), intruder:
        for _ in range(200):
            for _ in range(50):
                stranger.send(garbage(rng))
                with contextlib.suppress(BlockingIOError):
                    intruder.send(garbage(rng))
            # which also keeps the socket's buffer from running over
            net.passes(*(routers.attitude() for _ in range(5)))
        net.answers()
        links = net.router.links()
        assert len(links) == 3  # the stranger is none
        assert endpoint(net.router, f"udpin://{LOCALHOST}:{net.port}")["stray_bytes"] > 0
        assert endpoint(net.router, f"udpin://{LOCALHOST}:{net.port}")["kernel_drop"] == 0
        assert net.router.link_of(net.vehicle)["crc_error"] == 0
        assert sum(link["junk_bytes"] for link in links if link["endpoint"] == "tcp") > 0
        assert all(source["sys"] != 66 for source in net.router.stats("source"))


def test_ten_thousand_peers_of_one_host_take_bounded_memory(pair, program):
    most, crowd = 32, 10_000
    net = pair(options=f"max_peers={most}&name=in")
    memory = {}
    net.passes(routers.heartbeat())
    for number in range(1, crowd + 1):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as peer:
            peer.bind((f"127.1.{number >> 8 & 255}.{number & 255}", 0))
            peer.sendto(routers.heartbeat((200, 1)), (LOCALHOST, net.port))
        if number % 10 == 0:
            frame = net.say()  # at least once in any two seconds, as a vehicle does: it is never evicted
        if number % 50 == 0:
            seen = harness.wait_for(lambda: (e := endpoint(net.router, "in"))["peers_evicted"]
                                    + e["peers_refused"] >= number + 1 - most and e, what=f"{number} peers to be seen")
            assert len([link for link in net.router.links() if link["endpoint"] == "in"]) <= most
            net.station.until(frame)
            net.answers()
            memory[number] = memory_kib(net.process.pid)
    assert seen["peers_evicted"] + seen["peers_refused"] == crowd + 1 - most
    assert seen["peers_evicted"] > 0 and seen["kernel_drop"] == 0
    assert net.router.link_of(net.vehicle)["frames_in"] == 2 + crowd // 10
    if not has_sanitizer(program):
        assert memory[crowd] - memory[crowd // 10] < 4096, memory


def test_a_crowd_that_comes_and_goes_is_reported_in_few_lines(pair):
    net = pair(options="max_peers=4&name=in")
    crowd = 1000
    for number in range(crowd):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as peer:
            peer.bind((f"127.3.{number >> 8}.{number & 255}", 0))  # one address each: the kernel gives a port twice
            peer.sendto(routers.heartbeat((200, 1)), (LOCALHOST, net.port))
    harness.wait_for(lambda: (e := endpoint(net.router, "in"))["peers_evicted"] + e["peers_refused"]
                     + e["kernel_drop"] >= crowd - 4, what="the crowd to be seen")
    net.process.wait_output(r"links came or went (\d+) more times", stream="err")

    assert net.process.stderr.count(": up") + net.process.stderr.count(": down") < 200


def test_sources_and_messages_of_peers_that_are_gone_give_their_places_back(pair):
    """The table of messages has room for 32,768 rows: those of evicted peers must not keep newcomers out."""
    net = pair(options="max_peers=4&name=in")
    peers = 140
    for number in range(1, peers + 1):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as peer:
            peer.bind((f"127.2.{number >> 8 & 255}.{number & 255}", 0))
            crowd = b"".join(routers.heartbeat((200, component)) for component in range(1, 250))

            def has_entered():  # 50 newcomers a second may
                peer.sendto(crowd, (LOCALHOST, net.port))
                return endpoint(net.router, "in")["peers_evicted"] >= number - 4
            harness.wait_for(has_entered, what="the peer to be seen")
        net.station.now()

    def is_listed():
        net.vehicle.send(routers.attitude((7, 7)))
        return any(message["sys"] == 7 for message in net.router.stats("message"))
    harness.wait_for(is_listed, what="the newcomer in the table")


def test_an_idle_peer_goes_and_comes_back_under_its_name(pair):
    net = pair(options="idle=1")
    name = net.router.link_of(net.vehicle)["link"]
    assert name.endswith(f"#{LOCALHOST}:{net.vehicle.port}")
    net.process.wait_output(f"{name}: down, idle", stream="err")
    assert [link["link"] for link in net.router.links()] == ["station"]
    assert net.router.routes() == set()

    net.passes(routers.heartbeat())
    assert net.router.link_of(net.vehicle)["link"] == name
    net.answers()


# ---- those who do not read -------------------------------------------------------------------------------------------

def fill_until_dropped(net, label, sent):
    """Bulk, which the station gets whole, until the link that is not read has had to drop some."""
    def dropped():
        frames_now = bulk(50)
        net.passes(*frames_now)
        sent.extend(frames_now)
        return next(link for link in net.router.links() if link["endpoint"] == label)["queue_bytes"] > 100
    harness.wait_for(dropped, what="the queue to run over")


def resumes_with_whole_frames(net, end, label, sent):
    """A reader that begins to read again gets whole frames in order, and missing ones are counted."""
    last = net.say()
    sent.append(last)
    got = [*end.until(last), last]  # an End asserts that frame follows frame
    places = {frame: place for place, frame in enumerate(sent)}
    order = [places[frame] for frame in got]
    assert order == sorted(set(order))
    link = next(link for link in net.router.links() if link["endpoint"] == label)
    assert link["frames_out"] == len(got)
    assert link["queue_bytes"] + link["queue_age"] == len(sent) - len(got)
    assert net.station.until(last) == []
    assert net.router.link_of(net.station)["queue_bytes"] == 0


def test_a_tcp_client_that_stops_reading_harms_itself_only(pair):
    port = routers.tcp_port()
    net = pair(f"tcpin://{LOCALHOST}:{port}?name=tcp&queue_bytes=64k")
    with socket.socket() as sock:
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        sock.connect((LOCALHOST, port))
        net.router.wait_links(3)
        sent = []
        fill_until_dropped(net, "tcp", sent)
        net.answers()
        resumes_with_whole_frames(net, TcpEnd(sock), "tcp", sent)
        after = routers.attitude()
        net.passes(after)
        assert sock.recv(2048) == after


def test_a_serial_port_that_is_not_read_harms_itself_only(pair):
    far = routers.SerialEnd("uart")
    net = pair(f"serial://{far.device}?name=uart&baud=4000000&queue_bytes=16k")
    with contextlib.closing(far):
        sent = [net.first]
        fill_until_dropped(net, "uart", sent)
        net.answers()
        resumes_with_whole_frames(net, far, "uart", sent)
        after = routers.attitude()
        net.passes(after)
        assert far.next() == after


def test_a_black_hole_delays_nobody(pair):
    with socket.socket() as hole, socket.socket() as first, socket.socket() as second:
        hole.bind((LOCALHOST, 0))
        hole.listen(0)
        for filler in (first, second):  # the kernel answers no further call until somebody accepts these
            filler.setblocking(False)
            filler.connect_ex(hole.getsockname())
        net = pair(f"tcpout://{LOCALHOST}:{hole.getsockname()[1]}?name=hole")
        for _ in range(20):
            net.passes(*(routers.attitude() for _ in range(25)))
            net.answers()
        assert [link["link"] for link in net.router.links()][0] == "station" and len(net.router.links()) == 2

        hole.settimeout(harness.DEFAULT_TIMEOUT_S)
        hole.listen(16)
        mine = (first.getsockname()[1], second.getsockname()[1])
        while (found := hole.accept())[1][1] in mine:
            found[0].close()
        net.router.wait_links(3)
        with contextlib.closing(TcpEnd(found[0])) as far:
            frame = routers.attitude()
            net.passes(frame)
            assert far.next() == frame


def test_without_file_descriptors_it_lives_on_and_recovers(pair, run):
    port = routers.tcp_port()
    net = pair(f"tcpin://{LOCALHOST}:{port}?name=tcp")
    most = 48
    resource.prlimit(net.process.pid, resource.RLIMIT_NOFILE, (most, most))
    with contextlib.ExitStack() as clients:
        for _ in range(100):
            clients.enter_context(socket.create_connection((LOCALHOST, port)))
        net.process.wait_output("few file descriptors left", stream="err")
        for _ in range(10):
            net.passes(*(routers.attitude() for _ in range(20)))
            net.answers()
        assert 2 < len(net.router.links()) <= most
        for _ in range(3):
            assert run("ctl", net.router.name, "links", env=net.router.env).status == 0

    net.router.wait_links(2)
    with contextlib.closing(routers.tcp_client(port)) as client:
        net.router.wait_links(3)
        frame = routers.attitude()
        net.passes(frame)
        assert client.next() == frame
        assert run("ctl", net.router.name, "links", env=net.router.env).status == 0


def test_clients_of_the_metrics_leave_the_last_descriptors(pair):
    port, metrics = routers.tcp_port(), routers.tcp_port()
    net = pair(f"tcpin://{LOCALHOST}:{port}", "--metrics", f"{LOCALHOST}:{metrics}")
    resource.prlimit(net.process.pid, resource.RLIMIT_NOFILE, (48, 48))
    open_now = lambda: len(os.listdir(f"/proc/{net.process.pid}/fd"))
    with contextlib.ExitStack() as clients:
        connect = lambda port: clients.enter_context(socket.create_connection((LOCALHOST, port), 10))
        for _ in range(60):
            connect(port)
        net.process.wait_output("few file descriptors left", stream="err")
        before = open_now()
        for _ in range(30):
            connect(metrics)
        last = connect(metrics)
        last.sendall(b"GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n")
        assert last.recv(12) == b"HTTP/1.1 200"
        assert open_now() <= before + 4 + 2, "four clients, and two descriptors that are only open for a moment"


def test_it_allows_itself_as_many_descriptors_as_the_system_permits(pair):
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (before[1] // 2, before[1]))
    try:
        net = pair()
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, before)
    assert resource.prlimit(net.process.pid, resource.RLIMIT_NOFILE) == (before[1], before[1])


@pytest.mark.parametrize("most", range(4, 24))
def test_too_few_descriptors_are_reported(program, most):
    if has_sanitizer(program):
        pytest.skip("a sanitizer needs descriptors of its own")
    done = subprocess.run(["prlimit", f"--nofile={most}", program, "route", f"udpin://{LOCALHOST}:{routers.udp_port()}",
                           "--metrics", f"{LOCALHOST}:{routers.tcp_port()}", "--for", "50ms", "--name",
                           f"few-{os.getpid()}"], capture_output=True, text=True, timeout=60)

    assert done.returncode in (0, 1), done
    assert done.returncode == 0 or "oo many open files" in done.stderr, done


# ---- disk and clock --------------------------------------------------------------------------------------------------

class SmallLimit:
    """The same for anybody: the largest file that the program may write."""

    def __init__(self, folder):
        pass

    def fill(self, pid):
        resource.prlimit(pid, resource.RLIMIT_FSIZE, (100_000, resource.RLIM_INFINITY))

    def free(self, pid):
        resource.prlimit(pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))

    def close(self):
        pass


class Tape:
    """Sends frames through a router and reads the counters of its recording."""

    def __init__(self, net):
        self.net, self.sent = net, [net.first]

    def counters(self):
        return self.net.router.stats("recording")[0]

    def after_more(self):
        more = bulk(50)
        self.net.passes(*more)
        self.sent.extend(more)
        return self.counters()


@pytest.mark.parametrize("kind", [SmallDisk, SmallLimit])
def test_a_full_disk_stops_the_recording_only_and_only_while_it_is_full(pair, tmp_path, kind):
    disk = kind(tmp_path)
    with contextlib.closing(disk):
        path = tmp_path / "flight.tlog"
        net = pair(f"tlog://{path}?name=tape")
        disk.fill(net.process.pid)
        tape = Tape(net)
        counter = "queue_full" if kind is SmallDisk else "write_error"
        harness.wait_for(lambda: tape.after_more() and f"are counted as {counter}" in net.process.stderr,
                         what="the disk to be full")
        for _ in range(30):  # more than the writer's own buffer
            tape.after_more()
        net.answers()
        disk.free(net.process.pid)
        before = tape.counters()["frames"]
        harness.wait_for(lambda: tape.after_more()["frames"] > before + 500, what="the recording to go on")
        net.process.wait_output("records are written again", stream="err")
        harness.wait_for(lambda: (r := tape.counters())["frames"] + r["write_error"] == len(tape.sent) + 1,
                         what="the last record")
        end = tape.counters()
        assert net.process.stop().status == 130
        recorded = [frame for _, frame in frames.read_tlog(path)]  # whole records and nothing else
        assert len(recorded) == end["frames"] and end["queue_full"] == 0
        assert (end["write_error"] == 0) == (kind is SmallDisk)
        places = {frame: place for place, frame in enumerate(tape.sent)}
        order = [places[frame] for frame in recorded if frame in places]
        assert order == sorted(set(order)) and order[-1] == len(tape.sent) - 1


def test_frames_of_a_disk_that_stays_full_are_not_counted_as_recorded(pair, tmp_path):
    """Neither those that the writer still buffers when the disk fills, nor those that come later."""
    path = tmp_path / "flight.tlog"
    net = pair(f"tlog://{path}?name=tape")
    SmallLimit(tmp_path).fill(net.process.pid)
    tape = Tape(net)
    end = harness.wait_for(lambda: (r := tape.after_more())["write_error"] > 20 and r, what="the disk to be full")

    done = net.process.stop()  # until then, each attempt to write leaves a part of a record there for a moment
    recorded = frames.read_tlog(path)
    assert (end["frames"], end["bytes"]) == (len(recorded), sum(len(frame) for _, frame in recorded))
    assert done.status == 130
    assert f"tape: {len(tape.sent) - len(recorded)} frames not written" in done.stderr


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_what_had_arrived_before_the_end_goes_its_way(pair, tmp_path, number):
    path = tmp_path / "flight.tlog"
    net = pair(f"tlog://{path}")
    sent = bulk(300)
    net.process.send(signal.SIGSTOP)
    for frame in sent:
        net.vehicle.send(frame)
    net.process.send(number)
    net.process.send(signal.SIGCONT)
    assert net.process.wait().status == 128 + number

    assert net.station.count(len(sent)) == sent
    assert [frame for _, frame in frames.read_tlog(path)][-len(sent):] == sent


def test_a_rotated_recording_keeps_to_its_limits_on_a_full_disk(pair, tmp_path):
    disk = SmallDisk(tmp_path)
    with contextlib.closing(disk):
        net = pair(f"tlog://{tmp_path / 'flight.tlog'}?name=tape&rotate_bytes=20k")
        tape = Tape(net)
        harness.wait_for(lambda: tape.after_more() and "No space left on device" in net.process.stderr,
                         what="the disk to be full")
        files = sorted(tmp_path.glob("*.tlog"))
        for _ in range(40):
            tape.after_more()
        assert sorted(tmp_path.glob("*.tlog")) == files
        disk.free(net.process.pid)
        harness.wait_for(lambda: tape.counters()["frames"] == len(tape.sent), what="the frames that waited")
        assert net.process.stop().status == 130
        paths = sorted(tmp_path.glob("*.tlog"))
        assert [frame for path in paths for _, frame in frames.read_tlog(path)] == tape.sent
        assert len(paths) > len(files) and max(path.stat().st_size for path in paths) <= 20 << 10


def recorded_in(folder):
    return [frame for path in sorted(folder.glob("*.tlog")) for _, frame in frames.read_tlog(path)]


@pytest.mark.parametrize("freed", ["fillers", "segment"])
def test_rotation_continues_when_the_disk_has_inodes_again(pair, tmp_path, freed):
    disk = FewFilesDisk(tmp_path)
    with contextlib.closing(disk):
        net = pair(f"tlog://{tmp_path / 'flight.tlog'}?name=tape&rotate_bytes=100kB")
        tape = Tape(net)
        harness.wait_for(lambda: tape.after_more() and "No space left on device" in net.process.stderr,
                         what="the last inode")
        deleted = []
        if freed == "fillers":
            disk.free(net.process.pid)
        else:  # the open segment: its inode is free only when the router has closed it
            last = max(tmp_path.glob("*.tlog"))
            deleted = [frame for _, frame in frames.read_tlog(last)]
            last.unlink()
        net.process.wait_output("records are written again", stream="err")
        if deleted:
            net.process.wait_output(f"tape: {last} was removed or replaced; a new file begins", stream="err")
        harness.wait_for(lambda: tape.counters()["frames"] == len(tape.sent), what="the frames that waited")
        assert net.process.stop().status == 130
        assert len(recorded_in(tmp_path)) + len(deleted) == len(tape.sent)


def test_a_recording_whose_file_is_replaced_continues_beside_it(pair, tmp_path):
    """Every frame after that was missing."""
    path = tmp_path / "flight.tlog"
    net = pair(f"tlog://{path}?name=tape")
    tape = Tape(net)
    harness.wait_for(lambda: tape.after_more()["frames"] == len(tape.sent), what="records")
    before = len(frames.read_tlog(path))
    path.unlink()
    path.write_text("another program's notes")
    net.process.wait_output(f"{path} was removed or replaced; a new file begins: {tmp_path / 'flight_2.tlog'}",
                            stream="err")
    tape.after_more()
    assert net.process.stop().status == 130

    assert path.read_text() == "another program's notes"
    assert [frame for _, frame in frames.read_tlog(tmp_path / "flight_2.tlog")] == tape.sent[before:]


def test_a_recording_finds_room_again_without_further_frames(pair, tmp_path):
    disk = SmallDisk(tmp_path)
    with contextlib.closing(disk):
        path = tmp_path / "flight.tlog"
        net = pair(f"tlog://{path}?name=tape")
        tape = Tape(net)
        harness.wait_for(lambda: tape.after_more() and "No space left on device" in net.process.stderr,
                         what="the disk to be full")
        disk.free(net.process.pid)
        net.process.wait_output("records are written again", stream="err")
        harness.wait_for(lambda: (r := tape.counters())["frames"] + r["write_error"] == len(tape.sent),
                         what="the records that waited")

        assert len(frames.read_tlog(path)) == tape.counters()["frames"]


@pytest.mark.parametrize("how", ["deleted", "replaced", "rotated"])
def test_a_recording_whose_file_goes_begins_a_new_one(pair, tmp_path, how):
    options = "&rotate_every=1h" if how == "rotated" else ""
    net = pair(f"tlog://{tmp_path / 'flight.tlog'}?name=tape{options}")
    tape = Tape(net)
    harness.wait_for(lambda: tape.after_more()["frames"] > 0, what="records")
    first, = tmp_path.glob("*.tlog")
    first.unlink()
    if how == "replaced":
        first.write_bytes(b"")
    net.process.wait_output(f"tape: {first} was removed or replaced; a new file begins", stream="err")
    net.passes(last := routers.attitude())
    harness.wait_for(lambda: any(last == frame for path in tmp_path.glob("*.tlog")
                                 for _, frame in frames.read_tlog(path)), what="the frame in the new file")

    assert (tmp_path / "flight_2.tlog").exists() == (how == "replaced")
    assert tape.counters()["write_error"] == 0


def test_a_file_that_can_grow_no_more_is_left_for_the_next_one(pair, tmp_path):
    net = pair(f"tlog://{tmp_path / 'flight.tlog'}?name=tape&rotate_every=1s")
    SmallLimit(tmp_path).fill(net.process.pid)
    tape = Tape(net)
    harness.wait_for(lambda: tape.after_more()["write_error"] > 20, what="the file to be full")
    harness.wait_for(lambda: tape.after_more() and len(list(tmp_path.glob("*.tlog"))) > 3, what="new files")


def test_a_router_that_cannot_start_leaves_recordings_alone(run, tmp_path):
    path = tmp_path / "flight.tlog"
    path.write_bytes(before := b"what an earlier flight left")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind((LOCALHOST, 0))
        port = taken.getsockname()[1]
        assert run("route", f"tlog://{path}", f"udpin://{LOCALHOST}:{port}").status == 1
    assert run("route", f"tlog://{path}", f"tlog://{tmp_path}/./flight.tlog?name=again",
               f"udpin://{LOCALHOST}:{port}").status == 2
    assert run("route", f"tlog://{path}", f"udpin://{LOCALHOST}:{port}", "--explain", "NOPE").status == 2

    assert os.listdir(tmp_path) == ["flight.tlog"] and path.read_bytes() == before


def faketime_library():
    found = sorted(pathlib.Path("/usr/lib").glob("*/faketime/libfaketimeMT.so.1"))
    return found[0] if found else pytest.skip("a stepped clock needs libfaketime (Debian: faketime)")


@contextlib.contextmanager
def kept_awake(end):
    """libfaketime also moves the alarm that the router sleeps by: a request could wait for an hour. Frames wake it."""
    over = threading.Event()

    def send():
        while not over.wait(0.1):
            end.send(routers.heartbeat((50, 1)))
    thread = threading.Thread(target=send)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def test_a_clock_that_jumps_by_an_hour_changes_nothing(pair, program, tmp_path):
    """Only the router's own wall clock jumps; the recording's times of TCP frames show that it did."""
    library = faketime_library()
    if has_sanitizer(program):
        pytest.skip("libfaketime and sanitizers do not go together")
    step = tmp_path / "step"
    step.write_text("+0s\n")
    port, path = routers.tcp_port(), tmp_path / "flight.tlog"
    net = pair(f"tcpin://{LOCALHOST}:{port}?name=tcp", f"tlog://{path}?name=tape",
               rules={"dedup_ms": 60_000, "route_timeout": 60}, options="idle=60",
               env={"LD_PRELOAD": str(library), "FAKETIME_TIMESTAMP_FILE": str(step), "FAKETIME_NO_CACHE": "1",
                    "FAKETIME_DONT_FAKE_MONOTONIC": "1"})
    client = routers.tcp_client(port)
    with contextlib.closing(client):
        net.router.wait_links(3)
        repeated = routers.attitude()
        net.passes(repeated)
        client.until(repeated)

        def shift():
            """How far the router's wall clock is from ours, in seconds, by a recorded frame."""
            mark = routers.heartbeat((50, 1))
            client.send(mark)
            net.station.until(mark)
            net.vehicle.until(mark)
            records = harness.wait_for(lambda: [r for r in frames.read_tlog(path) if r[1] == mark], what="the record")
            return records[0][0] / 1e6 - time.time()
        assert abs(shift()) < 600
        for text, seconds in (("-3600s", -3600), ("+3600s", 3600)):
            step.write_text(text + "\n")
            harness.wait_for(lambda seconds=seconds: abs(shift() - seconds) < 600, what=f"the clock at {text}")
            with kept_awake(client):
                routes, links = net.router.routes(), net.router.links()
                there = net.router.link_of(net.vehicle)["link"]
            assert (1, 1, there) in routes and len(links) == 3
            shift()  # receives what kept it awake
            net.vehicle.send(repeated)  # still a copy
            fresh = routers.attitude()
            net.vehicle.send(fresh)
            assert net.station.until(fresh) == [] and client.until(fresh) == []
            net.answers()
        with kept_awake(client):
            assert net.router.link_of(net.vehicle)["duplicate"] == 2
            assert net.router.stats("router")[0]["routes_expired"] == 0
    assert "down, idle" not in net.process.stderr


# ---- loops -----------------------------------------------------------------------------------------------------------

def two_that_call_each_other(spawn):
    here, there = routers.udp_port(), routers.udp_port()
    station = UdpEnd(label="station")
    return here, station, [Router(spawn, f"udpin://{LOCALHOST}:{here}", f"udpout://{LOCALHOST}:{there}"),
                           Router(spawn, f"udpin://{LOCALHOST}:{there}", f"udpout://{LOCALHOST}:{here}",
                                  f"udpout://{LOCALHOST}:{station.port}?name=station")]


def two_joined_twice(spawn):
    here, first, second = routers.udp_port(), routers.udp_port(), routers.udp_port()
    station = UdpEnd(label="station")
    return here, station, [Router(spawn, f"udpin://{LOCALHOST}:{here}", f"udpout://{LOCALHOST}:{first}",
                                  f"udpout://{LOCALHOST}:{second}"),
                           Router(spawn, f"udpin://{LOCALHOST}:{first}", f"udpin://{LOCALHOST}:{second}",
                                  f"udpout://{LOCALHOST}:{station.port}?name=station")]


def ring_of_three(spawn):
    ports = [routers.tcp_port() for _ in range(3)]
    here = routers.udp_port()
    station = UdpEnd(label="station")
    extra = [f"udpin://{LOCALHOST}:{here}", f"udpout://{LOCALHOST}:{station.port}?name=station",
             f"udpin://{LOCALHOST}:{routers.udp_port()}"]
    ring = [Router(spawn, f"tcpin://{LOCALHOST}:{ports[i]}", f"tcpout://{LOCALHOST}:{ports[(i + 1) % 3]}", extra[i])
            for i in range(3)]
    for router, others in zip(ring, (2, 3, 2)):
        router.wait_links(others)
    return here, station, ring


@pytest.mark.parametrize("make", [two_that_call_each_other, two_joined_twice, ring_of_three])
def test_a_loop_ends(spawn, make):
    port, station, all_routers = make(spawn)
    vehicle = UdpEnd((LOCALHOST, port))
    with contextlib.closing(vehicle), contextlib.closing(station):
        sent = [routers.attitude() for _ in range(100)]
        for frame in sent:
            vehicle.send(frame)
            vehicle.send(frame)  # a network that doubles, or a sender that repeats frames
        got = station.until(sent[-1])

        def moved():
            return sum(link["frames_in"] + link["frames_out"] for router in all_routers for link in router.links())

        def at_rest():
            before = moved()
            time.sleep(0.1)
            assert before < 200 * 4 * 2 * len(all_routers)
            return moved() == before
        harness.wait_for(at_rest, what="the loop to come to rest")
        got += [sent[-1], *station.now()]
        assert list(dict.fromkeys(got)) == sent
        assert all(got.count(frame) <= 2 for frame in sent)


# ---- stopped, killed -------------------------------------------------------------------------------------------------

def test_stopped_and_continued_it_has_what_the_kernel_kept(pair):
    port = routers.tcp_port()
    net = pair(f"tcpin://{LOCALHOST}:{port}?name=tcp", options="rcvbuf=16k&name=in")
    with contextlib.closing(routers.tcp_client(port)) as client:
        net.router.wait_links(3)
        net.process.send(signal.SIGSTOP)
        sent = [routers.attitude() for _ in range(2000)]
        for frame in sent:
            net.vehicle.send(frame)
        by_tcp = [routers.attitude((2, 1)) for _ in range(500)]
        for frame in by_tcp:
            client.send(frame)
        net.process.send(signal.SIGCONT)
        harness.wait_for(lambda: net.router.link_of(net.vehicle)["frames_in"] - 1
                         + endpoint(net.router, "in")["kernel_drop"] == len(sent),
                         what="every frame to be taken or counted")
        assert 0 < endpoint(net.router, "in")["kernel_drop"] < len(sent)

        last = routers.attitude()
        net.vehicle.send(last)
        got = net.station.until(last)
        assert [frame for frame in got if frame in by_tcp] == by_tcp
        kept = [frame for frame in got if frame not in by_tcp]
        assert len(kept) == net.router.link_of(net.vehicle)["frames_in"] - 2
        assert kept == [frame for frame in sent if frame in set(kept)]
        assert client.until(last) == kept
        assert len(net.router.links()) == 3
        net.answers()


class Restarted(Router):
    """The same router once more, under its old name."""

    def __init__(self, spawn, before):
        self.name, self.env = before.name, before.env
        self.process = spawn(*before.process.args[1:], env=self.env)
        self._control = harness.wait_for(self._connect, what="the control socket").makefile("rwb")


def test_killed_and_started_again_everything_comes_back(pair, spawn, tmp_path):
    port, path, far_port = routers.tcp_port(), tmp_path / "flight.tlog", routers.udp_port()
    net = pair(f"tcpin://{LOCALHOST}:{port}?name=tcp", f"tlog://{path}?name=tape")
    other = Router(spawn, f"tcpout://{LOCALHOST}:{port}?name=up", f"udpin://{LOCALHOST}:{far_port}?name=far")
    net.router.wait_links(3)
    sent = [routers.attitude() for _ in range(300)]
    net.passes(*sent)
    harness.wait_for(lambda: net.router.stats("recording")[0]["frames"] == 301, what="the recording")
    net.process.send(signal.SIGKILL)
    assert net.process.wait().status == -signal.SIGKILL
    harness.wait_for(lambda: not any(link["link"] == "up" for link in other.links()), what="the other router to see it")

    net.router = Restarted(spawn, net.router)
    harness.wait_for(lambda: any(link["link"] == "up" for link in other.links()), what="the other router to come back")
    again = net.say()
    net.station.target = net.station.sock.recvfrom(65536)[1]
    assert harness.wait_for(lambda: [e for e in other.stats("endpoint") if e["endpoint"] == "up"][0]["reconnects"] == 1,
                            what="the count")
    with contextlib.closing(UdpEnd((LOCALHOST, far_port))) as far:
        far.send(heartbeat := routers.heartbeat((9, 9)))
        assert net.station.until(heartbeat) == []
        more = [routers.attitude() for _ in range(50)]
        net.passes(*more)
        assert far.until(more[-1])[-49:] == more[:-1]
    assert net.process.stop().status == 130
    old = [frame for _, frame in frames.read_tlog(f"{path}.1")]
    assert old[1:] == sent[:len(old) - 1] and len(old) > 250
    assert [frame for _, frame in frames.read_tlog(path)] == [again, heartbeat, *more]


def test_a_second_router_without_name_continues_without_a_socket(spawn, tmp_path):
    ends = [UdpEnd((LOCALHOST, routers.udp_port()), "in") for _ in range(2)]
    env = {"MAVLOOM_RUN": str(tmp_path)}
    first = spawn("route", f"udpin://{LOCALHOST}:{ends[0].target[1]}", env=env)
    first.wait_output("receive buffer", stream="err")
    second = spawn("route", f"udpin://{LOCALHOST}:{ends[1].target[1]}", env=env)
    second.wait_output("no control socket: .* is served by another process", stream="err")
    second.wait_output("receive buffer", stream="err")
    for end in ends:
        end.close()
    assert first.stop().status == 130 and second.stop().status == 130


# ---- names -----------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("scheme", ["udpout", "tcpout"])
def test_a_host_without_address_delays_nobody(pair, scheme):
    net = pair(f"{scheme}://no-such-host.invalid:14550?name=far")
    for _ in range(5):
        net.passes(*(routers.attitude() for _ in range(20)))
        net.answers()
    net.process.wait_output(r"far: .*trying again", stream="err")
    net.passes(routers.attitude())
    assert len(net.router.links()) == 2


@pytest.fixture
def own_hosts(program, tmp_path):
    """Starts the program where `own_hosts.file` is /etc/hosts."""
    if os.geteuid() != 0 or not shutil.which("unshare"):
        pytest.skip("a hosts file of its own needs root and unshare")
    file = tmp_path / "hosts"
    file.write_text("127.0.0.1 localhost\n")
    if subprocess.run(["unshare", "-m", "mount", "--bind", file, "/etc/hosts"], capture_output=True).returncode != 0:
        pytest.skip("no mount namespaces here")
    running = []

    def start(*args, env=None):
        inside = 'mount --bind "$0" /etc/hosts && exec "$@"'
        running.append(harness.Running(["unshare", "-m", "sh", "-c", inside, file, program, *args],
                                       env={**os.environ, **(env or {})}))
        return running[-1]
    start.file = file
    yield start
    harness.end(running)


@pytest.mark.parametrize("scheme", ["udpout", "tcpout"])
def test_a_host_is_looked_up_until_it_has_an_address(own_hosts, scheme):
    port = routers.udp_port()
    with (socket.create_server((LOCALHOST, 0)) as server,
          contextlib.closing(UdpEnd((LOCALHOST, port))) as vehicle,
          contextlib.closing(UdpEnd()) as far):
        far_port = far.port if scheme == "udpout" else server.getsockname()[1]
        router = Router(own_hosts, f"udpin://{LOCALHOST}:{port}", f"{scheme}://ground.invalid:{far_port}?name=far")
        router.process.wait_output(r"far: .*trying again", stream="err")
        own_hosts.file.write_text("127.0.0.1 localhost ground.invalid\n")
        harness.wait_for(lambda: any(link["link"] == "far" for link in router.links()), what="the link")
        frame = routers.attitude()
        vehicle.send(frame)
        end = far if scheme == "udpout" else TcpEnd(server.accept()[0])
        assert end.next() == frame
        end.close()


@pytest.mark.short
def test_an_endpoint_that_hears_nothing_is_reported_once(spawn):
    """A PX4 that talks to somebody else already takes what the router sends, and answers nobody."""
    with UdpEnd() as px4, UdpEnd() as copy:
        router = Router(spawn, f"udpout://{LOCALHOST}:{px4.port}?name=px4",
                        f"udpout://{LOCALHOST}:{copy.port}?name=copy&tap=true", rules={"heartbeat": "255/191"})
        told = router.process.wait_output(r"px4: nothing heard for 5 s; .*", stream="err")[0]
        px4.count(60)  # it continues

    assert f"{LOCALHOST}:{px4.port}" in told and "PX4" in told
    assert router.process.stderr.count("nothing heard") == 1
