# SPDX-License-Identifier: MIT
"""`mavloom doctor`: finds faults that are really planted, each under its name, and nothing on healthy links and
recordings."""
import contextlib
import json
import os
import pathlib
import pty
import random
import re
import signal
import socket
import subprocess
import sys
import threading
import time
import tty

import frames
import harness
import netns
import pytest
from frames import mavlink


def ids(done):
    assert done.status in (0, 4), done
    found = {finding["id"] for finding in json.loads(done.stdout)["findings"]}
    assert bool(found) == (done.status == 4), done
    return found


class Vehicle:
    """Numbered frames of one sender: ATTITUDE, and each fiftieth a HEARTBEAT."""

    def __init__(self, system=1, component=1, boot_ms=10_000, kind=2, key=None, heartbeats=True):
        self.mav = frames.sender(system, component)
        self.begin, self.boot_ms, self.count = time.monotonic(), boot_ms, 0
        self.kind, self.heartbeats = kind, heartbeats
        if key:
            self.mav.signing.secret_key, self.mav.signing.link_id = key, 0
            self.mav.signing.timestamp, self.mav.signing.sign_outgoing = 10 ** 14, True

    def pack(self, message):
        frame = bytes(message.pack(self.mav))
        self.mav.seq = (self.mav.seq + 1) % 256
        return frame

    def next(self):
        self.count += 1
        if self.heartbeats and self.count % 50 == 1:
            return self.pack(mavlink.MAVLink_heartbeat_message(self.kind, 12, 81, 0, 4, 3))
        now_ms = self.boot_ms + int((time.monotonic() - self.begin) * 1000)
        return self.pack(mavlink.MAVLink_attitude_message(now_ms, self.count * 1e-3, -0.2, 3.0, 0.01, 0.02, 0.03))


class World:
    """Where faults are planted: senders that run until the end of the test, and the doctors that look for them."""

    def __init__(self, spawn, folder, stack):
        self.spawn, self.folder, self.stack = spawn, folder, stack
        self.ended, self.is_one_silent = threading.Event(), threading.Event()
        self.threads, self.doctors = [], {}

    def name(self, fault):
        return f"doc-{os.getpid()}-{fault}"

    def repeat(self, action, hz=100):
        """Calls action(n) with n = 0, 1, ... at this rate."""
        def loop():
            begin, n = time.monotonic(), 0
            while not self.ended.is_set():
                with contextlib.suppress(OSError):
                    action(n)
                n += 1
                self.ended.wait(max(0.0, begin + n / hz - time.monotonic()))
        self.threads.append(threading.Thread(target=loop))
        self.threads[-1].start()

    def udp_to(self, port):
        sock = self.stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        sock.connect(("127.0.0.1", port))
        return sock

    def sender(self, **options):
        """A vehicle with a socket to send by, and the doctor's source that hears it."""
        port = self.port()
        return self.udp_to(port), Vehicle(**options), [f"udpin://127.0.0.1:{port}"]

    def port(self, kind=socket.SOCK_DGRAM):
        return harness.free_port(kind)

    def pty(self):
        """A serial port: our end of its line, and its path."""
        far, near = pty.openpty()
        tty.setraw(near)
        os.set_blocking(far, False)
        for end in (far, near):
            self.stack.callback(os.close, end)
        return far, os.ttyname(near)

    def router(self, fault, *arguments):
        name = self.name(fault)
        router = self.spawn("route", *arguments, "--ring", name, "--name", name)
        harness.wait_for(lambda: os.path.exists(f"/dev/shm/mavloom.{name}.stat"), what=f"the ring of {fault}")
        return router, f"shm://{name}"

    def close(self):
        self.ended.set()
        for thread in self.threads:
            thread.join()


# ---- the faults: each returns the sources of the doctor --------------------------------------------------------------

def plant_nothing_heard(world):
    return [f"udpin://127.0.0.1:{world.port()}"]


def plant_port_taken(world):
    port = world.port()
    taken = world.stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
    taken.bind(("127.0.0.1", port))
    return [f"udpin://127.0.0.1:{port}"]


def plant_port_refused_tcp(world):
    return [f"tcpout://127.0.0.1:{world.port(socket.SOCK_STREAM)}"]


def plant_port_refused_udp(world):
    return [f"udpout://127.0.0.1:{world.port()}"]


def plant_cannot_open(world):
    return [f"udpin://192.0.2.1:{world.port()}"]  # no machine has an address of TEST-NET-1 (RFC 5737)


def plant_not_connected(world):
    return [f"serial://{world.folder}/absent"]


