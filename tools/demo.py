#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`./run demo --recorded`: a demonstration on one machine, over real UDP sockets:

    recorded PX4 flight --replay--> +--> mavloom listen   (decoded, shown here)
                                    +--> mavloom relay    (decoded, re-encoded) --> ground-station port (recorded)

At the end it prints the messages heard, with rates and loss, and checks that the ground station received byte for byte
what the vehicle sent. Then it does the same through shared memory, in both directions:

    vehicle --> python -m mavloom.hear --ring--> mavloom relay --> ground station --(its frames of the flight)--> relay
    --inlet--> hear --> vehicle

At last, a simulated vehicle takes off, behind a router, and is watched in the router's ring:

    mavloom sim --> mavloom route --ring--> mavloom listen

Exit status: 0 all bytes agree, 4 they do not, 1 a program failed.
"""
import argparse
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
FLIGHT = ROOT / "tests" / "data" / "px4_gcs_flight.tlog"
SHOWN_EACH_S = 2.0  # at most one line per message in this time, because 370 lines a second are unreadable


GROUND_STATION = 255  # its system in the flight
PATIENCE_S = 10.0
FLIGHT_PATIENCE_S = 60.0


class Program:
    """One of our programs. A thread reads its stderr, from which its ports are taken."""

    def __init__(self, *args):
        self.args = args
        self.process = subprocess.Popen([*map(str, args)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                        errors="replace")
        self.talk = []
        self.thread = threading.Thread(target=self._read_talk, daemon=True)
        self.thread.start()

    def _read_talk(self):
        for line in self.process.stderr:
            self.talk.append(line.rstrip())

    def port(self):
        return int(self.said(r"listening on port (\d+)")[1])

    def said(self, pattern):
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            for line in self.talk:
                if found := re.search(pattern, line):
                    return found
            if self.process.poll() is not None:
                break
            time.sleep(0.01)
        raise SystemExit(f"demo: '{' '.join(map(str, self.args))}' did not start:\n" + "\n".join(self.talk))

    def stop(self, seconds=10.0):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        try:
            self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.thread.join(seconds)
        return self.process.returncode


def frames_of(tlog):
    """Returns the frames of a tlog, split by their own length bytes. It checks our code, so it uses none of it."""
    data, frames, at = pathlib.Path(tlog).read_bytes(), [], 0
    while at + 8 + 3 <= len(data):
        start, length, flags = data[at + 8], data[at + 9], data[at + 10]
        size = length + (12 + 13 * (flags & 1) if start == 0xFD else 8)
        frames.append(data[at + 8:at + 8 + size])
        at += 8 + size
    return frames


class Show:
    """Prints one line of each message now and then, and everything of the closing table."""

    def __init__(self, stream):
        self.last, self.lines, self.in_table = {}, 0, False
        self.thread = threading.Thread(target=self._run, args=(stream,), daemon=True)
        self.thread.start()

    def _run(self, stream):
        for line in stream:
            self.in_table = self.in_table or line == "\n"
            if self.in_table:
                print(line, end="")
                continue
            self.lines += 1
            name = next((word for word in line.split() if word.isupper() and len(word) > 3), "")
            if time.monotonic() - self.last.get(name, -SHOWN_EACH_S) >= SHOWN_EACH_S:
                self.last[name] = time.monotonic()
                print(line.rstrip()[:180], flush=True)


def wait_until_steady(path, seconds=3.0):
    """Waits until the file no longer grows: the recorder has then written everything."""
    size, since = -1, time.monotonic()
    end = since + seconds
    while time.monotonic() < end and time.monotonic() - since < 0.5:
        now = os.path.getsize(path) if os.path.exists(path) else 0
        if now != size:
            size, since = now, time.monotonic()
        time.sleep(0.02)


class Peer:
    """A plain UDP socket: the vehicle, or the ground station."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(PATIENCE_S)
        self.port = self.socket.getsockname()[1]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def receive(self, size):
        """Receives `size` bytes, or as many as arrive. Returns them and the sender of the last."""
        got, sender = b"", None
        while len(got) < size:
            try:
                datagram, sender = self.socket.recvfrom(65536)
            except TimeoutError:
                break
            got += datagram
        return got, sender


def way_back(options):
    """Returns whether the ground station's frames reach the vehicle through ring and inlet, byte for byte."""
    flight = frames_of(FLIGHT)
    answers = [frame for frame in flight if frame[5] == GROUND_STATION]
    ring, started = f"demo-{os.getpid()}", []
    with Peer() as vehicle, Peer() as station:
        try:
            hear = Program(sys.executable, "-m", "mavloom.hear", "udpin://127.0.0.1:0", "--ring", ring)
            started.append(hear)
            port = int(hear.said(r"hearing on udpin://127.0.0.1:(\d+)")[1])
            started.append(Program(options.program, "relay", f"shm://{ring}?from=oldest", "--to",
                                   f"udpout://127.0.0.1:{station.port}"))
            vehicle.socket.sendto(flight[0], ("127.0.0.1", port))
            _, relay = station.receive(len(flight[0]))
            if relay is None:
                return False
            got = b""
            for frame in answers:
                station.socket.sendto(frame, relay)
                arrived, _ = vehicle.receive(len(frame))
                got += arrived
                if not arrived:
                    break
        finally:
            for program in reversed(started):
                program.stop(2)
    agree = got == b"".join(answers)
    print(f"demo: the way back: {len(answers)} frames of the ground station sent, "
          f"{len(got)} of {sum(map(len, answers))} bytes reached the vehicle "
          f"through mavloom relay, the ring's inlet and python -m mavloom.hear")
    return agree


