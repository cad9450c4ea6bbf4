# SPDX-License-Identifier: MIT
"""`mavloom demo`, with pymavlink as its ground station."""
import json
import os
import pathlib
import pty
import re
import signal
import subprocess
import urllib.request

import pytest
from pymavlink import mavutil

import harness

HOPS = ["vehicle", "router", "listener", "relay", "ground station"]
ARM, TAKEOFF, ACCEPTED = 400, 22, 0


def children_of(pid):
    return [int(child) for task in pathlib.Path(f"/proc/{pid}/task").glob("*/children")
            for child in task.read_text().split()]


def left_by(pid):
    """Rings, counter pages, sockets and lock files of the demo with this process."""
    return [*pathlib.Path("/dev/shm").glob(f"mavloom.demo-{pid}*"), *harness.RUN.glob(f"demo-{pid}*")]


def is_over(pid):
    return not pathlib.Path(f"/proc/{pid}").exists()


def report_at(demo, name):
    url = demo.wait_output(r"open (http://\S+)")[1]
    with urllib.request.urlopen(f"{url}/api/v1/{name}", timeout=harness.DEFAULT_TIMEOUT_S) as answer:
        return json.load(answer)


def hops_at(demo):
    return {hop["name"]: hop for hop in report_at(demo, "links")["hops"]}


def alarms_at(demo):
    return report_at(demo, "alarms")["alarms"]


def test_each_hop_counts_every_frame(run):
    done = run("demo", "--ports", "free", "--for", "3s", "--json")
    report = json.loads(done.stdout)
    hops = {hop["name"]: hop for hop in report["hops"]}
    frames = hops["vehicle"]["frames_out"]

    assert done.status == 0 and report["ok"], done
    assert list(hops) == HOPS and frames > 100
    assert [hops[name]["frames_in"] for name in HOPS[1:]] == [frames] * 4
    assert [hops[name]["frames_out"] for name in HOPS[:-1]] == [frames] * 4
    assert all(hop["lost"] == 0 and not hop["losses"] and hop["state"] == "up" for hop in hops.values())
    assert 0 < report["latency_ms"]["median"] <= report["latency_ms"]["p99"] <= report["latency_ms"]["longest"]


def test_a_real_vehicle_takes_the_place_of_the_simulated_one(run, spawn, udp_port):
    """It sends on when the demo ends."""
    port = udp_port()
    spawn("sim", "--listen", f"udpin://127.0.0.1:{port}", "--name", f"real-{port}").wait_output("listening")
    done = run("demo", "--ports", "free", "--source", f"udpout://127.0.0.1:{port}", "--for", "3s", "--json")
    hops = {hop["name"]: hop for hop in json.loads(done.stdout)["hops"]}

    assert done.status == 0, done
    frames = hops["vehicle"]["frames_out"]
    assert frames > 100 and [hops[name]["frames_in"] for name in HOPS[1:]] == [frames] * 4
    assert all(hop["lost"] == 0 for hop in hops.values())


def test_a_vehicle_that_never_comes_is_waited_for_and_the_reason_is_shown(run):
    done = run("demo", "--ports", "free", "--source", "serial:///dev/ttyNONE?baud=57600", "--for", "2s")
    reason = "serial:///dev/ttyNONE: cannot open /dev/ttyNONE: No such file or directory"

    assert done.status == 4 and f"\nvehicle: waiting; {reason}" in done.stdout and "STOPPED" not in done.stdout, done
    assert not [line for line in done.lines if re.match(r"([6-9]|\d\d) s[:;]", line)], done  # 10 s before


def test_frames_of_others_at_the_ground_stations_port_hide_no_loss(spawn):
    demo = spawn("demo", "--ports", "free", "--for", "7s", "--json", "--break", "relay")
    port = demo.wait_output(r"UDP port (\d+)")[1]
    other = spawn("sim", "--name", f"other-{port}", "--to", f"udpout://127.0.0.1:{port}")
    demo.wait_output(f"process {other.pid}.* also sends to port {port}")
    hops = {hop["name"]: hop for hop in json.loads(demo.wait().stdout)["hops"]}

    assert hops["relay"]["lost"] == hops["vehicle"]["frames_out"] - hops["ground station"]["frames_in"] > 0
    assert hops["relay"]["frames_out"] <= hops["listener"]["frames_out"]
    assert "not counted" in hops["ground station"]["hint"]


@pytest.mark.parametrize("broken", ["listener", *(pytest.param(name, marks=pytest.mark.long)
                                                  for name in ("vehicle", "router", "relay"))])
