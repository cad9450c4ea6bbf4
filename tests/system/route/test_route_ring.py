# SPDX-License-Identifier: MIT
"""mavloom route --ring: the tap, its counter page, and the inlet. The ring is read here by docs/formats/ring.md;
frames are pymavlink's."""
import array
import contextlib
import fcntl
import hashlib
import json
import os
import pathlib
import random
import shutil
import signal
import socket
import struct
import subprocess
import time
import types
import uuid

import pytest

import frames
import harness
import routers
from routers import Router, UdpEnd, attitude, command, damaged, heartbeat, make, unknown
from frames import mavlink

pytestmark = pytest.mark.short

GCS, VEHICLE = (255, 190), (1, 1)
HOST = ("127.0.0.1",)

# The verdict byte of docs/formats/ring.md.
FORWARDED, NOWHERE, FILTERED, RATE_LIMITED, DUPLICATE, ECHO, UNKNOWN_TARGET, CONSUMED, TAP, PRIVATE = range(1, 11)
UNCHECKED, GOOD = 1 << 4, 2 << 4


# ---- reading by the documented bytes ---------------------------------------------------------------------------------

def is_mark(frame) -> bool:
    return frame[5 if frame[0] == 0xFD else 3] == 0


def next_from(end) -> bytes:
    """The next frame that came there, marks left out."""
    while is_mark(frame := end.next()):
        pass
    return frame


def shared(name, suffix="") -> pathlib.Path:
    return pathlib.Path(f"/dev/shm/mavloom.{name}{suffix}")


def is_there_again(file):
    """Whether the writer has created the file again. It removes a shortened file first, so there may be none."""
    with contextlib.suppress(FileNotFoundError):
        return file.stat().st_size > 0
    return False


def records(name) -> list:
    """All that the ring holds, which must not have gone round."""
    data = shared(name).read_bytes()
    assert data[:8] == b"MVLRING\0" and struct.unpack_from("<HH", data, 8) == (1, 0)
    capacity, = struct.unpack_from("<Q", data, 16)
    tail, = struct.unpack_from("<Q", data, 128)
    assert tail < capacity, "the ring went round: what began it is overwritten"
    found, position = [], 0
    while position < tail:
        length, kind, verdict, flags, link, sequence, time_ns = struct.unpack_from("<iHBBIIq", data, 16384 + position)
        assert length >= 0 and flags == 0
        begin = 16384 + position + 24
        found.append(types.SimpleNamespace(data=data[begin:begin + length], kind=kind, verdict=verdict, link=link,
                                           sequence=sequence, time_ns=time_ns))
        position += (24 + length + 7) // 8 * 8
    assert [record.sequence for record in found] == list(range(len(found)))
    return found


class Tapped:
    """A router with a ring, a vehicle and a ground station;
    a mark shows that all earlier frames are in the ring."""

    def __init__(self, spawn, ring, *extra, vehicle="", ground="", rules=None, options=("--ring",)):
        self.ring = ring
        port = routers.udp_port()
        self.vehicle = UdpEnd((*HOST, port), "vehicle")
        near = routers.udp_port()
        self.ground = UdpEnd((*HOST, near), "ground")
        urls = [f"udpin://127.0.0.1:{port}?name=vehicle{vehicle}",
                f"udpout://127.0.0.1:{self.ground.port}?bind=127.0.0.1:{near}&name=ground{ground}"]
        self.router = Router(spawn, *urls, *extra, *([*options, ring] if options else []), rules=rules)

    def close(self):
        self.vehicle.close()
        self.ground.close()

    @property
    def inlet(self) -> str:
        path = harness.RUN / f"{self.ring}.in"
        harness.wait_for(path.exists, what="the inlet")
        return str(path)

    def settled(self) -> list:
        """The records so far, without those of marks. Marks come by the ground station's link, which is always up."""
        mark = heartbeat((0, 0))
        self.ground.send(mark)
        harness.wait_for(lambda: any(r.data == mark for r in records(self.ring)), what="the mark in the ring")
        return [r for r in records(self.ring) if not is_mark(r.data)]

    def sent_by(self, end, *all_frames) -> list:
        """Their records, once the last is in the ring."""
        for frame in all_frames:
            end.send(frame)
        harness.wait_for(lambda: any(r.data == all_frames[-1] for r in records(self.ring)),
                         what="the last frame in the ring")
        return self.settled()

    def page(self, run) -> list:
        done = run("stat", self.ring, "--json", env=self.router.env)
        assert done.status == 0, done
        return [json.loads(line) for line in done.lines]

    def names(self, run) -> dict:
        return {line["id"]: line["link"] for line in self.page(run) if line["kind"] == "link"}


@pytest.fixture
def ring():
    name = f"tap-{os.getpid()}-{uuid.uuid4().hex[:8]}"
    yield name
    suffixes = ("", ".stat", ".aside", ".stat.aside")
    for path in (*(shared(name, suffix) for suffix in suffixes), harness.RUN / f"{name}.in"):
        with contextlib.suppress(OSError):
            path.unlink()


@pytest.fixture
def tapped(spawn, ring):
    made = []

    def build(*extra, **options):
        made.append(Tapped(spawn, ring, *extra, **options))
        return made[-1]
    yield build
    for one in made:
        one.close()


@pytest.fixture
def app():
    """app(inlet) -> a bound local socket, app(inlet, None) an unbound one; closed at the end."""
    made = []

    def build(inlet, name=""):
        sock = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        made.append(sock)
        if name is not None:
            sock.bind(name)  # "": an abstract name of the kernel's choice
        sock.connect(inlet)
        sock.settimeout(harness.DEFAULT_TIMEOUT_S)
        return sock
    yield build
    for sock in made:
        sock.close()


# ---- the tap ---------------------------------------------------------------------------------------------------------

