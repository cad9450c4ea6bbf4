# SPDX-License-Identifier: MIT
"""`mavloom web` with other people's clients: Python's websockets as a Foxglove viewer, PyPI's mcap-ros2-support as its
decoder, and urllib. Frames are pymavlink's."""
import contextlib
import json
import os
import re
import signal
import socket
import struct
import time
import urllib.error
import urllib.request

import frames
import harness
import pytest
import routers
from frames import mavlink
from mcap.records import Schema
from mcap_ros2.decoder import DecoderFactory
from prometheus_client.parser import text_string_to_metric_families
from pymavlink.quaternion import Quaternion
from pymavlink.rotmat import Matrix3, Vector3
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

pytestmark = pytest.mark.short

ESSENTIAL = 200


class Viewer:
    """A client of the Foxglove protocol."""

    def __init__(self, url, **options):
        self.ends = contextlib.ExitStack()
        self.socket = self.ends.enter_context(
            connect(url, subprotocols=["foxglove.websocket.v1", "foxglove.sdk.v1"], max_size=None, **options))
        self.channels, self.status = {}, []
        self.info = self._read_text()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.ends.close()

    def ask(self, op, **arguments):
        self.socket.send(json.dumps({"op": op, **arguments}))

    def subscribe(self, *topics):
        """The ids of subscriptions are the channels' plus 1,000."""
        while not set(topics) <= set(self.topics()):
            self.read()
        ids = [channel["id"] for channel in self.channels.values() if channel["topic"] in topics]
        self.ask("subscribe", subscriptions=[{"id": 1000 + i, "channelId": i} for i in ids])

    def topics(self):
        return [channel["topic"] for channel in self.channels.values()]

    def read(self):
        """(topic, time in ns, decoded message) of the next message; None: it was a text."""
        got = self.socket.recv(timeout=harness.DEFAULT_TIMEOUT_S)
        if isinstance(got, str):
            return self._take(json.loads(got))
        kind, subscription, time_ns = struct.unpack_from("<BIQ", got)
        assert kind == 1
        channel = self.channels[subscription - 1000]
        if channel["encoding"] == "json":
            return channel["topic"], time_ns, json.loads(got[13:])
        schema = Schema(channel["id"], channel["schema"].encode(), channel["schemaEncoding"], channel["schemaName"])
        return channel["topic"], time_ns, DecoderFactory().decoder_for(channel["encoding"], schema)(got[13:])

    def next(self):
        while (message := self.read()) is None:
            pass
        return message

    def next_status(self):
        while not self.status:
            self.read()
        return self.status[0]

    def _read_text(self):
        return json.loads(self.socket.recv(timeout=harness.DEFAULT_TIMEOUT_S))

    def _take(self, text):
        if text["op"] == "advertise":
            self.channels.update((channel["id"], channel) for channel in text["channels"])
        elif text["op"] == "status":
            self.status.append(text)


class Web:
    def __init__(self, spawn, *options):
        self.port, source = routers.tcp_port(), routers.udp_port()
        self.source = f"udpin://127.0.0.1:{source}"
        self.process = spawn("web", self.source, "--listen", f"127.0.0.1:{self.port}", *options)
        self.process.wait_output("open http", stream="err")
        self.vehicle = routers.UdpEnd(("127.0.0.1", source))

    def send(self, message, source=(1, 1)):
        self.vehicle.send(routers.make(message, source))

    def url(self, scheme, path=""):
        return f"{scheme}://127.0.0.1:{self.port}{path}"

    def get(self, path, **headers):
        request = urllib.request.Request(self.url("http", path), headers=headers)
        return urllib.request.urlopen(request, timeout=harness.DEFAULT_TIMEOUT_S).read().decode()

    def counts(self):
        """The samples of /metrics without labels."""
        return {s.name: s.value for f in text_string_to_metric_families(self.get("/metrics")) for s in f.samples
                if not s.labels}

    def messages(self):
        return json.loads(self.get("/api/v1/messages"))

    def viewer(self, **options):
        return Viewer(self.url("ws"), **options)


@pytest.fixture
def web(spawn):
    with contextlib.ExitStack() as ends:
        def start(*options):
            started = Web(spawn, *options)
            ends.enter_context(started.vehicle)
            return started
        yield start


def attitude(roll):
    return mavlink.MAVLink_attitude_message(5, roll, 0.25, 3, 0, 0, 0)


def text(words):
    return mavlink.MAVLink_statustext_message(4, words.encode())


