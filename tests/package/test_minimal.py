# SPDX-License-Identifier: MIT
"""The small router of -DMAVLOOM_MINIMAL=ON: its size, its memory, and how it reports what it lacks. The tests in
tests/system/route also run with it, but for those that use other commands, WebSockets or the metrics."""
import json
import os
import re
import socket
import subprocess

import pytest
from test_package import ROOT, build_folder, call, frames

import harness

pytestmark = [pytest.mark.timeout(1800),
              pytest.mark.skipif("MAVLOOM_FULL" not in os.environ, reason="only .ci/run --full")]

LARGEST_BYTES = 1_500_000
LARGEST_ANONYMOUS_KIB = 2_000_000 // 1024
FRAMES = 20_000


@pytest.fixture(scope="module")
def minimal():
    with build_folder("minimal") as folder:
        call("cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DMAVLOOM_MINIMAL=ON", "-DCMAKE_UNITY_BUILD=ON",
             "-DCMAKE_UNITY_BUILD_BATCH_SIZE=12")
        call("cmake", "--build", folder, "--target", "mavloom_app")
    return folder / "bin" / "mavloom"


def test_it_is_small(minimal):
    assert minimal.stat().st_size < LARGEST_BYTES


def test_its_help_lists_only_what_it_has(minimal):
    text = call(minimal, "--help")
    assert re.findall(r"^  (\w+)  ", text, re.MULTILINE) == ["route", "ctl", "stat"]
    assert "tcpin://" in text and not re.search(r"ws(in|out)|listen", text)


def anonymous_kib(process):
    with open(f"/proc/{process.pid}/smaps_rollup") as file:
        return int(re.search(r"^Anonymous: +(\d+) kB", file.read(), re.MULTILINE)[1])


def read_bytes(sock, count):
    while count > 0:
        count -= len(sock.recv(65536))
    assert count == 0


def test_four_links_take_little_memory(minimal):
    """Two vehicles, a station by UDP and one by TCP, and more frames than the router remembers."""
    first, second, station = (harness.udp_socket() for _ in range(3))
    ports = [harness.free_port(socket.SOCK_DGRAM) for _ in range(2)]
    tcp = harness.free_port(socket.SOCK_STREAM)
    name = f"minimal-{os.getpid()}"
    router = harness.Running([minimal, "route", *(f"udpin://127.0.0.1:{port}" for port in ports),
                              f"udpout://127.0.0.1:{station.getsockname()[1]}", f"tcpin://127.0.0.1:{tcp}",
                              "--name", name], env=harness.environment())

    def links():
        lines = subprocess.run([minimal, "ctl", name, "links"], capture_output=True, text=True,
                               env=harness.environment()).stdout.splitlines()
        return [link for link in map(json.loads, lines) if link.get("up")]
    harness.wait_for(links, what="the control socket")
    with socket.create_connection(("127.0.0.1", tcp), harness.DEFAULT_TIMEOUT_S) as client:
        harness.wait_for(lambda: len(links()) == 2, what="the client")
        flight = list(frames.heartbeats(FRAMES))
        for begin in range(0, FRAMES, 100):
            for frame in flight[begin:begin + 100]:
                first.sendto(frame, ("127.0.0.1", ports[0]))
            for sock in (station, client):
                read_bytes(sock, sum(map(len, flight[begin:begin + 100])))
        second.sendto(next(frames.heartbeats(1, system=9)), ("127.0.0.1", ports[1]))
        harness.wait_for(lambda: len(links()) == 4, what="four links")
        used = anonymous_kib(router)
    assert router.stop().status == 130  # by the signal
    assert used < LARGEST_ANONYMOUS_KIB
    for sock in (first, second, station):
        sock.close()


@pytest.mark.parametrize(("arguments", "reason"), [
    (("route", "udpout://127.0.0.1:9", "--metrics", "127.0.0.1:0"), "built without them"),
    (("route", "wsout://127.0.0.1:9"), "no wsout links"), (("listen", "x.tlog"), "unknown command 'listen'")])
def test_it_reports_what_it_lacks(minimal, arguments, reason):
    done = subprocess.run([minimal, *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert (done.returncode, reason in done.stderr) == (2, True), done.stderr
