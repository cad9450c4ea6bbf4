#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench websocket: datagrams of 8 frames go by UDP to one process, through a WebSocket to another, and on by UDP.

Mavloom's wsout and wsin are compared with its own tcpout and tcpin, and with Python's websockets, in turns, on the same
frames. CPU is that of both processes per frame, with their UDP sides. Every frame that arrives is compared with the one
that was sent. The exit status is 4 if mavloom lost a frame."""
import argparse
import json
import pathlib
import statistics
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "bench" / "route"))
import peers as routers  # noqa: E402
from measure import Kit, Load, free_port, measure  # noqa: E402


class Pair(routers.Mavloom):
    """Two routers with a link between them."""
    counts_beside = True

    def __init__(self, program, calling, listening):
        super().__init__(program, f"{calling} to {listening}")
        self.calling, self.listening = calling, listening

    def command(self, in_port, out_ports, folder):
        self.out_port, self.between = out_ports[0], free_port()
        return [self.program, "route", "--name", f"{self.calling}-bench", f"udpin://127.0.0.1:{in_port}",
                f"{self.calling}://127.0.0.1:{self.between}"]

    def beside(self):
        return [[self.program, "route", "--name", f"{self.listening}-bench",
                 f"{self.listening}://127.0.0.1:{self.between}", f"udpout://127.0.0.1:{self.out_port}"]]


class PythonPair(routers.Peer):
    counts_beside = True
    script = ROOT / "bench/route/websockets_pair.py"

    def command(self, in_port, out_ports, folder):
        self.out_port, self.between = out_ports[0], free_port()
        return [sys.executable, self.script, "in", in_port, self.between]

    def beside(self):
        return [[sys.executable, self.script, "out", self.between, self.out_port]]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/mavloom")
    parser.add_argument("--tools", type=pathlib.Path, default=ROOT / "build/release/bench/bin",
                        help="where route_generator and route_sink are")
    parser.add_argument("--flight", type=pathlib.Path, default=ROOT / "tests/data/px4_gcs_flight.tlog")
    parser.add_argument("--rate", type=int, default=16_000, help="frames a second")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--json", action="store_true", help="print one JSON object per line")
    options = parser.parse_args()
    kit, program = Kit(options.tools.resolve(), options.flight.resolve()), options.program.resolve()
    pairs = [Pair(program, "wsout", "wsin"), Pair(program, "tcpout", "tcpin"), PythonPair("Python's websockets")]
    load = Load("websocket", "8 frames a message", options.rate, per_datagram=8)
    costs, failed = {pair.name: [] for pair in pairs}, False
    for _ in range(options.rounds):
        for pair in pairs:
            got = measure(kit, pair, load, options.seconds)
            costs[pair.name].append(got["cpu_us_per_frame"])
            failed = failed or (got["lost"] != 0 and isinstance(pair, Pair))
            print(json.dumps(got) if options.json else
                  f"{pair.name:20} {got['cpu_us_per_frame']:8.3f} us a frame, {got['lost']} lost of {got['expected']}",
                  flush=True)
    if not options.json:
        middle = {name: statistics.median(values) for name, values in costs.items()}
        ours = middle[pairs[0].name]
        for name, value in middle.items():
            print(f"{name:20} median {value:8.3f} us a frame, {ours / value:.3f} of it for {pairs[0].name}")
    return 4 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
