# SPDX-License-Identifier: MIT
"""Attacks without a key, on a running router. docs/design/security.md lists them; the rules themselves are tested in
units."""
import contextlib
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

    def __init__(self, port, rate, seconds, ids=1):
        self.process = subprocess.Popen([FLOOD, "127.0.0.1", str(port), str(rate), str(seconds), str(ids)],
                                        stdout=subprocess.PIPE, text=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()

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


def test_a_flood_of_invented_peers_takes_nothing_from_those_who_talk(pair):
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
    with Net(spawn, "udpin", 3) as net:
        vehicle, attacker, station = net[1], net[2], net[3]
        station.send(heartbeat(STATION))
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


def test_one_frame_with_the_vehicles_id_costs_a_station_no_telemetry(spawn):
    with Net(spawn, "udpin", 2) as net:
        vehicle, station = net[1], net[2]
        vehicle.send(heartbeat(VEHICLE))
        station.send(heartbeat(STATION))
        station.send(heartbeat(VEHICLE))  # forged: it has the station's address

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


def test_invented_ids_do_not_grow_the_metrics(spawn):
    """One scrape after invented ids was 216 MB."""
    from prometheus_client.parser import text_string_to_metric_families
    port, metrics = routers.udp_port(), routers.tcp_port()
    router = Router(spawn, f"udpin://127.0.0.1:{port}", "--metrics", f"127.0.0.1:{metrics}")
    with UdpEnd(("127.0.0.1", port)) as attacker, UdpEnd(("127.0.0.1", port)) as vehicle:
        ids = [(system, component) for system in range(2, 26) for component in range(1, 101)]
        for begin in range(0, len(ids), 40):
            attacker.send(b"".join(heartbeat(source) for source in ids[begin:begin + 40]))
        for _ in range(3):
            vehicle.send(heartbeat(VEHICLE))
        harness.wait_for(lambda: sum(link["frames_in"] for link in router.links()) == len(ids) + 3, what="all frames")
        text = urllib.request.urlopen(f"http://127.0.0.1:{metrics}/metrics").read().decode()
    samples = [sample for family in text_string_to_metric_families(text) for sample in family.samples]
    by_source = [s for s in samples if s.name == "mavloom_source_frames_total"]
    by_message = [s for s in samples if s.name == "mavloom_message_frames_total"]

    assert len(by_source) <= 256 + 2 and len(by_message) <= 1024 + 2  # and what is left of each link
    for all_of in (by_source, by_message):
        assert sum(s.value for s in all_of) == len(ids) + 3
        assert [s.value for s in all_of if s.labels["sys"] == "1"] == [3]  # the busiest is listed
    assert any(s.labels["message"] == "other" for s in by_message)
