# SPDX-License-Identifier: MIT
"""A stand-in for PX4 flies on `mavloom sim --hil px4`, by pymavlink and by PX4's rules of the lock-step."""
import math
import signal
import time

import pytest

import harness

SHORT = {"arm_at": 0.5, "height": 2.0, "hold": 0.5}
LONG_HOLD = {**SHORT, "hold": 1e9}


def answered_all(simulator, answers):
    """Late are the first answers, as steps come in real time until then, and those of a machine that stood still."""
    state = simulator.hil()
    assert state["unanswered"] <= state["late"] and state["answered"] + state["late"] == answers


def test_takes_off_holds_and_lands_in_lock_step(hil, stand_in):
    simulator = hil("--speed", "max")
    pilot = stand_in(simulator.hil_port)
    report = pilot.said("report")

    assert pilot.said("hold")["place"][2] == pytest.approx(5, abs=0.3)
    assert report["highest_m"] < 6.5
    assert report["place"] == pytest.approx([0, 0, 0], abs=0.5)
    assert report["time_errors"] == 0
    assert report["answers"] == report["steps"] - 35, "each step after the boot has one answer"
    answered_all(simulator, report["answers"])


def test_sensors_agree_with_the_truth_and_keep_their_rates(hil, stand_in):
    report = stand_in(hil("--speed", "max").hil_port).said("report")

    seconds, counts = report["steps"] * 0.004, report["counts"]
    for name, rate in (("gyro", 250), ("mag", 50), ("baro", 50), ("gps", 10)):
        assert counts[name] == pytest.approx(rate * seconds, abs=2), name
    assert counts["truth"] > 50 * seconds
    rest, worst = report["rest"], report["worst"]
    assert rest["acceleration"] == pytest.approx([0, 0, -9.80665], abs=0.1)
    # PX4's model of the field at the start, near Zurich: 3.41 degrees east, 0.482 gauss.
    assert math.remainder(rest["compass_deg"] + 3.41 - report["heading_deg"], 360) == pytest.approx(0, abs=5)
    assert rest["field_gauss"] == pytest.approx(0.482, abs=0.03)
    assert worst["baro_m"] < 3 and worst["gps_m"] < 3 and worst["speed_m_s"] < 1


def test_sensors_repeat_with_the_seed(hil, stand_in):
    def digest(seed):
        simulator = hil("--speed", "max", "--seed", seed)
        return stand_in(simulator.hil_port, **SHORT, boot_steps=200).said("report")["digest"]
    assert digest(1) == digest(1) != digest(2)


@pytest.mark.parametrize("body", ["standard", "iris", "jmavsim"])
def test_every_body_flies(hil, stand_in, body):
    simulator = hil("--speed", "max", vehicle={"body": body})
    pilot = stand_in(simulator.hil_port, **SHORT)
    assert pilot.said("hold")["place"] == pytest.approx([0, 0, 2], abs=0.5)
    assert pilot.said("report")["time_errors"] == 0


def test_never_runs_faster_than_asked(hil, stand_in):
    simulator = hil("--speed", "4")
    pilot = stand_in(simulator.hil_port, **SHORT)
    pilot.said("first answer")
    began, answered = time.monotonic(), simulator.hil()["answered"]
    pilot.said("landed")
    flown = (simulator.hil()["answered"] - answered) * 0.004
    assert flown < 4.2 * (time.monotonic() - began) + 0.5


def test_a_killed_autopilot_starts_again_at_the_start_place(hil, stand_in):
    simulator = hil("--speed", "max")
    first = stand_in(simulator.hil_port, **LONG_HOLD)
    assert first.said("hold")["place"][2] > 1.5
    first.send(signal.SIGKILL)

    second = stand_in(simulator.hil_port, **SHORT)
    assert second.said("climb")["place"] == pytest.approx([0, 0, 0], abs=0.1)
    assert second.said("report")["time_errors"] == 0
    assert second.said("first answer")["time_us"] > first.said("first answer")["time_us"], "the clock goes on"
    assert simulator.process.alive


def test_steps_on_without_answers(hil, stand_in):
    """The wait for an answer is bounded; after ten in vain, the simulator steps at real time, and reports that once."""
    simulator = hil("--speed", "max")
    pilot = stand_in(simulator.hil_port, **{**SHORT, "hold": 2.0}, silent_at=2.0, silent_steps=14)
    report = pilot.said("report")
    assert report["time_errors"] == 0 and report["answers"] == report["steps"] - 35 - 14
    state = simulator.hil()
    assert 14 <= state["unanswered"] <= 14 + state["late"] and state["losses"] == 1
    assert simulator.process.stderr.count("no answer") == 1, simulator.process.stderr


def test_waits_for_a_slow_autopilot(hil, stand_in):
    simulator = hil("--speed", "max")
    report = stand_in(simulator.hil_port, **SHORT, slow=0.003).said("report")
    assert report["time_errors"] == 0
    answered_all(simulator, report["answers"])


def test_a_second_autopilot_is_refused(hil, stand_in):
    simulator = hil("--speed", "max")
    first = stand_in(simulator.hil_port, **LONG_HOLD)
    first.said("hold")
    second = stand_in(simulator.hil_port)
    assert second.said("simulator gone")["answers"] == 0
    simulator.process.wait_output("one autopilot a port")
    assert first.alive and simulator.hil()["state"] == "lock-step"


def test_several_autopilots_fly_independently(hil, stand_in):
    simulator = hil("--speed", "max", "--vehicles", "2")
    lost = stand_in(simulator.hil_port, **LONG_HOLD)
    stays = stand_in(simulator.hil_port + 1, 1, **SHORT, stay=True)
    lost.said("climb")
    lost.send(signal.SIGKILL)
    assert stays.said("report")["time_errors"] == 0
    assert simulator.hil(2)["state"] == "lock-step" and simulator.hil(1)["state"] != "lock-step"


@pytest.mark.parametrize("faulty, counter", [("nan", "not_numbers"), ("beyond", "clamped")])
def test_controls_out_of_range_are_counted_and_harmless(hil, stand_in, faulty, counter):
    simulator = hil("--speed", "max")
    assert stand_in(simulator.hil_port, **SHORT, faulty=faulty).said("report")["time_errors"] == 0
    assert simulator.hil()[counter] > 0


@pytest.mark.parametrize("counter, oddity", [("repeated", {"copies": 2}), ("foreign", {"ahead_us": 10_000_000})])
def test_odd_times_of_answers_are_counted_and_do_not_stop_the_flight(hil, stand_in, counter, oddity):
    simulator = hil("--speed", "max")
    report = stand_in(simulator.hil_port, **SHORT, **oddity).said("report")
    assert report["time_errors"] == 0
    harness.wait_for(lambda: simulator.hil()["state"] == "waiting", what="the end of the link")
    state = simulator.hil()
    assert report["answers"] - 2 <= state[counter] <= state["steps"]  # the stand-in answers on until it has closed
