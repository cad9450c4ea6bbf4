# SPDX-License-Identifier: MIT
"""Real clients that fly the vehicle: pymavlink as scripts use it, MAVSDK, MAVProxy, and all of them through a router.
Behaviour 9 of docs/guide/sim-behaviour.md is here."""
import itertools
import signal
import time

import pytest

import harness
import mavproxies
import mavsdks
import mavutils
from simulators import HOLD, HOME, LAND, MISSION, OFFBOARD, RETURN, Simulator, item, metres_between, place
from stations import NAN, mavlink

from pymavlink import mavwp

PATIENT = {"px4": {"COM_DISARM_PRFLT": 600.0, "RTL_RETURN_ALT": 15.0}, "ardupilot": {"DISARM_DELAY": 127,
                                                                                     "RTL_ALT": 1500}}


def start(sim, autopilot="px4", speed=10, *options, **more):
    more.setdefault("parameters", PATIENT[autopilot])
    return sim("--speed", speed, "--autopilot", autopilot, *options, **more)


# ---- pymavlink

def acknowledged(connection, command):
    return mavutils.receive(connection, "COMMAND_ACK", where=lambda m: m.command == command).result


def pymavlink_parameters(connection, autopilot):
    """All of them; one is set and read back, with the conversions that pymavlink's own mavparm has."""
    connection.param_fetch_all()
    names = {}
    first = mavutils.receive(connection, "PARAM_VALUE", where=lambda m: m.param_index != 0xFFFF)
    names[first.param_id] = first
    while len(names) < first.param_count:
        message = mavutils.receive(connection, "PARAM_VALUE", where=lambda m: m.param_index != 0xFFFF)
        names[message.param_id] = message
    name = "MIS_TAKEOFF_ALT" if autopilot == "px4" else "WPNAV_SPEED"
    value = 12.5 if autopilot == "px4" else 640.0
    connection.param_set_send(name, value)
    assert mavutils.receive(connection, "PARAM_VALUE", where=lambda m: m.param_id == name).param_value == value
    connection.param_fetch_one(name)
    assert mavutils.receive(connection, "PARAM_VALUE", where=lambda m: m.param_id == name).param_value == value


def pymavlink_upload(connection, items):
    loader = mavwp.MAVWPLoader()
    for one in items:
        loader.add(one)
    connection.waypoint_count_send(loader.count())
    while True:
        message = mavutils.receive(connection, ["MISSION_REQUEST_INT", "MISSION_REQUEST", "MISSION_ACK"])
        if message.get_type() == "MISSION_ACK":
            assert message.type == 0
            return
        connection.mav.send(loader.wp(message.seq))


def pymavlink_download(connection):
    connection.waypoint_request_list_send()
    count = mavutils.receive(connection, "MISSION_COUNT").count
    items = []
    for seq in range(count):
        connection.waypoint_request_send(seq)
        items.append(mavutils.receive(connection, ["MISSION_ITEM_INT", "MISSION_ITEM"],
                                      where=lambda m, s=seq: m.seq == s))
    return items


def pymavlink_mode(connection, name, custom_mode=None):
    connection.set_mode(name)
    mavutils.receive(connection, "HEARTBEAT", where=lambda m: connection.flightmode == name and
                     custom_mode in (None, m.custom_mode))


