# SPDX-License-Identifier: MIT
"""`mavloom ctl` for people: tables on a terminal, and what runs if the name is missing."""
import json
import os
import re

import harness
import pytest
import terminals


@pytest.fixture
def ctl(tmp_path, program):
    with terminals.opened(tmp_path, program, "ctl") as start:
        yield start


@pytest.fixture
def names(spawn, run, udp_port):
    """A router and a simulated vehicle that sends to it."""
    port, router = udp_port(), f"ctl-{os.getpid()}-{udp_port()}"
    spawn("route", f"udpin://127.0.0.1:{port}", f"udpout://127.0.0.1:{udp_port()}?name=tablet", "--name", router)
    spawn("sim", "--to", f"udpout://127.0.0.1:{port}", "--name", f"{router}-sim")
    harness.wait_for(lambda: "ATTITUDE" in run("ctl", router, "stats").stdout, what="the vehicle at the router")
    return router, f"{router}-sim"


def lines(terminal):
    """The output of the command, once it has ended."""
    terminal.wait_for(r"^ended with 0$")
    return terminal.shown().split("ended with")[0].splitlines()


def test_the_links_are_a_table_on_a_terminal(ctl, names):
    shown = lines(ctl(names[0], "links", columns=100))
    assert re.split(" +", shown[0]) == ["LINK", "STATE", "RANK", "IN", "OUT", "BYTES", "IN", "BYTES", "OUT",
                                            "LOST", "QUEUE"], shown
    assert any(re.match(r"tablet +up +own +0 +\d+ ", line) for line in shown), shown
    assert any(re.match(r"udpin://127\.0\.0\.1:\d+#127\.0\.0\.1:\d+ +up +own +\d+ +0 ", line) for line in shown), shown


def test_a_heading_is_less_than_360_degrees(ctl, run, spawn, udp_port):
    name = f"ctl-heading-{os.getpid()}"
    spawn("sim", "--to", f"udpout://127.0.0.1:{udp_port()}", "--name", name, "--home", "47.4,8.5,489,359.8")
    harness.wait_for(lambda: run("ctl", name, "state").status == 0, what="the simulator")
    shown = lines(ctl(name, "state", columns=200))
    place = re.split("  +", shown[0].strip()).index("HEADING")
    assert re.split("  +", shown[1].strip())[place] == "0", shown


@pytest.mark.parametrize("columns", [400, 80, 40])
@pytest.mark.parametrize("action", ["links", "stats"])
def test_each_line_fits_into_the_terminal(ctl, names, action, columns):
    shown = lines(ctl(names[0], action, columns=columns, lines=100))
    assert len(shown) > 2 and max(map(len, shown)) <= columns, shown
    assert ("Not all fits; --json prints all." in shown) == (columns < 400), shown


def test_a_narrow_terminal_keeps_both_ends_of_a_name_and_the_counts(ctl, names):
    shown = lines(ctl(names[0], "links", columns=40, lines=10))
    assert re.split(" +", shown[0])[:4] == ["LINK", "STATE", "IN", "OUT"], shown
    assert any(re.match(r"udp\w*\S*\.\.\S*:\d{4,5} +up +\d+ +0$", line) for line in shown), shown


def test_the_vehicles_are_a_table_too(ctl, names):
    shown = lines(ctl(names[1], "state"))
    assert shown[0].startswith("VEHICLE  TYPE  AUTOPILOT  MODE") and re.match(" +1  quad  px4 +Hold  no ", shown[1])
    shown = lines(ctl(names[1], "param", "MIS_TAKEOFF_ALT"))
    assert shown[:2] == ["VEHICLE  PARAMETER        VALUE", "      1  MIS_TAKEOFF_ALT  2.5"]


def test_the_flight_clock_is_a_table_too(ctl, names):
    shown = lines(ctl(names[1], "pause"))
    assert shown[0].split() == ["FLIGHT,", "S", "PAUSED"] and re.match(r" +\d+\.\d+ +yes$", shown[1]), shown
    assert re.match(r"sim: up \d+ s, flight clock at \d+\.\d s \(paused\), ", lines(ctl(names[1], "stats"))[0])


def test_what_a_router_refuses_is_named_as_it_was_typed(run, names):
    for typed in (["land"], ["rtl"], ["wait", "landed"]):
        done = run("ctl", names[0], *typed)
        assert done.status == 1 and f"there is no command '{typed[0]}'; there are links, " in done.stderr, done


def test_a_wait_in_vain_states_where_the_vehicles_are(run, names):
    done = run("ctl", names[1], "wait", "alt", "100", "--for", "100ms")
    assert done.status == 1, done
    assert re.search(r"not there yet: vehicle 1: Hold, disarmed, on_ground(, not ready)?, -?0\.\d m above home$",
                     done.stderr, re.MULTILINE), done


def test_an_empty_answer_is_a_sentence(ctl, spawn, run, udp_port):
    name = f"ctl-empty-{os.getpid()}"
    spawn("route", f"udpin://127.0.0.1:{udp_port()}", "--name", name)
    harness.wait_for(lambda: run("ctl", name, "links").status == 0, what="the router")
    assert lines(ctl(name, "routes"))[0] == "no routes: no system was heard so far"
    assert lines(ctl(name, "links"))[0] == "no links"


def test_json_on_a_terminal_is_the_same_as_in_a_pipe(ctl, names, run):
    shown = "".join(lines(ctl(names[0], "routes", "--json", columns=400)))
    piped = run("ctl", names[0], "routes")
    assert json.loads(shown.strip()).keys() == json.loads(piped.stdout).keys()
    assert run("ctl", names[0], "routes", "--json").status == 0


@pytest.mark.parametrize("arguments, status", [((), 2), (("links",), 2), (("nobody", "links"), 1)])
def test_without_a_name_what_runs_is_listed(run, spawn, udp_port, tmp_path, arguments, status):
    env = {"MAVLOOM_RUN": str(tmp_path)}
    done = run("ctl", *arguments, env=env)
    assert done.status == status and "running" not in done.stderr, done
    spawn("sim", "--listen", "tcpin://127.0.0.1:0", "--name", "bird", env=env)
    spawn("route", f"udpin://127.0.0.1:{udp_port()}", "--name", "nest", env=env)
    for name, action in (("bird", "state"), ("nest", "links")):
        harness.wait_for(lambda a=(name, action): run("ctl", *a, env=env).status == 0, what=name)
    done = run("ctl", *arguments, env=env)
    assert done.status == status and "running: bird (simulator), nest (router)" in done.stderr, done
