# SPDX-License-Identifier: MIT
"""mavloom sim as a process: options, scenario files, links of every kind, ctl, stat, reports, rings, signals. Flights
with real clients are in other files."""
import collections
import contextlib
import json
import os
import pty
import select
import signal
import socket
import time
import tty
import urllib.request

import pytest

import frames
import harness
from frames import mavlink
from routers import make

pytestmark = pytest.mark.short

GCS = (255, 190)
HEARTBEAT, ATTITUDE, VFR_HUD, COMMAND_ACK, AUTOPILOT_VERSION = 0, 30, 74, 77, 148


def name():
    return f"sim-{os.getpid()}-{harness.free_port()}"


def decode(frame):
    return mavlink.MAVLink(None).decode(bytearray(frame))


def header(frame):
    """(sequence, system, component, message id) of a MAVLink 2 frame."""
    assert frame[0] == 0xFD, frame.hex()
    return frame[4], frame[5], frame[6], int.from_bytes(frame[7:10], "little")


def request_message(message_id, target=(1, 1)):
    return make(mavlink.MAVLink_command_long_message(*target, 512, 0, message_id, 0, 0, 0, 0, 0, 0), GCS)


def set_interval(message_id, interval_us, target=(1, 1)):
    return make(mavlink.MAVLink_command_long_message(*target, 511, 0, message_id, interval_us, 0, 0, 0, 0, 0), GCS)


def heartbeat():
    return make(mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3), GCS)


class Client:
    """One end of a link to a simulator, over UDP or a stream: frames come with the order in which they were sent."""

    def __init__(self, sock, peer=None):
        self.sock, self.peer, self._left = sock, peer, b""
        self.got = []
        self.mark = 0  # until() looks at the frames from here on

    def send(self, frame):
        self.mark = len(self.got)
        if self.peer:
            self.sock.sendto(frame, self.peer)
        else:
            self.sock.sendall(frame)

    def read(self, timeout=0.2):
        """Takes what has come, and waits for it for `timeout` seconds."""
        if not select.select([self.sock], [], [], timeout)[0]:
            return
        if self.sock.type == socket.SOCK_DGRAM:
            data, self.peer = self.sock.recvfrom(65536)
        else:
            data = self._left + self.sock.recv(65536)
        while data and len(data) >= 12 and len(data) >= frames.frame_length(data, 0):
            size = frames.frame_length(data, 0)
            self.got.append(data[:size])
            data = data[size:]
        assert not data or self.sock.type != socket.SOCK_DGRAM, "part of a frame in a datagram"
        self._left = data

    def until(self, message_id, system=1, timeout=harness.DEFAULT_TIMEOUT_S):
        """The first frame of a message since the last send(), as pymavlink decodes it."""
        deadline = time.monotonic() + timeout
        first = self.mark
        while time.monotonic() < deadline:
            for frame in self.got[first:]:
                if header(frame)[1::2] == (system, message_id):
                    return decode(frame)
            first = len(self.got)
            self.read()
        raise AssertionError(f"no message {message_id} from system {system} within {timeout} s")

    def next(self, message_id, system=1):
        """The same, from now on."""
        self.mark = len(self.got)
        return self.until(message_id, system)

    def clear(self):
        self.got.clear()
        self.mark = 0

    def collect(self, seconds):
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            self.read(max(0, deadline - time.monotonic()))

    def take_rest(self, patience=0.0):
        """Takes all that has come, until nothing follows for so many seconds."""
        before = -1
        while len(self.got) != before:
            before = len(self.got)
            self.read(patience)

    def gaps(self):
        """Frames missing between those that came, by the sequence numbers of each system and component."""
        last, missing = {}, 0
        for frame in self.got:
            sequence, system, component, _ = header(frame)
            source = (system, component)
            if source in last:
                missing += (sequence - last[source] - 1) % 256
            last[source] = sequence
        return missing


@pytest.fixture
def sim(spawn):
    """sim(*options) -> the running simulator, with a name of its own as `.name`."""
    def start(*options, own_name=True, **more):
        used = name()
        running = spawn("sim", *options, *(["--name", used] if own_name else []), **more)
        running.name = used
        return running
    return start


@pytest.fixture
def station(udp_socket):
    """A ground station that waits at a port of its own: (client, the endpoint that sends to it)."""
    sock = udp_socket()
    return Client(sock), f"udpout://127.0.0.1:{sock.getsockname()[1]}"


