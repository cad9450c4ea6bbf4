# SPDX-License-Identifier: MIT
"""docs/guide/recipes.md: the programs on the page are run as written, but for their ports. test_docs.py runs its
commands."""
import os
import re
import shlex
import shutil
import socket
import subprocess
import sys
import urllib.request

import frames
import harness
import netns
import pytest
from frames import mavlink

PAGE = (harness.ROOT / "docs" / "guide" / "recipes.md").read_text()


def file_of(name):
    """The block that begins with the name of a file."""
    return re.search(rf"```\w+\n(# {re.escape(name)}\n.*?)```", PAGE, re.DOTALL)[1]


def environment(program, tmp_path):
    """With the package of the build, as an installed wheel would give it, and the program in PATH."""
    package = os.environ.get("PYTHONPATH", str(program.parent.parent / "python"))
    return {**os.environ, "PYTHONPATH": package, "PATH": f"{program.parent}:{os.environ['PATH']}",
            "MAVLOOM_RUN": str(tmp_path)}


@pytest.mark.unsanitized
def test_the_script_for_mavsdk_takes_off(spawn, program, udp_port, tmp_path):
    pytest.importorskip("mavsdk")
    port = udp_port()
    spawn("sim", "--to", f"udpout://127.0.0.1:{port}", "--name", f"recipe-{port}", "--seed", "1")
    script = file_of("takeoff.py").replace("14540", str(port))
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120,
                          env=environment(program, tmp_path))
    if "cannot open shared object" in done.stderr or "GLIBC" in done.stderr:
        pytest.skip("MAVSDK's library does not load here")
    assert done.returncode == 0 and re.search(r"^at [45]\.\d m$", done.stdout, re.MULTILINE), done


@pytest.mark.unsanitized
def test_the_pytest_fixture_flies_a_vehicle(program, tmp_path):
    for name in ("conftest.py", "test_flight.py"):
        (tmp_path / name).write_text(file_of(name))
    done = subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(tmp_path)], timeout=120,
                          cwd=tmp_path, capture_output=True, text=True, env=environment(program, tmp_path))
    assert done.returncode == 0 and "1 passed" in done.stdout, done


def test_each_series_of_the_queries_exists(spawn, udp_port, udp_socket):
    names = set(re.findall(r"\bmavloom_\w+", PAGE))
    assert len(names) >= 6
    port = udp_port()
    router = spawn("route", f"udpin://127.0.0.1:{port}", "--name", f"recipe-{port}", "--metrics", "127.0.0.1:0")
    metrics = router.wait_output(r"metrics on port (\d+)")[1]
    udp_socket().sendto(next(frames.heartbeats(1)), ("127.0.0.1", port))
    router.wait_output(r": up")

    def text():
        with urllib.request.urlopen(f"http://127.0.0.1:{metrics}/metrics", timeout=10) as answer:
            return answer.read().decode()
    harness.wait_for(lambda: "mavloom_system_frames_total{" in text(), what="the vehicle's series")
    assert names <= set(re.findall(r"^(mavloom_\w+)\{", text(), re.MULTILINE))


# ---- LTE: the vehicle's machine and the server, with a slow line between them ----------------------------------------

def commands_of(title):
    section = PAGE.split(f"\n## {title}\n")[1].split("\n## ")[0]
    return [shlex.split(line)[1:] for line in re.findall(r"^mavloom .*", section, re.MULTILINE)]


@pytest.fixture
def machines():
    yield from netns.two_machines()


class Lte:
    """The commands of the page, but for the serial port: a simulated vehicle takes its place."""

    def __init__(self, program, spawn, machines, folder):
        self.vehicle, self.server = machines
        key, at_vehicle, at_server, _ = commands_of("LTE")
        spawn(*key, cwd=folder).wait()
        if not shutil.which("tc"):
            pytest.skip("tc is missing")
        line = ["tc", "qdisc", "add", "dev", self.vehicle.interface, "root", "tbf", "rate", "200kbit", "burst", "3000",
                "latency", "2s"]
        subprocess.run(self.vehicle.command(*line), check=True)
        self.programs = []
        self.start(self.server, program, folder, *at_server, "--name", f"lte-server-{os.getpid()}")
        at_vehicle = [word.replace("serial:///dev/ttyAMA0?baud=921600", "udpin://127.0.0.1:14999")
                      .replace("203.0.113.5", self.server.host) for word in at_vehicle]
        self.start(self.vehicle, program, folder, *at_vehicle, "--name", f"lte-vehicle-{os.getpid()}")
        self.start(self.vehicle, program, folder, "sim", "--to", "udpout://127.0.0.1:14999", "--name",
                   f"lte-sim-{os.getpid()}")

    def start(self, machine, program, folder, *command):
        self.programs.append(harness.Running(machine.command(program, *command), env=harness.environment(), cwd=folder))

    def station(self):
        """A ground station at the server."""
        def connect():
            sock = self.server.socket(kind=socket.SOCK_STREAM)
            if sock.connect_ex(("127.0.0.1", 5760)) == 0:
                return sock
            sock.close()
            return None
        return harness.wait_for(connect, what="the server's TCP port")


@pytest.fixture
def lte(program, spawn, machines, tmp_path):
    made = Lte(program, spawn, machines, tmp_path)
    yield made
    harness.end(made.programs)


def test_a_station_flies_over_lte_and_a_stranger_is_not_heard(lte):
    station, parser = lte.station(), mavlink.MAVLink(None)
    parser.robust_parsing = True
    heard = []

    def hear(wanted):
        def look():
            heard.extend(parser.parse_buffer(station.recv(65536)) or [])
            return next((one for one in heard if wanted(one)), None)
        return harness.wait_for(look, what="a message")

    def is_answer(one):
        return one.get_type() == "COMMAND_ACK" and one.command == mavlink.MAV_CMD_REQUEST_MESSAGE

    hear(lambda one: one.get_type() == "HEARTBEAT")
    with lte.vehicle.socket() as stranger:
        for frame in frames.heartbeats(20, system=9):
            stranger.sendto(frame, (lte.server.host, 14560))
    asked = mavlink.MAVLink_command_long_message(1, 1, mavlink.MAV_CMD_REQUEST_MESSAGE, 0, 148, 0, 0, 0, 0, 0, 0)
    station.sendall(bytes(asked.pack(frames.sender(255, 190))))
    assert hear(is_answer).result == mavlink.MAV_RESULT_ACCEPTED
    first = hear(lambda one: one.get_type() == "ATTITUDE").time_boot_ms
    hear(lambda one: one.get_type() == "ATTITUDE" and one.time_boot_ms > first + 3000)
    station.close()
    attitudes = [one.time_boot_ms for one in heard if one.get_type() == "ATTITUDE"]
    seconds = (attitudes[-1] - attitudes[0]) / 1000  # of the vehicle's clock
    assert len(attitudes) <= 1.1 * 10 * seconds + 2, "max_rate=*:10"
    assert not any(one.get_srcSystem() == 9 for one in heard)
