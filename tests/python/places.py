# SPDX-License-Identifier: MIT
"""Where things are, and which ports are free."""
import itertools
import os
import pathlib
import random
import socket

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / os.environ.get("MAVLOOM_PROGRAM", "build/release/bin/mavloom")
PACKAGE = PROGRAM.parent.parent / "python"  # of the same build

# Below those that the kernel gives to sockets that ask for any, and below those of the system tests. Each worker of
# pytest-xdist has its own share.
_worker = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0")[2:])
_ports = itertools.cycle(random.sample(range(10_000 + _worker % 8, 20_000, 8), 1000))


def free_port(kind=socket.SOCK_DGRAM):
    """A port that was free a moment ago, and is not given again before all others were."""
    for port in _ports:
        with socket.socket(socket.AF_INET, kind) as one:
            try:
                one.bind(("127.0.0.1", port))
                return port
            except OSError:
                pass