def battery(number, remaining):
    return mavlink.MAVLink_battery_status_message(number, 0, 1, 2500, [4200] + [65535] * 9, 100, -1, -1, remaining)


def test_a_viewer_reads_each_message_and_instance(web):
    server = web()
    with server.viewer() as viewer:
        assert viewer.info["op"] == "serverInfo" and viewer.socket.subprotocol == "foxglove.sdk.v1"
        for message in (attitude(0.5), battery(0, 90), battery(1, 40), text("hello")):
            server.send(message)
        viewer.subscribe("/1/1/ATTITUDE", "/1/1/BATTERY_STATUS/1", "/1/1/STATUSTEXT")
        got = {topic: message for topic, _, message in (viewer.next() for _ in range(3))}
        assert (got["/1/1/ATTITUDE"].roll, got["/1/1/ATTITUDE"].time_boot_ms) == (0.5, 5)
        assert got["/1/1/BATTERY_STATUS/1"].battery_remaining == 40
        assert got["/1/1/STATUSTEXT"].text == "hello", "sent before the subscription"
        server.send(attitude(0.75))
        assert viewer.next()[2].roll == 0.75


def test_each_name_of_a_value_is_a_topic(web):
    server = web()
    with server.viewer() as viewer:
        for name, value in (("alpha", 1.5), ("beta", 2.5)):
            server.send(mavlink.MAVLink_named_value_float_message(5, name.encode(), value))
        viewer.subscribe("/1/1/NAMED_VALUE_FLOAT/alpha", "/1/1/NAMED_VALUE_FLOAT/beta")
        got = {topic: message.value for topic, _, message in (viewer.next(), viewer.next())}
        assert got == {"/1/1/NAMED_VALUE_FLOAT/alpha": 1.5, "/1/1/NAMED_VALUE_FLOAT/beta": 2.5}


def test_maps_and_logs_get_their_own_types(web):
    server = web()
    with server.viewer() as viewer:
        server.send(mavlink.MAVLink_global_position_int_message(9, 473977418, -85455939, 489400, 0, 0, 0, 0, 0))
        server.send(text("battery low"))
        viewer.subscribe("/1/1/position", "/1/1/log")
        got = {topic: message for topic, _, message in (viewer.next() for _ in range(2))}
    position, log = got["/1/1/position"], got["/1/1/log"]
    assert (position.latitude, position.longitude, position.altitude) == pytest.approx((47.3977418, -8.5455939, 489.4))
    assert (log.msg, log.level, log.name) == ("battery low", 30, "1/1")


REPORTS = {"/mavloom/vehicles": "vehicles", "/mavloom/traffic": "rows", "/mavloom/links": "hops",
           "/mavloom/alarms": "alarms"}


def schema_of(json_value):
    """The keys and types that Lichtblick's parseJsonSchema makes of a schema; it refuses what this does not know."""
    if json_value["type"] == "object":
        return {key: schema_of(value) for key, value in json_value["properties"].items()}
    if json_value["type"] == "array":
        return [schema_of(json_value["items"])]
    return {"string": str, "number": (int, float), "integer": int, "boolean": bool}[json_value["type"]]


def fits(value, schema):
    if value is None:
        return True
    if isinstance(schema, dict):
        return set(value) <= set(schema) and all(fits(value[key], schema[key]) for key in value)
    if isinstance(schema, list):
        return all(fits(one, schema[0]) for one in value)
    return isinstance(value, schema)


def test_reports_are_channels_and_answers(web):
    server = web()
    server.send(mavlink.MAVLink_heartbeat_message(2, 12, 0x81, 50593792, 4, 3))
    server.send(battery(1, 40))
    with server.viewer() as viewer:
        viewer.subscribe("/1/1/BATTERY_STATUS/1", *REPORTS)
        got = {}
        while set(got) != set(REPORTS) or not got["/mavloom/vehicles"]["vehicles"]:
            topic, _, message = viewer.next()
            got.update({topic: message} if topic in REPORTS else {})
        schemas = {c["topic"]: schema_of(json.loads(c["schema"])) for c in viewer.channels.values()
                   if c["topic"] in REPORTS}
    assert [(v["sys"], v["mode"], v["armed"]) for v in got["/mavloom/vehicles"]["vehicles"]] == [(1, "Hold", True)]
    assert {(r["topic"], r["instance"], r["count"]) for r in got["/mavloom/traffic"]["rows"]} == {
        ("/1/1/HEARTBEAT", None, 1), ("/1/1/BATTERY_STATUS/1", "1", 1)}
    assert [h["kind"] for h in got["/mavloom/links"]["hops"]] == ["web"]
    for topic, entries in REPORTS.items():
        answer = json.loads(server.get(f"/api/v1/{topic.split('/')[-1]}"))
        assert list(answer) == list(got[topic]) and list(answer)[:2] == ["time_us", entries]
        assert fits(answer, schemas[topic]), (answer, schemas[topic])