def pymavlink_log(connection):
    """Downloads a log by LOG_REQUEST_DATA."""
    connection.mav.log_request_list_send(connection.target_system, 1, 0, 0xFFFF)
    entry = mavutils.receive(connection, "LOG_ENTRY", where=lambda m: m.size > 0)
    connection.mav.log_request_data_send(connection.target_system, 1, entry.id, 0, 0xFFFFFFFF)
    content = bytearray()
    while len(content) < entry.size:
        part = mavutils.receive(connection, "LOG_DATA", where=lambda m: m.id == entry.id)
        assert part.ofs == len(content) and part.count > 0
        content += bytes(part.data[:part.count])
    connection.mav.log_request_end_send(connection.target_system, 1)
    return len(content) == entry.size


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_pymavlink_flies(sim, autopilot):
    """Parameters, modes by name, a guided take-off, a mission to its end, a log, a file."""
    simulator = start(sim, autopilot)
    simulator.station((254, 1)).ready()
    modes = {"px4": ("LOITER", "MISSION"), "ardupilot": ("GUIDED", "AUTO")}[autopilot]
    with mavutils.connected(simulator.port) as connection:
        assert connection.target_system == 1
        pymavlink_parameters(connection, autopilot)
        home = [item(0, 16)] if autopilot == "ardupilot" else []
        plan = [*home, item(len(home), 22, 0, 0, 10), item(len(home) + 1, 16, 40, 0, 10),
                item(len(home) + 2, 16, 40, 30, 12), item(len(home) + 3, 20, frame=2)]
        pymavlink_upload(connection, plan)
        assert [m.command for m in pymavlink_download(connection)] == [m.command for m in plan]

        pymavlink_mode(connection, modes[0])
        connection.arducopter_arm()
        connection.motors_armed_wait()
        height = HOME[2] + 10 if autopilot == "px4" else 10
        connection.mav.command_long_send(1, 1, 22, 0, 0, 0, 0, NAN if autopilot == "px4" else 0, 0, 0, height)
        assert acknowledged(connection, 22) == 0
        mavutils.receive(connection, "GLOBAL_POSITION_INT", where=lambda m: abs(m.relative_alt - 10_000) < 500)
        pymavlink_mode(connection, modes[1])
        seen = []
        while not seen or seen[-1] < len(plan) - 1:
            seen.append(mavutils.receive(connection, "MISSION_ITEM_REACHED").seq)
            if seen[-1] >= len(plan) - 2 and not connection.motors_armed():
                break
        while connection.motors_armed():
            mavutils.receive(connection, "HEARTBEAT")
        assert pymavlink_log(connection)
        loss = connection.packet_loss()

    assert [seq for seq, _ in itertools.groupby(seen)] == sorted(set(seen)) and len(plan) - 2 in seen
    assert loss == 0


@pytest.mark.parametrize("kind", ["tcp", "udpin"])
def test_pymavlink_over_other_links(program, kind):
    """A TCP server of the simulator's, and a port of pymavlink's that the simulator calls."""
    if kind == "tcp":
        simulator = Simulator(program, listen=("tcpin://127.0.0.1:0",))
        port = simulator.port
    else:
        port = harness.free_port()
        simulator = Simulator(program, "--to", f"udpout://127.0.0.1:{port}", listen=())
    try:
        with mavutils.connected(port, kind=kind) as connection:
            connection.mav.command_long_send(1, 1, 512, 0, 148, 0, 0, 0, 0, 0, 0)
            assert mavutils.receive(connection, "AUTOPILOT_VERSION").capabilities & 8192
            assert connection.packet_loss() == 0
    finally:
        simulator.end()


# ---- MAVSDK

def test_mavsdk_flies(sim):
    simulator = start(sim)
    simulator.station()
    answer = mavsdks.run(simulator.port, "flight")

    for name in ("goto", "orbit", "speed", "hold", "return", "land", "kill"):
        assert answer[name] == "SUCCESS", (name, answer)
    for name in ("take_off", "again", "third"):
        assert answer[name] == ["SUCCESS", "SUCCESS"], (name, answer)
    assert answer["disarm_in_air"] != "SUCCESS" and answer["in_air"]
    assert answer["orbit_mode"] == "POSCTL"  # as MAVSDK calls Orbit
    assert answer["return_altitude"] == ["SUCCESS", 20.0]
    states = answer["states"]
    assert states[states.index("TAKING_OFF"):][:2] == ["TAKING_OFF", "IN_AIR"] and states[-2:] == ["LANDING",
                                                                                                   "ON_GROUND"]
    assert {"TAKEOFF", "HOLD", "RETURN_TO_LAUNCH"} <= set(answer["modes"])