def plant_wrong_baud(world):
    far, near = world.pty()
    noise = random.Random(2)
    world.repeat(lambda n: os.write(far, noise.randbytes(40)))
    return [f"serial://{near}?baud=57600"]


def plant_not_mavlink(world):
    port = world.port()
    sock = world.udp_to(port)
    world.repeat(lambda n: sock.send(b"$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n"))
    return [f"udpin://127.0.0.1:{port}"]


def plant_damaged_frames(world):
    sock, vehicle, source = world.sender()

    def send(n):
        frame = vehicle.next()
        sock.send(frame)
        if n % 5 == 0:  # a copy of what was sent, damaged on the way
            sock.send(frame[:-1] + bytes([frame[-1] ^ 1]))
    world.repeat(send)
    return source


def plant_wrong_dialect(world):
    sock, vehicle, source = world.sender()

    def send(n):
        sock.send(vehicle.next())
        if n % 10 == 0:  # VFR_HUD of a version with other fields
            frame = vehicle.pack(mavlink.MAVLink_vfr_hud_message(1, 2, 3, 4, 5, n))
            crc = mavlink.x25crc(frame[1:-2] + b"\x7b").crc
            sock.send(frame[:-2] + crc.to_bytes(2, "little"))
    world.repeat(send)
    return source


def plant_long_datagrams(world):
    sock, vehicle, source = world.sender()
    world.repeat(lambda n: sock.send(b"".join(vehicle.next() for _ in range(50))), hz=10)
    return source


def plant_lost_before(world):
    sock, vehicle, source = world.sender()

    def send(n):
        frame = vehicle.next()
        if n % 80 not in range(40, 55):  # a radio loses frames in bursts
            sock.send(frame)
    world.repeat(send)
    return source


def plant_regular_gaps(world):
    to, port = world.port(), world.port()
    world.router("gaps", f"udpin://127.0.0.1:{to}", f"udpout://127.0.0.1:{port}?out_block=ATTITUDE")
    world.spawn("sim", "--to", f"udpout://127.0.0.1:{to}", "--name", world.name("gaps-sim"))
    return [f"udpin://127.0.0.1:{port}"]


def plant_two_senders_by_clock(world):
    port = world.port()
    for boot_ms in (10_000, 900_000):
        sock, vehicle = world.udp_to(port), Vehicle(boot_ms=boot_ms)
        world.repeat(lambda n, sock=sock, vehicle=vehicle: sock.send(vehicle.next()))
    return [f"udpin://127.0.0.1:{port}"]


def plant_two_stations(world):
    port = world.port()
    for first in (0, 100):
        sock = world.udp_to(port)
        vehicle = Vehicle(255, 190, kind=6)
        vehicle.mav.seq = first
        world.repeat(lambda n, sock=sock, vehicle=vehicle: sock.send(vehicle.pack(
            mavlink.MAVLink_heartbeat_message(6, 8, 0, n, 4, 3))), hz=20)
    return [f"udpin://127.0.0.1:{port}"]


def plant_two_links(world):
    port = world.port()
    socks, vehicle = [world.udp_to(port), world.udp_to(port)], Vehicle()

    def send(n):
        frame = vehicle.next()
        for sock in socks:
            sock.send(frame)
    world.repeat(send)
    return [f"udpin://127.0.0.1:{port}"]


def plant_two_simulators_together(world):
    """The same flight twice, but for the time of day: the second one begins some milliseconds after the first."""
    port = world.port()
    for name in ("twin-a", "twin-b"):
        world.spawn("sim", "--to", f"udpout://127.0.0.1:{port}", "--name", world.name(name)).wait_output("vehicle 1: ")
    return [f"udpin://127.0.0.1:{port}"]


def behind_a_router(world, name, in_options="", out_options=""):
    """A vehicle, a router, the router's ring, and the port that it sends to."""
    to, port = world.port(), world.port()
    _, ring = world.router(name, f"udpin://127.0.0.1:{to}{in_options}", f"udpout://127.0.0.1:{port}{out_options}")
    sock, vehicle = world.udp_to(to), Vehicle()
    world.repeat(lambda n: sock.send(vehicle.next()))
    return [ring, f"udpin://127.0.0.1:{port}"]


def plant_router_faults(world):
    return behind_a_router(world, "faults", "?in_fault=loss:0.2")[1:]


def plant_faults_before_a_named_link(world):
    """The name of the link that leads to the doctor does not show its port."""
    return behind_a_router(world, "faults-named", "?in_fault=loss:0.2", "?name=gcs")[1:]