@pytest.fixture
def ctl(run):
    def call(running, *args, command="ctl"):
        return run(command, running.name, *args)
    return call


def objects(done):
    assert done.status == 0, done
    return [json.loads(line) for line in done.lines]


# ---- on the wire -----------------------------------------------------------------------------------------------------

def test_the_first_datagram_is_a_heartbeat_of_an_autopilot(sim, station):
    client, url = station
    sim("--to", url)

    beat = client.until(HEARTBEAT)

    assert header(client.got[0]) == (0, 1, 1, HEARTBEAT)
    assert (beat.type, beat.autopilot, beat.mavlink_version) == (2, 12, 3)


@pytest.mark.parametrize("options, expected", [
    (("--vehicle", "plane"), (1, 12)), (("--vehicle", "rover"), (10, 12)),
    (("--autopilot", "ardupilot"), (2, 3)), (("--vehicle", "rover", "--autopilot", "ardupilot"), (10, 3))])
def test_kind_and_autopilot_show_in_the_heartbeat(sim, station, options, expected):
    client, url = station
    sim("--to", url, *options)
    beat = client.until(HEARTBEAT)

    assert (beat.type, beat.autopilot) == expected


def test_a_command_gets_its_answer_where_it_came_from(sim, station):
    client, url = station
    sim("--to", url, "--system", "7")
    client.until(HEARTBEAT, system=7)
    client.send(request_message(AUTOPILOT_VERSION, (7, 1)))

    version = client.until(AUTOPILOT_VERSION, system=7)
    ack = client.until(COMMAND_ACK, system=7)

    assert version.capabilities & 8192  # MAVLink 2
    assert (ack.command, ack.result, ack.target_system, ack.target_component) == (512, 0, *GCS)
    assert client.gaps() == 0


def test_a_frame_for_another_system_gets_no_answer(sim, station):
    client, url = station
    sim("--to", url)
    client.until(HEARTBEAT)
    client.send(request_message(AUTOPILOT_VERSION, (9, 1)))
    client.send(request_message(AUTOPILOT_VERSION, (1, 1)))
    client.until(COMMAND_ACK)

    assert sum(header(frame)[3] == AUTOPILOT_VERSION for frame in client.got) == 1


def test_several_vehicles_stand_5_m_apart_and_all_answer(sim, station):
    client, url = station
    sim("--to", url, "--vehicles", "4", "--system", "10", "--home", "0,0,100,0")
    places = [client.until(33, system) for system in range(10, 14)]
    client.send(make(mavlink.MAVLink_command_long_message(0, 0, 512, 0, AUTOPILOT_VERSION, 0, 0, 0, 0, 0, 0), GCS))
    versions = {client.until(AUTOPILOT_VERSION, system).uid for system in range(10, 14)}

    metres = 111_195e-7  # of 1e-7 degrees, at the equator
    at = [(place.lat * metres, place.lon * metres) for place in places]
    expected = [(0, 0), (0, 5), (5, 0), (5, 5)]
    assert all(abs(n - x) < 0.5 and abs(e - y) < 0.5 for (n, e), (x, y) in zip(at, expected)), at
    assert len(versions) == 4
    assert client.gaps() == 0


def test_each_peer_of_a_port_has_rates_and_numbers_of_its_own(sim, udp_socket, tcp_port):
    port = tcp_port()
    running = sim("--listen", f"udpin://127.0.0.1:{port}")
    running.wait_output("listening")
    first, second = (Client(udp_socket(), ("127.0.0.1", port)) for _ in range(2))
    for client in (first, second):
        client.send(heartbeat())
        assert client.until(HEARTBEAT).autopilot == 12
        assert header(client.got[0])[0] == 0
    first.send(set_interval(ATTITUDE, 10_000))
    assert first.until(COMMAND_ACK).result == 0
    for client in (first, second):
        client.clear()
    first.collect(1)
    for client in (first, second):
        client.take_rest()
    counts = [collections.Counter(header(frame)[3] for frame in client.got) for client in (first, second)]

    assert counts[0][ATTITUDE] > 3 * counts[1][ATTITUDE] > 0
    assert first.gaps() == second.gaps() == 0


def test_clients_over_tcp_come_and_go(sim, tcp_port):
    port = tcp_port()
    running = sim("--listen", f"tcpin://127.0.0.1:{port}")
    running.wait_output("listening")
    for _ in range(2):
        with socket.create_connection(("127.0.0.1", port)) as sock:
            client = Client(sock)
            client.until(HEARTBEAT)
            client.send(request_message(AUTOPILOT_VERSION))
            client.until(AUTOPILOT_VERSION)
            assert client.gaps() == 0
        running.wait_output("down")