def test_mavsdk_over_grpc_takes_off(sim, tcp_port):
    assert 4.5 < mavsdks.fly_over_grpc(start(sim).port, tcp_port()) < 5.5


def test_mavsdk_flies_missions(sim):
    simulator = start(sim)
    simulator.station()
    answer = mavsdks.run(simulator.port, "mission")

    for name in ("return_after", "upload", "arm", "start", "pause", "set_current", "resume", "clear"):
        assert answer[name] == "SUCCESS", (name, answer)
    assert answer["same"] == [True] * 4
    assert not answer["finished_early"]
    assert [4, 4] in answer["progress"]


def test_mavsdk_moves_and_flies_raw_plans(sim):
    simulator = start(sim)
    simulator.station()
    rows = [[seq, 6, command, int(seq == 0), 1, 0, 2, 0, NAN, x, y, z, 0] for seq, (command, x, y, z) in enumerate(
        [(22, 473977420, 85455940, 8.0), (16, 473979420, 85455940, 8.0), (16, 473979420, 85458940, 9.0)])]
    fence = [[seq, 5, 5001, int(seq == 0), 1, 3, 0, 0, 0, 473900000 + x, 85400000 + y, 0, 1] for seq, (x, y) in
             enumerate([(0, 0), (200000, 0), (200000, 200000)])]
    points = [[0, 6, 5100, 1, 1, 0, 0, 0, 0, 473977420, 85455940, 12.0, 2]]
    answer = mavsdks.run(simulator.port, "raw_plans", rows, fence, points)
    assert answer["uploads"] == ["SUCCESS"] * 3

    def comparable(all_rows):
        return [["nan" if v != v else v for v in row[:3] + row[4:]] for row in all_rows]
    assert comparable(answer["mission"]) == comparable(rows)
    assert comparable(answer["fence"]) == comparable(fence)
    assert comparable(answer["rally"]) == comparable(points)

    flown = mavsdks.run(simulator.port, "raw_mission", rows)
    assert [flown[name] for name in ("upload", "arm", "start", "pause", "resume", "clear")] == ["SUCCESS"] * 6
    assert [2, 3] in flown["progress"] or [3, 3] in flown["progress"], flown["progress"]


def test_mavsdk_offboard(sim):
    simulator = start(sim, speed=4, parameters={**PATIENT["px4"], "COM_OF_LOSS_T": 20.0})
    simulator.station()
    answer = mavsdks.run(simulator.port, "offboard")

    assert answer["without"] == "NO_SETPOINT_SET"  # MAVSDK's own check
    assert (answer["start"], answer["stop"]) == ("SUCCESS", "SUCCESS")
    assert (answer["active"], answer["mode"], answer["after"]) == (True, "OFFBOARD", False)


def test_mavsdk_notices_the_end_of_offboard(sim):
    """The set-points are lost on the way; telemetry arrives."""
    simulator = start(sim, speed=2)
    witness = simulator.station()
    with mavsdks.started(simulator.port, "offboard_loss") as client:
        assert client.answer()["start"] == "SUCCESS"
        simulator.ctl("fault", simulator.newest_link(), "--in", "loss:1")
        witness.until(lambda: witness.latest("HEARTBEAT").custom_mode != OFFBOARD, what="the end of Offboard")
        assert client.answer()["mode"] in ("HOLD", "RETURN_TO_LAUNCH", "POSCTL")


def test_mavsdk_geofence_and_origin(sim):
    simulator = sim()
    simulator.station()
    fence = mavsdks.run(simulator.port, "geofence")
    assert (fence["upload"], fence["clear"], fence["left"]) == ("SUCCESS", "SUCCESS", 0)
    assert len(fence["points"]) == 4 and abs(fence["points"][2][0] - 47.40) < 1e-6
    assert fence["circles"] == [[50.0, "EXCLUSION"]]

    origin = mavsdks.run(simulator.port, "origin", 47.4, 8.55, 500.0)
    assert origin["result"] == "SUCCESS"
    assert max(abs(a - b) for a, b in zip(origin["origin"], (47.4, 8.55, 500.0))) < 1e-3