def test_every_good_frame_once_byte_for_byte(tapped, run):
    net = tapped()
    signed = make(mavlink.MAVLink_heartbeat_message(2, 12, 81, 1, 4, 3), (4, 1), signing=(bytes(32), 3, 1 << 40))
    from_vehicle = [heartbeat(), attitude(), attitude(version=1), unknown(), signed, command(VEHICLE, (9, 9)),
                    *(attitude() for _ in range(300))]
    before = time.time_ns()
    net.vehicle.send(heartbeat((3, 1)))
    net.vehicle.send(damaged())
    found = net.sent_by(net.vehicle, *from_vehicle)
    found = net.sent_by(net.ground, heartbeat(GCS), command(GCS, VEHICLE))
    after = time.time_ns()

    by_vehicle = [r for r in found if r.data in from_vehicle]
    assert [r.data for r in by_vehicle] == from_vehicle
    assert len(found) == 1 + len(from_vehicle) + 2 and len({r.data for r in found}) == len(found)
    assert {r.kind for r in found} == {1}
    assert all(before <= r.time_ns <= after for r in found)
    assert [r.time_ns for r in by_vehicle] == sorted(r.time_ns for r in by_vehicle)
    verdicts = {r.data: r.verdict for r in found}
    assert verdicts[signed] == FORWARDED | UNCHECKED
    assert verdicts[from_vehicle[5]] == UNKNOWN_TARGET
    assert verdicts[from_vehicle[0]] == verdicts[from_vehicle[3]] == FORWARDED
    names = net.names(run)
    assert {names[r.link] for r in by_vehicle} == {f"vehicle#127.0.0.1:{net.vehicle.port}"}
    assert names[found[-1].link] == "ground"
    # pymavlink takes them apart as it would from a socket, and finds what shm read prints.
    parsed = mavlink.MAVLink(None).parse_buffer(b"".join(r.data for r in by_vehicle[-300:]))
    assert [m.get_type() for m in parsed] == ["ATTITUDE"] * 300
    printed = run("shm", "read", net.ring, "--from", "oldest", "--count", len(records(net.ring)), "--json")
    assert [bytes.fromhex(json.loads(line)["hex"]) for line in printed.lines] == [r.data for r in records(net.ring)]


def test_what_is_not_forwarded_is_there_with_its_verdict(tapped):
    net = tapped(f"tcpin://127.0.0.1:{routers.tcp_port()}", vehicle="&in_block=ATTITUDE&max_rate=SCALED_PRESSURE:1",
                 ground="&max_rate=SYS_STATUS:0.01", rules={"dedup_ms": 2000, "heartbeat": "77/66"})
    blocked = attitude()
    twice = make(mavlink.MAVLink_vfr_hud_message(1, 2, 3, 4, routers.unique(), 6))
    mine = command(VEHICLE, (77, 66))
    status = [make(mavlink.MAVLink_sys_status_message(routers.unique(), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0))
              for _ in range(2)]
    net.vehicle.send(heartbeat())
    found = net.sent_by(net.vehicle, blocked, twice, *status, mine)
    verdicts = {r.data: r.verdict for r in found}
    assert verdicts[blocked] == FILTERED and verdicts[twice] == FORWARDED and verdicts[mine] == CONSUMED
    assert [verdicts[frame] for frame in status] == [FORWARDED, RATE_LIMITED]
    net.ground.send(twice)
    net.vehicle.send(twice)
    harness.wait_for(lambda: len([r for r in records(net.ring) if r.data == twice]) == 3, what="three copies")
    assert {r.verdict for r in net.settled() if r.data == twice} - {FORWARDED} <= {DUPLICATE, ECHO}
    assert [r.verdict for r in net.settled() if r.data == twice].count(FORWARDED) == 1


def test_signatures_that_were_checked(tapped, tmp_path, run):
    key_file = tmp_path / "link.key"
    assert run("key", "new", key_file).status == 0
    key = bytes.fromhex(key_file.read_text().strip())
    net = tapped(vehicle=f"&verify={key_file}")
    ticks = int((time.time() - 1420070400) * 100_000)
    good = make(mavlink.MAVLink_heartbeat_message(2, 12, 81, routers.unique(), 4, 3), signing=(key, 1, ticks))
    forged = make(mavlink.MAVLink_heartbeat_message(2, 12, 81, routers.unique(), 4, 3),
                  signing=(hashlib.sha256(b"x").digest(), 1, ticks + 1))
    last = make(mavlink.MAVLink_heartbeat_message(2, 12, 81, routers.unique(), 4, 3), signing=(key, 1, ticks + 2))
    found = net.sent_by(net.vehicle, good, forged, last)
    assert [(r.data, r.verdict) for r in found] == [(good, FORWARDED | GOOD), (last, FORWARDED | GOOD)]


def test_readers_follow_and_sleep(tapped, spawn, run, tmp_path):
    """A reader that sleeps is woken; one that is lossless and stalls holds neither the routing up nor the ring once
    that is full."""
    file = tmp_path / "r.toml"
    file.write_text('[ring]\ncapacity = "64k"\n')
    net = tapped("--config", str(file))
    stat = lambda: json.loads(run("shm", "stat", net.ring, "--json").stdout)
    follower = spawn("shm", "read", net.ring, "--json", "--count", "50")
    stalled = spawn("shm", "read", net.ring, "--lossless")
    harness.wait_for(lambda: len(stat()["readers"]) == 2, what="two readers")
    stalled.send(signal.SIGSTOP)
    sent = []
    for count in range(1, 51):
        sent.append(attitude())
        net.vehicle.send(sent[-1])
        harness.wait_for(lambda count=count: len(follower.stdout.splitlines()) == count,
                         what="the frame that was written while it slept")
    done = follower.wait()
    assert done.status == 0
    assert [bytes.fromhex(json.loads(line)["hex"]) for line in done.stdout.splitlines()] == sent
    held, = stat()["readers"]
    assert held["holds"] and stat()["capacity"] == 65536 and stat()["evictions"] == 0

    for _ in range(40):  # records of 72 bytes: more than twice round
        part = [attitude() for _ in range(50)]
        for frame in part:
            net.vehicle.send(frame)
        sent += part
        net.ground.until(part[-1])
    harness.wait_for(lambda: stat()["records"] == len(sent), what="all frames in the ring")
    status = stat()
    assert status["bytes"] > 2 * 65536 and status["dropped"] == 0 and status["evictions"] == 1
    held, = status["readers"]
    assert held["lossless"] and not held["holds"] and held["pid"] == stalled.pid
    stalled.kill()