def test_half_of_a_serial_line_is_left_for_answers(sim):
    far, near = pty.openpty()
    tty.setraw(near)
    running = sim("--to", f"serial://{os.ttyname(near)}?baud=57600", "--profile", "px4-normal", "--for", "3s",
                  "--report", "--json")
    running.wait_output("up$")
    os.close(near)
    got = b""
    with contextlib.suppress(OSError):  # the end of the simulator
        while True:
            if select.select([far], [], [], harness.DEFAULT_TIMEOUT_S)[0]:
                got += os.read(far, 65536)
    os.close(far)
    done = running.wait()
    streams = {row["name"]: row for row in map(json.loads, done.lines) if row["kind"] == "stream"}

    half_s = 57600 / 10 / 2
    assert 0.5 * half_s < len(got) / 3 < 1.15 * half_s  # the start is a little more
    assert streams["ATTITUDE"]["asked_hz"] == 50 and streams["ATTITUDE"]["achieved_hz"] < 25
    assert streams["HEARTBEAT"]["sent"] >= 3
    total = done.lines and [row for row in map(json.loads, done.lines) if row["kind"] == "link_total"][0]
    assert total["gaps"] == 0


def test_what_max_bytes_allows_is_kept(sim, station, run):
    client, url = station
    begin = time.monotonic()
    done = run("sim", "--to", f"{url}?max_bytes=1000", "--profile", "px4-normal", "--for", "3s", "--name", name())
    assert done.status == 0, done
    most = 1000 * (time.monotonic() - begin) + 750
    client.take_rest(0.1)

    assert 1500 < sum(map(len, client.got)) < most


# ---- options and scenarios -------------------------------------------------------------------------------------------

@pytest.mark.parametrize("options, text", [
    (("--vehicle", "qad"), "--vehicle: 'qad' is none of quad, plane, rover, did you mean 'quad'?"),
    (("--autopilot", "ardupilt"), "--autopilot: 'ardupilt' is none of px4, ardupilot, did you mean 'ardupilot'?"),
    (("--profile", "px4-norml"), "did you mean 'px4-normal'?"),
    (("--motion", "randm"), "did you mean 'random'?"),
    (("--home", "47"), "--home: '47' is not LAT,LON[,ALT[,HEADING]], as in 47.397742,8.545594 or "),
    (("--home", "97,8,0,0"), "--home: latitude: '97' is not a number from -90 to 90"),
    (("--home", "nan,8,0,0"), "--home: latitude: 'nan' is not a number from -90 to 90"),
    (("--home", "1,2,3,4,5"), "--home: '5' is one value too many"),
    (("--wind", "5"), "--wind: '5' is not SPEED,DIR"),
    (("--wind", "inf,0"), "--wind: speed: 'inf' is not a number from 0 to 60"),
    (("--speed", "0"), "--speed: '0' is neither a number from 0.1 to 100 nor max"),
    (("--seed", "-1"), "--seed: '-1' is not a whole number"),
    (("--system", "255"), "--system: '255' is not a system id of a vehicle, which is from 1 to 254"),
    (("--vehicles", "0"), "--vehicles: '0' is not a whole number from 1 to 254"),
    (("--vehicles", "100", "--system", "200"), "would have id 299"),
    (("--traffic", "65"), "--traffic: '65' is not a whole number from 0 to 64"),
    (("--for", "soon"), "--for: 'soon' is not a duration"),
    (("--name", "a b"), "--name: 'a b' is not a simulator name"),
    (("--ring", "a/b"), "--ring: 'a/b' is not a ring name"),
    (("--metrics", "9090"), "--metrics: '9090' is not HOST:PORT"),
    (("--to", "udpin://127.0.0.1:14550"), "put udpin://127.0.0.1:14550 after --listen"),
    (("--listen", "udpout://127.0.0.1:14550"), "put udpout://127.0.0.1:14550 after --to"),
    (("udpout://127.0.0.1:14550",), "for an endpoint, write --to udpout://127.0.0.1:14550"),
    (("udpin:127.0.0.1:14550",), "for an endpoint, write --listen udpin:127.0.0.1:14550"),
    (("--to", "udp://127.0.0.1:14550"), "udpout://127.0.0.1:14550"),
    (("--to", "udpout://127.0.0.1:1?max_rate=*:5"), "max_rate"),
    (("--to", "tlog://x.tlog"), "a simulator writes no recordings"),
    (("--autopilt", "px4"), "did you mean '--autopilot'?"),
])
def test_wrong_use_is_status_2_and_teaches(run, options, text):
    done = run("sim", *options)

    assert done.status == 2 and done.stdout == "", done
    assert text in done.stderr, done