@pytest.mark.parametrize("kind", ["accelerometer", pytest.param("magnetometer", marks=pytest.mark.long),
                                  pytest.param("level_horizon", marks=pytest.mark.long)])
def test_mavsdk_calibrates(sim, kind):
    simulator = sim("--speed", "5")
    simulator.station()
    answer = mavsdks.run(simulator.port, "calibration", kind)

    assert answer["result"] == "SUCCESS", answer


def test_mavsdk_cancels_a_calibration(sim):
    """Slowly, because MAVSDK 4.1 blocks for ever if a text comes between its cancel command and the acknowledgement."""
    simulator = sim("--speed", "0.3", vehicle={"ready_after": "0s"})
    simulator.station()
    answer = mavsdks.run(simulator.port, "cancelled_calibration")

    assert answer == {"cancel": "SUCCESS", "result": "CANCELLED"}


def test_mavsdk_gimbal(sim):
    simulator = sim("--gimbal")
    simulator.station()
    answer = mavsdks.run(simulator.port, "gimbal")

    assert [answer[name] for name in ("control", "angles", "roi", "release")] == ["SUCCESS"] * 4
    assert abs(answer["yaw"] - 20) < 3
    assert answer["in_control"] == ["PRIMARY", 245]


def test_mavsdk_manual_control(sim):
    simulator = start(sim, speed=3, parameters={**PATIENT["px4"], "COM_RC_LOSS_T": 10.0})
    simulator.station()
    answer = mavsdks.run(simulator.port, "manual_control")

    assert [answer[name] for name in ("start", "arm", "altitude", "mode", "land")] == ["SUCCESS", "SUCCESS", "SUCCESS",
                                                                                       "ALTCTL", "SUCCESS"]


def test_mavsdk_ends_flights(sim):
    simulator = start(sim)
    station = simulator.station()
    with mavsdks.started(simulator.port, "failsafe_actions") as client:
        assert client.answer()["result"] == "SUCCESS"
        assert client.answer()["armed"] is False
    # The station may still have frames to read that came before MAVSDK's answer.
    station.expect("HEARTBEAT", where=lambda m: m.system_status == mavlink.MAV_STATE_FLIGHT_TERMINATION)


def test_mavsdk_reboots(sim):
    simulator = sim()
    simulator.station().ready()
    assert mavsdks.run(simulator.port, "reboot")["result"] == "SUCCESS"


@pytest.mark.parametrize("kind", ["quad"])
def test_mavsdk_flies_ardupilot(sim, kind):
    simulator = start(sim, "ardupilot", 5, "--vehicle", kind)
    station = simulator.station()
    for message, hertz in ((242, 1), (245, 5)):
        station.set_interval(message, 1e6 / hertz)
    with mavsdks.started(simulator.port, "short_flight", 8.0) as client:
        up, down = client.answer(), client.answer()

    assert up["results"] == ["SUCCESS"] * 3
    assert down["results"] == ["SUCCESS"]


def test_mavsdk_gets_the_answers_of_ardupilot(sim):
    """ArduPilot has no DO_ORBIT. Its missions begin with home, in a frame that MAVSDK's `mission` does not support."""
    simulator = start(sim, "ardupilot")
    simulator.station()
    rows = [[seq, 6, command, int(seq == 0), 1, 0, 0, 0, 0, 473979420, 85455940, 8.0, 0]
            for seq, command in enumerate((16, 22, 16))]
    answer = mavsdks.run(simulator.port, "refused_of_ardupilot", rows)

    assert answer["orbit"] == answer["download"] == "UNSUPPORTED"
    assert answer["upload"] == "SUCCESS"
    assert [row[1] for row in answer["raw"]] == [0, 3, 3]
    assert [row[9] for row in answer["raw"][1:]] == [473979420] * 2


