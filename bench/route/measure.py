# SPDX-License-Identifier: MIT
"""One measurement of `bench route`: a router runs as a process between the load generator and the far side.

This module opens the sockets of both sides and passes them on. So the kernel chooses the ports, and every router gets
the same kind of sockets."""
import dataclasses
import json
import math
import pathlib
import re
import select
import signal
import socket
import struct
import subprocess
import tempfile
import time

SO_SNDBUFFORCE, SO_RCVBUFFORCE, SO_MEMINFO, MEMINFO_DROPS = 32, 33, 55, 8
START_DEADLINE_S = 30


@dataclasses.dataclass(frozen=True)
class Load:
    """A load of `links` senders and `outs` receivers. With 0 receivers, each sender receives what the others sent."""
    key: str
    title: str
    rate: int
    per_datagram: int = 1
    outs: int = 1
    links: int = 1
    systems: int = 1
    components: int = 1
    longest_s: float = math.inf
    sink_rest_us: int = 250  # waking for each datagram would cost more than what is measured
    tick_us: int = 100


@dataclasses.dataclass(frozen=True)
class Kit:
    """The programs and the recording that a measurement uses."""
    tools: pathlib.Path
    flight: pathlib.Path


class NoAnswer(Exception):
    """A router that forwards nothing."""


def heartbeat(system, number):
    """Returns a unique HEARTBEAT (id 0, CRC_EXTRA 50) of component 1, with `number` as its custom_mode.

    Its arrival shows that a router is up."""
    body = struct.pack("<BBBBBB3xIBBBBB", 9, 0, 0, number & 0xFF, system, 1, number, 2, 12, 81, 4, 3)
    crc = 0xFFFF
    for byte in body + b"\x32":
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
    return b"\xfd" + body + struct.pack("<H", crc)


def udp_socket():
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    for option, usual in ((SO_RCVBUFFORCE, socket.SO_RCVBUF), (SO_SNDBUFFORCE, socket.SO_SNDBUF)):
        try:
            sock.setsockopt(socket.SOL_SOCKET, option, 32 << 20)
        except PermissionError:
            sock.setsockopt(socket.SOL_SOCKET, usual, 32 << 20)
    sock.bind(("127.0.0.1", 0))
    return sock


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        sock.bind(("127.0.0.1", 0))
        return sock.getsockname()[1]


def dropped_by(sock):
    return struct.unpack("9I", sock.getsockopt(socket.SOL_SOCKET, SO_MEMINFO, 36))[MEMINFO_DROPS]


def cpu_seconds(pids):
    """Returns the CPU time of all threads of the processes, user and system."""
    return sum(int((task / "schedstat").read_text().split()[0])
               for pid in pids for task in pathlib.Path(f"/proc/{pid}/task").iterdir()) / 1e9