def plant_split_stream(world):
    port = world.port()
    socks, vehicle = [world.udp_to(port), world.udp_to(port)], Vehicle()
    world.repeat(lambda n: socks[n % 2].send(vehicle.next()))
    return [f"udpin://127.0.0.1:{port}"]


def plant_duplicates(world):
    sock, vehicle, source = world.sender()

    def send(n):
        frame = vehicle.next()
        sock.send(frame)
        sock.send(frame)
    world.repeat(send)
    return source


def plant_no_heartbeat(world):
    sock, vehicle, source = world.sender(heartbeats=False)
    world.repeat(lambda n: sock.send(vehicle.next()))
    return source


def plant_unsigned(world):
    port = world.port()
    for vehicle in (Vehicle(key=b"k" * 32), Vehicle(255, 190, kind=6)):
        sock = world.udp_to(port)
        world.repeat(lambda n, sock=sock, vehicle=vehicle: sock.send(vehicle.next()))
    return [f"udpin://127.0.0.1:{port}"]


def plant_kernel_drop(world):
    return [f"udpin://127.0.0.1:{world.port()}?rcvbuf=4096"]


@contextlib.contextmanager
def standing_still(program):
    program.send(signal.SIGSTOP)
    yield
    program.send(signal.SIGCONT)


def overflow(world, doctor, sources):
    """The doctor stands still while more comes than its buffer holds."""
    sock = world.udp_to(int(sources[0].split(":")[2].split("?")[0]))
    vehicle = Vehicle()
    doctor.wait_output("listening", stream="err")
    with standing_still(doctor):
        for _ in range(200):
            sock.send(vehicle.next())
    world.repeat(lambda n: sock.send(vehicle.next()))


def plant_queue_drop(world):
    port, hears = world.port(), world.port(socket.SOCK_STREAM)
    listener = world.stack.enter_context(socket.create_server(("127.0.0.1", hears)))
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
    _, ring = world.router("queue", f"udpin://127.0.0.1:{port}", f"tcpout://127.0.0.1:{hears}?queue_bytes=4096")
    sock, vehicle = world.udp_to(port), Vehicle()
    world.repeat(lambda n: [sock.send(vehicle.next()) for _ in range(100)])  # its reader takes none of them
    return [ring]


def plant_router_refused(world):
    port, closed = world.port(), world.port()
    _, ring = world.router("refused", f"udpin://127.0.0.1:{port}", f"udpout://127.0.0.1:{closed}")
    sock, vehicle = world.udp_to(port), Vehicle()
    world.repeat(lambda n: sock.send(vehicle.next()))
    return [ring]


def plant_link_full(world):
    far, near = world.pty()
    vehicle, rest = Vehicle(), bytearray()

    def send(n):
        if not rest:  # its clock stands still while nobody reads the line
            vehicle.begin, vehicle.boot_ms = time.monotonic(), vehicle.boot_ms + 4
            rest.extend(vehicle.next())
        del rest[:os.write(far, rest)]
    world.repeat(send, hz=250)  # 40 bytes each; the line carries 5,760 a second
    return [f"serial://{near}?baud=57600"]


def plant_radio(world, **status):
    port = world.port()
    sock, vehicle, radio = world.udp_to(port), Vehicle(), Vehicle(51, 68)
    values = {"rssi": 180, "remrssi": 180, "txbuf": 90, "noise": 50, "remnoise": 50, "rxerrors": 0, "fixed": 0} | status

    def send(n):
        sock.send(vehicle.next())
        if n % 50 == 0:
            values["rxerrors"] += status.get("rxerrors", 0)
            sock.send(radio.pack(mavlink.MAVLink_radio_status_message(**values)))
    world.repeat(send)
    return [f"udpin://127.0.0.1:{port}"]


def plant_radio_full(world):
    return plant_radio(world, txbuf=5)


def plant_radio_weak(world):
    return plant_radio(world, rxerrors=7)


def ask(world, port, hz, source=(255, 190)):
    """A ground station that asks vehicle 1 for ATTITUDE."""
    sock, station = world.udp_to(port), Vehicle(*source, kind=6)

    def send(n):
        sock.send(station.pack(mavlink.MAVLink_heartbeat_message(6, 8, 0, n, 4, 3)))
        sock.send(station.pack(mavlink.MAVLink_command_long_message(1, 1, 511, 0, 30, 1e6 / hz, 0, 0, 0, 0, 0)))
    world.repeat(send, hz=5)


