#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench sim: measures `mavloom sim` from outside.

- CPU of one vehicle, in turns with a bare loop that sends as many datagrams of the same sizes at the same instants
- rate and jitter of every stream, by the kernel's receive times
- time from a command to its acknowledgement
- time to fetch all parameters, by pymavlink, over loopback and over a line of 57,600 baud
- memory of one vehicle more
- time from the start to the first heartbeat

Every frame that arrives is checked for gaps in the sequence numbers. The exit status is 4 if there was one."""
import argparse
import collections
import contextlib
import json
import os
import pathlib
import pty
import random
import re
import select
import signal
import socket
import statistics
import struct
import subprocess
import sys
import tempfile
import threading
import time
import tty

os.environ["MAVLINK20"] = "1"
from pymavlink import mavutil  # noqa: E402
from pymavlink.dialects.v20 import common as mavlink  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
SO_TIMESTAMPNS = 35
HEARTBEAT, COMMAND_ACK, AUTOPILOT_VERSION = 0, 77, 148
PROFILE = "px4-normal"
GCS = (255, 190)


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        sock.bind(("127.0.0.1", 0))
        return sock.getsockname()[1]


def cpu_seconds(pid):
    """CPU time of all threads of a process, user and system."""
    return sum(int((task / "schedstat").read_text().split()[0])
               for task in pathlib.Path(f"/proc/{pid}/task").iterdir()) / 1e9


def anonymous_kib(pid):
    return int(re.search(r"RssAnon:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text())[1])


def frames_in(data, at=0):
    """(time, system, component, sequence, message id) of each whole frame."""
    while len(data) >= 12 and len(data) >= (size := data[1] + 12 + 13 * (data[2] & 1)):
        assert data[0] == 0xFD, bytes(data[:20])
        yield at, data[5], data[6], data[4], int.from_bytes(data[7:10], "little")
        data = data[size:]


def gaps_in(frames):
    """Frames that are missing between others of the same source. pymavlink's own count takes each message that it does
    not know for a missing one."""
    last, gaps = {}, 0
    for _, system, component, sequence, _ in frames:
        source = (system, component)
        gaps += (sequence - last.get(source, sequence - 1) - 1) % 256
        last[source] = sequence
    return gaps


class Receiver:
    """A bound UDP socket. Keeps (kernel receive time in ns, bytes) of each datagram."""

    def __init__(self):
        self.sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8 << 20)
        self.sock.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
        self.sock.bind(("127.0.0.1", 0))
        self.sock.setblocking(False)
        self.port = self.sock.getsockname()[1]
        self.peer, self.datagrams = None, []

    def drain(self):
        with contextlib.suppress(BlockingIOError):
            while True:
                data, ancillary, _, self.peer = self.sock.recvmsg(65536, 64)
                seconds, ns = struct.unpack("qq", ancillary[0][2])
                self.datagrams.append((seconds * 1_000_000_000 + ns, data))

    def run(self, seconds):
        """Receives for a while. It wakes rarely, so that it does not disturb what it measures."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            time.sleep(min(0.05, left))
            self.drain()

    def wait(self, seconds=10):
        assert select.select([self.sock], [], [], seconds)[0], "nothing arrives"
        self.drain()

    def frames(self):
        for at, data in self.datagrams:
            yield from frames_in(data, at)

    def close(self):
        self.sock.close()


@contextlib.contextmanager
def running(command):
    process = subprocess.Popen([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                               stdin=subprocess.DEVNULL)
    try:
        yield process
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)
        if not process.stdout.closed:
            process.communicate()