def ros_axes(attitude):
    """The rotation matrix of an ATTITUDE with ROS's axes: of the body (x ahead, y left, z up) in east, north, up."""
    from_north_east_down = Matrix3(Vector3(0, 1, 0), Vector3(1, 0, 0), Vector3(0, 0, -1))
    from_left_and_up = Matrix3(Vector3(1, 0, 0), Vector3(0, -1, 0), Vector3(0, 0, -1))
    turned = Matrix3()
    turned.from_euler(*attitude)
    return from_north_east_down * turned * from_left_and_up


def test_poses_have_the_axes_of_ros(web):
    server = web()
    angles = (0.3, -0.4, 2.5)
    with server.viewer() as viewer:
        server.send(mavlink.MAVLink_attitude_message(5, *angles, 0, 0, 0))
        viewer.subscribe("/1/1/pose", "/1/1/tf")
        assert {viewer.next()[0] for _ in range(2)} == {"/1/1/pose", "/1/1/tf"}
        server.send(mavlink.MAVLink_local_position_ned_message(5, 10, 20, -30, 0, 0, 0))
        server.send(mavlink.MAVLink_attitude_message(5, *angles, 0, 0, 0))
        got = {topic: message for topic, _, message in (viewer.next() for _ in range(2))}
    pose, transform = got["/1/1/pose"].pose, got["/1/1/tf"].transforms[0]
    turned = Quaternion([getattr(pose.orientation, name) for name in "wxyz"]).dcm
    expected = ros_axes(angles)
    for row, expected_row in zip((turned.a, turned.b, turned.c), (expected.a, expected.b, expected.c)):
        assert (row.x, row.y, row.z) == pytest.approx((expected_row.x, expected_row.y, expected_row.z), abs=1e-6)
    assert (pose.position.x, pose.position.y, pose.position.z) == (20, 10, 30), "east, north, up"
    assert str(transform.transform.rotation).split("(")[1] == str(pose.orientation).split("(")[1]
    assert (transform.header.frame_id, transform.child_frame_id) == ("1/1/local", "1/1")


def test_scripts_read_a_stream_of_lines(web):
    server = web()
    address = server.url("http", "/api/v1/stream?only=ATTITUDE,STATUSTEXT&from=1/1&max_rate=ATTITUDE:1")
    with urllib.request.urlopen(address, timeout=harness.DEFAULT_TIMEOUT_S) as lines:
        server.send(attitude(0.25), (1, 2))
        for roll in (0.5, 0.75, 1):
            server.send(attitude(roll))
        server.send(text("end"))
        first, second = (json.loads(lines.readline()) for _ in range(2))
    assert (first["name"], first["sys"], first["comp"], first["fields"]["roll"]) == ("ATTITUDE", 1, 1, 0.5)
    assert first["link"].startswith(server.source) and first["time_us"] > 1e15
    assert second["fields"]["text"] == "end", "the other two came too early"


def test_a_stream_of_something_else_is_refused_by_name(web):
    server = web()
    for query, reason in (("only=ATITUDE", "only: "), ("from=x", "from: 'x' is not SYS or SYS/COMP"),
                          ("rate=5", "a stream takes only, from and max_rate")):
        with pytest.raises(urllib.error.HTTPError) as refused:
            server.get(f"/api/v1/stream?{query}")
        assert refused.value.code == 400 and reason in refused.value.read().decode()


def test_alarms_and_losses(web):
    server = web()
    server.send(mavlink.MAVLink_heartbeat_message(2, 12, 0x81, 50593792, 5, 3))
    server.send(text("<img src=x onerror=alert(1)>"))
    damaged = routers.damaged()
    server.vehicle.send(damaged)
    alarms = harness.wait_for(
        lambda: len(a := json.loads(server.get("/api/v1/alarms"))["alarms"]) == 3 and a, what="all alarms")
    assert {(a["kind"], a["severity"], a["sys"], a["ended_us"]) for a in alarms} == {
        ("failsafe", "error", 1, None), ("text", "warning", 1, None), ("drop", "warning", None, None)}
    assert any(a["text"].startswith("mavloom web lost 1: crc_error") for a in alarms)
    assert "<img src=x onerror=alert(1)>" in [a["text"] for a in alarms]

    def losses():
        hop = json.loads(server.get("/api/v1/links"))["hops"][-1]
        return {loss["name"]: loss["count"] for loss in hop["losses"]}
    assert harness.wait_for(losses, what="losses") == {"crc_error": 1}
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:  # whose frame never was one
        stranger.sendto(damaged, server.vehicle.target)
    harness.wait_for(lambda: losses().get("stray_bytes") == len(damaged), what="damaged datagram of no link")