def plant_rate_low(world):
    port = world.port()
    sock, vehicle = world.udp_to(port), Vehicle()
    world.repeat(lambda n: sock.send(vehicle.next()), hz=20)
    ask(world, port, hz=50)
    return [f"udpin://127.0.0.1:{port}"]


def plant_rate_high(world):
    port = world.port()
    sock, vehicle = world.udp_to(port), Vehicle()
    world.repeat(lambda n: sock.send(vehicle.next()), hz=20)
    ask(world, port, hz=5)
    return [f"udpin://127.0.0.1:{port}"]


def plant_went_silent(world):
    port = world.port()
    sock, other, world.silenced = world.udp_to(port), Vehicle(2), Vehicle()

    def send(n):
        sock.send(other.next())
        if not world.is_one_silent.is_set():
            sock.send(world.silenced.next())
    world.repeat(send)
    return [f"udpin://127.0.0.1:{port}"]


def silence_one(world, doctor):
    doctor.wait_output("listening", stream="err")
    heard = world.silenced.count + 160
    harness.wait_for(lambda: world.silenced.count > heard, what="three HEARTBEATs before the silence")
    world.is_one_silent.set()


def plant_rate_contested(world):
    port = world.port()
    sock, vehicle = world.udp_to(port), Vehicle()
    world.repeat(lambda n: sock.send(vehicle.next()), hz=20)
    ask(world, port, hz=20)
    ask(world, port, hz=5, source=(254, 190))
    return [f"udpin://127.0.0.1:{port}"]


def plant_filtered_between(world):
    to, port = world.port(), world.port()
    _, ring = world.router("hop", f"udpin://127.0.0.1:{to}", f"udpout://127.0.0.1:{port}?out_block=ATTITUDE")
    world.spawn("sim", "--to", f"udpout://127.0.0.1:{to}", "--name", world.name("hop-sim"))
    return [ring, f"udpin://127.0.0.1:{port}"]


def plant_two_simulators(world):
    """Their clocks must differ by more than two seconds, so the second one starts after the other doctors."""
    port = world.port()
    world.spawn("sim", "--to", f"udpout://127.0.0.1:{port}", "--name", world.name("first"))
    return [f"udpin://127.0.0.1:{port}"]


def healthy_simulator(world):
    port = world.port()
    world.spawn("sim", "--to", f"udpout://127.0.0.1:{port}", "--name", world.name("healthy"))
    return [f"udpin://127.0.0.1:{port}"]


def healthy_router(world):
    """A vehicle, a router, and a ground station behind it, all without a fault."""
    to, port = world.port(), world.port()
    _, ring = world.router("good", f"udpin://127.0.0.1:{to}", f"udpout://127.0.0.1:{port}")
    world.spawn("sim", "--to", f"udpout://127.0.0.1:{to}", "--name", world.name("good-sim"))
    return [ring, f"udpin://127.0.0.1:{port}"]


def healthy_named_link(world):
    """The name of the link does not show that it leads to the port that the doctor opens."""
    return behind_a_router(world, "named", out_options="?name=station")


PLANTED = {
    plant_nothing_heard: "nothing-heard",
    plant_port_taken: "port-taken",
    plant_cannot_open: "cannot-open",
    plant_port_refused_tcp: "port-refused",
    plant_port_refused_udp: "port-refused",
    plant_not_connected: "not-connected",
    plant_wrong_baud: "wrong-baud",
    plant_not_mavlink: "not-mavlink",
    plant_damaged_frames: "damaged-frames",
    plant_wrong_dialect: "wrong-dialect",
    plant_long_datagrams: "long-datagrams",
    plant_lost_before: "lost-before",
    plant_regular_gaps: "regular-gaps",
    plant_two_senders_by_clock: "two-senders",
    plant_two_stations: "two-senders",
    plant_two_links: "two-links",
    plant_two_simulators_together: "two-senders",
    plant_router_faults: "faults-on lost-before",
    plant_faults_before_a_named_link: "faults-on lost-before",
    plant_split_stream: "split-stream",
    plant_duplicates: "duplicates",
    plant_no_heartbeat: "no-heartbeat",
    plant_unsigned: "unsigned-frames",
    plant_kernel_drop: "kernel-drop",
    plant_queue_drop: "queue-drop",
    plant_router_refused: "port-refused",
    plant_link_full: "link-full",
    plant_radio_full: "radio-full",
    plant_radio_weak: "radio-weak",
    plant_rate_low: "rate-low",
    plant_rate_high: "rate-high",
    plant_went_silent: "went-silent",
    plant_rate_contested: "rate-contested",
    plant_filtered_between: "filtered-between",
    plant_two_simulators: "two-senders",
    healthy_simulator: "",
    healthy_router: "",
    healthy_named_link: "",
}


