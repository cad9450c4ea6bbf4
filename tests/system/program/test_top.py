# SPDX-License-Identifier: MIT
"""`mavloom top` in tmux, on a recorded flight and on a simulated vehicle; and its views printed once."""
import json
import os
import re
import subprocess
import sys

import frames
import harness
import netns
import pytest
import terminals


@pytest.fixture
def tmux(tmp_path, program):
    with terminals.opened(tmp_path, program, "top") as start:
        yield start


def test_a_vehicle_is_searched_opened_and_left(tmux, spawn, udp_port):
    port = udp_port()
    spawn("sim", "--to", f"udpout://127.0.0.1:{port}", "--name", f"top-{os.getpid()}")
    terminal = tmux(f"udpin://127.0.0.1:{port}")
    terminal.wait_for(r"ATTITUDE +\d")
    terminal.type("/")
    terminal.type("-l", "global_pos")
    terminal.wait_for(r"GLOBAL_POSITION_INT +\d")
    harness.wait_for(lambda: "ATTITUDE" not in terminal.shown(), what="only what was searched")
    terminal.type("Enter")
    terminal.type("Enter")
    terminal.wait_for(r"relative_alt")
    terminal.type("Escape")
    terminal.type("2")
    terminal.wait_for(r"quadrotor +Hold")
    terminal.type("3")
    terminal.wait_for(f"udpin://127.0.0.1:{port}")
    terminal.type("q")
    terminal.wait_for("^ended with 0\n *icanon")


def test_a_message_gets_another_rate_and_routes_are_shown(tmux, spawn, run, udp_port):
    """The question goes by the ring's inlet and the router to the simulator, the answer comes back."""
    port, name = udp_port(), f"top-rate-{os.getpid()}"
    spawn("route", f"udpin://127.0.0.1:{port}", "--ring", name, "--name", name)
    sim = f"{name}-sim"
    spawn("sim", "--to", f"udpout://127.0.0.1:{port}", "--name", sim)
    terminal = tmux(f"shm://{name}", "--only", "ATTITUDE")
    terminal.wait_for(r"ATTITUDE +\d")
    terminal.type("Down")
    terminal.type("-l", "i4")
    terminal.wait_for(r"rate: 4_ Hz ATTITUDE from 1/1")
    terminal.type("Enter")
    terminal.wait_for(r"ATTITUDE from 1/1: accepted")
    streams = [json.loads(line) for line in run("ctl", sim, "streams").stdout.splitlines()]
    assert [one["asked_hz"] for one in streams if one.get("name") == "ATTITUDE"] == [4], streams
    terminal.type("4")
    terminal.wait_for(rf"1/1 +{name[:10]}.*udpin://127.0.0.1")


@pytest.mark.parametrize("number", ["TERM", "HUP"])
def test_a_signal_gives_the_terminal_back(tmux, spawn, number):
    terminal = tmux(frames.FLIGHT)
    terminal.wait_for(r"ATTITUDE +\d")
    pane = terminal.call("display-message", "-p", "#{pane_pid}").strip()
    subprocess.run(["pkill", f"-{number}", "-P", pane, "mavloom"], check=True)
    terminal.wait_for(r"^ended with \d+\n *icanon")


@pytest.mark.parametrize("columns, lines", [(5, 5), (40, 10), (200, 60)])
def test_each_size_shows_what_fits(tmux, columns, lines):
    of_another_terminal = ("COLUMNS", "80"), ("LINES", "24")
    terminal = tmux(frames.FLIGHT, columns=columns, lines=lines, env=[("NO_COLOR", "1"), *of_another_terminal])
    terminal.wait_for("1/1 quadrotor" if columns > 5 else r"\S")
    terminal.type("q")
    terminal.wait_for("(?<!-)icano")  # five cells of a line


def test_a_terminal_that_changes_its_size(tmux):
    terminal = tmux(frames.FLIGHT, columns=120, lines=30)
    terminal.wait_for(r"ATTITUDE +\d")
    terminal.call("resize-window", "-x", "50", "-y", "12")
    terminal.wait_for(r"ATTITUDE +\d")
    assert max(map(len, terminal.shown().splitlines())) <= 50


def test_a_recording_is_halted_and_moved_in(tmux):
    terminal = tmux(frames.FLIGHT)
    terminal.wait_for(r"ATTITUDE +\d")
    terminal.type("$")
    terminal.wait_for(r"1/1 quadrotor")
    terminal.type("0")
    terminal.wait_for(r"00:0\d")
    terminal.type("q")
    terminal.wait_for("^ended with 0")


def test_once_prints_the_views(run):
    done = run("top", frames.FLIGHT, "--once", env={"COLUMNS": "120"})
    assert done.status == 0 and re.search(r"1/1.*quadrotor.*px4", done.stdout), done
    sent = sum(1 for _, frame in frames.read_tlog(frames.FLIGHT) if frame[0] == 0xFD and frame[7:10] == b"\x1e\0\0")
    assert re.search(rf"^   ATTITUDE  .* kB +{sent} ", done.stdout, re.MULTILINE), (sent, done)
    assert "\x1b" not in done.stdout


def test_no_terminal_prints_once_and_states_why(run):
    done = run("top", frames.FLIGHT, env={"TERM": "dumb"})
    assert done.status == 0 and "as with --once" in done.stderr and "ATTITUDE" in done.stdout


def test_a_large_file_without_a_record_is_refused(run, tmp_path):
    with (tmp_path / "zeros.tlog").open("wb") as zeros:
        zeros.truncate(64 << 20)
    done = run("top", tmp_path / "zeros.tlog", "--once")
    assert done.status == 3 and "none of its first " in done.stderr, done