class Bench:
    def __init__(self, options):
        self.program, self.tools, self.quick = options.program, options.tools, options.quick
        self.as_json, self.rounds, self.lost = options.json, 1 if options.quick else options.rounds, 0
        self.warm_up_s = 0.5 if options.quick else 4  # longer than a vehicle takes to be ready

    def sim(self, *options):
        return [self.program, "sim", "--name", f"bench-{os.getpid()}", *options]

    def tell(self, what, value, unit, target, met, more=""):
        if self.as_json:
            print(json.dumps({"bench": f"sim {what}", "value": value, "unit": unit, "target": target, "met": met}),
                  flush=True)
        else:
            verdict = "" if met is None else "met" if met else "missed"
            print(f"  {what:<58} {value:10.3f} {unit:<10} target {target:<14} {verdict:<7} {more}", flush=True)

    def check(self, receiver):
        gaps = gaps_in(receiver.frames())
        self.lost += gaps
        if gaps:
            print(f"  {gaps} frames are missing", file=sys.stderr)

    # ---- CPU

    def schedule(self, folder, seconds):
        """Records the datagrams of a simulator: a file for the bare loop."""
        receiver = Receiver()
        with running(self.sim("--to", f"udpout://127.0.0.1:{receiver.port}", "--profile", PROFILE)):
            receiver.wait()
            receiver.run(self.warm_up_s)
            receiver.datagrams.clear()
            receiver.run(seconds)
        self.check(receiver)
        receiver.close()
        first = receiver.datagrams[0][0]
        path = pathlib.Path(folder, "schedule")
        path.write_text("".join(f"{at - first} {len(data)}\n" for at, data in receiver.datagrams))
        frames = sum(1 for _ in receiver.frames())
        return path, len(receiver.datagrams) / seconds, frames / seconds

    def cpu_of(self, command, seconds):
        """Part of a core that a process uses, and datagrams a second."""
        receiver = Receiver()
        with running([str(part).replace("PORT", str(receiver.port)) for part in command]) as process:
            receiver.wait()
            receiver.run(self.warm_up_s)
            before, count, began = cpu_seconds(process.pid), len(receiver.datagrams), time.monotonic()
            receiver.run(seconds)
            spent, took = cpu_seconds(process.pid) - before, time.monotonic() - began
            arrived = (len(receiver.datagrams) - count) / took
        receiver.close()
        return 100 * spent / took, arrived

    def cpu(self):
        seconds = 1 if self.quick else 10
        with tempfile.TemporaryDirectory() as folder:
            path, datagrams, frames = self.schedule(folder, seconds)
            ours, bare = [], []
            sides = ((self.sim("--to", "udpout://127.0.0.1:PORT", "--profile", PROFILE), ours),
                     ([self.tools / "sim_bare_sender", "PORT", path], bare))
            for number in range(self.rounds):
                for command, taken in sides[::1 if number % 2 else -1]:
                    taken.append(self.cpu_of(command, seconds))
        ratios = [a[0] / b[0] for a, b in zip(ours, bare)]
        more = (f"{statistics.median(a for a, _ in ours):.2f} % of a core, bare loop "
                f"{statistics.median(b for b, _ in bare):.2f} %; {frames:.0f} messages in {datagrams:.0f} datagrams/s; "
                f"lowest {min(ratios):.2f}, highest {max(ratios):.2f}")
        ratio = statistics.median(ratios)
        self.tell("CPU of one vehicle, against the bare loop", ratio, "times", "1.3 at most", ratio <= 1.3, more)

    # ---- rates

    def rates(self):
        seconds = 2 if self.quick else 60
        receiver = Receiver()
        command = self.sim("--to", f"udpout://127.0.0.1:{receiver.port}", "--profile", PROFILE, "--for",
                           f"{seconds + 2}s", "--report", "--json")
        with running(command) as process:
            receiver.wait()
            receiver.run(seconds + 2.5)
            rows = [json.loads(line) for line in process.communicate()[0].splitlines()]
        receiver.drain()
        self.check(receiver)
        receiver.close()
        streams = {row["id"]: row for row in rows if row["kind"] == "stream" and row["sent"] > 2}
        times = collections.defaultdict(list)
        for at, _, _, _, message in receiver.frames():
            times[message].append(at)
        worst, late, skipped = (0, ""), [], sum(row["skipped"] for row in streams.values())
        for message, row in streams.items():
            at = times[message]
            if row["sent"] != len(at) or row["asked_hz"] < 0.4:
                continue  # also sent on request or on change
            rate = (len(at) - 1 + row["skipped"]) / ((at[-1] - at[0]) / 1e9)
            worst = max(worst, (abs(rate / row["asked_hz"] - 1), row["name"]))
            if row["skipped"] == 0:
                rest = [t - i * 1e9 / row["asked_hz"] for i, t in enumerate(at)]
                late += [t - min(rest) for t in rest]
        late.sort()
        self.tell(f"rate of every stream over {seconds} s, worst deviation", 100 * worst[0], "%", "0.1 at most",
                  worst[0] <= 0.001, f"{worst[1]}; {len(streams)} streams, {skipped} instants skipped")
        p99 = late[int(0.99 * len(late))] / 1e6
        self.tell("jitter of all streams, 99th percentile", p99, "ms", "1 at most", p99 <= 1,
                  f"median {late[len(late) // 2] / 1e6:.3f} ms, highest {late[-1] / 1e6:.3f} ms")

    # ---- answers

    def acknowledgements(self):
        count = 50 if self.quick else 1000
        receiver, mav = Receiver(), mavlink.MAVLink(None, *GCS)
        taken = []
        with running(self.sim("--to", f"udpout://127.0.0.1:{receiver.port}", "--profile", PROFILE)):
            receiver.wait()
            receiver.run(self.warm_up_s)
            for _ in range(count):
                receiver.datagrams.clear()
                message = mavlink.MAVLink_command_long_message(1, 1, 512, 0, AUTOPILOT_VERSION, 0, 0, 0, 0, 0, 0)
                frame = message.pack(mav)
                sent = time.clock_gettime_ns(time.CLOCK_REALTIME)
                receiver.sock.sendto(frame, receiver.peer)
                while not (acks := [at for at, *_, message in receiver.frames() if message == COMMAND_ACK]):
                    receiver.wait(2)
                taken.append((acks[0] - sent) / 1e6)
                time.sleep(random.uniform(0, 0.02))
        receiver.close()
        taken.sort()
        p99 = taken[int(0.99 * count)]
        self.tell(f"command to acknowledgement, 99th percentile of {count}", p99, "ms", "1 at most", p99 <= 1,
                  f"median {taken[count // 2]:.3f} ms, highest {taken[-1]:.3f} ms")

    # ---- parameters

    @staticmethod
    def fetch(link, limit):
        """All parameters by pymavlink. Returns (values, seconds, whether all came)."""
        link.wait_heartbeat(timeout=10)
        link.mav.param_request_list_send(1, 1)
        names, total, began, ended = set(), None, time.monotonic(), 0
        while time.monotonic() - began < limit and (total is None or len(names) < total):
            message = link.recv_match(type="PARAM_VALUE", blocking=True, timeout=2)
            if message is None:
                break
            if message.param_index != 65535:
                names.add(message.param_index)
                total, ended = message.param_count, time.monotonic()
        return len(names), ended - began, total is not None and len(names) == total

    def parameters(self):
        port = free_port()
        link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}")
        with running(self.sim("--to", f"udpout://127.0.0.1:{port}", "--profile", PROFILE)):
            values, seconds, complete = self.fetch(link, 30)
        link.close()
        rate = values / seconds
        self.tell("all parameters by pymavlink, on loopback", rate, "values/s", "1000 at least",
                  complete and rate >= 1000, f"{values} values in {seconds:.2f} s{'' if complete else ', NOT all'}")

    def parameters_by_radio(self):
        """Over a pseudo-terminal whose far end reads no faster than 57,600 baud carry."""
        far, near = pty.openpty()
        tty.setraw(near)
        ours, theirs = socket.socketpair()
        over = threading.Event()

        def line():
            step_s, bytes_s, due = 0.01, 5760, time.monotonic()
            while not over.is_set():
                due += step_s
                time.sleep(max(0, due - time.monotonic()))
                with contextlib.suppress(OSError):
                    if select.select([far], [], [], 0)[0]:
                        theirs.sendall(os.read(far, int(bytes_s * step_s)))
                    if select.select([theirs], [], [], 0)[0]:
                        os.write(far, theirs.recv(int(bytes_s * step_s)))

        thread = threading.Thread(target=line, daemon=True)
        thread.start()
        link = mavutil.mavfile(ours.fileno(), "pty", source_system=255, source_component=190)
        heard = bytearray()
        link.recv = lambda n=None: self.read_some(ours, heard)
        link.write = ours.sendall
        with running(self.sim("--to", f"serial://{os.ttyname(near)}?baud=57600", "--profile", PROFILE)):
            values, seconds, complete = self.fetch(link, 120)
        over.set()
        thread.join()
        os.close(near)
        os.close(far)
        lost = gaps_in(frames_in(heard))
        self.lost += lost
        self.tell("all parameters by pymavlink, at 57,600 baud, lost", lost, "frames", "0", complete and lost == 0,
                  f"{values} values in {seconds:.1f} s{'' if complete else ', NOT all'}")

    @staticmethod
    def read_some(sock, heard):
        data = sock.recv(4096) if select.select([sock], [], [], 0.01)[0] else b""
        heard += data
        return data

    # ---- memory and start

    def memory(self):
        sizes = []
        for vehicles in (1, 51):
            receiver = Receiver()
            command = self.sim("--to", f"udpout://127.0.0.1:{receiver.port}", "--vehicles", str(vehicles))
            with running(command) as process:
                receiver.wait()
                receiver.run(self.warm_up_s)
                sizes.append(anonymous_kib(process.pid))
            receiver.close()
        each = (sizes[1] - sizes[0]) / 50
        self.tell("memory of one vehicle more", each, "KiB", "64 at most", each <= 64,
                  f"{sizes[0]} KiB with one vehicle")

    def start(self):
        taken = []
        for _ in range(5 if self.quick else 30):
            receiver = Receiver()
            began = time.clock_gettime_ns(time.CLOCK_REALTIME)
            with running(self.sim("--to", f"udpout://127.0.0.1:{receiver.port}")):
                receiver.wait()
            taken.append((receiver.datagrams[0][0] - began) / 1e6)
            assert next(receiver.frames())[4] == HEARTBEAT
            receiver.close()
        self.tell("start to first heartbeat, highest", max(taken), "ms", "50 at most", max(taken) <= 50,
                  f"median {statistics.median(taken):.1f} ms")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/mavloom")
    parser.add_argument("--tools", type=pathlib.Path, default=ROOT / "build/release/bench/bin")
    parser.add_argument("--rounds", type=int, default=7, help="turns of the CPU comparison")
    parser.add_argument("--only", default="", help="cpu, rates, acknowledgements, parameters, parameters_by_radio, "
                                                   "memory, start; separated by commas")
    parser.add_argument("--quick", action="store_true", help="short turns: checks that it works, not how fast it is")
    parser.add_argument("--json", action="store_true", help="print one JSON object per line")
    options = parser.parse_args()
    options.program, options.tools = options.program.resolve(), options.tools.resolve()
    bench = Bench(options)
    parts = [bench.cpu, bench.rates, bench.acknowledgements, bench.parameters, bench.parameters_by_radio, bench.memory,
             bench.start]
    wanted = options.only.split(",") if options.only else [part.__name__ for part in parts]
    for part in parts:
        if part.__name__ in wanted:
            part()
    return 4 if bench.lost else 0


if __name__ == "__main__":
    sys.exit(main())
