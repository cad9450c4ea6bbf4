#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench hostile: a vehicle sends to a ground station through one udpin endpoint of the router, while others flood it.

Measures how many of the vehicle's frames are lost, their delay, how long `stat` takes, and how much of one processor
the router uses. Needs root: all runs in a network namespace of its own, and the router gets the receive buffer that it
asks for. With --json, each measurement is a line; else a table has the median of all rounds, with the highest value in
parentheses. The exit status is 4 if a frame was lost."""
import argparse
import dataclasses
import json
import multiprocessing
import os
import pathlib
import socket
import statistics
import struct
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "system"))
import routers  # noqa: E402
from routers import mavlink  # noqa: E402

VEHICLE, STATION = (1, 1), (255, 190)
ATTITUDE = b"\x1e\0\0"
LOOPBACK, ELSEWHERE = "127.0.0.1", "10.0.0.1"  # the second is routed to lo, but is no address of this machine


@dataclasses.dataclass
class Attack:
    key: str
    what: str
    host: str = ELSEWHERE
    rate: int = 0  # datagrams/s
    ids: int = 1
    addresses: int = 0  # 0: each datagram comes from another
    refuses: bool = False
    frames_per_s: int = 1000  # of the vehicle
    options: str = ""

    def flood(self, tool, port, seconds):
        return subprocess.Popen([tool, self.host, str(port), str(self.rate), str(seconds), str(self.ids),
                                 str(self.addresses or 16_000_000), *["refuse"] * self.refuses],
                                stdout=subprocess.PIPE, text=True)


ATTACKS = [
    Attack("none", "none"),
    Attack("20k", "20,000 datagrams/s", rate=20_000),
    Attack("100k", "100,000 datagrams/s", rate=100_000),
    Attack("20k/12k", "20,000 from 12,000 addresses", rate=20_000, addresses=12_000),
    Attack("100k/60k", "100,000 from 60,000 addresses", rate=100_000, addresses=60_000),
    Attack("loopback", "loopback: none", LOOPBACK, frames_per_s=100),
    Attack("refuse", "loopback: 20,000 that refuse answers", LOOPBACK, rate=20_000, refuses=True),
    Attack("refuse-strangers", "the same, trusted=false", LOOPBACK, rate=20_000, refuses=True,
           options="&trusted=false"),
    Attack("200", "loopback: 3,000 from 200 with 40 ids each", LOOPBACK, rate=3_000, ids=8_000, addresses=200,
           frames_per_s=100),
]


# ---- the honest pair

def send(sock, target, frames_per_s, begin, sent_at):
    """The vehicle: ATTITUDE at this rate, numbered in time_boot_ms."""
    mav = mavlink.MAVLink(None, *VEHICLE)
    frames = [bytes(mavlink.MAVLink_attitude_message(n, 0.1, 0.2, 0.3, 0, 0, 0).pack(mav))
              for n in range(1, len(sent_at) + 1)]
    for n, frame in enumerate(frames):
        while (left := begin + n / frames_per_s - time.monotonic()) > 0:
            time.sleep(left)
        sent_at[n] = time.monotonic()
        sock.sendto(frame, target)


def receive(sock, until, sent_at):
    """Delays in ms of the frames that arrived."""
    delays = {}
    sock.settimeout(0.2)
    while time.monotonic() < until:
        try:
            data = sock.recv(65536)
        except TimeoutError:
            continue
        now = time.monotonic()
        while len(data) >= 12:
            size = 12 + data[1]
            if data[7:10] == ATTITUDE:
                number, = struct.unpack_from("<I", data, 10)
                delays.setdefault(number, 1000 * (now - sent_at[number - 1]))
            data = data[size:]
    return delays


def honest_pair(attack, target):
    """Two sockets that the router knows. On loopback, both have its address."""
    pair = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2)]
    for sock, address in zip(pair, ("10.0.0.2", "10.0.0.3")):
        sock.bind((LOOPBACK if attack.host == LOOPBACK else address, 0))
        routers.harness.enlarge_receive_buffer(sock)
    for _ in range(2):
        for sock, source in zip(pair, (VEHICLE, STATION)):
            sock.sendto(routers.heartbeat(source), target)
        time.sleep(0.6)
    return pair


# ---- one measurement

def cpu_seconds(pid):
    return sum(int((task / "schedstat").read_text().split()[0])
               for task in pathlib.Path(f"/proc/{pid}/task").iterdir()) / 1e9


class Asking(threading.Thread):
    """Runs `stat` again and again, and keeps the longest time that it took."""

    def __init__(self, program, name):
        super().__init__()
        self.command, self.over, self.slowest = [program, "stat", name], threading.Event(), 0.0

    def run(self):
        while not self.over.wait(0.3):
            begin = time.monotonic()
            subprocess.run(self.command, check=True, stdout=subprocess.DEVNULL)
            self.slowest = max(self.slowest, time.monotonic() - begin)

    def end(self):
        self.over.set()
        self.join()
        return self.slowest


def measure(options, attack):
    port, name = routers.udp_port(), f"hostile-{os.getpid()}"
    url = f"udpin://{attack.host}:{port}?rcvbuf=32MiB{attack.options}"
    router = subprocess.Popen([options.program, "route", url, "--name", name], stderr=subprocess.DEVNULL)
    try:
        time.sleep(1)
        vehicle, station = honest_pair(attack, (attack.host, port))
        return measure_pair(options, attack, port, vehicle, station, Asking(options.program, name), router.pid)
    finally:
        router.terminate()
        router.wait()


def measure_pair(options, attack, port, vehicle, station, asking, pid):
    seconds = options.seconds
    sent_at = multiprocessing.Array("d", int(attack.frames_per_s * seconds), lock=False)
    flood = attack.flood(options.tools / "flood_tool", port, seconds + 1) if attack.rate else None
    begin, cpu_before = time.monotonic() + 0.5, cpu_seconds(pid)
    sender = multiprocessing.Process(target=send, args=(vehicle, (attack.host, port), attack.frames_per_s, begin,
                                                        sent_at))
    sender.start()
    asking.start()
    delays = receive(station, begin + seconds + 1, sent_at)
    sender.join()
    cpu = (cpu_seconds(pid) - cpu_before) / (seconds + 1.5)
    in_order = sorted(delays.values()) or [float("nan")]
    return {"attack": attack.key, "flood_per_s": int(flood.communicate()[0]) / (seconds + 1) if flood else 0,
            "sent": len(sent_at), "lost": len(sent_at) - len(delays), "median_ms": statistics.median(in_order),
            "p99_ms": in_order[int(0.99 * len(in_order))], "max_ms": in_order[-1], "slowest_stat_s": asking.end(),
            "processor": cpu}


# ---- the table

COLUMNS = {"flood_per_s": ",.0f", "lost": "", "median_ms": ".2f", "p99_ms": ".2f", "max_ms": ".1f",
           "slowest_stat_s": ".2f", "processor": ".2f"}


def row(attack, results):
    cells = []
    for name, form in COLUMNS.items():
        values = [result[name] for result in results]
        middle = statistics.median_low(values)
        cells.append(f"{middle:{form}}" + (f" ({max(values):{form}})" if len(values) > 1 else ""))
    return f"| {attack.what} | {results[0]['sent']:,} | {' | '.join(cells)} |"


def parsed():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/mavloom")
    parser.add_argument("--tools", type=pathlib.Path, default=ROOT / "build/release/bench/bin",
                        help="the folder of flood_tool")
    parser.add_argument("--attacks", default=",".join(attack.key for attack in ATTACKS), help="default: %(default)s")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--quick", action="store_true", help="one round of half a second each")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    if unknown := set(options.attacks.split(",")) - {attack.key for attack in ATTACKS}:
        parser.error(f"no attack {', '.join(sorted(unknown))}")
    if options.quick:
        options.rounds, options.seconds = 1, 0.5
    return options


def enter_namespace():
    """Starts this program again, in a network namespace where 10.0.0.0/8 leads back to it."""
    if os.environ.pop("HOSTILE_NAMESPACE", None):
        return
    if os.geteuid() != 0:
        sys.exit("bench hostile needs root")
    os.environ["HOSTILE_NAMESPACE"] = "entered"
    setup = "ip link set lo up && ip route add local 10.0.0.0/8 dev lo && exec"
    os.execvp("unshare", ["unshare", "--net", "sh", "-c", f'{setup} "$@"', "sh", sys.executable, *sys.argv])


def main():
    options = parsed()
    enter_namespace()
    if not options.json:
        print("| attack | frames | sent/s | lost | delay, median (ms) | p99 | max | slowest stat (s) | processor |\n"
              "|---|---|---|---|---|---|---|---|---|", flush=True)
    lost = 0
    with tempfile.TemporaryDirectory(prefix="mv-") as run:
        os.environ["MAVLOOM_RUN"] = run
        for attack in (attack for attack in ATTACKS if attack.key in options.attacks.split(",")):
            results = [measure(options, attack) for _ in range(options.rounds)]
            lost += sum(result["lost"] for result in results)
            print("\n".join(map(json.dumps, results)) if options.json else row(attack, results), flush=True)
    return 4 if lost else 0


if __name__ == "__main__":
    sys.exit(main())
