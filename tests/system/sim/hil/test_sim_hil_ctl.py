# SPDX-License-Identifier: MIT
"""`mavloom ctl` at the simulator for PX4, while a stand-in holds its place in the air."""
import json
import re

import pytest

import harness
from simulators import unique_name

HOLD = {"arm_at": 0.5, "height": 3.0, "hold": 1e9}


@pytest.fixture
def holding(hil, stand_in):
    simulator = hil("--speed", "max")
    pilot = stand_in(simulator.hil_port, **HOLD)
    pilot.said("hold")
    return simulator, pilot


def moved_by(simulator, seconds):
    """The state after so much more of a paused flight."""
    before, steps = simulator.hil(), round(seconds * 250)
    lines = [json.loads(line) for line in simulator.ctl("step", f"{seconds * 1000:.0f}ms").splitlines()]
    step, state = [line for line in lines if line.get("kind") in ("step", "hil")]
    assert step["moved_s"] == pytest.approx(seconds, abs=1e-9)
    assert state["steps"] - before["steps"] == steps == state["answered"] - before["answered"]
    assert simulator.hil()["steps"] == state["steps"]
    return state


def test_a_step_is_rounded_up_and_reports_it(holding):
    simulator, _ = holding
    simulator.ctl("pause")
    before = simulator.hil()
    step = json.loads(simulator.ctl("step", "10ms").splitlines()[0])
    assert step == {"kind": "step", "system": 1, "moved_s": 0.012}
    assert simulator.hil()["flight_s"] == pytest.approx(before["flight_s"] + 0.012, abs=1e-9)


def test_without_an_autopilot_there_is_no_step(hil, run):
    simulator = hil()
    simulator.ctl("pause")
    done = run("ctl", simulator.name, "step", "10ms")
    assert done.status == 1 and "waits for its PX4" in done.stderr, done


@pytest.fixture
def stepping(hil, stand_in):
    """A simulator whose paused flight moves by 0.3 s, in 2 s of real time, and the client that waits for it, at most
    for 4 s."""
    simulator = hil("--speed", "0.15")
    stand_in(simulator.hil_port, boot_steps=5)
    harness.wait_for(lambda: simulator.hil()["state"] == "lock-step", what="the first answer")
    simulator.ctl("pause")
    before = simulator.hil()["flight_s"]
    client = harness.Running([simulator.program, "ctl", simulator.name, "step", "300ms"], env=harness.environment())
    harness.wait_for(lambda: simulator.hil()["flight_s"] > before, what="a flight that moves")
    assert client.alive, "the state came before the answer to the step"
    yield simulator, before, client
    harness.end([client])


def test_during_a_step_others_are_answered_and_their_steps_added(stepping):
    simulator, before, client = stepping
    further = json.loads(simulator.ctl("step", "20ms").splitlines()[0])
    assert 0 < further["moved_s"] < 0.32
    assert simulator.hil()["flight_s"] == pytest.approx(before + 0.32, abs=1e-9)
    assert json.loads(client.wait().stdout.splitlines()[0])["moved_s"] == pytest.approx(0.32, abs=1e-9)


def test_a_client_that_goes_during_a_step_leaves_the_rest(stepping):
    simulator, before, client = stepping
    client.kill()
    simulator.ctl("step", "20ms")
    assert simulator.hil()["flight_s"] == pytest.approx(before + 0.32, abs=1e-9)


def test_during_a_step_the_simulator_ends_at_once(stepping):
    simulator, _, client = stepping
    assert simulator.stop().status == 130
    ended = client.wait()
    assert ended.status == 1 and "the answer was cut off" in ended.stderr, ended


def test_a_paused_flight_moves_by_exact_steps(holding):
    simulator, pilot = holding
    simulator.ctl("pause")
    before = simulator.hil()
    assert before["paused"]
    after = moved_by(simulator, 0.04)
    assert after["flight_s"] == pytest.approx(before["flight_s"] + 0.04, abs=1e-6)
    simulator.ctl("resume")
    harness.wait_for(lambda: simulator.hil()["steps"] > after["steps"] + 500, what="a flight that continues")
    assert pilot.alive and simulator.hil()["relative_alt_m"] == pytest.approx(3, abs=0.7)


def test_an_autopilot_that_dies_in_a_pause_leaves_the_vehicle_at_its_start(holding, stand_in):
    simulator, pilot = holding
    simulator.ctl("pause")
    pilot.kill()
    state = harness.wait_for(lambda: (row := simulator.hil())["state"] == "waiting" and row, what="the end of the link")
    assert state["relative_alt_m"] == 0 and state["paused"]
    simulator.ctl("resume")
    assert stand_in(simulator.hil_port, **{**HOLD, "hold": 0.1}).said("report")["time_errors"] == 0