def test_a_port_in_use_is_status_1(run, udp_socket):
    port = udp_socket().getsockname()[1]
    done = run("sim", "--listen", f"udpin://127.0.0.1:{port}", "--name", name())

    assert done.status == 1 and "in use" in done.stderr, done


SCENARIO = """\
[sim]
seed = 42
profile = "lite"
[streams]
ATTITUDE = 20
[[vehicle]]
kind = "plane"
system = 5
home = [47.1, 8.5, 400, 90]
wind = "5,270"
battery = {capacity = 3000, minutes = 10}
[vehicle.parameters]
NAV_DLL_ACT = 2
[[vehicle]]
autopilot = "ardupilot"
count = 2
body = {preset = "iris", mass = 1.7}
[[endpoint]]
url = "udpout://127.0.0.1:14550?name=station"
streams = {VFR_HUD = 3}
"""


def test_check_shows_the_values_of_a_scenario_with_their_origin(run, tmp_path):
    path = tmp_path / "scenario.toml"
    path.write_text(SCENARIO)
    found = {(v["section"], v["endpoint"], v["key"]): v
             for v in objects(run("check", path, "--json", env={"MAVLOOM_SIM_SPEED": "2"}))}

    assert (found["sim", None, "seed"]["value"], found["sim", None, "seed"]["line"]) == ("42", 2)
    assert found["sim", None, "speed"]["variable"] == "MAVLOOM_SIM_SPEED"
    assert (found["streams", None, "ATTITUDE"]["value"], found["streams", None, "ATTITUDE"]["line"]) == ("20", 5)
    assert found["vehicle", "5", "home"]["value"] == "47.1,8.5,400,90"
    assert found["vehicle", "5", "battery"]["value"] == "capacity:3000,minutes:10"
    assert found["vehicle", "5", "body"]["value"] == "standard"
    assert found["vehicle", "6 to 7", "body"]["value"] == "mass:1.7,preset:iris"
    assert found["vehicle", "6 to 7", "system"]["value"] == "6"
    assert found["vehicle", "6 to 7", "kind"]["origin"] == "default"
    assert found["endpoint", "station", "streams"]["value"] == "VFR_HUD:3"


