# SPDX-License-Identifier: MIT
"""A stand-in for PX4 flies a plane and drives a rover, with the outputs of PX4's airframes 1030 and 1060."""
import math

import pytest

COARSE = ("--speed", "max", "--hil-sensors", "imu:100")  # fewer steps


def answered_all(report):
    assert report["time_errors"] == 0 and report["answers"] == report["steps"] - 35


def test_a_plane_takes_off_circles_and_lands(hil, stand_in):
    simulator = hil(*COARSE, vehicle={"kind": "plane"})
    pilot = stand_in(simulator.hil_port, vehicle="plane", height=25.0, stay=True)
    report = pilot.said("report")

    answered_all(report)
    assert 60 < pilot.said("turn")["place"][0] < 400, "a run and a climb to the north"
    assert 25 < report["highest_m"] < 35
    assert report["turned_deg"] == pytest.approx(360, abs=5)
    assert pilot.said("descend")["place"][2] == pytest.approx(25, abs=4), "it was level"
    assert report["place"][2] == pytest.approx(0, abs=0.1)
    assert 13 < report["fastest_m_s"] < 30
    state = simulator.hil()
    assert state["landed_state"] == "on_ground" and not state["armed"] and state["unanswered"] == 0


def test_a_planes_sensors_agree_with_the_truth_in_wind(hil, stand_in):
    simulator = hil(*COARSE, vehicle={"kind": "plane", "wind": "4,0", "home": "-35.363,149.165,1500,0"})
    report = stand_in(simulator.hil_port, vehicle="plane", height=15.0, hold=1.0).said("report")

    seconds, counts, worst = report["steps"] * 0.01, report["counts"], report["worst"]
    for name, rate in (("gyro", 100), ("mag", 50), ("baro", 50), ("airspeed", 50), ("gps", 10)):
        assert counts[name] == pytest.approx(rate * seconds, abs=2), name
    assert worst["baro_m"] < 3 and worst["gps_m"] < 3 and worst["speed_m_s"] < 1
    assert 0 < worst["airspeed_m_s"] < 1.5, "by the pressures of 1,500 m, as PX4 computes it"


def test_a_rover_drives_turns_and_stops(hil, stand_in):
    simulator = hil(*COARSE, vehicle={"kind": "rover", "home": "47.397742,8.545594,489.4,90"})
    pilot = stand_in(simulator.hil_port, vehicle="rover", stay=True)
    report = pilot.said("report")

    answered_all(report)
    north, east, up = pilot.said("turn")["place"]
    assert (north, up) == pytest.approx((0, 0), abs=0.3) and east > 10, "it drove along its heading"
    assert report["turned_deg"] == pytest.approx(360, abs=15)
    assert math.remainder(report["heading_deg"] - 90, 360) == pytest.approx(0, abs=3), "it kept its heading at last"
    assert 2 < report["fastest_m_s"] < 4
    assert report["worst"]["gps_m"] < 3 and report["worst"]["speed_m_s"] < 1
    state = simulator.hil()
    assert math.hypot(state["vn_m_s"], state["ve_m_s"]) < 0.05 and not state["armed"]


@pytest.mark.parametrize("kind", ["plane", "rover"])
def test_controls_out_of_range_are_counted_and_harmless(hil, stand_in, kind):
    simulator = hil(*COARSE, vehicle={"kind": kind, "body": "standard"})
    options = {"height": 10.0, "hold": 0.2, "vehicle": kind}
    for faulty, counter in (("nan", "not_numbers"), ("beyond", "clamped")):
        assert stand_in(simulator.hil_port, **options, faulty=faulty).said("report")["time_errors"] == 0
        assert simulator.hil()[counter] > 0


def test_a_killed_autopilot_finds_the_plane_at_its_start_again(hil, stand_in):
    simulator = hil(*COARSE, vehicle={"kind": "plane"})
    first = stand_in(simulator.hil_port, vehicle="plane")
    first.said("turn")
    first.kill()
    second = stand_in(simulator.hil_port, vehicle="plane", height=10.0, hold=0.1)
    assert second.said("climb")["place"] == pytest.approx([0, 0, 0], abs=0.1)
    assert second.said("report")["place"][2] == pytest.approx(0, abs=0.1)