def anonymous_kib(pid):
    return int(re.search(r"RssAnon:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text())[1])


def drain(sockets):
    """Reads everything that has arrived, and returns the sockets that had data."""
    heard = set()
    for sock in select.select(sockets, [], [], 0)[0]:
        try:
            while sock.recv(65536, socket.MSG_DONTWAIT):
                heard.add(sock)
        except OSError:  # nothing more, or the port of a router that is not up yet refused a datagram
            pass
    return heard


def wait_until_up(router, senders, receivers):
    """Sends heartbeats from every sender until every receiver has received one, then waits until all is quiet."""
    deadline = time.monotonic() + START_DEADLINE_S
    silent, number = set(receivers), 0
    while silent:
        if router.poll() is not None or time.monotonic() > deadline:
            raise NoAnswer(f"status {router.returncode}" if router.poll() is not None
                           else f"nothing within {START_DEADLINE_S} s")
        for system, sock in enumerate(senders, 1):
            number += 1
            try:
                sock.send(heartbeat(system, number))
            except ConnectionRefusedError:
                pass
        time.sleep(0.05)
        silent -= drain(silent)
    quiet_since = time.monotonic()
    while time.monotonic() - quiet_since < 0.3 and time.monotonic() < deadline:
        time.sleep(0.02)
        if drain(receivers):
            quiet_since = time.monotonic()


def descriptors(sockets):
    return ",".join(str(sock.fileno()) for sock in sockets)


def start(command, sockets=(), **options):
    return subprocess.Popen([str(part) for part in command], pass_fds=[sock.fileno() for sock in sockets], **options)


def run_load(kit, load, rate, seconds, pids, senders, receivers):
    """Runs the load through the running router, the first of `pids`. Returns what was sent, what arrived, and the cost
    of all `pids`."""
    frames = int(rate * seconds)
    shape = [kit.flight, load.systems, load.components]
    mode = "fan" if load.outs else "mesh"
    with start([kit.tools / "route_sink", descriptors(receivers), *shape, frames, mode, load.sink_rest_us], receivers,
               stdin=subprocess.PIPE, stdout=subprocess.PIPE) as sink:
        sink.stdout.readline()
        dropped, cpu = sum(map(dropped_by, receivers)), cpu_seconds(pids)
        with start([kit.tools / "route_generator", descriptors(senders), *shape, rate, frames, load.per_datagram,
                    load.tick_us], senders,
                   stdout=subprocess.PIPE) as generator:
            time.sleep(seconds / 4)
            early_kib = anonymous_kib(pids[0])
            sent = json.loads(generator.stdout.read())
        sink.stdin.close()
        arrived = json.loads(sink.stdout.read())
        cpu = cpu_seconds(pids) - cpu
        dropped = sum(map(dropped_by, receivers)) - dropped
    return sent, arrived, cpu, dropped, early_kib


def summary(load, sent, arrived, cpu, dropped, early_kib, late_kib):
    delivered = sum(arrived["distinct"])
    # In a mesh, each sender receives the frames of all others but not its own. So each frame should arrive links - 1
    # times, whichever link sent it.
    expected = sent["frames"] * (load.outs or load.links - 1)
    return {"sent": sent["frames"], "rate": sent["rate"], "expected": expected, "delivered": delivered,
            "lost": expected - delivered, "lost_at_sink": dropped,
            "loss_percent": round(100 * (expected - delivered) / expected, 4), "cpu_s": round(cpu, 4),
            "cpu_us_per_frame": round(1e6 * cpu / delivered, 4) if delivered else None,
            "datagrams": arrived["datagrams"], "median_us": arrived["median_us"], "p99_us": arrived["p99_us"],
            "duplicates": arrived["duplicates"], "reordered": arrived["reordered"], "echoes": arrived["echoes"],
            "damaged": arrived["damaged"], "foreign": arrived["foreign"], "generator_latest_us": sent["latest_us"],
            "rss_anon_kib_early": early_kib, "rss_anon_kib": late_kib}


def measure(kit, peer, load, seconds, rate=None):
    """Starts the router, waits until it forwards, runs the load and ends the router.

    Raises NoAnswer if it never forwards."""
    rate, seconds = rate or load.rate, min(seconds, load.longest_s)
    in_port = free_port()
    senders = [udp_socket() for _ in range(load.links)]
    receivers = [udp_socket() for _ in range(load.outs)] or senders
    for sock in senders:
        sock.connect(("127.0.0.1", in_port))
    with tempfile.TemporaryDirectory(prefix="bench-route-") as folder:
        out_ports = [sock.getsockname()[1] for sock in receivers] if load.outs else []
        log = open(pathlib.Path(folder, "log"), "w+")
        router = start(peer.command(in_port, out_ports, folder), cwd=folder, stdin=subprocess.DEVNULL, stdout=log,
                       stderr=log)
        beside = []
        try:
            beside = [start(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=log)
                      for command in peer.beside()]
            wait_until_up(router, senders, receivers)
            pids = [router.pid, *(process.pid for process in beside if peer.counts_beside)]
            measured = run_load(kit, load, rate, seconds, pids, senders, receivers)
            if router.poll() is not None:
                raise NoAnswer(f"ended with {router.returncode} under the load")
            return {"load": load.key, "peer": peer.name, "asked_rate": rate, "seconds": seconds,
                    **summary(load, *measured, anonymous_kib(router.pid))}
        except NoAnswer as why:
            log.seek(0)
            raise NoAnswer(f"{peer.name}: {why}; it said: {log.read()[-400:].strip()!r}") from None
        finally:
            for process in (*beside, router):
                end(process)
            log.close()
            for sock in {*senders, *receivers}:
                sock.close()


def end(process):
    if process.poll() is None:
        process.send_signal(signal.SIGTERM)
        try:
            process.wait(5)
        except subprocess.TimeoutExpired:
            process.kill()
    process.wait()