@pytest.mark.parametrize("text, expected", [
    ("[sin]\n[[vehicle]]\n", "1: there is no section 'sin', did you mean 'sim'?"),
    ("[sim]\n[router]\n", "2: there is no section 'router'; there are sim, web, streams, vehicle, endpoint, event"),
    ("[sim]\nsed = 1\n", "2: [sim] has no key 'sed', did you mean 'seed'?"),
    ("[sim]\nspeed = 1000\n", "2: speed: '1000' is neither a number from 0.1 to 100 nor max"),
    ("[vehicle]\nkind = 1\n", "1: vehicles are written [[vehicle]], each with its own heading"),
    ("[[vehicle]]\nknd = 'quad'\n", "2: [[vehicle]] has no key 'knd', did you mean 'kind'?"),
    ("[[vehicle]]\nkind = 'qad'\n", "2: kind: 'qad' is none of quad, plane, rover, did you mean 'quad'?"),
    ("[[vehicle]]\nhome = [1, 2, 'x']\n", "2: home: altitude: 'x' is not a number from -500 to 20000"),
    ("[[vehicle]]\n[vehicle.battery]\ncapacity = 5000\ncels = 3\n",
     "4: battery: 'cels' is none of capacity, cells, minutes, start, did you mean 'cells'?"),
    ("[[vehicle]]\n[vehicle.body]\nmass = 1.5\nthrst = 3\n", "4: body: 'thrst' is none of "),
    ("[[vehicle]]\n[vehicle.body]\nmass = 5\n", "2: body: its 4 motors lift 29.4 N, and it weighs 49.0 N"),
    ("[[vehicle]]\nkind = 'plane'\nbody = 'iris'\n", "3: body: preset: 'iris' is none of standard, aerosonde, gazebo"),
    ("[[vehicle]]\n[vehicle.parameters]\nNAV_DLL_ACT = 2\nNAV_DLL_AKT = 2\n",
     "4: a quad has no parameter 'NAV_DLL_AKT', did you mean 'NAV_DLL_ACT'?"),
    ("[[vehicle]]\nsystem = 3\n[[vehicle]]\nsystem = 3\n", "4: two vehicles have system id 3; each needs its own"),
    ("[[vehicle]]\nsystem = 250\ncount = 10\n", "3: the last of 10 vehicles from system id 250 on would have id 259"),
    ("[streams]\nATITUDE = 5\n", "2: vehicles stream no message 'ATITUDE', did you mean 'ATTITUDE'?"),
    ("[streams]\nATTITUDE = 1000\n", "2: ATTITUDE: '1000' is not a number from 0 to 250"),
    ("[sim]\n[[endpoint]]\nurl = 'udpout://127.0.0.1:14550'\nstreams = {ATTITUDE = -1}\n",
     "4: ATTITUDE: '-1' is not a number from 0 to 250"),
    ("[sim]\n[[endpoint]]\nurl = 'udpout://127.0.0.1:14550'\nprofile = 'lit'\n", "4: profile: 'lit' is none of lite,"),
    ("[sim]\n[[endpoint]]\nurl = 'udpout://127.0.0.1:14550'\nmax_rat = 1\n", "4: "),
    ("[sim]\n[[endpoint]]\nurl = 'udpout://127.0.0.1:14550?max_rate=*:5'\n", "2: "),
    ("[sim]\n[[endpoint]]\nurl = 'udpin://127.0.0.1:14550'\n[[endpoint]]\nurl = 'udpin://0.0.0.0:14550'\n",
     "5: 'udpin://0.0.0.0:14550' binds UDP port 14550, which 'udpin://127.0.0.1:14550' in line 3 already uses"),
    ("[sim\n", "1: "),
])
def test_a_bad_scenario_is_status_3_with_its_line(run, tmp_path, text, expected):
    path = tmp_path / "bad.toml"
    path.write_text(text)
    for command in ("check", "sim"):
        done = run(command, path)

        assert done.status == 3 and done.stdout == "", done
        assert f"{path}:{expected}" in done.stderr, done


def test_a_scenario_flies_as_written_and_options_come_last(sim, station, tmp_path):
    client, url = station
    path = tmp_path / "scenario.toml"
    path.write_text(SCENARIO.replace("udpout://127.0.0.1:14550", url))
    sim(path, "--seed", "7")

    assert client.until(HEARTBEAT, 5).type == 1
    assert client.until(HEARTBEAT, 6).autopilot == client.until(HEARTBEAT, 7).autopilot == 3
    client.until(ATTITUDE, 5)
    client.clear()
    client.collect(2)
    counts = collections.Counter(header(frame)[1::2] for frame in client.got)
    assert 5 < counts[5, ATTITUDE] / counts[5, VFR_HUD] < 9  # 20 to 3


def test_options_of_one_vehicle_are_not_for_a_file_of_several(run, tmp_path):
    path = tmp_path / "two.toml"
    path.write_text("[[vehicle]]\n[[vehicle]]\n")
    done = run("sim", path, "--vehicles", "3")

    assert done.status == 2 and "has several vehicles; write it there" in done.stderr, done


def test_a_missing_scenario_is_status_3(run, tmp_path):
    assert run("sim", tmp_path / "none.toml").status == 3
    assert run("check", tmp_path / "none.toml").status == 3


# ---- life and death --------------------------------------------------------------------------------------------------

def test_for_ends_it_with_0(run, station):
    done = run("sim", "--to", station[1], "--for", "200ms", "--name", name())

    assert done.status == 0 and done.stdout == "", done