def test_a_server_that_stood_still_sees_no_clock_jump(web):
    server = web()
    begin = time.time()

    def send():
        now = time.time()
        server.send(mavlink.MAVLink_system_time_message(int(now * 1e6), 60_000 + int((now - begin) * 1000)))

    send()
    harness.wait_for(lambda: server.messages(), what="the first message")
    os.kill(server.process.pid, signal.SIGSTOP)
    try:
        sent = 1
        while time.time() - begin < 3:
            send()
            sent += 1
            time.sleep(0.1)
    finally:
        os.kill(server.process.pid, signal.SIGCONT)
    harness.wait_for(lambda: server.messages()[0]["frames"] == sent, what="all messages")
    send()
    assert harness.wait_for(lambda: server.messages()[0]["frames"] == sent + 1, what="another message")
    assert json.loads(server.get("/api/v1/alarms"))["alarms"] == []


def test_its_sources_are_links(web):
    server = web()
    server.send(attitude(0.5))
    link, = harness.wait_for(lambda: json.loads(server.get("/api/v1/links"))["hops"][-1]["links"], what="the link")
    host, port = server.vehicle.sock.getsockname()
    assert (link["name"], link["state"], link["frames_in"]) == (f"{server.source}#{host}:{port}", "up", 1)


def test_a_link_has_the_gaps_of_its_senders(web):
    server = web()
    server.send(attitude(0.5))
    for _ in range(3):
        routers.make(attitude(0.5))  # takes a sequence number
    server.send(attitude(0.5))

    def losses():
        hop = json.loads(server.get("/api/v1/links"))["hops"][-1]
        return hop["losses"], [(loss["name"], loss["count"]) for link in hop["links"] for loss in link["losses"]]
    assert harness.wait_for(lambda: any(losses()) and losses(), what="the loss") == ([], [("lost", 3)])


def test_the_counts_of_an_answer_are_of_one_moment(web):
    server = web()
    server.send(attitude(0))
    seen = set()
    while len(seen) < 4:
        for i in range(50):
            server.send(attitude(i))
        hop = json.loads(server.get("/api/v1/links"))["hops"][-1]
        assert hop["frames_in"] == sum(link["frames_in"] for link in hop["links"])
        seen.add(hop["frames_in"])


def test_curl_reads_systems_and_messages(web):
    server = web()
    server.send(mavlink.MAVLink_heartbeat_message(2, 12, 0x81, 50593792, 4, 3), (7, 1))
    server.send(battery(1, 40), (7, 1))
    messages = harness.wait_for(lambda: len(m := json.loads(server.get("/api/v1/messages"))) == 2 and m, what="both")
    server.send(mavlink.MAVLink_heartbeat_message(2, 12, 0x81, 50593792, 4, 3), (3, 1))
    assert [(m["topic"], m["instance"], m["frames"]) for m in messages] == [("/7/1/HEARTBEAT", None, 1),
                                                                           ("/7/1/BATTERY_STATUS/1", 1, 1)]
    assert messages[1]["fields"]["battery_remaining"] == 40
    other, system = harness.wait_for(lambda: len(s := json.loads(server.get("/api/v1/systems"))) == 2 and s,
                                     what="both systems")
    assert other["sys"] == 3, "the order is that of the ids"
    assert (system["sys"], system["type"], system["mode"], system["armed"]) == (7, "MAV_TYPE_QUADROTOR", "Hold", True)
    assert "Foxglove" in server.get("/")