# Regular gaps are judged by half seconds, a vehicle is silent after 5 s, SYSTEM_TIME comes once a second, and a port
# that was closed is open if nothing is refused after 2 s.
LISTENS = {plant_regular_gaps: "5500ms", plant_went_silent: "8500ms", plant_two_simulators_together: "5500ms",
           healthy_named_link: "5500ms"}


def test_each_planted_fault_has_its_finding(spawn, tmp_path):
    with contextlib.ExitStack() as stack:
        world = World(spawn, tmp_path, stack)
        stack.callback(world.close)

        def examine(plant, sources):
            world.doctors[plant] = spawn("doctor", *sources, "--for", LISTENS.get(plant, "2500ms"), "--json", "-v")

        sources = {plant: plant(world) for plant in PLANTED}
        begin = time.monotonic()
        examine(plant_went_silent, sources[plant_went_silent])
        silence_one(world, world.doctors[plant_went_silent])
        for plant, given in sources.items():
            if plant not in (plant_went_silent, plant_two_simulators):
                examine(plant, given)
        overflow(world, world.doctors[plant_kernel_drop], sources[plant_kernel_drop])
        harness.wait_for(lambda: time.monotonic() - begin > 3, what="a difference of the clocks")
        port = sources[plant_two_simulators][0].split(":")[-1]
        spawn("sim", "--to", f"udpout://127.0.0.1:{port}", "--name", world.name("second"))
        examine(plant_two_simulators, sources[plant_two_simulators])
        results = {plant.__name__: ids(doctor.wait()) for plant, doctor in world.doctors.items()}
    assert results == {plant.__name__: set(findings.split()) for plant, findings in PLANTED.items()}


@pytest.fixture
def world(spawn, tmp_path):
    with contextlib.ExitStack() as stack:
        its = World(spawn, tmp_path, stack)
        stack.callback(its.close)
        yield its


class SmallRing:
    """A router with a ring of 64 KiB, which holds 1,024 frames of a vehicle."""

    def __init__(self, world, run, fault, *arguments):
        port = world.port()
        _, self.source = world.router(fault, f"udpin://127.0.0.1:{port}", "--ring-capacity", "64k", *arguments)
        self.name, self.run = self.source.removeprefix("shm://"), run
        self.sock, self.vehicle = world.udp_to(port), Vehicle()

    def send(self, count):
        for _ in range(count):
            self.sock.send(self.vehicle.next())

    def readers(self):
        return json.loads(self.run("shm", "stat", self.name, "--json").stdout)["readers"]

    def send_until(self, counter, value):
        """Sends so many frames, then a few at a time, until a counter of the router's page has grown by so many."""
        def count():
            return json.loads(self.run("stat", self.name, "--json").lines[0])[counter]

        def is_reached():
            self.send(10)
            return count() >= before + value
        before = count()
        self.send(value)
        harness.wait_for(is_reached, what=f"{value} {counter}")


def findings_at_end(doctor):
    return {finding["id"] for finding in json.loads(doctor.stop().stdout)["findings"]}
    return {finding["id"] for finding in json.loads(doctor.stop().stdout)["findings"]}


def test_a_ring_that_overtook_the_doctor_is_found(world, run):
    ring = SmallRing(world, run, "lapped")
    doctor = world.spawn("doctor", ring.source, "--for", "10m", "--json", "-v")
    harness.wait_for(ring.readers, what="the doctor to read the ring")
    ring.send_until("ring_records", 1)
    with standing_still(doctor):
        ring.send_until("ring_records", 1200)
    harness.wait_for(lambda: ring.readers()[0]["behind_bytes"] == 0, what="the doctor to read what is left")
    assert findings_at_end(doctor) == {"ring-lapped"}


def test_a_ring_that_a_reader_keeps_full_is_found(world, run):
    """Frames that the ring misses are no loss before this machine, though sequence numbers are missing."""
    ring = SmallRing(world, run, "full", "--ring-full", "drop_newest")
    reader = world.spawn("shm", "read", ring.name, "--lossless", "--json")
    doctor = world.spawn("doctor", ring.source, "--for", "10m", "--json", "-v")
    harness.wait_for(lambda: len(ring.readers()) == 2, what="both to read the ring")
    with standing_still(reader):
        ring.send(600)
        ring.send_until("ring_dropped", 20)
    ring.send_until("ring_records", 100)
    harness.wait_for(lambda: all(one["behind_bytes"] == 0 for one in ring.readers()), what="the doctor to read all")
    assert findings_at_end(doctor) == {"ring-dropped"}