def test_a_broken_hop_is_named(spawn, broken):
    demo = spawn("demo", "--ports", "free", "--for", "7s", "--json", "--break", broken)
    demo.wait_output(f"the {broken} is stopped")
    loses = broken != "vehicle"

    harness.wait_for(lambda: hops_at(demo)[broken]["state"] == "down" and
                     bool(hops_at(demo)[broken]["losses"]) == loses, what="the hop on the page")
    if loses:
        harness.wait_for(lambda: [alarm for alarm in alarms_at(demo) if alarm["kind"] == "drop" and
                                  alarm["severity"] == "error" and alarm["text"].startswith(f"{broken} lost ")],
                         what="an alarm about the hop")
    others = [hop for name, hop in hops_at(demo).items() if name != broken]
    done = demo.wait()
    hops = {hop["name"]: hop for hop in json.loads(done.stdout)["hops"]}

    assert not any(hop["losses"] for hop in others) and all(hop["state"] == "up" for hop in others)
    assert done.status == 4 and not json.loads(done.stdout)["ok"], done
    assert [name for name in HOPS if hops[name]["state"] == "down"] == [broken]
    assert {name for name in HOPS if hops[name]["lost"]} == ({broken} if loses else set())
    assert hops["vehicle"]["frames_out"] - hops["ground station"]["frames_in"] == hops[broken]["lost"]


def test_two_hops_that_stop_do_not_lose_the_same_frames(spawn):
    demo = spawn("demo", "--ports", "free", "--json", "--break", "relay")
    demo.wait_output("the relay is stopped")
    harness.wait_for(lambda: hops_at(demo)["relay"]["losses"], what="the loss of the relay")
    listener = next(child for child in children_of(demo.pid) if "mavloom.hear" in words_of(child))
    os.kill(listener, signal.SIGKILL)
    harness.wait_for(lambda: hops_at(demo)["listener"]["losses"], what="the loss of the listener")
    hops = {hop["name"]: hop for hop in json.loads(demo.stop(signal.SIGINT).stdout)["hops"]}

    written, arrived = hops["listener"]["frames_out"], hops["ground station"]["frames_in"]
    assert hops["relay"]["lost"] == written - arrived > 0
    assert hops["listener"]["lost"] == hops["router"]["frames_out"] - written > 0


def test_a_ground_station_connects_and_flies_and_ctrl_c_leaves_nothing(spawn):
    demo = spawn("demo", "--ports", "free")
    port = demo.wait_output(r"UDP port (\d+)")[1]
    station = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=255, source_component=190)
    try:
        fly(station)
        harness.wait_for(lambda: is_heard(station, demo), what="the ground station on the page")
    finally:
        station.close()
    children = children_of(demo.pid)
    done = demo.stop(signal.SIGINT)

    assert done.status == 130 and len(children) == 4, done
    assert all(map(is_over, children)) and left_by(demo.pid) == []
    table = table_of(done)
    assert [line.split("  ")[0] for line in table[:6]] == ["hop", *HOPS]
    assert all(line.endswith(" 0") for line in table[1:6]) and table[6].startswith("vehicle to ground station: median")


def test_a_table_is_drawn_over_what_the_terminal_echoed(program):
    """The terminal echoes Ctrl-C as ^C, so the cursor is not at the beginning of its line."""
    own, terminal = pty.openpty()
    demo = subprocess.Popen([program, "demo", "--ports", "free", "--for", "2s"], stdout=terminal,
                            stderr=subprocess.DEVNULL)
    os.close(terminal)
    text = b"".join(iter(lambda: read_terminal(own), b"")).decode()
    os.close(own)

    assert demo.wait() == 0
    moves = re.findall(r"(.)\x1b\[\d+A", text)
    assert moves and set(moves) == {"\r"}, text


def read_terminal(terminal):
    try:
        return os.read(terminal, 4096)
    except OSError:  # the other end is closed
        return b""


def test_a_second_ctrl_c_ends_the_wait_and_prints_the_counts(spawn):
    demo = spawn("demo", "--ports", "free", "--json")
    harness.wait_for(lambda: hops_at(demo).get("ground station", {}).get("frames_in"), what="frames at the end")
    children = children_of(demo.pid)
    vehicle, relay = (next(child for child in children if words_of(child)[1] == name) for name in ("sim", "relay"))
    os.kill(relay, signal.SIGSTOP)  # so frames stay on their way
    try:
        harness.wait_for(lambda: hops_at(demo)["router"]["frames_out"] > hops_at(demo)["ground station"]["frames_in"],
                         what="frames that the relay holds")
        demo.send(signal.SIGINT)
        await_look_at_the_end(demo, words_of(vehicle), words_of(relay))
        demo.send(signal.SIGINT)
        report = json.loads(demo.wait_output(r"(\{.*\})\n", stream="out")[1])
    finally:
        os.kill(relay, signal.SIGCONT)
    done = demo.wait()

    # A wait to its end would call the frames lost: "ok" would be false.
    assert done.status == 130 and report["ok"] is None and [hop["name"] for hop in report["hops"]] == HOPS, done
    assert all(map(is_over, children)) and left_by(demo.pid) == []