# A machine of its own, as far as top looks: no ring, free ports, and these devices.
ALONE = """
mount -t tmpfs none /dev && mkdir /dev/shm && mknod -m 666 /dev/null c 1 3 && mknod -m 666 /dev/urandom c 1 9
touch /dev/ttyUSB0 /dev/ttyACM1 /dev/ttyS0
"""


@pytest.fixture
def alone(tmp_path):
    """A script in which `more` runs as on a machine without rings and with two serial ports."""
    def script(*commands):
        path = tmp_path / f"alone{len(commands)}.sh"
        path.write_text(ALONE + "\n".join(commands) + "\n")
        return ["unshare", "-mn", "sh", "-e", str(path)]
    if os.geteuid() != 0 or subprocess.run(["unshare", "-mn", "true"], capture_output=True, check=False).returncode:
        pytest.skip("this needs root and namespaces of its own")
    return script


def test_without_sources_and_rings_serial_ports_are_named(alone, program, tmp_path):
    done = subprocess.run(alone(f"{program} top --once --for 200ms", "mkdir -p /dev/serial/by-id",
                                "touch /dev/serial/by-id/usb-Pixhawk-if00", f"{program} doctor --for 200ms || true"),
                          capture_output=True, text=True, check=True, timeout=harness.DEFAULT_TIMEOUT_S,
                          env=harness.environment({"MAVLOOM_RUN": str(tmp_path)}))
    hints = [line for line in done.stderr.splitlines() if "a vehicle may be at" in line]
    assert hints == ["mavloom: a vehicle may be at /dev/ttyACM1, /dev/ttyUSB0: to read it, name the source "
                     "'serial:///dev/ttyACM1?baud=57600'",
                     "mavloom: a vehicle may be at /dev/serial/by-id/usb-Pixhawk-if00: to read it, name the source "
                     "'serial:///dev/serial/by-id/usb-Pixhawk-if00?baud=57600'"], done


# The ports of argv[2:] are taken, as by a ground station. Prints what `top` shows beside a simulator without a ring.
PORTS_TAKEN = r"""
import json, socket, subprocess, sys, time
program, ports = sys.argv[1], [int(port) for port in sys.argv[2:]]
taken = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for port in ports]
for sock, port in zip(taken, ports):
    sock.bind(("0.0.0.0", port))
sim = subprocess.Popen([program, "sim", "--to", "udpout://127.0.0.1:14540", "--name", "top-sim"],
                       stderr=subprocess.PIPE, text=True)
ready = [program, "ctl", "top-sim", "wait", "ready"]
while sim.poll() is None and subprocess.run(ready, capture_output=True).returncode:
    time.sleep(0.1)
done = subprocess.run([program, "top", "--once", "--for", "3s"], capture_output=True, text=True)
sim.terminate()
sim.communicate()
print(json.dumps([done.returncode, done.stdout, done.stderr]))
"""


@pytest.mark.parametrize("ports, shown, said", [
    ([14550], r"^   ATTITUDE +\d", r"in use by .* \(process \d+\); listening on udpin://0.0.0.0:14540$"),
    ([14550, 14540], r"^   udpout://127.0.0.1:14540 +[\d.-]+ +[\d.-]+ +0 +[1-9]", r"in use by .* \(process \d+\)$")])
def test_beside_a_ground_station_the_other_port_and_counters_are_shown(program, tmp_path, ports, shown, said):
    done = netns.alone(tmp_path, sys.executable, "-c", PORTS_TAKEN, program, *map(str, ports))
    status, out, log = json.loads(done.stdout)
    assert status == 0 and re.search(shown, out, re.MULTILINE), (out, log)
    assert re.search(said, log, re.MULTILINE), log


@pytest.mark.parametrize("columns, lines", [(100, 26), (80, 24), (40, 10)])
def test_an_empty_screen_names_the_serial_ports(alone, program, tmp_path, columns, lines):
    with terminals.opened(tmp_path, *alone(f"MAVLOOM_RUN={tmp_path} exec {program} top")[:2]) as start:
        terminal = start(*alone(f"MAVLOOM_RUN={tmp_path} exec {program} top")[2:], columns=columns, lines=lines)
        terminal.wait_for(r"nothing to show")
        shown = re.sub(r"\s+", " ", terminal.shown())
        assert "a vehicle may be at /dev/ttyACM1, /dev/ttyUSB0: to read it, name the source" in shown, terminal.shown()
        terminal.type("q")
        terminal.wait_for("^ended with 0")


def test_an_empty_screen_names_the_program_that_has_the_usual_port(alone, program, tmp_path):
    keep = "import socket, time; s = socket.socket(2, 2); s.bind(('0.0.0.0', 14550)); time.sleep(600)"
    command = alone(f'{sys.executable} -c "{keep}" & keeper=$!; trap "kill $keeper" EXIT',
                    "until grep -q :38D6 /proc/net/udp; do sleep 0.1; done", f"MAVLOOM_RUN={tmp_path} {program} top")
    with terminals.opened(tmp_path, *command[:2]) as start:
        terminal = start(*command[2:])
        terminal.wait_for(r"nothing to show")
        shown = re.sub(r"\s+", " ", terminal.shown())
        assert re.search(r"UDP 0.0.0.0:14550: Address already in use by \w+.* \(process \d+\)", shown), shown
        assert "reading udpin://0.0.0.0:14540" in shown, shown
        terminal.type("q")
        terminal.wait_for("^ended with 0")
