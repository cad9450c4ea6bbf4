# SPDX-License-Identifier: MIT
"""A flood of heartbeats from invented addresses at one udpin, while a vehicle sends to a ground station through it.
Prints loss and delay of the vehicle's frames, and how long `ctl` and `stat` take. docs/performance.md

    build/venv/bin/python bench/hostile.py [RATE[/ADDRESSES]...]

With ADDRESSES, each address sends again after so many others.

Needs root, the program, and tests/bin/flood_tool of the release build. The router gets the receive buffer that it asks
for. All run in a network namespace of their own, with addresses that are not loopback: peers on loopback are
trusted, so there the router sends everything to invented peers too."""
import multiprocessing
import os
import pathlib
import socket
import statistics
import struct
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = pathlib.Path(os.environ.get("MAVLOOM_PROGRAM", ROOT / "build/release/bin/mavloom")).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "system"))
import routers  # noqa: E402
from routers import mavlink  # noqa: E402

FRAMES_PER_S, SECONDS = 1000, 5
HOST = "10.0.0.1"
VEHICLE, STATION = (1, 1), (255, 190)


def send(sock, target, begin, sent_at):
    """The vehicle: one ATTITUDE a millisecond, numbered in time_boot_ms."""
    mav = mavlink.MAVLink(None, *VEHICLE)
    frames = [bytes(mavlink.MAVLink_attitude_message(n, 0.1, 0.2, 0.3, 0, 0, 0).pack(mav)) for n in
              range(1, FRAMES_PER_S * SECONDS + 1)]
    for n, frame in enumerate(frames):
        while (left := begin + n / FRAMES_PER_S - time.monotonic()) > 0:
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
            if data[7:10] == b"\x1e\0\0":
                number, = struct.unpack_from("<I", data, 10)
                delays.setdefault(number, 1000 * (now - sent_at[number - 1]))
            data = data[size:]
    return delays


def asked(*arguments):
    begin = time.monotonic()
    subprocess.run([BUILD / "bin/mavloom", *arguments], check=True, stdout=subprocess.DEVNULL)
    return time.monotonic() - begin


def measure(rate, addresses=0):
    port = routers.udp_port()
    target = (HOST, port)
    name = f"hostile-{os.getpid()}-{rate}"
    router = subprocess.Popen([BUILD / "bin/mavloom", "route", f"udpin://{HOST}:{port}?rcvbuf=32MiB", "--name", name],
                              stderr=subprocess.DEVNULL)
    vehicle, station = (socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2))
    for sock, address in ((vehicle, "10.0.0.2"), (station, "10.0.0.3")):
        sock.bind((address, 0))
        routers.harness.enlarge_receive_buffer(sock)
    time.sleep(1)
    for _ in range(2):
        vehicle.sendto(routers.heartbeat(VEHICLE), target)
        station.sendto(routers.heartbeat(STATION), target)
        time.sleep(0.6)
    sent_at = multiprocessing.Array("d", FRAMES_PER_S * SECONDS, lock=False)
    flood = subprocess.Popen([BUILD / "tests/bin/flood_tool", HOST, str(port), str(rate), str(SECONDS + 1),
                              *(["1", str(addresses)] if addresses else [])],
                             stdout=subprocess.PIPE, text=True) if rate else None
    begin = time.monotonic() + 0.5
    sender = multiprocessing.Process(target=send, args=(vehicle, target, begin, sent_at))
    sender.start()
    asking = multiprocessing.Pool(1).starmap_async(asked, [("ctl", name, "links"), ("stat", name)] * 3)
    delays = receive(station, begin + SECONDS + 1.5, sent_at)
    sender.join()
    answers = asking.get()
    stats = subprocess.run([BUILD / "bin/mavloom", "stat", name], capture_output=True, text=True).stdout
    offered = int(flood.communicate()[0]) / (SECONDS + 1) if flood else 0
    router.terminate()
    router.wait()
    in_order = sorted(delays.values()) or [float("nan")]
    p99 = in_order[int(0.99 * len(in_order))]
    asked_for = f"{rate:,} from {addresses:,}" if addresses else f"{rate:,}"
    print(f"| {asked_for} | {offered:,.0f} | {FRAMES_PER_S * SECONDS - len(delays)} | "
          f"{statistics.median(in_order):.2f} | {p99:.2f} | {in_order[-1]:.1f} | {max(answers):.2f} |", flush=True)
    return stats


if __name__ == "__main__":
    if os.environ.pop("HOSTILE_NAMESPACE", None) is None:
        os.environ["HOSTILE_NAMESPACE"] = "entered"
        setup = "ip link set lo up && ip route add local 10.0.0.0/8 dev lo && exec"
        os.execvp("unshare", ["unshare", "--net", "sh", "-c", f'{setup} "$@"', "sh", sys.executable, *sys.argv])
    os.environ.setdefault("MAVLOOM_RUN", tempfile.mkdtemp(prefix="mv-"))
    print("| flood asked, datagrams/s | sent | frames lost of 5,000 | delay, median (ms) | p99 | max | "
          "slowest ctl, stat (s) |\n|---|---|---|---|---|---|---|", flush=True)
    for text in sys.argv[1:] or ["0", "20000", "100000"]:
        measure(*(int(part) for part in text.split("/")))
