#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the benchmarks behind docs/performance.md, one after another: ./run bench
[parse|decode|python|listen|inside|shm|sim|hil|pipeline|route|websocket|hostile|web|page|top ...]. Most compare
Mavloom with another program. If one benchmark is named, options that this script does not know are passed to it:
./run bench route --quick"""
import argparse
import pathlib
import platform
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
FLIGHT = HERE.parent / "tests" / "data" / "px4_gcs_flight.tlog"


def commands(program, build):
    folder = pathlib.Path(build) / "bench" / "bin"
    return {
        "parse": [[folder / "parse_bench", FLIGHT, chunk] for chunk in ("4096", "65536", "256")],
        "decode": [[sys.executable, HERE / "decode.py", "--program", program]],
        "python": [[sys.executable, HERE / "python.py"]],
        "listen": [[sys.executable, HERE / "listen.py", "--program", program, "--load", folder / "load_bench"]],
        "inside": [[folder / "inside_bench", FLIGHT, frames] for frames in ("8", "1")],
        "shm": [[sys.executable, HERE / "shm.py", "--tools", folder]],
        "sim": [[program, "bench", "sim"], [program, "bench", "sim", "--fly", "--vehicles", "100", "--seconds", "10"],
                [sys.executable, HERE / "sim.py", "--program", program, "--tools", folder]],
        "hil": [[sys.executable, HERE / "hil.py", "--program", program, "--tools", folder]],
        "pipeline": [[sys.executable, HERE / "pipeline.py", "--program", program, "--tools", folder]],
        "route": [[sys.executable, HERE / "route.py", "--program", program, "--tools", folder]],
        "websocket": [[sys.executable, HERE / "websocket.py", "--program", program, "--tools", folder]],
        "web": [[sys.executable, HERE / "web.py", "--program", program]],
        "page": [[sys.executable, HERE / "page.py", "--program", program]],
        "top": [[sys.executable, HERE / "top.py", "--program", program, "--load", folder / "load_bench"]],
        "hostile": [[sys.executable, HERE / "hostile.py", "--program", program, "--tools", folder]],
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="build/release/bin/mavloom")
    parser.add_argument("--build", default="build/release")
    parser.add_argument("what", nargs="*", help="the benchmarks to run; default: all")
    options, more = parser.parse_known_args()
    if more and len(options.what) != 1:
        parser.error(f"{' '.join(more)}: for which benchmark?")
    table = commands(options.program, options.build)
    if unknown := set(options.what) - set(table):
        parser.error(f"no benchmark {', '.join(sorted(unknown))}; there are {', '.join(table)}")
    print(f"machine: {platform.processor() or platform.machine()}, Linux {platform.release()}", flush=True)
    status = 0
    for what in options.what or table:
        for command in table[what]:
            print(f"\n== {what}: {' '.join(str(part) for part in command[1:])}", flush=True)
            status = max(status, subprocess.run([str(part) for part in [*command, *more]]).returncode)
    return status


if __name__ == "__main__":
    sys.exit(main())
