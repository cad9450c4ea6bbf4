# SPDX-License-Identifier: MIT
"""Real clients at the router: pymavlink, MAVProxy and MAVSDK load parameters, change one and move missions through it,
to and from a vehicle that is made with pymavlink. A frame for one of them reaches no other."""
import json
import os
import subprocess
import sys
import time

import pytest

import harness
import routers
import vehicle_stub
from frames import mavlink
from pymavlink import mavutil
from routers import Router
from vehicle_stub import Vehicle

VEHICLE = (vehicle_stub.SYSTEM, vehicle_stub.COMPONENT)
PYMAVLINK_URL = {"udpin": "udpout:127.0.0.1:{}", "udpout": "udpin:127.0.0.1:{}", "tcpin": "tcp:127.0.0.1:{}",
                 "tcpout": "tcpin:127.0.0.1:{}"}


class Side:
    """An endpoint of the router, and how a client reaches it."""

    def __init__(self, kind):
        self.kind = kind
        self.port = routers.udp_port() if kind.startswith("udp") else routers.tcp_port()
        self.url = f"{kind}://127.0.0.1:{self.port}"
        self.client_url = PYMAVLINK_URL[kind].format(self.port)


class Station:
    """A ground station made with pymavlink."""

    def __init__(self, side, system=255, component=190):
        self.id = (system, component)
        self.connection = mavutil.mavlink_connection(side.client_url, source_system=system, source_component=component)
        self.seen = []  # (name, target system) of all that came

    def next(self, *names, timeout=harness.DEFAULT_TIMEOUT_S):
        deadline = time.monotonic() + timeout
        while time.monotonic() < deadline:
            message = self.connection.recv_match(blocking=True, timeout=0.1)
            if message is None:
                continue
            self.seen.append((message.get_type(), getattr(message, "target_system", None)))
            if message.get_type() in names:
                return message
        raise AssertionError(f"no {' or '.join(names)} within {timeout:g} s")

    def meet(self):
        """Until the vehicle is heard, and has heard this station."""
        deadline = time.monotonic() + harness.DEFAULT_TIMEOUT_S
        while time.monotonic() < deadline:
            self.connection.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0)
            if self.connection.recv_match(type="HEARTBEAT", blocking=True, timeout=0.2):
                return
        raise AssertionError("the vehicle was not heard")

    def fetch_parameters(self):
        self.connection.mav.param_request_list_send(*VEHICLE)
        got, count = {}, None
        while count is None or len(got) < count:
            message = self.next("PARAM_VALUE")
            got[message.param_id], count = (message.param_value, message.param_type), message.param_count
        return got

    def set_parameter(self, name, value, kind):
        self.connection.mav.param_set_send(*VEHICLE, name.encode(), value, kind)
        while (message := self.next("PARAM_VALUE")).param_id != name:
            pass
        return message.param_value

    def upload(self, items):
        self.connection.mav.mission_count_send(*VEHICLE, len(items), 0)
        while (message := self.next("MISSION_REQUEST_INT", "MISSION_REQUEST",
                                    "MISSION_ACK")).get_type() != "MISSION_ACK":
            self.connection.mav.mission_item_int_send(*VEHICLE, *items[message.seq], 0)
        return message.type

    def download(self):
        self.connection.mav.mission_request_list_send(*VEHICLE, 0)
        items = []
        for number in range(self.next("MISSION_COUNT").count):
            self.connection.mav.mission_request_int_send(*VEHICLE, number, 0)
            items.append(plain(self.next("MISSION_ITEM_INT")))
        self.connection.mav.mission_ack_send(*VEHICLE, mavlink.MAV_MISSION_ACCEPTED, 0)
        return items


def plain(item):
    return (item.seq, item.frame, item.command, item.current, item.autocontinue, item.param1, item.param2, item.param3,
            item.param4, item.x, item.y, item.z)


def mission(count=40):
    """Home, a take-off and a row of waypoints, in numbers that a float carries exactly."""
    frame = mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT
    return [(number, frame, mavlink.MAV_CMD_NAV_TAKEOFF if number == 1 else mavlink.MAV_CMD_NAV_WAYPOINT,
             int(number == 0), 1, 0.5 * number, 0.0, 0.0, 0.0, 473977418 + 1000 * number, 85455939 - 1000 * number,
             10.0 + number) for number in range(count)]


@pytest.fixture
def vehicle():
    """vehicle(side) -> a vehicle at that side of the router."""
    there = []

    def make(side):
        there.append(Vehicle(side.client_url).__enter__())
        return there[-1]
    yield make
    for one in there:
        one.__exit__()