@pytest.mark.parametrize("number, status", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_signals_end_it_cleanly(sim, station, number, status):
    client, url = station
    running = sim("--to", url)
    client.until(HEARTBEAT)

    assert running.stop(number).status == status
    assert not (harness.RUN / f"{running.name}.ctl").exists()
    assert not os.path.exists(f"/dev/shm/mavloom.{running.name}.stat")


def test_the_service_manager_hears_that_it_is_ready(sim, station, tmp_path):
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(str(tmp_path / "notify"))
        manager.settimeout(harness.DEFAULT_TIMEOUT_S)
        running = sim("--to", station[1], env={"NOTIFY_SOCKET": str(tmp_path / "notify")})
        assert manager.recv(4096) == b"READY=1"
        running.send(signal.SIGTERM)
        assert manager.recv(4096) == b"STOPPING=1"


def test_two_simulators_of_one_name(sim, station, run):
    client, url = station
    running = sim("--to", url)
    client.until(HEARTBEAT)
    done = run("sim", "--to", url, "--name", running.name, "--for", "1s")

    assert done.status == 1 and "give this one another name with --name" in done.stderr, done


def test_a_vanished_peer_disturbs_nobody(sim, station, udp_socket):
    client, url = station
    gone = udp_socket()
    running = sim("--to", url, "--to", f"udpout://127.0.0.1:{gone.getsockname()[1]}")
    Client(gone).until(HEARTBEAT)
    gone.close()
    client.until(HEARTBEAT)
    client.collect(1.2)
    client.next(HEARTBEAT)

    assert running.alive and client.gaps() == 0


# ---- ctl, stat, reports ----------------------------------------------------------------------------------------------

def test_ctl_commands_a_vehicle(sim, station, ctl):
    client, url = station
    running = sim("--to", url)
    client.until(HEARTBEAT)

    state, = objects(ctl(running, "state"))
    assert (state["kind"], state["system"], state["type"], state["armed"]) == ("vehicle", 1, "quad", False)
    harness.wait_for(lambda: objects(ctl(running, "state"))[0]["ready"], what="the vehicle to be ready")
    assert objects(ctl(running, "arm"))[0]["armed"]
    assert objects(ctl(running, "disarm"))[0]["armed"] is False
    assert objects(ctl(running, "mode", "position"))[0]["mode"] == "Position"
    assert objects(ctl(running, "param", "MIS_TAKEOFF_ALT", "7.5"))[0]["value"] == 7.5
    assert objects(ctl(running, "param", "MIS_TAKEOFF_ALT"))[0]["value"] == 7.5


def test_ctl_flies_there_and_waits(sim, station, ctl):
    client, url = station
    running = sim("--to", url, "--speed", "10")
    client.until(HEARTBEAT)

    ready, = objects(ctl(running, "wait", "ready"))
    assert ready["ready"] and not ready["armed"]
    ctl(running, "takeoff", "10")
    there, = objects(ctl(running, "wait", "alt", "10"))
    assert abs(there["relative_alt_m"] - 10) <= 0.5 and there["armed"]
    north = ready["lat"] + 20 / 111_195  # 20 m
    assert ctl(running, "goto", f"{north:.7f}", ready["lon"], "15").status == 0
    there, = objects(ctl(running, "wait", "alt", "15"))
    harness.wait_for(lambda: abs(objects(ctl(running, "state"))[0]["lat"] - north) < 1e-5, what="the way of 20 m")
    assert objects(ctl(running, "rtl"))[0]["mode"] == "Return"
    assert objects(ctl(running, "land"))[0]["mode"] == "Land"
    landed, = objects(ctl(running, "wait", "landed"))
    assert landed["lat"] == pytest.approx(north, abs=1e-4)
    assert objects(ctl(running, "wait", "disarmed"))[0]["armed"] is False

    done = ctl(running, "wait", "alt", "100", "--for", "200ms")
    assert done.status == 1 and done.stdout == "" and "waited 0.2 s for alt 100" in done.stderr


def test_ctl_chooses_a_vehicle(sim, station, ctl):
    client, url = station
    running = sim("--to", url, "--vehicles", "3")
    client.until(HEARTBEAT)

    assert [o["system"] for o in objects(ctl(running, "state"))] == [1, 2, 3]
    assert [o["system"] for o in objects(ctl(running, "mode", "Hold", "--system", "2"))] == [2]
    done = ctl(running, "state", "--system", "9")
    assert done.status == 1 and "there is no vehicle 9" in done.stderr


@pytest.mark.parametrize("autopilot, words, shown", [
    ("px4", ("RTL", "Return", "auto.rtl", "AUTO_RTL"), "Return"),
    ("px4", ("LOITER", "hold", "AUTO.LOITER"), "Hold"),
    ("ardupilot", ("rtl", "Return"), "RTL"),
    ("ardupilot", ("Hold", "AUTO.LOITER"), "LOITER"),
    ("ardupilot", ("Smart RTL", "SMART_RTL"), "SMART_RTL"),
])
def test_ctl_takes_every_vocabulary_of_modes(sim, station, ctl, autopilot, words, shown):
    client, url = station
    running = sim("--to", url, "--autopilot", autopilot)
    client.until(HEARTBEAT)
    for word in words:
        done = ctl(running, "mode", word)
        assert done.status == 0, done.stderr
        assert [o["mode"] for o in objects(done)] == [shown], word


@pytest.mark.parametrize("args, status, text", [
    (("arm",), 1, ""),  # not ready yet: the vehicle's own text
    (("mode", "Hovr"), 1, "there is no mode 'Hovr'"),
    (("param", "MIS_TAKEOFF_ALTT", "1"), 1, "there is no parameter 'MIS_TAKEOFF_ALTT', did you mean"),
    (("takeoff", "-5"), 1, "takeoff needs an altitude above home"),
    (("takeoff",), 2, "takeoff takes the altitude above home in metres"),
    (("takeoff", "high"), 2, "altitude: 'high' is not a number"),
    (("mode",), 2, "mode takes the name of a mode"),
    (("wait",), 2, "wait takes ready, armed, disarmed, landed, or alt"),
    (("wait", "alt", "high"), 2, "not 'alt high'"),
    (("wait", "ready", "--for", "soon"), 2, "--for"),
    (("arm", "--for", "1s"), 2, "--for is for wait, not for arm"),
    (("goto", "47.4"), 2, "goto takes latitude and longitude"),
    (("goto", "91", "8"), 1, "goto needs a latitude"),
    (("state", "now"), 2, "state takes no argument"),
    (("stats", "--system", "1"), 2, "--system is not for stats"),
    (("state", "--force"), 2, "--force is for arm and disarm"),
    (("routes",), 1, "there is no command 'routes'"),
    (("stat",), 2, ""),
])
def test_ctl_refusals(sim, station, ctl, tmp_path, args, status, text):
    client, url = station
    path = tmp_path / "never.toml"
    path.write_text("[[vehicle]]\nready_after = '1h'\n")
    running = sim(path, "--to", url)
    client.until(HEARTBEAT)
    done = ctl(running, *args)

    assert done.status == status and done.stdout == "" and text in done.stderr and done.stderr, done


def test_ctl_adds_and_removes_endpoints(sim, station, udp_socket, ctl):
    client, url = station
    running = sim("--to", url)
    client.until(HEARTBEAT)
    second = Client(udp_socket())
    assert ctl(running, "add", f"udpout://127.0.0.1:{second.sock.getsockname()[1]}?name=second").status == 0
    second.until(HEARTBEAT)
    assert {o["link"] for o in objects(ctl(running, "links"))} == {url, "second"}
    assert ctl(running, "remove", "second").status == 0
    second.collect(0.1)
    second.clear()
    client.next(HEARTBEAT)
    second.collect(0.2)

    assert second.got == []
    assert {o["link"] for o in objects(ctl(running, "links"))} == {url}
    assert {o["link"] for o in objects(ctl(running, "streams"))} == {url}


def test_stat_reads_the_page_of_a_stopped_simulator(sim, station, ctl):
    client, url = station
    running = sim("--to", url)
    client.until(HEARTBEAT)
    client.send(heartbeat())
    client.next(HEARTBEAT)
    running.send(signal.SIGSTOP)
    rows = objects(ctl(running, "--json", command="stat"))
    running.send(signal.SIGCONT)

    page, link = rows[0], rows[1]
    assert page["kind"] == "page" and page["alive"] and page["pid"] == running.pid
    assert (page["vehicles"], page["links"], page["gaps"]) == (1, 1, 0) and page["frames_sent"] > 0
    assert link["link"] == url and link["frames_in"] == 1 and link["frames_out"] > 0


def test_stats_and_metrics_have_the_same_counters(sim, station, ctl):
    client, url = station
    running = sim("--to", url, "--metrics", "127.0.0.1:0")
    port = int(running.wait_output(r"metrics on port (\d+)", stream="err")[1])
    client.until(HEARTBEAT)
    rows = objects(ctl(running, "stats"))
    text = urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics", timeout=harness.DEFAULT_TIMEOUT_S).read().decode()

    assert [row["kind"] for row in rows] == ["sim", "endpoint", "gone", "link", "vehicle"]
    assert set(rows[0]) >= {"uptime_s", "speed", "vehicles", "frames_sent", "bytes_sent", "gaps", "frames_received"}
    assert "mavloom_sim_frames_sent_total{}" in text
    assert f'mavloom_link_frames_out_total{{link="{url}"}}' in text


def test_the_report_has_every_stream_of_every_link(run, station, udp_socket):
    client, url = station
    other = udp_socket()
    done = run("sim", "--to", url, "--to", f"udpout://127.0.0.1:{other.getsockname()[1]}", "--for", "2s", "--report",
               "--json", "--name", name())
    rows = objects(done)
    client.take_rest(0.1)
    counts = collections.Counter(decode(frame).get_type() for frame in client.got)

    streams = {row["name"]: row for row in rows if row["kind"] == "stream" and row["link"] == url}
    assert {row["link"] for row in rows} == {url, f"udpout://127.0.0.1:{other.getsockname()[1]}"}
    attitude = streams["ATTITUDE"]
    assert (attitude["asked_hz"], attitude["system"], attitude["id"]) == (10, 1, 30)
    assert attitude["sent"] == counts["ATTITUDE"] and attitude["jitter_p99_ms"] >= attitude["jitter_median_ms"] > 0
    total, = [row for row in rows if row["kind"] == "link_total" and row["link"] == url]
    assert (total["frames"], total["bytes"], total["gaps"]) == (len(client.got), sum(map(len, client.got)), 0)
    assert client.gaps() == 0


def test_the_report_for_people_is_a_table(run, station):
    done = run("sim", "--to", station[1], "--for", "300ms", "--report", "--name", name())

    assert done.status == 0 and done.lines[0].startswith(f"{station[1]}: ")
    assert done.lines[1].split()[:3] == ["sys", "message", "asked"]
    assert any(line.split()[:2] == ["1", "HEARTBEAT"] for line in done.lines)


def test_the_report_keeps_links_that_are_gone(sim, tcp_port):
    port = tcp_port()
    running = sim("--listen", f"tcpin://127.0.0.1:{port}", "--report")
    running.wait_output("listening")
    with socket.create_connection(("127.0.0.1", port)) as sock:
        Client(sock).until(HEARTBEAT)
    running.wait_output("down")
    done = running.stop(signal.SIGTERM)

    assert done.status == 143 and f"tcpin://127.0.0.1:{port}#" in done.lines[0], done


# ---- rings -----------------------------------------------------------------------------------------------------------

def test_a_ring_of_its_own_is_read_and_answered(sim, run):
    ring = name()
    running = sim("--ring", ring, own_name=False)
    running.name = ring
    harness.wait_for(lambda: (harness.RUN / f"{ring}.in").exists(), what="the inlet")
    beat = objects(run("listen", f"shm://{ring}", "--only", "HEARTBEAT", "--count", "1", "--json"))[0]
    assert (beat["sys"], beat["fields"]["autopilot"]) == (1, 12)
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as inlet:
        inlet.bind("")
        inlet.sendto(request_message(AUTOPILOT_VERSION), str(harness.RUN / f"{ring}.in"))
        acks = run("listen", f"shm://{ring}?from=oldest", "--only", "COMMAND_ACK", "--count", "1", "--json")

    assert objects(acks)[0]["fields"]["target_system"] == 255
    assert objects(run("stat", ring, "--json"))[0]["ring_records"] > 0
    assert running.stop(signal.SIGTERM).status == 143
    assert not os.path.exists(f"/dev/shm/mavloom.{ring}")
    assert not (harness.RUN / f"{ring}.in").exists()


def test_a_routers_ring_carries_commands_and_answers(sim, spawn, station, udp_socket, udp_port):
    ring, port = name(), udp_port()
    router = spawn("route", f"udpin://127.0.0.1:{port}", "--ring", ring)
    router.wait_output("listening")
    running = sim("--to", f"shm://{ring}")
    client = Client(udp_socket(), ("127.0.0.1", port))
    client.send(heartbeat())
    client.until(HEARTBEAT)
    client.send(request_message(AUTOPILOT_VERSION))

    assert client.until(AUTOPILOT_VERSION).capabilities & 8192
    assert client.until(COMMAND_ACK).target_system == 255
    assert client.gaps() == 0
    assert running.stop(signal.SIGTERM).status == 143


def test_a_ring_that_comes_later_is_found(sim, spawn, udp_socket, udp_port):
    ring, port = name(), udp_port()
    running = sim("--to", f"shm://{ring}")
    running.wait_output("does not exist|there is no ring|waiting")
    spawn("route", f"udpin://127.0.0.1:{port}", "--ring", ring).wait_output("listening")
    client = Client(udp_socket(), ("127.0.0.1", port))

    def hears():
        client.send(heartbeat())
        client.read(0.5)
        return any(header(frame)[3] == HEARTBEAT and header(frame)[1] == 1 for frame in client.got)
    harness.wait_for(hears, what="the vehicle through the router")
    client.send(request_message(AUTOPILOT_VERSION))
    client.until(AUTOPILOT_VERSION)