def test_prometheus_reads_the_metrics(web):
    server = web()
    server.send(mavlink.MAVLink_heartbeat_message(2, 12, 0x81, 50593792, 4, 3))
    server.send(battery(0, 40))

    def samples():
        families = text_string_to_metric_families(server.get("/metrics"))
        return {(s.name, *map(s.labels.get, ("message", "instance"))): s.value for f in families for s in f.samples}
    hop_frames = "mavloom_hop_frames_in_total", None, None
    battery_frames = "mavloom_message_frames_total", "BATTERY_STATUS", "0"
    got = harness.wait_for(lambda: (s := samples())[hop_frames] == 2 and battery_frames in s and s, what="both")
    assert got[battery_frames] == 1
    assert got["mavloom_message_frames_total", "HEARTBEAT", None] == 1
    assert got["mavloom_vehicle_armed", None, None] == 1
    assert got["mavloom_server_requests_total", None, None] >= 1
    assert got["mavloom_vehicle_battery_percent", None, None] == 40


def test_foreign_pages_and_names_are_refused(web):
    server = web("--origin", "https://app.example.com")
    foreign = {"Origin": "https://evil.example"}
    for request in ({"Origin": "https://evil.example"}, {"Host": "evil.example"}):
        with pytest.raises(urllib.error.HTTPError) as refused:
            server.get("/api/v1/messages", **request)
        assert refused.value.code == 403
    assert refused.value.read() == b"the Host header must be this address, localhost, or a name of --host\n"
    with pytest.raises(InvalidStatus) as refused:
        server.viewer(additional_headers=foreign)
    assert refused.value.response.status_code == 403
    for good in ("https://app.example.com", server.url("http")):
        with server.viewer(additional_headers={"Origin": good}) as viewer:
            assert viewer.info["op"] == "serverInfo"


def test_wrong_requests_get_a_status_and_harm_nobody(web):
    server = web()
    with server.viewer() as viewer, server.viewer() as other:
        viewer.socket.send("no JSON")
        assert "JSON" in viewer.next_status()["message"]
        viewer.status.clear()
        viewer.ask("subscribe", subscriptions=[{"id": i, "channelId": i + 5} for i in range(10_000)])
        assert "there is no channel 5; 9999 more" in viewer.next_status()["message"]
        server.send(attitude(0.5))
        other.subscribe("/1/1/ATTITUDE")
        assert other.next()[2].roll == 0.5
        other.ask("subscribe", subscriptions=[{"id": 7, "channelId": 1}])
        assert "subscribed already" in other.next_status()["message"]
        other.status.clear()
        other.ask("getParameters", parameterNames=[], id="x")
        assert "there is no operation 'getParameters'" in other.next_status()["message"]
        other.status.clear()
        other.ask("unsubscribe", subscriptionIds=[1001, 7, 8])
        assert other.next_status()["message"] == "there is no subscription 7; 1 more are unknown"
        counts = server.counts()
        viewer.socket.send("x" * (1 << 21))
        other.subscribe("/1/1/ATTITUDE")
        server.send(attitude(0.75))
        while other.next()[2].roll != 0.75:
            pass
    assert {name: counts[f"mavloom_server_ws_{name}_total"] for name in (
        "bad_message", "unknown_op", "refused_subscription", "unknown_subscription")} == {
            "bad_message": 1, "unknown_op": 1, "refused_subscription": 10_001, "unknown_subscription": 2}


def test_a_viewer_that_never_reads_takes_nothing_from_others(web):
    server = web()
    with server.viewer() as viewer, socket.create_connection(("127.0.0.1", server.port)) as stalled:
        stalled.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                        b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n")
        assert stalled.recv(12) == b"HTTP/1.1 101"
        for i in range(40):  # each has a schema of its own, and there are many of them
            server.send(attitude(0.5), (1 + i, 1))
            server.send(text("begin"), (1 + i, 1))
        viewer.subscribe("/1/1/STATUSTEXT")
        assert viewer.next()[2].text == "begin"
        for i in range(ESSENTIAL):
            server.send(attitude(i))
            server.send(text(str(i)))
        assert [viewer.next()[2].text for _ in range(ESSENTIAL)] == [str(i) for i in range(ESSENTIAL)]