# ---- its life --------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("number, status", [(signal.SIGTERM, 143), (signal.SIGINT, 130)])
def test_a_clean_end_removes_everything(tapped, number, status):
    net = tapped()
    inlet = net.inlet
    assert shared(net.ring).stat().st_mode & 0o777 == 0o600 and os.stat(inlet).st_mode & 0o777 == 0o600
    assert shared(net.ring, ".stat").exists()
    net.router.process.process.send_signal(number)
    assert net.router.process.wait().status == status
    assert not shared(net.ring).exists() and not shared(net.ring, ".stat").exists() and not os.path.exists(inlet)


def test_killed_it_carries_on(tapped, spawn, run):
    net = tapped()
    first = [heartbeat(), *(attitude() for _ in range(50))]
    net.sent_by(net.vehicle, *first)
    held = records(net.ring)
    net.router.process.process.kill()
    net.router.process.wait()
    inlet = net.inlet
    left = run("stat", net.ring, env=net.router.env)
    assert left.status == 0 and "which was killed" in left.stdout
    net.close()

    again = tapped()
    assert again.inlet == inlet
    later = [heartbeat(), *(attitude() for _ in range(50))]
    again.sent_by(again.vehicle, *later)
    both = records(again.ring)
    assert [r.data for r in both[:len(held)]] == [r.data for r in held]
    assert [r.data for r in both if r.data in later] == later
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as sender:
        sender.sendto(heartbeat((9, 9)), inlet)
    harness.wait_for(lambda: again.router.stats("endpoint")
                     and any(link["link"].endswith("#unbound") for link in again.router.links()), what="the sender")
    again.router.process.process.terminate()
    assert again.router.process.wait().status == 143
    assert not shared(again.ring).exists() and not os.path.exists(inlet)


def test_frames_of_a_killed_router_keep_the_names_of_its_links(tapped, run):
    """A reader that lags behind reads them while the next router writes."""
    net = tapped()
    first = [heartbeat(), attitude()]
    net.sent_by(net.vehicle, *first)
    net.router.process.process.kill()
    net.router.process.wait()
    net.close()
    again = tapped()
    later = [heartbeat(), attitude()]
    again.sent_by(again.vehicle, *later)

    wanted = [(frame.hex(), f"vehicle#127.0.0.1:{end.port}")
              for end, sent in ((net.vehicle, first), (again.vehicle, later)) for frame in sent]
    held = {r.data.hex(): r.link for r in records(again.ring)}
    assert len({held[frame] for frame, _ in wanted}) == 2, "no number stands for two links"
    all_records = records(again.ring)
    listed = run("listen", f"shm://{again.ring}?from=oldest", "--json", "--count", len(all_records))
    links = dict(zip((r.data.hex() for r in all_records), (json.loads(line)["link"] for line in listed.lines)))
    assert [(frame, links[frame]) for frame, _ in wanted] == wanted


def test_a_second_writer_is_refused(tapped, run):
    net = tapped()
    done = run("route", f"udpin://127.0.0.1:{routers.udp_port()}", "--ring", net.ring, "--name", "second",
               env=net.router.env)
    assert done.status == 1 and f"ring {net.ring} already has a writer, process {net.router.process.pid}" in done.stderr
    frame = attitude()
    assert frame in [r.data for r in net.sent_by(net.vehicle, heartbeat(), frame)]
    assert os.path.exists(net.inlet) and shared(net.ring, ".stat").exists()


def test_the_inlet_of_somebody_who_lives_is_left_alone(run, ring, tmp_path):
    args = ("route", f"udpin://127.0.0.1:{routers.udp_port()}", "--ring", ring, "--for", "100ms")
    place = str(harness.RUN / f"{ring}.in")
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as other:
        other.bind(place)
        done = run(*args)
        assert done.status == 1 and f"{place} is already served by process {os.getpid()}" in done.stderr
        assert not shared(ring).exists() and not shared(ring, ".stat").exists()
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as sender:
            sender.sendto(b"still here", place)
        other.settimeout(harness.DEFAULT_TIMEOUT_S)
        assert other.recv(100) == b"still here"
    assert run(*args).status == 0, "nobody serves it any more"
    assert not os.path.exists(place)
    pathlib.Path(place).write_text("a file of somebody's")
    done = run(*args)
    assert done.status == 0, "a file in its place keeps no router down"
    assert f"{place} exists and is not a socket; remove it; programs cannot send through ring {ring}" in done.stderr
    assert pathlib.Path(place).read_text() == "a file of somebody's"