class DoctorOnATerminal:
    """Its user can halt the terminal with Ctrl-S. Then the doctor's progress, and so all of it, waits."""

    def __init__(self, program, world, source):
        self.user, screen = pty.openpty()
        for end in (self.user, screen):
            world.stack.callback(os.close, end)
        os.set_blocking(self.user, False)
        self.output = world.folder / "found.json"
        with self.output.open("wb") as found:
            self.process = subprocess.Popen([program, "doctor", source, "--for", "10m", "--json"],
                                            env=harness.environment(), stdout=found, stderr=screen)
        world.stack.callback(self.process.kill)
        self.wait_for_progress()

    def shown(self):
        with contextlib.suppress(BlockingIOError):
            return os.read(self.user, 1 << 16)
        return b""

    def wait_for_progress(self):
        harness.wait_for(lambda: b"left" in self.shown(), what="the doctor's progress")

    def halt(self):
        os.write(self.user, b"\x13")
        call = pathlib.Path(f"/proc/{self.process.pid}/syscall")  # its number, then its arguments
        harness.wait_for(lambda: call.read_text().split()[1:2] == ["0x2"], what="a write to stderr that waits")

    def resume(self):
        os.write(self.user, b"\x11")
        self.wait_for_progress()

    def findings(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(harness.DEFAULT_TIMEOUT_S)
        return {finding["id"] for finding in json.loads(self.output.read_text())["findings"]}


def test_a_doctor_that_is_too_slow_finds_itself(world, program):
    port = world.port(socket.SOCK_STREAM)
    doctor = DoctorOnATerminal(program, world, f"tcpin://127.0.0.1:{port}")
    vehicle = Vehicle()
    beat = vehicle.next()
    images = b"".join(vehicle.pack(mavlink.MAVLink_encapsulated_data_message(n, [*range(1, 254)]))
                      for n in range(40 * 256))  # their sequence numbers continue when all are sent again
    with socket.create_connection(("127.0.0.1", port)) as sock:
        doctor.halt()
        sock.sendall(beat)
        for _ in range(30):  # 80 MB; it keeps 64 MiB
            sock.sendall(images)
        sock.shutdown(socket.SHUT_WR)
        sock.settimeout(harness.DEFAULT_TIMEOUT_S)
        assert sock.recv(1) == b""  # it has received all, and closes
    doctor.resume()
    assert doctor.findings() == {"too-slow"}


def test_a_halted_terminal_is_no_fault_of_the_vehicle(world, program):
    """The vehicle's clock runs on while the doctor waits; it has not jumped."""
    sock, vehicle, source = world.sender()
    doctor = DoctorOnATerminal(program, world, *source)
    world.repeat(lambda n: sock.send(vehicle.next()))
    harness.wait_for(lambda: vehicle.count > 60, what="frames before")
    doctor.halt()
    begin = time.monotonic()
    harness.wait_for(lambda: time.monotonic() - begin > 3, what="more than the tolerance of clocks")
    doctor.resume()
    assert doctor.findings() == set()


def test_the_guide_has_each_finding():
    """Ids are words with hyphens, but for two."""
    words = "".join(path.read_text() for path in (harness.ROOT / "src/observe/diagnosis").glob("words*.cpp"))
    written = set(re.findall(r'"([a-z]+(?:-[a-z]+)+|duplicates|restart)"', words))
    guide = (harness.ROOT / "docs/guide/doctor.md").read_text()
    assert written == set(re.findall(r"\*\*`([a-z-]+)`\*\*", guide))
    assert set(" ".join(PLANTED.values()).split()) <= written


@pytest.mark.parametrize("recording", ["px4_gcs_flight.tlog", "px4_gcs_session.tlog"])
def test_a_healthy_recording_has_no_finding(run, data, recording):
    assert ids(run("doctor", data / recording, "--json")) == set()


# ---- without a source ------------------------------------------------------------------------------------------------

# The ports of argv[2:] are taken. Prints who has them, and the doctor's output beside a simulator that has no ring.
PORTS_TAKEN = r"""
import json, os, socket, subprocess, sys, time
program, ports = sys.argv[1], [int(port) for port in sys.argv[2:]]
taken = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for port in ports]
for sock, port in zip(taken, ports):
    sock.bind(("0.0.0.0", port))
sim = subprocess.Popen([program, "sim", "--name", "doc-sim", "-q"])
end = time.monotonic() + 30
while subprocess.run([program, "stat", "doc-sim"], capture_output=True).returncode and time.monotonic() < end:
    time.sleep(0.05)
said = [subprocess.run([program, "doctor", "--for", "1s", *more], capture_output=True, text=True)
        for more in ([], ["--json"])]
sim.terminate()
sim.wait()
print(json.dumps([os.getpid(), *({"status": done.returncode, "out": done.stdout} for done in said)]))
"""


@pytest.fixture
def beside_a_simulator(program, tmp_path):
    """The process that has these ports, the doctor's text, and its findings."""
    def examine(*ports):
        done = netns.alone(tmp_path, sys.executable, "-c", PORTS_TAKEN, program, *map(str, ports))
        owner, text, report = json.loads(done.stdout)
        assert text["status"] == report["status"] == 4, done
        return owner, text["out"], json.loads(report["out"])["findings"]
    return examine


def test_the_usual_port_taken_beside_a_simulator_without_ring(beside_a_simulator):
    """Where a vehicle sends to both ports, the other one is enough; this one sends to the first."""
    owner, text, findings = beside_a_simulator(14550)
    assert ("port-taken", "udpin://0.0.0.0:14550") in [(one["id"], one["source"]) for one in findings], findings
    assert f"(process {owner})" in text, text


def test_both_usual_ports_taken_beside_a_simulator_without_ring(beside_a_simulator):
    owner, text, findings = beside_a_simulator(14550, 14540)
    assert [(one["id"], one["source"]) for one in findings] == [
        ("port-taken", f"udpin://0.0.0.0:{port}") for port in (14550, 14540)], findings
    assert all(f"(process {owner})" in one["what"] for one in findings), findings
    assert "Nothing was heard" not in text and "2 findings." in text, text


# ---- is this loss real? ----------------------------------------------------------------------------------------------

def compared(done, system=1):
    return next(one for one in json.loads(done.stdout)["compared"] if one["sys"] == system)


@pytest.fixture(scope="module")
def flight():
    return [(time_us, frame) for time_us, frame in frames.read_tlog(frames.FLIGHT) if frame[5] == 1]


def test_two_recordings_show_what_was_lost_between_them(run, tmp_path, flight):
    lost = set(random.Random(4).sample(range(4000, 9000), 200))
    before = frames.write_tlog(tmp_path / "before.tlog", flight[:10_000])
    kept = [(time_us + 3_600_000_000, frame) for n, (time_us, frame) in enumerate(flight) if n not in lost]
    after = frames.write_tlog(tmp_path / "after.tlog", kept[3000:])  # its clock is an hour fast
    done = run("doctor", before, after, "--json")
    assert ids(done) == {"lost-between"}
    passage = compared(done)
    assert passage["lost"] == 200 and passage["frames"] == 7000 and passage["added"] == 0, passage


def test_a_filter_between_two_recordings_is_no_loss(run, tmp_path, flight):
    before = frames.write_tlog(tmp_path / "before.tlog", flight[:10_000])
    after = frames.write_tlog(tmp_path / "after.tlog", [(t, frame) for t, frame in flight[:10_000] if frame[7] != 30])
    done = run("doctor", before, after, "--json")
    attitudes = sum(frame[7:10] == b"\x1e\0\0" for _, frame in flight[:10_000])
    assert ids(done) == {"filtered-between"}
    assert [(one["name"], one["lost"]) for one in compared(done)["messages"]] == [("ATTITUDE", attitudes)]


def test_frames_that_are_numbered_again_are_compared_by_their_content(run, tmp_path, flight):
    before = frames.write_tlog(tmp_path / "before.tlog", flight[:5000])
    run("relay", before, "--to", f"tlog://{tmp_path}/after.tlog", "--resequence",
        "--only", "ATTITUDE,ALTITUDE,HEARTBEAT")
    done = run("doctor", before, tmp_path / "after.tlog", "--json")
    assert compared(done)["rewritten"] and ids(done) == {"filtered-between"}, done


def test_nothing_is_lost(run, tmp_path, flight):
    before = frames.write_tlog(tmp_path / "before.tlog", flight[:5000])
    after = frames.write_tlog(tmp_path / "after.tlog", flight[1000:8000])
    done = run("doctor", before, after)
    through = re.search(r"all (\d+) frames of 1/1 came through", " ".join(done.stdout.split()))
    assert done.status == 0 and 3990 <= int(through[1]) <= 4000, done  # some are for the ground station alone


def test_a_few_frames_are_not_called_another_stream(run, tmp_path):
    beats = list(enumerate(frames.heartbeats(8)))
    done = run("doctor", frames.write_tlog(tmp_path / "before.tlog", beats),
               frames.write_tlog(tmp_path / "after.tlog", beats))
    assert "sent too few frames to compare" in " ".join(done.stdout.split()), done


# ---- recordings ------------------------------------------------------------------------------------------------------

def recorded(tmp_path, messages):
    """A recording of one vehicle: [(seconds, message)]."""
    vehicle = frames.sender()
    records = []
    for seconds, message in messages:
        records.append((1_700_000_000_000_000 + int(seconds * 1e6), bytes(message.pack(vehicle))))
        vehicle.seq = (vehicle.seq + 1) % 256
    return frames.write_tlog(tmp_path / "made.tlog", records)


def beats(times):
    return [(t, mavlink.MAVLink_heartbeat_message(2, 12, 81, 0, 4, 3)) for t in times]


def clocks(times, jump_s=0, boot_s=0):
    return [(t, mavlink.MAVLink_system_time_message(1_700_000_000_000_000 + int((t + jump_s) * 1e6),
                                                    int((t + boot_s) * 1000))) for t in times]


def test_a_clock_that_jumps_and_a_restart(run, tmp_path):
    jumps = clocks(range(1, 10)) + clocks(range(10, 20), jump_s=3600)
    assert ids(run("doctor", recorded(tmp_path, sorted(jumps + beats(range(20)), key=lambda one: one[0])),
                   "--json")) == {"clock-jump"}
    starts = clocks(range(1, 10), boot_s=100) + clocks(range(10, 20), boot_s=-9)
    assert ids(run("doctor", recorded(tmp_path, sorted(starts + beats(range(20)), key=lambda one: one[0])),
                   "--json")) == {"restart"}


def test_a_damaged_recording(run, tmp_path, flight):
    log = tmp_path / "damaged.tlog"
    frames.write_tlog(log, flight[:1000])
    whole = log.read_bytes()
    log.write_bytes(whole[:20_000] + b"\0" * 3000 + whole[20_000:])
    assert "damaged-recording" in ids(run("doctor", log, "--json"))


def test_a_file_that_is_no_recording_is_bad_input(run, tmp_path):
    (tmp_path / "zeros.tlog").write_bytes(bytes(100_000))
    assert run("doctor", tmp_path / "zeros.tlog").status == 3
    assert run("doctor", tmp_path / "absent.tlog").status == 3


def test_recordings_and_live_sources_do_not_mix(run):
    done = run("doctor", frames.FLIGHT, "udpin://127.0.0.1:0")
    assert done.status == 2 and "one after the other" in done.stderr, done


# ---- output ----------------------------------------------------------------------------------------------------------

def test_the_text_states_what_where_why_and_what_to_do(run, udp_port):
    port = udp_port()
    done = run("doctor", f"udpin://127.0.0.1:{port}", "--for", "100ms", env={"COLUMNS": "60"})
    assert done.status == 4 and f"\nnothing-heard  udpin://127.0.0.1:{port}\n" in done.stdout, done
    assert "  Do:  Check: does the far side send to port" in done.stdout and "\n1 finding.\n" in done.stdout
    assert max(map(len, done.lines)) <= 60 and "\x1b" not in done.stdout


def test_a_signal_ends_the_listening_and_prints_what_was_found(spawn, udp_port):
    doctor = spawn("doctor", f"udpin://127.0.0.1:{udp_port()}", "--for", "10m", "-v")
    doctor.wait_output("listening")
    done = doctor.stop()
    assert done.status == 130 and "nothing-heard" in done.stdout, done


@pytest.mark.parametrize("color", [True, False])
def test_a_terminal_shows_a_countdown_and_colours(program, udp_port, color):
    env = harness.environment({"TERM": "xterm", "NO_COLOR": None if color else "1"})
    pid, terminal = pty.fork()
    if pid == 0:
        os.execvpe(program, ["mavloom", "doctor", f"udpin://127.0.0.1:{udp_port()}", "--for", "2500ms"], env)
    shown = b""
    with contextlib.suppress(OSError):  # the terminal ends with the program
        while more := os.read(terminal, 4096):
            shown += more
    os.waitpid(pid, 0)
    os.close(terminal)
    assert re.search(rb"listening, [12] s left", shown) and (b"\x1b[1;31mnothing-heard\x1b[0m" in shown) == color, shown