def test_a_viewer_that_reads_too_late_gets_a_status_with_its_losses(web):
    """Each such status has the same id, so that viewers show the newest only (Foxglove's protocol, "Status")."""
    server = web()
    server.send(text("begin"))
    with server.viewer() as viewer:
        viewer.subscribe("/1/1/STATUSTEXT")
        channel = next(one["id"] for one in viewer.channels.values() if one["topic"] == "/1/1/STATUSTEXT")
    with socket.create_connection(("127.0.0.1", server.port), timeout=harness.DEFAULT_TIMEOUT_S) as late:
        late.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                     b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n")
        assert late.recv(12) == b"HTTP/1.1 101"
        late.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 65536)
        wish = json.dumps({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": channel}]}).encode()
        late.sendall(bytes([0x81, 0x80 + len(wish), 0, 0, 0, 0]) + wish)  # masked with zeros
        got, status = b"", None
        while not status:
            for i in range(6000):
                server.send(text(f"{i:050}"))
            for _ in range(100):  # the kernel may have dropped most of them
                got = got[-1000:] + late.recv(1 << 16)
                status = status or re.search(rb'\{"op":"status".*?\}', got)
                server.send(text("next"))
    told = json.loads(status[0])
    assert (told["id"], told["level"]) == ("drops", 1)
    assert re.search(r"too slow: [1-9]\d* messages were not sent", told["message"])


def test_a_stream_that_is_read_too_late_counts_what_it_lost(web):
    server = web()
    with socket.create_connection(("127.0.0.1", server.port), timeout=harness.DEFAULT_TIMEOUT_S) as late:
        late.sendall(b"GET /api/v1/stream HTTP/1.1\r\nHost: localhost\r\n\r\n")
        assert late.recv(12) == b"HTTP/1.1 200"
        late.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 65536)
        for i in range(6000):
            server.send(text(f"{i:050}"))
        lines = late.makefile("rb")
        lost = 0
        while lost <= 1000:  # the first such line may come early
            if (line := lines.readline()).startswith(b'{"dropped":'):
                lost = json.loads(line)["dropped"]
            server.send(text("next"))


def test_a_recording_shows_its_last_messages(spawn, run):
    port = routers.tcp_port()
    process = spawn("web", frames.FLIGHT, "--listen", f"127.0.0.1:{port}")
    process.wait_output("open http", stream="err")
    with Viewer(f"ws://127.0.0.1:{port}") as viewer:
        viewer.subscribe("/1/1/ATTITUDE")
        assert viewer.next()[0] == "/1/1/ATTITUDE"

    def links():
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/api/v1/links", timeout=harness.DEFAULT_TIMEOUT_S) as got:
            return [(link["state"], link["frames_in"]) for link in json.load(got)["hops"][0]["links"]]
    count = len(frames.read_tlog(frames.FLIGHT))
    harness.wait_for(lambda: links() == [("ended", count)], what="the end of the recording")
    assert run("web", frames.FLIGHT, "--listen", "127.0.0.1:0", "--count", "10").status == 0


def test_a_port_in_use_names_its_owner(web, run):
    server = web()
    done = run("web", "udpin://127.0.0.1:0", "--listen", f"127.0.0.1:{server.port}")
    assert done.status == 1 and f"(process {server.process.pid}" in done.stderr
    assert "; choose another with --listen" in done.stderr


def modules_of(lines, shown):
    """The rows of a printed QR code, as lists of booleans."""
    if shown == "ascii":
        return [[line[i:i + 2] == "##" for i in range(0, len(line), 2)] for line in lines]
    return [[glyph in glyphs for glyph in line] for line in lines for glyphs in ("█▀", "█▄")]


def test_the_address_as_a_qr_code(run):
    def printed(locale):
        done = run("web", "shm://none", "--listen", "0.0.0.0:0", "--for", "100ms", "--qr",
                   env={"LC_ALL": locale})
        if "no address on a network" in done.stderr:
            pytest.skip("this machine has loopback only")
        assert done.status == 0 and done.lines[-1].startswith("http://") and "0.0.0.0" not in done.lines[-1], done
        return modules_of(done.lines[:-1], "ascii" if locale == "C" else "blocks")
    edge, ring, core = [True] * 7, [True, *[False] * 5, True], [True, False, True, True, True, False, True]
    corner = [edge, ring, core, core, core, ring, edge]
    for rows in (printed("C"), printed("C.UTF-8")):
        size = len(rows[0])
        for top, left in ((4, 4), (4, size - 11), (size - 11, 4)):  # a margin of 4, and patterns of 7 modules
            assert [row[left:left + 7] for row in rows[top:top + 7]] == corner


def test_a_qr_code_of_an_address_that_no_phone_reaches_is_refused(run):
    done = run("web", "shm://none", "--listen", "127.0.0.1:0", "--qr")

    assert done.status == 2 and "--listen 0.0.0.0:" in done.stderr, done


def test_an_origin_that_is_none_is_refused(run):
    done = run("web", "shm://none", "--listen", "127.0.0.1:0", "--origin", "app.example.com")

    assert done.status == 2 and "--origin: 'app.example.com' is not the origin of a web page" in done.stderr, done