def await_look_at_the_end(demo, vehicle, relay):
    """Until the demo has ended the vehicle's stream, and then seen a further frame. That is more than 0.2 s after the
    signal, so a second one is another request."""
    harness.wait_for(lambda: can_bind(port_in(vehicle, "udpin")), what="the end of the vehicle's stream")
    before = hops_at(demo)["ground station"]["frames_in"]
    end = mavutil.mavlink_connection(f"udpout:127.0.0.1:{port_in(relay, 'udpout')}")
    end.mav.heartbeat_send(6, 8, 0, 0, 4)
    end.close()
    harness.wait_for(lambda: hops_at(demo)["ground station"]["frames_in"] > before, what="a look at the end")


def port_in(words, scheme):
    return int([re.search(r":(\d+)", word.removeprefix(f"{scheme}:"))[1] for word in words
                if word.startswith(f"{scheme}:")][-1])


def can_bind(port):
    with harness.socket.socket(type=harness.socket.SOCK_DGRAM) as probe:
        try:
            probe.bind(("127.0.0.1", port))
            return True
        except OSError:
            return False


def words_of(pid):
    return pathlib.Path(f"/proc/{pid}/cmdline").read_text().split("\0")


def table_of(done):
    return done.lines[[line.split(" ")[0] for line in done.lines].index("hop"):]


def is_heard(station, demo):
    station.mav.heartbeat_send(6, 8, 0, 0, 4)
    return hops_at(demo)["ground station"]["state"] == "up"


def fly(station):
    home = station.recv_match(type="GLOBAL_POSITION_INT", blocking=True, timeout=harness.DEFAULT_TIMEOUT_S)
    harness.wait_for(lambda: accepted(station, ARM, 1), what="the vehicle to arm")
    assert accepted(station, TAKEOFF, 0, 0, 0, float("nan"), float("nan"), float("nan"), home.alt / 1000 + 10)

    def climbs():
        return station.recv_match(type="GLOBAL_POSITION_INT", blocking=True, timeout=5).relative_alt > 3000
    harness.wait_for(climbs, what="the vehicle to climb")


def accepted(station, command, *values):
    station.mav.heartbeat_send(6, 8, 0, 0, 4)
    station.mav.command_long_send(1, 1, command, 0, *values, *[0] * (7 - len(values)))
    answer = station.recv_match(type="COMMAND_ACK", condition=f"COMMAND_ACK.command=={command}", blocking=True,
                                timeout=5)
    return answer is not None and answer.result == ACCEPTED


def test_parts_that_were_killed_leave_nothing(spawn):
    demo = spawn("demo", "--ports", "free")
    demo.wait_output(r"[1-9]\d* frames at the end")
    for child in children_of(demo.pid):
        os.kill(child, signal.SIGKILL)
    for part in HOPS[:-1]:
        assert demo.wait_output(f"the {part} ended with signal 9(.*)")[1] == ""
    assert left_by(demo.pid)
    done = demo.stop(signal.SIGINT)

    assert done.status == 130 and left_by(demo.pid) == [], done
    assert "relay: STOPPED" in done.stdout


def test_a_killed_demo_leaves_nothing(spawn):
    demo = spawn("demo", "--ports", "free")
    demo.wait_output(r"[1-9]\d* frames at the end")
    children = children_of(demo.pid)
    assert len(children) == 4 and left_by(demo.pid)
    demo.send(signal.SIGKILL)
    demo.process.wait()

    harness.wait_for(lambda: all(map(is_over, children)), what="the children to end")
    assert left_by(demo.pid) == []


def test_without_the_package_the_error_names_the_next_step(run, tmp_path):
    python = tmp_path / "python3"
    python.write_text("#!/bin/sh\necho \"$0: Error while finding module specification for 'mavloom.hear' "
                      "(ModuleNotFoundError: No module named 'mavloom')\" >&2\nexit 1\n")
    python.chmod(0o755)
    done = run("demo", "--ports", "free", "--python", python)

    assert done.status == 1 and "pip install ." in done.stderr and "--python" in done.stderr, done


def test_a_missing_interpreter_is_named(run, tmp_path):
    done = run("demo", "--ports", "free", "--python", tmp_path / "python9")

    assert done.status == 1 and str(tmp_path / "python9") in done.stderr, done


def test_the_holder_of_a_port_is_named(run, tcp_port):
    with harness.socket.socket() as holder:
        holder.bind(("127.0.0.1", 0))
        holder.listen()
        done = run("demo", "--ports", "free", "--listen", f"127.0.0.1:{holder.getsockname()[1]}")

    assert done.status == 1 and f"process {os.getpid()}" in done.stderr, done
