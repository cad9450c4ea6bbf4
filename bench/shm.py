#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench shm: compares the ring with Aeron IPC, iceoryx publish/subscribe, UDP on loopback, a bare copy from core to
core and a bare exchange of a cache line, in turns.

Every program compares each record with what was written. Ratios are within one round. Peers that are not installed are
left out and listed."""
import argparse
import contextlib
import json
import pathlib
import shutil
import signal
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FLIGHT = ROOT / "tests" / "data" / "px4_gcs_flight.tlog"
AERON_VERSION = "1.44.1"
AERON_WINDOW_MIB = 32  # how far its publication may be ahead of the readers: half a term buffer of 64 MiB
OURS = "mavloom"


class Missing(Exception):
    """A peer is not available on this machine; the text states why."""


def run(command, what=None):
    """Runs a program and returns its output. `what`: the program installs a peer, which is missing if this fails."""
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode == 0:
        return done.stdout
    why = (done.stderr or done.stdout).strip().splitlines()[-1:]
    if what:
        raise Missing(f"{what} failed: {why}")
    sys.exit(f"bench shm: {' '.join(str(part) for part in command)} ended with {done.returncode}: {why}")


def per_second(printed):
    records, seconds = printed.split()
    return int(records) / float(seconds)


# ---- who takes part: (readers, mode) -> records a second

class Program:
    """One of our own programs. `records` is that of the longest run; slow peers get fewer."""

    def __init__(self, tools, transport, records, *more):
        self.command, self.records, self.more = [tools / "shm_throughput", transport], records, more

    def __call__(self, readers, mode):
        return per_second(run([*self.command, readers, mode, self.records, *self.more]))


class Iceoryx:
    def __init__(self, tools, records):
        self.program, self.records = tools / "shm_iceoryx", records
        self.roudi = shutil.which("iox-roudi")
        if not self.program.exists() or not self.roudi:
            raise Missing("not installed (Debian: iceoryx, libiceoryx-posh-dev)")

    @contextlib.contextmanager
    def daemon(self):
        roudi = subprocess.Popen([self.roudi], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            for line in roudi.stdout:
                if "ready for clients" in line:
                    break
            yield
        finally:
            roudi.send_signal(signal.SIGTERM)
            roudi.communicate()

    def __call__(self, readers, mode):
        with self.daemon():
            return per_second(run([self.program, readers, mode, self.records]).splitlines()[-1])


class Aeron:
    def __init__(self, folder, records):
        self.records, self.java, folder = records, shutil.which("java"), folder / "aeron"
        jar, classes = folder / f"aeron-all-{AERON_VERSION}.jar", folder / "classes"
        if not self.java or not shutil.which("javac"):
            raise Missing("no Java to run it with (Debian: default-jdk-headless)")
        if not jar.exists():
            self.fetch(folder)
        run(["javac", "-cp", jar, "-d", classes, ROOT / "bench" / "shm" / "AeronIpc.java"], "javac")
        self.command = [self.java, "-cp", f"{classes}:{jar}", "--add-opens", "java.base/jdk.internal.misc=ALL-UNNAMED",
                        "--add-opens", "java.base/sun.nio.ch=ALL-UNNAMED", "AeronIpc"]

    @staticmethod
    def fetch(folder):
        if not shutil.which("mvn"):
            raise Missing("no Maven to fetch it with (Debian: maven)")
        print("bench shm: fetching Aeron", file=sys.stderr, flush=True)
        run(["mvn", "-q", "-B", "dependency:copy", f"-Dartifact=io.aeron:aeron-all:{AERON_VERSION}",
             f"-DoutputDirectory={folder}"], "mvn dependency:copy")

    def __call__(self, readers, mode):
        return per_second(run([*self.command, mode, readers, self.records]).splitlines()[-1])


class Latency:
    """Median and 99.9th percentile in ns."""

    def __init__(self, tools, way, rounds):
        self.command = [tools / "shm_latency", way, rounds]

    def __call__(self):
        return [int(word) for word in run(self.command).split()]


# ---- what is measured

def throughputs(tools, folder, scale, without, missing):
    """[(title, us, name of the peer, peer, readers, mode, target)]"""
    ring = Program(tools, "ring", 20_000_000 // scale)
    peers = {"UDP on loopback": lambda: Program(tools, "udp", 600_000 // scale),
             "Aeron IPC": lambda: Aeron(folder, 20_000_000 // scale),
             "iceoryx": lambda: Iceoryx(tools, 1_000_000 // scale)}
    at_hand = {}
    for name, make in peers.items():
        if name.split()[0].lower() in without:
            continue
        try:
            at_hand[name] = make()
        except Missing as why:
            missing.append(f"{name} is left out: {why}")
    as_aeron = Program(tools, f"ring{AERON_WINDOW_MIB}", 20_000_000 // scale)
    aeron = [(us, readers, mode, "Aeron IPC", 1.5) for us in (as_aeron, ring) for readers in (1, 3)
             for mode in ("threads", "processes")]
    wanted = [*aeron, (ring, 3, "processes", "iceoryx", 40), (ring, 3, "processes", "UDP on loopback", 50)]
    rows = []
    for us, readers, mode, name, target in wanted:
        if name in at_hand:
            size_mib = AERON_WINDOW_MIB if us is as_aeron else 8
            title = f"64 bytes, {readers} reader{'s' * (readers > 1)}, {mode}, {size_mib} MiB"
            rows.append((title, us, name, at_hand[name], readers, mode, target))
    mixed = [Program(tools, transport, 20_000_000 // scale, FLIGHT) for transport in ("ring", "bare")]
    return [*rows, ("recorded mix, 1 reader, threads", mixed[0], "bare copy", mixed[1], 1, "threads", 0.8)]


def spread(values, form=".2f"):
    return f"{statistics.median(values):{form}} ({min(values):{form}}, {max(values):{form}})"


class Bench:
    def __init__(self, options):
        self.rounds, self.as_json = options.rounds, options.json

    def tell(self, title, peer, ours, theirs, target, at_most=False, unit="M/s"):
        """Prints one row. A ratio above the target meets it, or below it with `at_most`. No target: no verdict."""
        ratios = [a / b for a, b in zip(ours, theirs)]
        us, them, ratio = statistics.median(ours), statistics.median(theirs), statistics.median(ratios)
        met = None if target is None else ratio <= target if at_most else ratio >= target
        goal = "" if met is None else f"target {target}{' at most' if at_most else ''}: {'met' if met else 'missed'}"
        if self.as_json:
            print(json.dumps({"bench": f"shm {title}", "peer": peer, "unit": unit, OURS: us, "theirs": them,
                              "ratio": ratio, "lowest": min(ratios), "highest": max(ratios), "target": target,
                              "met": met}), flush=True)
        else:
            print(f"  {title:<42} {OURS} {us:8.2f}   {peer:<16} {them:8.2f} {unit:<4} ratio {spread(ratios):<22} "
                  f"{goal}", flush=True)

    def throughput(self, title, us, name, peer, readers, mode, target):
        ours, theirs = [], []
        for number in range(self.rounds):
            for side, taken in ((us, ours), (peer, theirs))[::1 if number % 2 else -1]:
                taken.append(side(readers, mode) / 1e6)
        self.tell(title, name, ours, theirs, target)

    def latency(self, title, us, name, peer, target):
        """Runs more and shorter turns than the other measurements, because tail latency varies quickly."""
        ours, theirs = zip(*((us(), peer()) for _ in range(3 * self.rounds)))
        for index, what in enumerate(("median", "99.9th percentile")):
            self.tell(f"{title}, {what}", name, [value[index] for value in ours], [value[index] for value in theirs],
                      target, at_most=True, unit="ns")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tools", type=pathlib.Path, default=ROOT / "build/release/bench/bin",
                        help="folder of shm_throughput and the other tools")
    parser.add_argument("--peers", type=pathlib.Path, default=ROOT / "build/peers",
                        help="folder in which Aeron is installed")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--quick", action="store_true",
                        help="one round with a fiftieth of the records: checks that it works, not how fast it is")
    parser.add_argument("--without", default="", help="peers to leave out: aeron,iceoryx,udp")
    parser.add_argument("--json", action="store_true", help="print one JSON object per line")
    options = parser.parse_args()
    options.tools, missing = options.tools.resolve(), []
    scale = 50 if options.quick else 1
    if options.quick:
        options.rounds = 1
    rows = throughputs(options.tools, options.peers.resolve(), scale, options.without.split(","), missing)
    run([options.tools / "shm_throughput", "ring", 1, "threads", 200_000, FLIGHT, "verify"])
    bench = Bench(options)
    print(f"shm: {options.rounds} rounds; every record was compared", file=sys.stderr, flush=True)
    for row in rows:
        bench.throughput(*row)
    bench.latency("hand-over, spinning", Latency(options.tools, "ring", 300_000 // scale), "cache line",
                  Latency(options.tools, "line", 300_000 // scale), 3)
    bench.latency("hand-over, futex", Latency(options.tools, "futex", 50_000 // scale), "pipe",
                  Latency(options.tools, "pipe", 50_000 // scale), None)
    for line in missing:
        print(f"  {line}", file=sys.stderr)


if __name__ == "__main__":
    main()
