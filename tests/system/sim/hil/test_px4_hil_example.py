# SPDX-License-Identifier: MIT
"""examples/px4-hil.sh, with a stand-in in PX4's place."""
import os
import random
import signal
import socket
import sys

import pytest

import harness
from conftest import STAND_IN
from stations import mavlink


def is_free(port, kind):
    with socket.socket(socket.AF_INET, kind) as sock:
        if kind == socket.SOCK_STREAM:
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # a closed connection leaves its port busy
        try:
            sock.bind(("127.0.0.1", port))
            return True
        except OSError:
            return False


def free_instance():
    """An instance of PX4 whose ports are free. Each worker of pytest-xdist has its own share."""
    tcp, udp = socket.SOCK_STREAM, socket.SOCK_DGRAM
    bases = ((4560, tcp), (18570, udp), (5057, udp), (5760, tcp))
    return next(number for number in random.sample(range(20 + harness.WORKER % 8, 250, 8), 28)
                if all(is_free(base + number, kind) for base, kind in bases))


@pytest.fixture
def px4_folder(tmp_path):
    """A folder as PX4's, whose bin/px4 is the stand-in."""
    build = tmp_path / "PX4 Autopilot" / "build" / "px4_sitl_default"
    (build / "bin").mkdir(parents=True)
    (build / "etc").mkdir()
    px4 = build / "bin" / "px4"
    px4.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{STAND_IN}" "$@"\n')
    px4.chmod(0o755)
    return tmp_path / "PX4 Autopilot"


@pytest.fixture
def example(program, px4_folder):
    """example(PX4_WORK=...) -> the running script, PX4's instance and a ground station's socket."""
    running, sockets = [], []

    def start(folder=px4_folder, **variables):
        sockets.append(harness.udp_socket())
        instance = free_instance()
        environment = harness.environment({
            "MAVLOOM_PROGRAM": str(program), "PX4_INSTANCE": str(instance), "PX4_STAND_IN": '{"telemetry": true}',
            "GCS": f"127.0.0.1:{sockets[-1].getsockname()[1]}", **variables})
        running.append(harness.Running([harness.ROOT / "examples" / "px4-hil.sh", folder, "--speed", "max"],
                                       env=environment, start_new_session=True))
        return running[-1], instance, sockets[-1]
    yield start
    for one in running:
        if one.alive:
            os.killpg(one.pid, signal.SIGKILL)
    harness.end(running)
    for sock in sockets:
        sock.close()


def px4_of(script):
    """Processes of the stand-in below the script."""
    children = f"/proc/{script.pid}/task/{script.pid}/children"
    with open(children) as file:
        pids = file.read().split()
    lines = {pid: open(f"/proc/{pid}/cmdline").read() for pid in pids if os.path.exists(f"/proc/{pid}/cmdline")}
    return [int(pid) for pid, line in lines.items() if str(STAND_IN) in line]


def test_a_ground_station_sees_the_flight_and_ctrl_c_ends_all(example):
    script, instance, station = example()
    parser, heights, armed = mavlink.MAVLink(None), [0], []
    while True not in armed or armed[-1]:  # until it is disarmed again
        for message in parser.parse_buffer(station.recv(65536)) or ():
            if message.get_srcSystem() != instance + 1:
                continue
            if message.get_type() == "HEARTBEAT":
                armed.append(message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED != 0)
            else:
                heights.append(message.relative_alt / 1000)
    assert max(heights) == pytest.approx(5, abs=0.7) and heights[-1] == pytest.approx(0, abs=0.2)
    os.killpg(script.pid, signal.SIGINT)  # as a terminal does
    done = script.wait()
    assert done.status == 130 and "sets nothing" not in done.stderr, done
    assert is_free(4560 + instance, socket.SOCK_STREAM) and is_free(18570 + instance, socket.SOCK_DGRAM)


def test_all_ends_when_px4_ends(example):
    script, _, _ = example()
    script.wait_output('"stand_in": "first answer"')
    os.kill(px4_of(script)[0], signal.SIGKILL)
    assert script.wait().status == 137


def test_px4_does_not_start_when_the_simulator_cannot(example):
    script, instance, _ = example(PX4_SIM_SPEED_FACTOR="fast")
    done = script.wait()
    assert done.status == 3 and "PX4_SIM_SPEED_FACTOR" in done.stderr and "stand_in" not in done.stdout + done.stderr
    assert is_free(18570 + instance, socket.SOCK_DGRAM)


def test_the_work_folder_stays_where_it_is_asked_for(example, tmp_path):
    script, _, _ = example(PX4_WORK=os.path.relpath(tmp_path / "work"))
    script.wait_output('"stand_in": "first answer"')
    os.killpg(script.pid, signal.SIGINT)
    script.wait()
    assert (tmp_path / "work").is_dir()


def test_a_folder_without_px4_is_an_error(example, tmp_path):
    script, _, _ = example(folder=tmp_path)
    done = script.wait()
    assert done.status == 1 and "build/px4_sitl_default/bin/px4" in done.stderr


def test_an_instance_that_is_no_number_is_an_error(example):
    done = example(PX4_INSTANCE="second")[0].wait()
    assert done.status == 2 and "PX4_INSTANCE=second is not a number" in done.stderr, done