def test_a_pushed_vehicle_moves_and_its_pilot_brings_it_back(holding):
    simulator, _ = holding
    simulator.ctl("pause")
    simulator.ctl("push", "4,0,0")
    assert moved_by(simulator, 0.6)["vn_m_s"] > 1
    simulator.ctl("resume")
    harness.wait_for(lambda: abs((state := simulator.hil())["vn_m_s"]) < 0.1 and abs(state["lat"] - 47.397742) < 5e-6,
                     what="the vehicle to be back at its place")


def test_a_heavier_vehicle_sinks_and_its_pilot_brings_it_back(holding):
    simulator, _ = holding
    simulator.ctl("pause")
    height = simulator.hil()["relative_alt_m"]
    simulator.ctl("mass", "2")
    assert moved_by(simulator, 0.8)["relative_alt_m"] < height - 0.1
    simulator.ctl("resume")
    harness.wait_for(lambda: simulator.hil()["relative_alt_m"] > 2.8, what="its pilot to lift it again")


def test_stat_names_the_autopilot_and_its_steps(holding, run):
    simulator, _ = holding
    said = run("stat", simulator.name).stdout
    assert re.search(rf"^vehicle 1 flown by the autopilot at tcpin://127.0.0.1:{simulator.hil_port}: lock-step, armed, "
                     r"[0-9.]+ m above home\n  steps \d+, answered \d+", said, re.MULTILINE), said


def test_a_motor_fails_and_the_vehicle_falls(holding, run):
    simulator, _ = holding
    done = run("ctl", simulator.name, "fail", "motor", "off", "7")
    assert done.status == 1 and "the vehicle has 4 motors" in done.stderr
    done = run("ctl", simulator.name, "fail", "battery", "off")
    assert done.status == 1 and "the battery is PX4's own" in done.stderr
    simulator.ctl("pause")
    simulator.ctl("fail", "motor", "off", "1")
    assert moved_by(simulator, 0.4)["roll_deg"] > 10, "its first motor is on the right"
    simulator.ctl("resume")
    harness.wait_for(lambda: simulator.hil()["landed_state"] == "on_ground", what="the vehicle to lie on the ground")


def test_the_time_line_has_faults(hil, stand_in, tmp_path):
    (tmp_path / "faults.toml").write_text('[[event]]\nat = "4s"\ndo = "fail gps jump 30 40"\n'
                                          '[[event]]\nat = "5s"\ndo = "fail gps ok"\n')
    simulator = hil(tmp_path / "faults.toml", "--speed", "max", "--hil-sensors", "imus:3")
    report = stand_in(simulator.hil_port, arm_at=2.0, height=3.0, hold=2.0).said("report")
    assert 45 < report["worst"]["gps_m"] < 55, "a position that is 50 m away"
    assert simulator.hil()["unanswered"] == 0


def test_an_order_of_the_time_line_that_is_refused_is_reported(spawn, stand_in, tmp_path):
    (tmp_path / "faults.toml").write_text('[[event]]\nat = "1s"\ndo = "fail motor off 9"\n')
    port = harness.free_port(harness.socket.SOCK_STREAM)
    simulator = spawn("sim", tmp_path / "faults.toml", "--hil", f"px4=tcpin://127.0.0.1:{port}", "--speed", "max",
                      "--for", "3s", "--name", unique_name())
    stand_in(port, stay=True)
    done = simulator.wait()
    assert done.status == 1 and "order 'fail motor off 9' at 1 s: the vehicle has 4 motors" in done.stderr, done


def test_waits_for_the_height_and_for_the_landing(hil, stand_in):
    simulator = hil("--speed", "2")
    stand_in(simulator.hil_port, arm_at=2.0, height=2.0, hold=6.0, stay=True)
    rows = [json.loads(line) for arguments in (("armed",), ("alt", "2"), ("disarmed",))
            for line in simulator.ctl("wait", *arguments).splitlines()]
    assert [row["armed"] for row in rows] == [True, True, False]
    assert rows[1]["relative_alt_m"] == pytest.approx(2, abs=0.5)


def test_orders_for_px4_are_refused_with_the_reason(hil, run):
    simulator = hil()
    done = run("ctl", simulator.name, "takeoff", "10")
    assert done.status == 1 and "PX4 flies this vehicle" in done.stderr