@pytest.mark.parametrize("how", ["rm", "shm remove"])
def test_a_ring_that_somebody_removes_is_created_again(tapped, run, how):
    net = tapped()
    net.sent_by(net.vehicle, heartbeat(), attitude())
    number = shared(net.ring).stat().st_ino
    if how == "rm":
        shared(net.ring).unlink()
        shared(net.ring, ".stat").unlink()
    else:
        assert run("shm", "remove", "--force", net.ring).status == 0
    harness.wait_for(lambda: shared(net.ring).exists() and shared(net.ring, ".stat").exists(), what="a new ring")
    assert shared(net.ring).stat().st_ino != number
    net.router.process.wait_output(f"ring {net.ring} was removed; it is created again")
    frame = attitude()
    assert [r.data for r in net.sent_by(net.vehicle, frame)] == [frame]
    assert f"vehicle#127.0.0.1:{net.vehicle.port}" in harness.wait_for(lambda: net.names(run),
                                                                       what="the links' names").values()


def test_an_inlet_that_somebody_removes_is_created_again(tapped, app):
    net = tapped()
    net.sent_by(net.vehicle, heartbeat())
    place = net.inlet
    os.unlink(place)
    net.router.process.wait_output(f"inlet {place} was removed; it is created again")
    frame = heartbeat((30, 1))
    app(net.inlet).send(frame)
    assert next_from(net.vehicle) == frame
    # The socket of another program is left alone, and reported once.
    os.unlink(place)
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as other:
        other.bind(place)
        net.router.process.wait_output(f"inlet {place} was removed: {place} is already served by process [0-9]+")
        net.router.process.process.terminate()
        assert net.router.process.wait().status == 143
        assert os.path.exists(place)


def test_a_name_that_another_writer_took_meanwhile(tapped, spawn, run):
    """The frames are counted as dropped, and the ring is the router's again when the other one is gone."""
    net = tapped()
    net.sent_by(net.vehicle, heartbeat(), attitude())
    name = f"{net.ring}-other"
    other = spawn("shm", "write", name, stdin=subprocess.PIPE)
    harness.wait_for(lambda: shared(name).exists(), what="the other ring")
    shared(name).rename(shared(net.ring))
    net.router.process.wait_output(f"ring {net.ring} was removed: ring {net.ring} already has a writer, "
                                   f"process {other.pid}; trying again every second")
    for _ in range(3):
        net.vehicle.send(attitude())
    harness.wait_for(lambda: net.page(run)[0]["ring_dropped"] == 3, what="three frames counted")
    other.process.stdin.close()
    assert other.wait().status == 0
    net.router.process.wait_output(f"ring {net.ring} was removed; it is created again")
    frame = attitude()
    assert [r.data for r in net.sent_by(net.vehicle, frame)] == [frame]
    assert net.router.process.stderr.count("trying again every second") == 1


def test_own_heartbeats_are_not_for_readers_of_the_ring(tapped, app):
    net = tapped(rules={"heartbeat": "77/66"})
    app(net.inlet).send(heartbeat((30, 1)))
    harness.wait_for(lambda: any("#@" in link["link"] for link in net.router.links()), what="the sender")
    own = [frame for frame in (net.ground.next() for _ in range(5)) if frame[5] == 77]
    assert len(own) >= 4, "the ground station gets them"
    link, = [link for link in net.router.links() if "#@" in link["link"]]
    assert link["frames_out"] == 0 and all(r.data not in own for r in records(net.ring))


@pytest.mark.skipif(os.geteuid() != 0 or not shutil.which("unshare"), reason="a small /dev/shm needs root and unshare")
@pytest.mark.parametrize("size, what", [("1m", "mavloom.full of "), ("8300k", "mavloom.full.stat of ")])
def test_a_full_dev_shm(program, size, what):
    script = (f'mount -t tmpfs -o size={size} none /dev/shm && "$0" route udpin://127.0.0.1:{routers.udp_port()} '
              '--ring full --for 1s; echo "status $?"; '
              'ls -A /dev/shm; ls $MAVLOOM_RUN/full.in 2>/dev/null')
    done = subprocess.run(["unshare", "--mount", "sh", "-c", script, str(program)], capture_output=True, text=True,
                          timeout=harness.DEFAULT_TIMEOUT_S)
    if "status" not in done.stdout:
        pytest.skip(f"no mount namespace here: {done.stderr.strip()}")
    assert done.stdout == "status 0\n", "nothing is left"
    assert f"cannot create /dev/shm/{what}" in done.stderr and "No space left on device" in done.stderr
    assert "the router runs without a ring" in done.stderr


def test_rings_that_cannot_be(run, ring, tmp_path):
    port = routers.udp_port()
    for name in ("a/b", "x" * 65, "a.b"):
        done = run("route", f"udpin://127.0.0.1:{port}", "--ring", name)
        assert done.status == 2 and f"'{name}' is not a ring name" in done.stderr, done
    done = run("route", f"udpin://127.0.0.1:{port}", f"shm://{ring}")
    assert done.status == 2 and f"a ring is not an endpoint of a router; --ring {ring}" in done.stderr
    file = tmp_path / "r.toml"
    file.write_text(f'[[endpoint]]\nurl = "shm://{ring}"\n')
    done = run("route", "--config", file)
    assert done.status == 3 and "a ring is not an endpoint of a router" in done.stderr


def test_a_start_that_fails_leaves_nothing(run, ring):
    taken = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    with taken:
        taken.bind((*HOST, 0))
        done = run("route", f"udpin://127.0.0.1:{taken.getsockname()[1]}", "--ring", ring)
    assert done.status == 1 and not shared(ring).exists() and not shared(ring, ".stat").exists()


def test_a_start_that_fails_leaves_the_ring_of_an_earlier_writer(run, ring):
    assert run("shm", "write", ring, input="one\ntwo\n").status == 0
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind((*HOST, 0))
        assert run("route", f"udpin://127.0.0.1:{taken.getsockname()[1]}", "--ring", ring).status == 1
    found = run("shm", "read", ring, "--from", "oldest", "--drain", "--data")
    shared(ring).unlink()

    assert "one" in found.stdout and "two" in found.stdout, found