# ---- MAVProxy

@pytest.fixture
def mavproxy(tmp_path):
    started = []

    def run(port, **options):
        started.append(mavproxies.Mavproxy(tmp_path / f"proxy{len(started)}", port, **options))
        return started[-1]
    yield run
    for one in started:
        one.close()


@pytest.mark.parametrize("seconds", [12, pytest.param(600, marks=[pytest.mark.long, pytest.mark.timeout(800)])])
def test_b09_mavproxy_keeps_the_link(sim, mavproxy, seconds):
    simulator = sim()
    simulator.station((254, 1))
    proxy = mavproxy(simulator.port)
    proxy.says("online system 1")
    proxy.says(r"(Received|Saved) \d+ parameters")
    end = time.monotonic() + seconds
    harness.wait_for(lambda: time.monotonic() > end, seconds + 60)
    proxy.type("link")
    proxy.says(r"link 1 OK")

    assert proxy.complaints == []


def test_mavproxy_flies_px4(sim, mavproxy, tmp_path):
    simulator = start(sim)
    station = simulator.station().ready()
    proxy = mavproxy(simulator.port)
    proxy.says("online system 1")
    count = len(station.parameters())
    proxy.says(rf"(Received|Saved) {count} parameters")
    proxy.type("param set MIS_TAKEOFF_ALT 6.5")
    harness.wait_for(lambda: station.parameter("MIS_TAKEOFF_ALT").param_value == 6.5, what="the parameter")
    proxy.repeats("param show MIS_TAKEOFF_ALT", r"MIS_TAKEOFF_ALT +6\.5")

    plan = [item(0, 22, 0, 0, 8), item(1, 16, 40, 0, 8), item(2, 16, 40, 30, 8)]
    path = mavproxies.write_waypoints(tmp_path / "plan.txt", plan)
    proxy.type(f"wp load {path}")
    harness.wait_for(lambda: len(station.download()) == 3, what="the mission")
    proxy.type("wp list")
    proxy.says(r"Saved 3 waypoints|Requesting 3 waypoints[\s\S]*2 ")
    plans(proxy, station, tmp_path)

    proxy.type("arm throttle")
    station.armed_is(True)
    proxy.type("long MISSION_START 0 0 0 0 0 0 0")
    station.mode_is(MISSION)
    station.expect("MISSION_ITEM_REACHED", where=lambda m: m.seq == 1)
    proxy.type("long NAV_RETURN_TO_LAUNCH 0 0 0 0 0 0 0")
    station.mode_is(RETURN)
    station.armed_is(False)
    assert metres_between(place(station.expect("GLOBAL_POSITION_INT")), HOME) < 2
    assert proxy.complaints == []


def plans(proxy, station, folder):
    """A fence and a rally point, from files."""
    fence = [item(seq, 5001, north, east, 0, frame=5, p=(3, 0, 0, 0), plan=1, current=0)
             for seq, (north, east) in enumerate([(200, -200), (200, 200), (-200, 0)])]
    proxy.type(f"fence load {mavproxies.write_waypoints(folder / 'fence.txt', fence)}")
    harness.wait_for(lambda: len(station.download(1)) == 3, what="the fence")
    proxy.type("fence list")
    proxy.says(r"Saved 3 fence|POLYGON|fence", 20)
    rally = [item(0, 5100, 50, 50, 20, frame=3, p=(0, 0, 0, 0), plan=2, current=0)]
    proxy.type(f"rally load {mavproxies.write_waypoints(folder / 'rally.txt', rally)}")
    harness.wait_for(lambda: len(station.download(2)) == 1, what="the rally point")