def simulated_flight(options):
    """Returns whether a simulated vehicle takes off and all its frames reach the router's ring."""
    name, altitude, started = f"demo-flight-{os.getpid()}", 10, []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    try:
        route = Program(options.program, "route", f"udpin://127.0.0.1:{port}", "--ring", name)
        started.append(route)
        route.said("listening")
        listen = Program(options.program, "listen", f"shm://{name}", "--only", "GLOBAL_POSITION_INT", "--json",
                         "--for", f"{FLIGHT_PATIENCE_S:.0f}s")
        started.append(listen)
        started.append(Program(options.program, "sim", "--to", f"udpout://127.0.0.1:{port}", "--name", f"{name}-sim",
                               "--speed", "5"))
        ordered, height = False, 0.0
        for line in listen.process.stdout:
            height = json.loads(line)["fields"]["relative_alt"] / 1000
            if not ordered:
                order = [options.program, "ctl", f"{name}-sim", "takeoff", str(altitude)]
                ordered = subprocess.run(order, capture_output=True).returncode == 0
            if height > 0.95 * altitude:
                break
        stats = subprocess.run([options.program, "ctl", name, "stats"], capture_output=True, text=True).stdout
        lost = sum(row["lost"] for row in map(json.loads, stats.splitlines()) if row["kind"] == "source")
    finally:
        for program in reversed(started):
            program.stop(2)
    print(f"demo: a simulated vehicle climbed to {height:.1f} m behind a router; {lost} of its frames were lost")
    return height > 0.95 * altitude and lost == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build" / "release" / "bin" / "mavloom"))
    parser.add_argument("--for", dest="duration", default=None, metavar="TIME",
                        help="only this much of the flight, for example 20s (default: all of it, 108 s)")
    parser.add_argument("--speed", default="1", metavar="N", help="times the recorded pace (default 1)")
    parser.add_argument("--flight", default=str(FLIGHT), metavar="FILE.tlog", help="another recording")
    options = parser.parse_args()

    with tempfile.TemporaryDirectory(prefix="mavloom-demo-") as folder:
        return run(options, pathlib.Path(folder))


def run(options, folder):
    mavloom, received = options.program, folder / "ground-station.tlog"
    started = []
    try:
        station = Program(mavloom, "record", "udpin://127.0.0.1:0", "-o", received)
        started.append(station)
        relay = Program(mavloom, "relay", "udpin://127.0.0.1:0", "--to", f"udpout://127.0.0.1:{station.port()}")
        started.append(relay)
        listen = Program(mavloom, "listen", "udpin://127.0.0.1:0", "--stats")
        started.append(listen)
        show = Show(listen.process.stdout)
        bound = ["--for", options.duration] if options.duration else []
        print(f"demo: replaying {pathlib.Path(options.flight).name} to mavloom listen (port {listen.port()}) and "
              f"through mavloom relay (port {relay.port()}) "
              f"to a ground station (port {station.port()})\n", flush=True)
        replay = Program(mavloom, "replay", options.flight, "--speed", options.speed, *bound,
                         "--to", f"udpout://127.0.0.1:{listen.port()}", "--to", f"udpout://127.0.0.1:{relay.port()}")
        started.append(replay)
        status = replay.process.wait()
        replay.thread.join()
        wait_until_steady(received)
        statuses = {"relay": relay.stop(), "record": station.stop(), "listen": listen.stop()}
        show.thread.join(10)
    except KeyboardInterrupt:
        return 130
    finally:
        for program in started:
            program.stop(2)

    for name, program in (("replay", replay), ("relay", relay), ("record", station), ("listen", listen)):
        for line in program.talk:
            print(f"{name:>7} | {line}")
    bad = {name: code for name, code in statuses.items() if code != 130}
    if status != 0 or bad:
        print(f"demo: FAILED: replay ended with {status}, others with {statuses}")
        return 1
    return compare(options, received, show.lines, sent_by(replay), damaged_in(replay))


def sent_by(replay):
    """Returns the number of frames that replay reports as sent, the smallest of all destinations."""
    return min(int(found[1]) for line in replay.talk if (found := re.search(r": (\d+) frames, \d+ bytes sent", line)))


def damaged_in(replay):
    """Returns the number of places in the flight where replay reports damage or a frame that must not be forwarded."""
    return sum(int(found[1]) for line in replay.talk
               if (found := re.search(r": (\d+) (damaged place|frames? not sent: an unknown)", line)))


def compare(options, received, shown, count, damaged):
    got = frames_of(received)
    print(f"\ndemo: {len(got)} frames reached the ground station, {sum(map(len, got))} bytes; "
          f"mavloom listen showed {shown} messages")
    agreeing, gaps = follow(got, pathlib.Path(options.flight).read_bytes(), to_its_end=not options.duration)
    if count == len(got) == agreeing == shown and got and gaps <= damaged:
        if not way_back(options):
            print("demo: MISMATCH: the frames of the ground station did not reach the vehicle unchanged")
            return 4
        if not simulated_flight(options):
            print("demo: MISMATCH: the simulated vehicle did not fly as ordered")
            return 4
        print("demo: OK: byte for byte what was sent, there and back")
        return 0
    print(f"demo: MISMATCH: {count} frames sent, {len(got)} received, {shown} shown; "
          f"the first {agreeing} agree, with {gaps} gaps in them and {damaged} damaged places in the flight")
    return 4


def follow(got, flight, to_its_end):
    """Returns how many frames of `got` are in the flight, in the same order, and in how many places bytes other than
    record times are missing."""
    at = gaps = 0
    for i, frame in enumerate(got):
        found = flight.find(frame, at)
        if found < 0:
            return i, gaps
        gaps += found != at + 8
        at = found + len(frame)
    return len(got), gaps + (to_its_end and at != len(flight))


if __name__ == "__main__":
    sys.exit(main())
