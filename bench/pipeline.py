#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench pipeline: UDP in, ring, decode, re-encode, UDP out.

One process writes the ring, and `mavloom relay` reads it in another. The writer is `mavloom route --ring` in one run
and `python -m mavloom.hear` in the other. Every frame that arrives is compared with the frame that was sent. The exit
status
is 4 if a frame was lost or differs."""
import argparse
import json
import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "bench" / "route"))
import peers as routers  # noqa: E402
from measure import Kit, Load, measure  # noqa: E402


class Pipeline(routers.Mavloom):
    """The process that writes the ring. The relay runs beside it. The CPU figure is that of the writer only."""

    def __init__(self, program, name, writer):
        super().__init__(program, name)
        self.writer, self.ring, self.out_ports = writer, f"bench-{os.getpid()}", []

    def command(self, in_port, out_ports, folder):
        self.out_ports = out_ports
        return self.writer(self, f"udpin://127.0.0.1:{in_port}")

    def beside(self):
        return [[self.program, "relay", f"shm://{self.ring}", "--to", f"udpout://127.0.0.1:{self.out_ports[0]}"]]


def by_route(pipeline, source):
    return pipeline.route(source, "--ring", pipeline.ring)


def by_hear(pipeline, source):
    return [sys.executable, "-m", "mavloom.hear", source, "--ring", pipeline.ring]


PIPELINES = [("mavloom route --ring", by_route, 200_000), ("python -m mavloom.hear", by_hear, 100_000)]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/mavloom")
    parser.add_argument("--tools", type=pathlib.Path, default=ROOT / "build/release/bench/bin",
                        help="where route_generator and route_sink are")
    parser.add_argument("--flight", type=pathlib.Path, default=ROOT / "tests/data/px4_gcs_flight.tlog")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--json", action="store_true", help="print one JSON object per line")
    options = parser.parse_args()
    kit, failed = Kit(options.tools.resolve(), options.flight.resolve()), False
    for name, writer, rate in PIPELINES:
        for _ in range(options.rounds):
            got = measure(kit, Pipeline(options.program.resolve(), name, writer), Load("pipeline", name, rate),
                          options.seconds)
            wrong = sum(got[what] for what in ("lost", "damaged", "duplicates", "reordered"))
            failed = failed or bool(wrong)
            print(json.dumps(got) if options.json else
                  f"  {name:<24} sent {got['sent']:,} at {got['rate']:,.0f}/s, delivered {got['delivered']:,}; "
                  f"lost {got['lost']}, damaged {got['damaged']}, duplicates {got['duplicates']}, "
                  f"reordered {got['reordered']}; median {got['median_us']} us",
                  flush=True)
    return 4 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
