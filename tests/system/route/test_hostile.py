# SPDX-License-Identifier: MIT
"""Attacks without a key, on a running router. docs/design/security.md lists them; the rules themselves are tested in
units."""
import contextlib
import http.client
import itertools
import pathlib
import re
import subprocess
import time
import urllib.request

import harness
import pytest
import routers
from routers import Net, Router, UdpEnd, attitude, command, heartbeat

FLOOD = harness.program_path().parent.parent / "tests" / "bin" / "flood_tool"
VEHICLE, STATION = (1, 1), (255, 190)

pytestmark = pytest.mark.skipif(not FLOOD.exists(), reason="needs the test tools beside the program")


class Flood:
    """Heartbeats from invented addresses, while the block runs."""

    def __init__(self, port, rate, seconds, ids=1, addresses=1_000_000):
        arguments = [port, rate, seconds, ids, addresses]
        self.process = subprocess.Popen([FLOOD, "127.0.0.1", *map(str, arguments)], stdout=subprocess.PIPE, text=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()

    def runs(self):
        return self.process.poll() is None

    def sent(self):
        return int(self.process.communicate()[0])


@pytest.fixture
def pair(spawn):
    """A router with one udpin, and two peers that talk."""
    port = routers.udp_port()
    router = Router(spawn, f"udpin://127.0.0.1:{port}")
    with UdpEnd(("127.0.0.1", port)) as vehicle, UdpEnd(("127.0.0.1", port)) as station:
        for _ in range(2):
            vehicle.send(heartbeat(VEHICLE))
            station.send(heartbeat(STATION))
        router.wait_links(2)
        yield router, vehicle, station


def pass_frames(vehicle, station, count):
    """Frames from the vehicle to the station, one at a time."""
    for _ in range(count):
        vehicle.send(frame := attitude(VEHICLE))
        station.until(frame)


def test_a_flood_of_invented_peers_takes_nothing_from_active_peers(pair):
    """Half to four fifths of the frames were lost when each newcomer became a peer."""
    router, vehicle, station = pair
    count, sent = 1000, []
    with Flood(vehicle.target[1], 20_000, 3) as flood:
        harness.wait_for(lambda: router.stats("endpoint")[0]["peers_refused"] > 1000, what="refused peers")
        for _ in range(count):
            sent.append(attitude(VEHICLE))
            vehicle.send(sent[-1])
            time.sleep(0.001)
        assert router.links()
        total = flood.sent()
    vehicle.send(last := heartbeat(VEHICLE))
    got = set(station.until(last))
    endpoint = router.stats("endpoint")[0]
    arrived = sum(frame in got for frame in sent)

    assert arrived > 0.9 * count
    assert count - arrived <= endpoint["kernel_drop"]  # each lost one is counted
    assert endpoint["peers_refused"] > total // 2
    assert len(router.links()) <= 256


def test_a_flood_of_peers_that_repeat_takes_nothing_from_active_peers(pair):
    """Half of the frames were lost, and others came seconds late, when each sender that repeats became a peer."""
    router, vehicle, station = pair
    count, sent = 500, []
    with Flood(vehicle.target[1], 20_000, 4, addresses=12_000) as flood:
        harness.wait_for(lambda: router.stats("endpoint")[0]["peers_limited"] > 1000, what="peers that were limited")
        for _ in range(count):
            sent.append(attitude(VEHICLE))
            vehicle.send(sent[-1])
            time.sleep(0.001)
        flood.sent()
    vehicle.send(last := heartbeat(VEHICLE))
    got = set(station.until(last))
    endpoint = router.stats("endpoint")[0]
    arrived = sum(frame in got for frame in sent)

    assert arrived > 0.9 * count
    assert count - arrived <= endpoint["kernel_drop"]
    # 512 at once, then 50 a second; and of those that repeat, 100 at once and 100 a second.
    assert endpoint["peers_evicted"] < 512 + 100 + 10 * (50 + 100)


def test_confirmed_senders_with_many_ids_take_nothing_from_an_honest_pair(pair):
    """Each of 200 senders gets copies of the frames of all others. On loopback, a sender is confirmed at once.
    coalescing_test checks the cost of the copies."""
    router, vehicle, station = pair
    sent = []
    with Flood(vehicle.target[1], 3_000, 4, ids=200 * 40, addresses=200) as flood:
        while flood.runs():
            sent.append(attitude(VEHICLE))
            vehicle.send(sent[-1])
            time.sleep(0.01)
            if len(sent) == 200:
                assert len(router.links()) == 200 + 2
        total = flood.sent()
    vehicle.send(last := heartbeat(VEHICLE))
    got = set(station.until(last))
    links = router.links()
    link = next(link for link in links if station.is_of(link))

    assert [frame for frame in sent if frame not in got] == []
    assert [link[name] for name in ("queue_bytes", "queue_age", "frames_not_sent", "refused", "unconfirmed")] == [0] * 5
    assert sum(link["frames_in"] for link in links) == total + len(sent) + 5, "heartbeats of the pair"
    assert router.stats("endpoint")[0]["kernel_drop"] == 0, "the statistics of 8,000 sources are answered"


def post_as_a_web_page(port, body):
    """Like a browser for `fetch("http://127.0.0.1:PORT/", {method: "POST", mode: "no-cors", body})`."""
    page = http.client.HTTPConnection("127.0.0.1", port, timeout=harness.DEFAULT_TIMEOUT_S)
    with contextlib.closing(page), pytest.raises((http.client.HTTPException, OSError)):
        page.request("POST", "/", body, {"Origin": "https://evil.example", "Content-Type": "text/plain"})
        page.getresponse()


def test_a_web_page_commands_no_vehicle(spawn):
    vehicle_port, client_port = routers.udp_port(), routers.tcp_port()
    router = Router(spawn, f"udpin://127.0.0.1:{vehicle_port}", f"tcpin://127.0.0.1:{client_port}")
    with UdpEnd(("127.0.0.1", vehicle_port)) as vehicle:
        vehicle.send(heartbeat(VEHICLE))
        router.wait_links(1)
        for _ in range(2):
            post_as_a_web_page(client_port, command(STATION, VEHICLE))
        harness.wait_for(lambda: sum(e["http_refused"] for e in router.stats("endpoint")) == 2, what="both refused")
        with routers.tcp_client(client_port) as station:
            station.send(order := command(STATION, VEHICLE))
            assert vehicle.until(order) == []
    router.process.wait_output("is an HTTP or TLS client")
    assert router.process.stderr.count("is an HTTP or TLS client") == 1


def test_invented_ids_on_many_links_starve_nobody_afterwards(pair):
    router, vehicle, station = pair
    with Flood(vehicle.target[1], 8_000, 1, ids=8_000) as flood:
        flood.sent()

    pass_frames(vehicle, station, 20)
    station.send(command(STATION, VEHICLE))
    vehicle.next()


def test_a_forged_restart_takes_no_commands_away(spawn):
    """SYSTEM_TIME of the vehicle from another link, with a clock that jumps back."""
    from frames import mavlink
    with Net(spawn, "udpin", 3, options={2: "trusted=false"}) as net:
        vehicle, attacker, station = net[1], net[2], net[3]
        station.send(heartbeat(STATION))
        harness.wait_for(lambda: any(r[:2] == STATION for r in net.router.routes()), what="the station's route")
        for boot_ms in (50_000, 50_100):
            vehicle.send(known := routers.make(mavlink.MAVLink_system_time_message(0, boot_ms), VEHICLE))
        station.until(known)
        for boot_ms in (90_000, 1_000, 80_000, 2_000):
            attacker.send(routers.make(mavlink.MAVLink_system_time_message(0, boot_ms), VEHICLE))
        vehicle.send(last := heartbeat(VEHICLE))
        station.until(last)

        station.send(order := command(STATION, VEHICLE))
        vehicle.until(order)
        station.send(end := heartbeat(STATION))

        assert order not in attacker.until(end)


@pytest.mark.parametrize("mode", ["best", "primary"])
def test_a_peer_in_a_group_does_not_take_the_vehicles_place(spawn, mode):
    """With best, it took all commands by sending more heartbeats."""
    ports = routers.udp_port(), routers.udp_port()
    router = Router(spawn, f"udpin://127.0.0.1:{ports[0]}?group=air&group_mode={mode}&trusted=false",
                    f"udpin://127.0.0.1:{ports[1]}")
    with UdpEnd(("127.0.0.1", ports[0])) as attacker, UdpEnd(("127.0.0.1", ports[0])) as vehicle, \
            UdpEnd(("127.0.0.1", ports[1])) as station:
        attacker.send(heartbeat(VEHICLE))  # it is first, also in the group's order
        vehicle.send(heartbeat(VEHICLE))
        station.send(heartbeat(STATION))
        router.wait_links(3)
        harness.wait_for(lambda: send_beats(vehicle, attacker) and sum(r[0] == 1 for r in router.routes()) == 2,
                         what="both routes")
        for _ in range(20):
            send_beats(vehicle, attacker)
            station.send(order := command(STATION, VEHICLE))
            vehicle.until(order)


def send_beats(vehicle, attacker):
    """One second of a vehicle, and of somebody who sends more."""
    vehicle.send(heartbeat(VEHICLE))
    for _ in range(10):
        attacker.send(heartbeat(VEHICLE))
    time.sleep(0.1)
    return True


def test_talkers_that_came_first_do_not_keep_a_vehicle_out(spawn):
    port = routers.udp_port()
    router = Router(spawn, f"udpin://127.0.0.1:{port}?max_peers=32")
    with contextlib.ExitStack() as ends:
        station, *talkers = (ends.enter_context(UdpEnd(("127.0.0.1", port))) for _ in range(32))
        vehicle = ends.enter_context(UdpEnd(("127.0.0.1", port)))

        def all_send():
            station.send(heartbeat(STATION))
            for n, talker in enumerate(talkers):
                talker.send(heartbeat((10 + n, 1)))
        for _ in range(2):
            all_send()
        router.wait_links(32)

        def has_a_route():
            all_send()
            vehicle.send(heartbeat(VEHICLE))
            time.sleep(0.6)
            return any(r[:2] == VEHICLE for r in router.routes())
        harness.wait_for(has_a_route, what="the vehicle's route")

        assert any(r[:2] == STATION for r in router.routes()), "it was there before most others"
        assert router.stats("endpoint")[0]["peers_displaced"] > 0
        station.send(order := command(STATION, VEHICLE))
        vehicle.until(order)


def test_one_frame_with_the_vehicles_id_costs_a_station_no_telemetry(spawn):
    with Net(spawn, "udpin", 2) as net:
        vehicle, station = net[1], net[2]
        net.hears(1, VEHICLE)
        net.hears(2, STATION)
        net.hears(2, VEHICLE)  # forged: it has the station's address

        vehicle.send(frame := attitude(VEHICLE))

        station.until(frame)


def test_silent_clients_turn_nobody_away(spawn):
    port = routers.tcp_port()
    router = Router(spawn, f"tcpin://127.0.0.1:{port}?max_peers=4", f"udpout://127.0.0.1:{routers.udp_port()}")
    silent = [routers.tcp_client(port) for _ in range(4)]
    router.wait_links(5)

    with routers.tcp_client(port) as newcomer:
        newcomer.send(heartbeat(STATION))
        harness.wait_for(lambda: any(r[0] == 255 for r in router.routes()), what="the newcomer's route")

    for client in silent:
        client.close()
    assert router.stats("endpoint")[0]["peers_evicted"] == 1


def test_invented_ids_on_many_clients_take_bounded_memory(spawn):
    """256 clients with 4,000 ids each took 230 MB, and `stat` 1 GB."""
    port, clients, ids = routers.tcp_port(), 100, [(1 + i // 250, 1 + i % 250) for i in range(1500)]
    router = Router(spawn, f"tcpin://127.0.0.1:{port}?queue_bytes=4k")
    with contextlib.ExitStack() as open_clients:
        for n in range(clients):
            client = open_clients.enter_context(routers.tcp_client(port))
            client.send(b"".join(attitude(source) for source in ids))
            harness.wait_for(lambda: sum(link["frames_in"] for link in router.links()) == (n + 1) * len(ids),
                             what="all frames")
        known = sum(source["frames"] for source in router.stats("source"))
        untracked = [link["untracked"] for link in router.links()]
        status = pathlib.Path(f"/proc/{router.process.pid}/status").read_text()

    assert int(re.search(r"RssAnon:\s+(\d+) kB", status)[1]) < 40_000
    assert untracked[0] == 0  # the first client came while there was room
    assert 0 < sum(untracked) == clients * len(ids) - known  # nobody's loss is left out silently


def metrics_of(port):
    """The samples of one scrape, by name; and the size of its text."""
    from prometheus_client.parser import text_string_to_metric_families
    text = urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics").read().decode()
    samples = {}
    for family in text_string_to_metric_families(text):
        for sample in family.samples:
            samples.setdefault(sample.name, []).append(sample)
    return samples, len(text)


@pytest.mark.parametrize("detail", [False, True])
def test_invented_ids_do_not_grow_the_metrics(spawn, detail):
    """One scrape after invented ids was 216 MB."""
    port, metrics = routers.udp_port(), routers.tcp_port()
    router = Router(spawn, f"udpin://127.0.0.1:{port}", "--metrics", f"127.0.0.1:{metrics}",
                    *["--metrics-detail"] * detail)
    with UdpEnd(("127.0.0.1", port)) as attacker, UdpEnd(("127.0.0.1", port)) as vehicle:
        ids = [(system, component) for system in range(2, 26) for component in range(1, 101)]
        for begin in range(0, len(ids), 40):
            attacker.send(b"".join(heartbeat(source) for source in ids[begin:begin + 40]))
        for _ in range(3):
            vehicle.send(heartbeat(VEHICLE))
        harness.wait_for(lambda: sum(link["frames_in"] for link in router.links()) == len(ids) + 3, what="all frames")
        samples, size = metrics_of(metrics)
    bounds = {"system": 256, "source": 256, "message": 1024} if detail else {"system": 256, "message": 256}

    assert size < 300_000
    for kind, most in bounds.items():
        series = samples[f"mavloom_{kind}_frames_total"]
        assert len(series) <= most + 2  # and what is left of each link
        assert sum(s.value for s in series) == len(ids) + 3
        assert [s.value for s in series if s.labels["sys"] == "1"] == [3]  # the busiest is listed
        assert all(("comp" in s.labels) == (kind != "system" and detail) for s in series)
    assert any(s.labels["message"] == "other" for s in samples["mavloom_message_frames_total"]) == detail
    assert ("mavloom_source_frames_total" in samples) == detail


def test_many_messages_and_links_do_not_grow_the_metrics(spawn):
    """1,100 clients, of which 1,024 may be listed; and more messages than 256."""
    port, metrics = routers.tcp_port(), routers.tcp_port()
    router = Router(spawn, f"tcpin://127.0.0.1:{port}?max_peers=2000&queue_bytes=4k", "--metrics",
                    f"127.0.0.1:{metrics}")
    clients = 1100
    with contextlib.ExitStack() as open_clients:
        for n in range(clients):
            client = open_clients.enter_context(routers.tcp_client(port))
            client.send(heartbeat((1 + n % 250, 1)) * (2 if n < 100 else 1))
        harness.wait_for(lambda: sum(link["frames_in"] for link in router.links()) == clients + 100, what="all frames")
        samples, size = metrics_of(metrics)

    assert size < 5_000_000
    for kind, most in {"link": 1024, "system": 256, "message": 256}.items():
        name = "mavloom_link_frames_in_total" if kind == "link" else f"mavloom_{kind}_frames_total"
        assert sum(s.labels.get("sys", "1") != "other" and s.labels["link"] != "other" for s in samples[name]) <= most
        assert sum(s.value for s in samples[name]) == clients + 100
        assert any(s.labels["link"] == "other" for s in samples[name])