def test_mavproxy_moves_plans_of_ardupilot(sim, mavproxy, tmp_path):
    simulator = start(sim, "ardupilot")
    station = simulator.station().ready()
    proxy = mavproxy(simulator.port)
    proxy.says("online system 1")
    plan = [item(0, 16), item(1, 22, 0, 0, 8, p=(0, 0, 0, 0)), item(2, 16, 40, 0, 8, p=(0, 0, 0, 0)),
            item(3, 20, frame=3, p=(0, 0, 0, 0))]
    proxy.type(f"wp load {mavproxies.write_waypoints(tmp_path / 'plan.txt', plan)}")
    harness.wait_for(lambda: len(station.download()) == 4, what="the mission")
    plans(proxy, station, tmp_path)
    proxy.repeats("mode AUTO", "AUTO>|Mode AUTO")
    proxy.type("mode GUIDED")
    station.mode_is(4)
    proxy.type("arm throttle")
    station.armed_is(True)
    proxy.type("takeoff 8")
    station.height_is(8)
    proxy.type("mode AUTO")
    station.expect("MISSION_ITEM_REACHED", where=lambda m: m.seq == 2)
    station.armed_is(False)
    assert proxy.complaints == []


def test_mavproxy_rejoins_a_rebooted_vehicle(sim, mavproxy):
    simulator = sim()
    station = simulator.station().ready()
    proxy = mavproxy(simulator.port)
    proxy.says(r"(Received|Saved) \d+ parameters")
    mark = station.mark()
    proxy.type("reboot")
    station.until(lambda: station.latest("ATTITUDE").time_boot_ms < 2000, what="the reboot")
    station.ready()
    proxy.repeats("link", "link 1 OK")


# ---- through the router

def test_three_clients_through_a_router(sim, spawn, mavproxy, udp_port):
    """A ground station, an SDK and MAVProxy at once, each with its own state: nothing for one reaches another."""
    vehicle_port, ground_port = udp_port(), udp_port()
    router = spawn("route", f"udpin://127.0.0.1:{vehicle_port}", f"udpin://127.0.0.1:{ground_port}")
    router.wait_output("listening|udpin")
    simulator = start(sim, "px4", 5, "--to", f"udpout://127.0.0.1:{vehicle_port}")
    station = simulator.station(port=ground_port).ready()
    assert station.upload([item(0, 22, 0, 0, 8), item(1, 16, 40, 0, 8)]).type == 0
    proxy = mavproxy(ground_port)
    with mavsdks.started(ground_port, "three_at_once", "MIS_TAKEOFF_ALT", 9.5) as client:
        count = len(station.parameters())
        answer = client.answer()
    proxy.says("online system 1")
    proxy.says(rf"(Received|Saved) {count} parameters")
    proxy.type("wp list")
    mark = station.mark()
    proxy.type("arm throttle")
    station.armed_is(True, since=mark)
    station.armed_is(True)
    targets = {(m.target_system, m.target_component) for m in station.since(0)
               if getattr(m, "target_system", 0) not in (0, 1)}

    assert answer == {"parameters": count, "set": "SUCCESS", "mission": 2}
    assert station.parameter("MIS_TAKEOFF_ALT").param_value == 9.5
    assert targets <= {(255, 190)}  # so its sequence numbers have gaps
    assert proxy.complaints == []
    assert router.stop(signal.SIGINT).status in (0, 130)


def test_a_flight_through_a_router(sim, spawn, udp_port):
    vehicle_port, ground_port = udp_port(), udp_port()
    router = spawn("route", f"udpin://127.0.0.1:{vehicle_port}", f"udpin://127.0.0.1:{ground_port}")
    router.wait_output("listening|udpin")
    simulator = start(sim, "px4", 10, "--to", f"udpout://127.0.0.1:{vehicle_port}", listen=())
    station = simulator.station(port=ground_port)
    with mavsdks.started(ground_port, "short_flight", 6.0) as client:
        assert client.answer()["results"] == ["SUCCESS"] * 3
        assert station.is_armed
        assert client.answer()["results"] == ["SUCCESS"]
    station.expect("HEARTBEAT", where=lambda m: m.custom_mode in (HOLD, LAND))