@pytest.mark.short
@pytest.mark.parametrize("heard", ["vehicle", "router"])
def test_a_client_hears_the_routers_heartbeat_only_where_it_is_asked_for(spawn, heard):
    """`wait_heartbeat` takes the first heartbeat for the vehicle's."""
    air, ground = Side("udpout"), Side("tcpin")
    option = "?heartbeat=true" if heard == "router" else ""
    with routers.UdpEnd(port=air.port) as craft:
        router = Router(spawn, air.url, ground.url + option, rules={"heartbeat": "255/191"})
        station = Station(ground)
        router.wait_links(2)
        craft.now()
        craft.count(3)  # the router is at work
        craft.target = craft.source
        craft.send(routers.heartbeat())
        got = station.connection.wait_heartbeat(timeout=harness.DEFAULT_TIMEOUT_S)
        station.connection.close()

    assert (got.get_srcSystem(), got.get_srcComponent()) == ((1, 1) if heard == "vehicle" else (255, 191))


@pytest.mark.short
@pytest.mark.parametrize("air, ground", [("udpin", "udpin"), ("udpin", "tcpin"), ("tcpin", "udpin"),
                                         ("udpout", "tcpin"), ("tcpout", "udpin"), ("udpin", "udpout")])
def test_pymavlink_parameters_and_a_mission(spawn, vehicle, air, ground):
    air, ground = Side(air), Side(ground)
    if ground.kind.endswith("out"):  # a listener of pymavlink is there before it is called
        station = Station(ground)
    craft = vehicle(air) if air.kind.endswith("out") else None
    router = Router(spawn, air.url, ground.url)
    craft = craft or vehicle(air)
    if not ground.kind.endswith("out"):
        station = Station(ground)
    bystander = Station(ground, 254, 190) if ground.kind.endswith("in") else None
    for one in filter(None, (station, bystander)):
        one.meet()

    assert station.fetch_parameters() == craft.parameters
    assert station.set_parameter("TEST_007", 1234.0, mavlink.MAV_PARAM_TYPE_INT32) == 1234.0
    assert craft.parameters["TEST_007"][0] == 1234.0
    assert station.upload(mission()) == mavlink.MAV_MISSION_ACCEPTED
    assert [plain(item) for item in craft.mission] == mission()
    assert station.download() == mission()
    if bystander:  # it heard the parameters, and nothing of the other's mission
        bystander.meet()
        while bystander.connection.recv_match(type="PARAM_VALUE", blocking=True, timeout=0.3):
            pass
        assert not [seen for seen in bystander.seen if seen[1] not in (None, 0, 254)]
        bystander.connection.close()
    assert all(link["lost"] == 0 for link in router.links())
    assert sum(link["unknown_target"] + link["queue_age"] + link["queue_bytes"] for link in router.links()) == 0
    station.connection.close()


@pytest.mark.short
def test_two_stations_at_once_each_get_their_own_answers(spawn, vehicle):
    air, ground, other = Side("udpin"), Side("udpin"), Side("tcpin")
    router = Router(spawn, air.url, ground.url, other.url)
    craft = vehicle(air)
    first, second = Station(ground, 255, 190), Station(other, 254, 191)
    for station in (first, second):
        station.meet()
    first.upload(mission(25))
    assert [len(station.download()) for station in (first, second)] == [25, 25]
    assert first.fetch_parameters() == second.fetch_parameters() == craft.parameters

    # Nobody saw what was for the other one.
    assert {target for _, target in first.seen} == {None, 255} and {target for _, target in second.seen} == {None, 254}
    assert router.process.alive
    for station in (first, second):
        station.connection.close()


# ---- MAVProxy --------------------------------------------------------------------------------------------------------

class Mavproxy:
    """MAVProxy as a person uses it: commands typed, answers read."""

    def __init__(self, spawn_process, side, folder):
        program = os.path.join(os.path.dirname(sys.executable), "mavproxy.py")
        self.folder = folder
        self.process = spawn_process([sys.executable, "-u", program, f"--master={side.client_url}",
                                      "--default-modules=param,wp,arm,cmdlong,link", f"--state-basedir={folder}",
                                      "--source-system=253"],
                                     stdin=subprocess.PIPE, cwd=folder,
                                     env={**os.environ, "HOME": str(folder), "TERM": "dumb"})

    def type(self, text):
        self.process.process.stdin.write(text.encode() + b"\n")
        self.process.process.stdin.flush()

    def says(self, pattern):
        return self.process.wait_output(pattern)


@pytest.fixture
def mavproxy(tmp_path):
    made = []

    def start(command, **options):
        made.append(harness.Running(command, **options))
        return made[-1]
    yield lambda side: Mavproxy(start, side, tmp_path)
    for process in made:
        process.kill()