def test_a_writer_that_fails_leaves_another_ones_page(run, tapped, ring):
    tapped()
    shared(ring).unlink()
    again = run("route", f"udpin://127.0.0.1:{routers.udp_port()}", "--ring", ring)

    assert again.status == 1, again
    assert shared(ring, ".stat").exists()


# ---- the file --------------------------------------------------------------------------------------------------------

def test_the_file_names_the_ring(spawn, run, ring, tmp_path):
    file = tmp_path / "r.toml"
    file.write_text(f'[ring]\nname = "{ring}"\ncapacity = "64k"\nmode = "0660"\n[[endpoint]]\n'
                    f'url = "udpin://127.0.0.1:{routers.udp_port()}"\n')
    printed = run("check", file)
    assert printed.status == 0 and all(word in printed.stdout for word in (ring, "64k", "0660", "evict"))
    process = spawn("route", "--config", file)
    harness.wait_for(lambda: shared(ring, ".stat").exists(), what="the page")
    assert struct.unpack_from("<Q", shared(ring).read_bytes(), 16) == (65536,)
    assert shared(ring).stat().st_mode & 0o777 == shared(ring, ".stat").stat().st_mode & 0o777 == 0o660
    # --name is the ring's name unless it is given.
    links = harness.wait_for(lambda: (done := run("ctl", ring, "stats")).status == 0 and done,
                             what="the control socket")
    assert '"kind":"router"' in links.stdout
    file.write_text(file.read_text().replace("64k", "128k"))
    process.process.send_signal(signal.SIGHUP)
    process.wait_output(r"a changed \[ring\] takes effect when the router restarts")
    process.process.terminate()
    assert process.wait().status == 143


@pytest.mark.parametrize("lines, what", [("nam = 'x'", "did you mean 'name'?"), ("capacity = 100", "power of two"),
                                         ("full = 'wait'", "a router does not wait for readers"),
                                         ("mode = 600", "in quotes"),
                                         ("size = 1", "[ring] has name, capacity, full, mode")])
def test_keys_that_are_wrong(run, tmp_path, lines, what):
    file = tmp_path / "r.toml"
    file.write_text(f"[ring]\n{lines}\n")
    done = run("check", file)
    assert done.status == 3 and what in done.stderr + done.stdout, done


# ---- the counter page ------------------------------------------------------------------------------------------------

def test_stat_agrees_with_ctl(tapped, run):
    net = tapped()
    net.sent_by(net.vehicle, heartbeat(), damaged(), *(attitude() for _ in range(20)))
    count = len(records(net.ring))

    def page():
        lines = net.page(run)
        return lines if lines[0].get("ring_records") == count and any(line.get("frames_in") == 21
                                                                      for line in lines) else None
    lines = harness.wait_for(page, what="the page to tell all")
    assert lines[0]["kind"] == "page" and lines[0]["alive"] and lines[0]["pid"] == net.router.process.pid
    assert lines[0]["ring_dropped"] == 0 and lines[0]["links"] == 2
    asked = {link["link"]: link for link in net.router.ask("links")}
    for line in (line for line in lines if line["kind"] == "link"):
        for key in line.keys() - {"kind", "id", "link", "frames_out", "bytes_out"}:
            assert line[key] == asked[line["link"]][key], key
    assert [line["crc_error"] for line in lines if line.get("link", "").startswith("vehicle#")] == [1]
    said = run("stat", net.ring, env=net.router.env).stdout
    assert f"{net.ring}, counters of process {net.router.process.pid}" in said and "link ground\n" in said
    assert "in 21 frames" in said
    by_name = run("stat", net.router.name, "--json", env=net.router.env)
    assert by_name.status == 0 and '"kind":"router"' in by_name.stdout, "a name that is no ring's is asked"


