# SPDX-License-Identifier: MIT
"""The instruments of `bench` themselves. Of `bench route`: a router that loses, damages and repeats frames in known
numbers is reported with these numbers. Nothing here asserts a time."""
import json
import os
import pathlib
import subprocess
import sys

import pytest

import harness

sys.path.insert(0, str(harness.ROOT / "bench" / "route"))
import measure  # noqa: E402
import peers  # noqa: E402

# Forwards to the ports given, or without any between all its peers. Counts the load's datagrams, not the heartbeats (id
# 0) that find out whether it is up.
FAULTY_ROUTER = """
import socket, sys
sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8 << 20)
sock.bind(("127.0.0.1", int(sys.argv[1])))
fixed = [("127.0.0.1", int(port)) for port in sys.argv[2:]]
peers, number = {}, 0
while True:
    data, sender = sock.recvfrom(65536)
    peers[sender] = True
    copies = 1
    if data[7]:
        copies = 0 if number % 10 == 9 else 2 if number % 50 == 25 else 1
        if number % 100 == 0:
            data = data[:20] + bytes([data[20] ^ 1]) + data[21:]
        number += 1
    for to in fixed or [peer for peer in peers if peer != sender]:
        for _ in range(copies):
            sock.sendto(data, to)
"""


class FaultyRouter(peers.Peer):
    def command(self, in_port, out_ports, folder):
        return [sys.executable, "-c", FAULTY_ROUTER, in_port, *out_ports]


@pytest.fixture
def kit(program):
    return measure.Kit(program.resolve().parents[1] / "bench" / "bin", harness.DATA / "px4_gcs_flight.tlog")


@pytest.mark.parametrize("outs, copies", [(1, 1), (2, 2), (0, 3)])
def test_reports_what_a_router_loses_damages_and_repeats(kit, outs, copies):
    links, systems = (1, 1) if outs else (4, 5)
    load = measure.Load("faulty", "", 1000, outs=outs, links=links, systems=systems, components=2)
    result = measure.measure(kit, FaultyRouter("faulty"), load, 1)
    assert (result["sent"], result["expected"]) == (1000, 1000 * copies)
    assert result["lost"] == (100 + 10) * copies  # dropped, and damaged
    assert (result["damaged"], result["duplicates"]) == (10 * copies, 20 * copies)
    assert (result["delivered"], result["echoes"], result["foreign"]) == (890 * copies, 0, 0)


@pytest.mark.parametrize("mode, per_datagram", [("single", 1), ("gather", 1), ("single", 8)])
def test_the_bare_loop_delivers_all(kit, mode, per_datagram):
    load = measure.Load("bare", "", 2000, per_datagram=per_datagram, outs=2)
    result = measure.measure(kit, peers.BareLoop("bare loop", pathlib.Path(kit.tools, "route_bare_loop"), mode), load,
                             1)
    assert (result["sent"], result["delivered"], result["lost"]) == (2000, 4000, 0)
    assert (result["damaged"], result["duplicates"], result["reordered"], result["foreign"]) == (0, 0, 0, 0)
    assert result["cpu_us_per_frame"] > 0


def test_a_router_that_does_not_run_is_named(kit):
    class Broken(peers.Peer):
        def command(self, in_port, out_ports, folder):
            return ["sh", "-c", "echo no such option >&2; exit 2"]
    with pytest.raises(measure.NoAnswer, match="broken: status 2; it said: 'no such option'"):
        measure.measure(kit, Broken("broken"), measure.Load("none", "", 1000), 1)


def test_every_part_of_bench_shm_gives_its_row(kit):
    done = subprocess.run([sys.executable, harness.ROOT / "bench" / "shm.py", "--tools", kit.tools, "--quick", "--json",
                           "--without", "aeron,iceoryx"],
                          capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    rows = [json.loads(line) for line in done.stdout.splitlines()]
    assert {row["peer"] for row in rows} == {"UDP on loopback", "bare copy", "cache line", "pipe"}
    assert all(row["mavloom"] > 0 and row["theirs"] > 0 for row in rows)


def test_every_byte_of_the_recorded_mix_comes_through(kit):
    for mode in ("threads", "processes"):
        done = subprocess.run([kit.tools / "shm_throughput", "ring", "3", mode, "50000", kit.flight, "verify"],
                              capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, done.stderr
        assert done.stdout.split()[0] == "50000"


def test_every_part_of_bench_sim_gives_its_rows(kit, program):
    done = subprocess.run([sys.executable, harness.ROOT / "bench" / "sim.py", "--program", program, "--tools",
                           kit.tools, "--quick", "--json"], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    rows = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(rows) == 8 and all(row["value"] >= 0 for row in rows), rows
    assert next(row for row in rows if "lost" in row["bench"])["value"] == 0


# Stands in for `mavloom sim` and loses every 50th datagram on the way to the port of its options.
LOSSY_SIMULATOR = """#!{python}
import re, select, signal, socket, subprocess, sys
sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
sock.bind(("127.0.0.1", 0))
words = " ".join(sys.argv[1:])
port = int(re.search(r"udpout://127.0.0.1:(\\d+)", words)[1])
real = subprocess.Popen(["{program}", *words.replace(str(port), str(sock.getsockname()[1])).split()])
signal.signal(signal.SIGTERM, lambda *_: real.terminate())
number = 0
while real.poll() is None:
    if not select.select([sock], [], [], 0.1)[0]:
        continue
    data, _ = sock.recvfrom(65536)
    number += 1
    if number % 50:
        sock.sendto(data, ("127.0.0.1", port))
"""


def test_bench_sim_reports_frames_that_are_missing(kit, program, tmp_path):
    lossy = tmp_path / "mavloom"
    lossy.write_text(LOSSY_SIMULATOR.format(python=sys.executable, program=program))
    lossy.chmod(0o755)
    done = subprocess.run([sys.executable, harness.ROOT / "bench" / "sim.py", "--program", lossy, "--tools", kit.tools,
                           "--quick", "--json", "--only", "rates"], capture_output=True, text=True, timeout=120)

    assert done.returncode == 4 and "frames are missing" in done.stderr, done


@pytest.mark.skipif(os.geteuid() != 0, reason="bench hostile needs root")
def test_bench_hostile_gives_its_rows(program):
    tools = program.resolve().parents[1] / "tests" / "bin"
    done = subprocess.run([sys.executable, harness.ROOT / "bench" / "hostile.py", "--program", program, "--tools",
                           tools, "--quick", "--json", "--attacks", "refuse"],
                          capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    rows = [json.loads(line) for line in done.stdout.splitlines()]
    assert [(row["attack"], row["lost"]) for row in rows] == [("refuse", 0)]
    assert rows[0]["flood_per_s"] > 0