def write_waypoints(path, items):
    """The text form that MAVProxy and Mission Planner read."""
    lines = ["QGC WPL 110"]
    for seq, frame, what, current, more, p1, p2, p3, p4, x, y, z in items:
        lines.append("\t".join(str(v) for v in (seq, current, 3, what, p1, p2, p3, p4, f"{x / 1e7:.7f}",
                                                f"{y / 1e7:.7f}", z, more)))
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize("air, ground", [("udpin", "udpin"), ("tcpin", "tcpin")])
def test_mavproxy_parameters_and_a_mission(spawn, vehicle, mavproxy, tmp_path, air, ground):
    air, ground = Side(air), Side(ground)
    router = Router(spawn, air.url, ground.url)
    craft = vehicle(air)
    sut = mavproxy(ground)
    sut.says(r"Received 150 parameters")
    sut.type("param set TEST_003 77.25")
    harness.wait_for(lambda: craft.parameters["TEST_003"][0] == 77.25, what="the parameter to change")
    sut.type("param show TEST_003")
    sut.says(r"TEST_003 +77\.25")
    items = mission(30)
    sut.type(f"wp load {write_waypoints(tmp_path / 'way.txt', items)}")
    harness.wait_for(lambda: len(craft.mission) == 30, what="the mission to arrive")
    saved = tmp_path / "saved.txt"
    sut.type(f"wp save {saved}")
    sut.says(r"Saved \d+ waypoints to")
    harness.wait_for(lambda: saved.exists() and len(saved.read_text().splitlines()) == 31,
                     what="the mission to come back")

    def of_items(all_items):
        return [(what, p1, z) for _, _, what, _, _, p1, _, _, _, _, _, z in all_items[1:]]
    arrived = [plain(item) for item in craft.mission]
    assert of_items(arrived) == of_items(items)
    # MAVProxy keeps degrees as numbers with a fraction and cuts them off: the last digit may differ.
    assert all(abs(got[at] - sent[at]) <= 1 for got, sent in zip(arrived[1:], items[1:]) for at in (9, 10))
    back = [line.split("\t") for line in saved.read_text().splitlines()[1:]]
    assert [(int(line[3]), float(line[4]), float(line[10])) for line in back[1:]] == of_items(items)
    assert all(link["lost"] == 0 for link in router.links())
    assert sum(link["unknown_target"] for link in router.links()) == 0


# ---- MAVSDK ----------------------------------------------------------------------------------------------------------

MAVSDK_CLIENT = r"""
import json, sys
try:
    from mavsdk import ComponentType, Configuration, Mavsdk
    from mavsdk.plugins.mission_raw.mission_raw import MissionItem, MissionRaw
    from mavsdk.plugins.param.param import Param, ProtocolVersion
    from mavsdk.plugins.action.action import Action
except OSError as error:  # its library does not load on this machine
    print(json.dumps({"cannot": str(error)}))
    sys.exit(0)
sdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
sdk.add_any_connection(sys.argv[1])
system = sdk.first_autopilot(60.0)
assert system, "no vehicle was heard"
answer = {}
parameters = Param(system)
everything = parameters.get_all_params()
answer["parameters"] = {p.name: p.value for p in [*everything.int_params, *everything.float_params]}
parameters.set_param_float("TEST_003", 77.25)
parameters.set_param_int("TEST_004", 4321)
answer["set"] = [parameters.get_param_float("TEST_003"), parameters.get_param_int("TEST_004")]
mission = MissionRaw(system)
items = [MissionItem(*fields, 0) for fields in json.loads(sys.argv[2])]
mission.upload_mission(items)
names = ("seq", "frame", "command", "current", "autocontinue", "param1", "param2", "param3", "param4", "x", "y", "z")
answer["mission"] = [[getattr(item, name) for name in names] for item in mission.download_mission()]
Action(system).arm()
print(json.dumps(answer))
"""


@pytest.mark.parametrize("air, ground", [("udpin", "udpin"), ("udpin", "tcpin"), ("tcpin", "udpout")])
def test_mavsdk_parameters_and_a_mission(spawn, vehicle, air, ground):
    air, ground = Side(air), Side(ground)
    # MAVSDK's words for the other side of ours.
    url = {"udpin": "udpout", "udpout": "udpin", "tcpin": "tcpout"}[ground.kind] + f"://127.0.0.1:{ground.port}"
    router = Router(spawn, air.url, ground.url)
    craft = vehicle(air)
    items = mission(30)
    client = subprocess.run([sys.executable, "-c", MAVSDK_CLIENT, url, json.dumps(items)], capture_output=True,
                            text=True, timeout=110)
    assert client.returncode == 0, client.stderr[-4000:] + client.stdout[-4000:]
    answer = json.loads(client.stdout.splitlines()[-1])
    if "cannot" in answer:
        pytest.skip(f"MAVSDK's library does not load here: {answer['cannot']}")

    expected = vehicle_stub.parameters()
    assert answer["parameters"] == {name: value for name, (value, _) in expected.items()}
    assert answer["set"] == [77.25, 4321]
    assert (craft.parameters["TEST_003"][0], craft.parameters["TEST_004"][0]) == (77.25, 4321)
    assert [tuple(item) for item in answer["mission"]] == items
    assert [plain(item) for item in craft.mission] == items
    assert mavlink.MAV_CMD_COMPONENT_ARM_DISARM in craft.commands
    assert sum(link["unknown_target"] + link["lost"] for link in router.links()) == 0