def test_more_links_than_the_page_has_rows(tapped, run):
    net = tapped(f"udpin://127.0.0.1:{(port := routers.udp_port())}?name=many&max_peers=400")
    ends = [UdpEnd((*HOST, port)) for _ in range(300)]
    try:
        for number, end in enumerate(ends, 1):
            end.send(heartbeat((number % 250 + 1, number // 250 + 1)))
        net.router.wait_links(301)
        for end in ends[:10]:
            end.send(heartbeat((1, 100)))

        def rows():
            lines = net.page(run)
            return lines if sum(line.get("frames_in", 0)
                                for line in lines if line["kind"] in ("link", "others")) == 310 else None
        lines = harness.wait_for(rows, what="310 frames in the page")
        assert lines[0]["links"] == 301
        links = [line for line in lines if line["kind"] == "link"]
        others = [line for line in lines if line["kind"] == "others"]
        assert len(links) == 256 and len(others) == 1 and others[0]["frames_in"] > 0
    finally:
        for end in ends:
            end.close()


# ---- the inlet -------------------------------------------------------------------------------------------------------

def test_a_command_reaches_the_vehicle_and_its_answer_is_in_the_ring(tapped, app, run):
    net = tapped()
    net.sent_by(net.vehicle, heartbeat())
    sender = app(net.inlet)
    asked = command(GCS, VEHICLE)
    sender.send(asked)
    assert next_from(net.vehicle) == asked
    answer = make(mavlink.MAVLink_command_ack_message(400, 0, 0, routers.unique(), *GCS))
    found = net.sent_by(net.vehicle, answer)
    assert [r.verdict for r in found if r.data in (asked, answer)] == [FORWARDED, FORWARDED]
    assert asked not in net.ground.now() and answer not in net.ground.now(), "targeted ones go to their target alone"
    names = harness.wait_for(lambda: len(found := net.names(run)) == 3 and found, what="three links")
    link, = {r.link for r in found if r.data == asked}
    assert names[link].startswith(f"shm://{net.ring}#@")
    # Broadcasts go to the others, and nothing is sent to the readers of the ring.
    greeting = heartbeat(GCS)
    sender.send(greeting)
    assert next_from(net.ground) == greeting and next_from(net.vehicle) == greeting
    net.sent_by(net.vehicle, *(attitude() for _ in range(50)))
    sender.setblocking(False)
    with pytest.raises(BlockingIOError):
        sender.recv(100)
    counted, = [link for link in net.router.links() if link["endpoint"] == f"shm://{net.ring}"]
    assert counted["frames_in"] == 2 and counted["frames_out"] >= 51
    assert counted["queue_bytes"] == counted["queue_age"] == 0


def test_senders_are_links_by_their_address(tapped, app, run):
    net = tapped()
    net.sent_by(net.vehicle, heartbeat())
    place = str(harness.RUN / f"{net.ring}.app")
    bound, unbound, unbound_too = app(net.inlet, place), app(net.inlet, None), app(net.inlet, None)
    sent = [heartbeat((21, 1)), heartbeat((22, 1)), heartbeat((23, 1))]
    for sock, frame in zip((bound, unbound, unbound_too), sent):
        sock.send(frame)
    harness.wait_for(lambda: all(frame in [r.data for r in records(net.ring)] for frame in sent), what="their frames")
    names = harness.wait_for(lambda: len(found := net.names(run)) == 4 and found, what="four links")
    by_frame = {r.data: names[r.link] for r in net.settled() if r.data in sent}
    assert [by_frame[frame] for frame in sent] == [f"shm://{net.ring}#{place}", f"shm://{net.ring}#unbound",
                                                   f"shm://{net.ring}#unbound"]
    # Several frames in one datagram.
    several = [heartbeat((21, 2)), attitude((21, 2)), attitude((21, 2))]
    bound.send(b"".join(several))
    harness.wait_for(lambda: several[-1] in [r.data for r in records(net.ring)], what="the last of several")
    assert [r.data for r in net.settled() if r.data in several] == several
    # One program reads in the ring what another one sends. A target behind the inlet is known after it has sent.
    question = command((21, 1), (22, 1))
    bound.send(question)
    harness.wait_for(lambda: question in [r.data for r in records(net.ring)], what="the question")
    assert [r.verdict for r in records(net.ring) if r.data == question] == [FORWARDED]


def test_garbage_is_counted_and_never_forwarded(tapped, app):
    net = tapped()
    net.sent_by(net.vehicle, heartbeat())
    stranger, friend = app(net.inlet), app(net.inlet)
    frame = routers.with_one_start((30, 1))
    plain = random.Random(1).choices([b for b in range(256) if b not in (0xFD, 0xFE)], k=1000)
    pieces = [bytes(plain), frame[:-1], b"", damaged()]
    for piece in pieces:
        stranger.send(piece)

    def inlet():
        return next(e for e in net.router.stats("endpoint") if e["endpoint"] == f"shm://{net.ring}")
    harness.wait_for(lambda: inlet()["stray_bytes"] == sum(map(len, pieces)), what="the stranger's bytes counted")
    good = heartbeat((30, 1))
    for piece in (good, bytes(plain), frame[:20], frame[20:], damaged(), frame + bytes(plain[:10])):
        friend.send(piece)
    harness.wait_for(lambda: frame in [r.data for r in records(net.ring)], what="the good frame")
    link, = [link for link in net.router.links() if link["endpoint"] == f"shm://{net.ring}"]
    assert link["frames_in"] == 2 and link["crc_error"] == 1
    assert link["junk_bytes"] >= len(plain) + 10
    assert [r.data for r in net.settled()][-2:] == [good, frame]
    assert next_from(net.vehicle) == good and next_from(net.vehicle) == frame, "and nothing else came"


def test_a_datagram_longer_than_any_slot(tapped, app):
    net = tapped()
    sender = app(net.inlet)
    sender.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 20)
    good = heartbeat((30, 1))
    sender.send(good)
    try:
        sender.send(bytes(100_000))
    except OSError as error:
        pytest.skip(f"this system sends none so long: {error}")
    harness.wait_for(lambda: [link["junk_bytes"] for link in net.router.links() if "#@" in link["link"]] == [100_000],
                     what="all its bytes counted")


def test_descriptors_that_are_sent_along_are_closed(tapped, app):
    net = tapped()
    sender = app(net.inlet)
    sender.send(heartbeat((30, 1)))
    harness.wait_for(lambda: any("#@" in link["link"] for link in net.router.links()), what="the sender")
    descriptors = f"/proc/{net.router.process.pid}/fd"
    before = len(os.listdir(descriptors))
    with open("/dev/null") as file:
        for count in (1, 4, 50):
            sender.sendmsg([heartbeat((30, 1))],
                           [(socket.SOL_SOCKET, socket.SCM_RIGHTS, array.array("i", [file.fileno()] * count))])
    last = heartbeat((30, 1))
    sender.send(last)
    harness.wait_for(lambda: last in [r.data for r in records(net.ring)], what="the last frame")
    assert len(os.listdir(descriptors)) == before


def test_two_hundred_senders_come_and_go(tapped):
    net = tapped()
    net.sent_by(net.vehicle, heartbeat())
    sent = []
    for number in range(200):
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as sock:
            sock.bind(f"\0{net.ring}-{number}")
            sock.connect(net.inlet)
            sent.append(heartbeat((number % 250 + 1, 7)))
            sock.send(sent[-1])
    harness.wait_for(lambda: sent[-1] in [r.data for r in records(net.ring)], what="the last one's frame")
    found = [r for r in net.settled() if r.data in sent]
    assert [r.data for r in found] == sent and len({r.link for r in found}) == 200
    # Beyond 256 the longest idle is evicted.
    for number in range(200, 400):
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as sock:
            sock.bind(f"\0{net.ring}-{number}")
            sock.connect(net.inlet)
            sent.append(heartbeat((number % 250 + 1, 8)))
            sock.send(sent[-1])
    harness.wait_for(lambda: sent[-1] in [r.data for r in records(net.ring)], what="the last one's frame")
    assert [r.data for r in net.settled() if r.data in sent] == sent
    endpoint, = [e for e in net.router.stats("endpoint") if e["endpoint"] == f"shm://{net.ring}"]
    assert endpoint["peers_evicted"] == 400 - 256 and endpoint["peers_refused"] == 0
    assert len([link for link in net.router.links() if link["endpoint"] == f"shm://{net.ring}"]) == 256


# ---- hostile neighbours ----------------------------------------------------------------------------------------------

def test_a_ring_that_a_neighbour_shortens_ends_and_the_routing_continues(tapped, run):
    """A member of the group may do that with mode=0660. It was the end of the router, by SIGBUS."""
    net = tapped()
    net.sent_by(net.vehicle, heartbeat(), attitude())
    os.truncate(shared(net.ring), 0)
    net.vehicle.send(frame := attitude())
    net.ground.until(frame)  # it is routed although the ring is lost
    net.router.process.wait_output(f"ring {net.ring} was removed; it is created again")
    net.router.process.wait_output(f"mavloom.{net.ring} is truncated: 0 bytes .*; it was renamed to "
                                   f"mavloom.{net.ring}.aside")
    frame = attitude()

    assert frame in [r.data for r in net.sent_by(net.vehicle, frame)]
    assert net.page(run)[0]["ring_dropped"] >= 1  # the frame that met the lost ring is counted


def test_a_counter_page_that_a_neighbour_shortens_is_created_again(tapped, run):
    net = tapped()
    net.sent_by(net.vehicle, heartbeat(), attitude())
    os.truncate(shared(net.ring, ".stat"), 0)
    net.sent_by(net.vehicle, attitude())
    harness.wait_for(lambda: is_there_again(shared(net.ring, ".stat")), what="a new page")

    assert net.router.process.alive
    assert f"vehicle#127.0.0.1:{net.vehicle.port}" in harness.wait_for(lambda: net.names(run),
                                                                       what="the links' names").values()


@pytest.mark.parametrize("reader", ["listen", "shm read"])
def test_a_reader_survives_a_ring_that_is_shortened(tapped, spawn, reader):
    net = tapped()
    args = ("listen", f"shm://{net.ring}", "--json") if reader == "listen" else ("shm", "read", net.ring, "--json")
    sut = spawn(*args)
    net.sent_by(net.vehicle, heartbeat())

    def reads():
        before = sut.stdout
        net.vehicle.send(frame := attitude())
        net.ground.until(frame)
        return len(sut.stdout) > len(before)
    harness.wait_for(reads, what="the reader")
    os.truncate(shared(net.ring), 0)
    harness.wait_for(lambda: is_there_again(shared(net.ring)), what="a new ring")
    harness.wait_for(lambda: not sut.alive or reads(), what="the reader's end, or the new ring")

    # `shm read` may open the file before it is replaced.
    assert sut.alive or (reader == "shm read" and sut.wait().status == 3), sut.wait()


def test_a_group_that_may_send_need_not_write_the_ring(tapped, tmp_path):
    file = tmp_path / "r.toml"
    file.write_text('[ring]\nmode = "0640"\ninlet_mode = "0660"\n')
    net = tapped("--config", str(file))

    assert shared(net.ring).stat().st_mode & 0o777 == 0o640
    assert os.stat(net.inlet).st_mode & 0o777 == 0o660


def test_a_readers_lock_does_not_keep_the_next_writer_out(tapped):
    """A process that may read the file may lock it for reading."""
    net = tapped()
    net.sent_by(net.vehicle, heartbeat())
    net.router.process.process.kill()
    net.router.process.wait()
    with open(shared(net.ring), "rb") as file:
        f_ofd_setlk = 37
        fcntl.fcntl(file, f_ofd_setlk, struct.pack("hhqqi4x", fcntl.F_RDLCK, os.SEEK_SET, 0, 70, 0))
        net.close()
        again = tapped()
        frame = attitude()

        assert frame in [r.data for r in again.sent_by(again.vehicle, heartbeat(), frame)]


of_two_users = pytest.mark.skipif(os.geteuid() != 0, reason="two users need root")


def routed_by_another_user(program, ring, run_folder):
    """The finished process of a router that user 12345 ran for 2 s."""
    run_folder.chmod(0o1777)
    for folder in list(run_folder.parents)[:3]:
        folder.chmod(0o755)
    return subprocess.run(["setpriv", "--reuid=12345", "--clear-groups", program, "route", "--ring", ring,
                           "--for", "2s", f"udpin://127.0.0.1:{routers.udp_port()}"],
                          capture_output=True, text=True, timeout=60,
                          env=harness.environment({"MAVLOOM_RUN": str(run_folder)}))


@of_two_users
@pytest.mark.parametrize("trusted", [False, True])
def test_a_ring_of_another_user_is_read_only_on_request(run, ring, trusted):
    """Unless that user owns the folder of the sockets, as the user of the service does."""
    written = subprocess.run([harness.program_path(), "shm", "write", ring, "--mode", "0644"], input="record\n",
                             capture_output=True, text=True, timeout=60)
    assert written.returncode == 0, written
    os.chown(shared(ring), 12344, 12344)
    folder = harness.RUN / f"{ring}.run"
    folder.mkdir()
    if trusted:
        os.chown(folder, 12344, 12344)
    environment = harness.environment({"MAVLOOM_RUN": str(folder)})
    args = ("shm", "read", ring, "--from", "oldest", "--data", "--drain")
    plain, foreign = run(*args, env=environment), run(*args, "--foreign", env=environment)
    listened = run("listen", f"shm://{ring}?required=true", "--for", "100ms", env=environment)
    folder.rmdir()

    refused = f"ring {ring} belongs to user 12344, so anything may be in it; foreign=true reads it"
    assert foreign.stdout == "record\n"
    assert (plain.stdout == "record\n") == trusted
    for done in (plain, listened):
        assert (refused in done.stderr) != trusted


@pytest.mark.parametrize("what", ["", ".stat"])
def test_a_damaged_file_under_its_name_keeps_no_router_down(tapped, ring, what):
    shared(ring, what).write_bytes(b"squatted" * 10_000)
    net = tapped()
    frame = attitude()

    assert frame in [r.data for r in net.sent_by(net.vehicle, heartbeat(), frame)]
    assert shared(ring, ".stat").stat().st_size > len(b"squatted") * 10_000
    if not what:
        net.router.process.wait_output(f"mavloom.{ring}: is not a Mavloom ring; it was renamed to mavloom.{ring}.aside")
        assert shared(ring, ".aside").read_bytes() == b"squatted" * 10_000


def squat(kind, path):
    if kind == "folder":
        path.mkdir()
    elif kind == "link":
        path.symlink_to("/etc/passwd")
    else:
        path.write_bytes(b"")
    os.chown(path, 12344, 12344, follow_symlinks=False)


def remove(path):
    path.rmdir() if path.is_dir() else path.unlink(missing_ok=True)


@of_two_users
@pytest.mark.parametrize("kind", ["file", "folder", "link"])
def test_a_counter_page_that_another_user_took_costs_root_nothing(tapped, ring, kind):
    squat(kind, shared(ring, ".stat"))
    net = tapped()
    try:
        net.router.process.wait_output(rf"mavloom\.{ring}\.stat.*; it was renamed to mavloom\.{ring}\.stat\.aside")
        assert shared(ring, ".stat").is_file() and shared(ring, ".stat").stat().st_uid == 0
    finally:
        remove(shared(ring, ".stat.aside"))


@of_two_users
@pytest.mark.parametrize("kind", ["folder", "link"])
def test_a_counter_page_that_another_user_took_costs_no_ring(ring, program, spawn, tmp_path, kind):
    squat(kind, shared(ring, ".stat"))
    done = routed_by_another_user(program, ring, tmp_path)
    remove(shared(ring, ".stat"))

    assert done.returncode == 0 and f"no counter page for ring {ring}" in done.stderr, done
    assert "without a ring" not in done.stderr


@pytest.mark.parametrize("what, said", [("", "the router runs without a ring"), (".stat", "no counter page for ring")])
def test_a_user_who_may_write_the_ring_keeps_no_router_down(tapped, tmp_path, what, said):
    """With mode=0660, members of the group can hold the lock by which a live writer is known."""
    file = tmp_path / "r.toml"
    file.write_text('[ring]\nmode = "0660"\n')
    net = tapped("--config", str(file))
    net.sent_by(net.vehicle, heartbeat())
    net.router.process.process.kill()
    net.router.process.wait()
    with open(shared(net.ring, what), "rb+") as held:
        f_ofd_setlk = 37
        fcntl.fcntl(held, f_ofd_setlk, struct.pack("hhqqi4x", fcntl.F_WRLCK, os.SEEK_SET, 0, 1, 0))
        net.close()
        again = tapped("--config", str(file))
        again.router.process.wait_output(said)
        again.ground.send(heartbeat((255, 190)))
        again.vehicle.send(frame := attitude())
        again.ground.until(frame)


@of_two_users
@pytest.mark.parametrize("what, said", [("", "the router runs without a ring"), (".stat", "no counter page for ring"),
                                        (".in", "belongs to another user (id 12344); remove it; programs cannot send")])
def test_a_name_that_another_user_took_keeps_no_router_down(ring, program, tmp_path, what, said):
    """In /dev/shm, and in a run folder that all may write, nobody may rename the file of another user."""
    place = tmp_path / f"{ring}.in" if what == ".in" else shared(ring, what)
    place.write_bytes(b"")
    os.chown(place, 12344, 12344)
    done = routed_by_another_user(program, ring, tmp_path)
    left = place.stat().st_uid
    place.unlink()

    assert done.returncode == 0 and said in done.stderr, done
    assert left == 12344


def test_the_page_shows_how_full_the_queue_of_a_stalled_client_is(spawn, run, udp_port, tcp_port, ring):
    """And that it is empty once the client has read all, although no frame arrives any more."""
    ports = udp_port(), tcp_port()
    router = spawn("route", f"udpin://127.0.0.1:{ports[0]}", "--ring", ring,
                   f"tcpin://127.0.0.1:{ports[1]}?queue_bytes=200000&queue_age=60s")

    def queue():
        lines = [json.loads(line) for line in run("stat", ring, "--json").lines]
        return [(line["queued_bytes"], line["queue_limit_bytes"]) for line in lines
                if line["kind"] == "link" and line["link"].startswith("tcpin")]
    with socket.socket() as client, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as vehicle:
        client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        harness.wait_for(lambda: client.connect_ex(("127.0.0.1", ports[1])) in (0, 106), what="the connection")
        router.wait_output(r"tcpin.*: up")
        frame = make(mavlink.MAVLink_statustext_message(6, b"x" * 50), (1, 1))

        def fill():
            for _ in range(500):
                vehicle.sendto(frame * 20, ("127.0.0.1", ports[0]))
            return queue()[0][0] > 100_000
        harness.wait_for(fill, what="a queue that is half full")
        assert queue()[0][0] <= queue()[0][1] == 200_000
        client.setblocking(False)

        def empty():
            with contextlib.suppress(BlockingIOError):
                while client.recv(1 << 16):
                    pass
            return queue()[0][0] == 0
        harness.wait_for(empty, what="an empty queue")
