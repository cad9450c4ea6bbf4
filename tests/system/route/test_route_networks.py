# SPDX-License-Identifier: MIT
"""mavloom route over bad networks: redundant links of every group mode through a seeded impairer, TCP in pieces, lossy
and narrow cables."""
import contextlib
import ctypes
import dataclasses
import os
import select
import shutil
import socket
import subprocess
import threading
import time

import pytest

import frames
import harness
import netns
import routers
from impairer import Profile, TcpImpairer, UdpImpairer
from routers import Router, TcpEnd, UdpEnd

LOCALHOST = "127.0.0.1"
BAD = Profile(delay=0.005, jitter=0.01, loss=0.2, reorder=0.1)
DOUBLING = dataclasses.replace(BAD, duplicate=0.05)
LATE = Profile(delay=0.005, jitter=0.005)
GROUND_STATION, VEHICLE = (255, 190), (1, 1)
ATTITUDE = 30


class CountingEnd(UdpEnd):
    sent = 0

    def send(self, data):
        self.sent += 1
        super().send(data)


# ---- redundant links -------------------------------------------------------------------------------------------------

class Sky:
    """vehicle - router == two impaired UDP links == router - station."""

    def __init__(self, spawn, rng, mode, profiles, rules=None):
        self.vehicle = CountingEnd((LOCALHOST, routers.udp_port()))
        self.station = CountingEnd(label="station")
        ports = [routers.udp_port() for _ in range(2)]
        self.links = [UdpImpairer((LOCALHOST, port), rng, profile) for port, profile in zip(ports, profiles)]
        common = f"group=sky&group_mode={mode}&mtu=0"  # one frame a datagram: the impairer's losses are the links'
        self.air = Router(spawn, f"udpin://{LOCALHOST}:{self.vehicle.target[1]}",
                          *(f"udpout://{LOCALHOST}:{link.port}?name=a{i}&{common}"
                            for i, link in enumerate(self.links)), rules=rules)
        self.ground = Router(spawn, *(f"udpin://{LOCALHOST}:{port}?name=g{i}&{common}" for i, port in enumerate(ports)),
                             f"udpout://{LOCALHOST}:{self.station.port}?name=station", rules=rules)

    def __enter__(self):
        for link in self.links:
            link.__enter__()
        return self

    def __exit__(self, *_):
        for link in self.links:
            link.__exit__()
        self.vehicle.close()
        self.station.close()

    def join(self):
        """Both sides hear each other on both links."""
        def heard():
            self.vehicle.send(routers.heartbeat(VEHICLE))
            if self.station.target is None:
                if not select.select([self.station.sock], [], [], 0.1)[0]:
                    return False  # lost on both links: the next heartbeat
                self.station.target = self.station.sock.recvfrom(65536)[1]
            self.station.send(routers.heartbeat(GROUND_STATION))
            return all(len([link for link in router.links() if link["endpoint"][0] == letter and link["frames_in"]])
                       == 2
                       for router, letter in ((self.air, "a"), (self.ground, "g")))
        harness.wait_for(heard, what="both links")
        self.settle()
        self.station.now()
        self.vehicle.now()

    def settle(self):
        """Nothing is under way any more."""
        harness.wait_for(self.is_settled, what="all to have arrived")

    def is_settled(self):
        air, ground = self.totals(self.air), self.totals(self.ground)
        if air[""]["frames_in"] != self.vehicle.sent or ground["station"]["frames_in"] != self.station.sent:
            return False
        return all(link.idle and air[f"a{i}"]["frames_out"] == link.forth.taken and ground[f"g{i}"]["frames_out"]
                   == link.back.taken and
                   ground[f"g{i}"]["frames_in"] == len(link.forth.delivered) and air[f"a{i}"]["frames_in"]
                   == len(link.back.delivered)
                   for i, link in enumerate(self.links))

    @staticmethod
    def totals(router):
        """Frames in and out by endpoint; "": the one without a name."""
        sums = {}
        for link in router.ask("links"):
            name = "" if "//" in link["endpoint"] else link["endpoint"]
            sums[name] = {key: sums.get(name, {}).get(key, 0) + link[key] for key in ("frames_in", "frames_out")}
        return sums

    def carried(self, number, since=0):
        """Telemetry that link `number` delivered."""
        return [frame for frame in self.links[number].forth.delivered[since:] if frame[7] == ATTITUDE]


# The same bytes again on one link count as a sender's repetition, unless `dedup_ms` is set (docs/guide/routing.md).
@pytest.mark.parametrize("profile, rules", [(BAD, None), (DOUBLING, {"dedup_ms": 1500})], ids=["losing", "doubling"])
def test_of_two_bad_links_each_frame_comes_once(spawn, rng, profile, rules):
    with Sky(spawn, rng, "all", [profile, profile], rules) as sky:
        sky.join()
        for sender, receiver, way, sent in (
                (sky.vehicle, sky.station, "forth", [routers.attitude(VEHICLE) for _ in range(1500)]),
                (sky.station, sky.vehicle, "back", [routers.command(GROUND_STATION, VEHICLE) for _ in range(300)])):
            directions = [getattr(link, way) for link in sky.links]
            for frame in sent:
                sender.send(frame)
            sky.settle()
            expected = {frame for d in directions for frame in d.delivered} & set(sent)
            got = receiver.count(len(expected))
            assert set(got) == expected and receiver.now() == []
            assert len(sent) * 0.9 < len(expected) < len(sent)
        duplicates = sum(link["duplicate"] for link in sky.ground.links())
        assert duplicates > 0 and sum(link["echo"] for link in sky.ground.links()) == 0


@pytest.mark.parametrize("victim", [0, 1])
def test_of_two_links_either_may_die(spawn, rng, victim):
    with Sky(spawn, rng, "all", [LATE, LATE]) as sky:
        sky.join()
        sent = [routers.attitude(VEHICLE) for _ in range(600)]
        for number, frame in enumerate(sent):
            if number == 300:
                sky.links[victim].kill()
            sky.vehicle.send(frame)
        assert sorted(sky.station.count(len(sent))) == sorted(sent)
        commands = [routers.command(GROUND_STATION, VEHICLE) for _ in range(50)]
        for frame in commands:
            sky.station.send(frame)
        assert sorted(sky.vehicle.count(len(commands))) == sorted(commands)
        assert len(sky.links[victim].forth.cut) >= 300
        sky.settle()
        assert sky.station.now() == []


class Flow:
    """Telemetry down, heartbeats both ways, in small steps; keeps what was sent and what came."""

    def __init__(self, sky):
        self.sky, self.sent, self.got, self.steps = sky, [], [], 0

    def step(self):
        sky = self.sky
        if self.steps % 5 == 0:
            sky.station.send(routers.heartbeat(GROUND_STATION))
            sky.vehicle.send(routers.heartbeat(VEHICLE))
        self.steps += 1
        self.sent.append(routers.attitude(VEHICLE))
        sky.vehicle.send(self.sent[-1])
        time.sleep(0.005)  # a rate; no verdict hangs on it
        self.take()

    def take(self):
        self.got += [frame for frame in self.sky.station.now() if frame[7] == ATTITUDE]

    def until(self, condition, what):
        def stepped():
            self.step()
            return condition()
        return harness.wait_for(stepped, what=what)

    def carries(self, *numbers, count=40):
        """Continues until one link of `numbers` alone has carried so much: which."""
        marks = [len(link.forth.delivered) for link in self.sky.links]
        return self.until(lambda: [n for n in numbers if not self.moved(marks, 1 - n)
                                   and self.moved(marks, n) >= count], f"link {numbers} to carry")[0]

    def moved(self, marks, number):
        moved = len(self.sky.carried(number, marks[number]))
        if moved and len(self.sky.carried(1 - number, marks[1 - number])):
            marks[:] = [len(link.forth.delivered) for link in self.sky.links]
        return moved

    def finish(self):
        """Each once; missing is only what was on a link when it died."""
        self.sky.settle()
        self.take()
        died = {frame for link in self.sky.links for frame in (*link.forth.cut, *link.forth.lost)}
        assert len(self.got) == len(set(self.got))
        assert set(self.sent) - set(self.got) <= died
        return died & set(self.sent)


class BothWays(Flow):
    def step(self):
        super().step()
        self.sky.station.send(routers.command(GROUND_STATION, VEHICLE))


def test_primary_falls_over_and_comes_back(spawn, rng):
    with Sky(spawn, rng, "primary", [LATE, LATE]) as sky:
        sky.join()
        flow = Flow(sky)
        flow.carries(0, count=100)
        sky.links[0].kill()
        flow.carries(1)
        sky.links[0].revive()
        flow.carries(0)
        assert flow.finish()


def test_best_leaves_a_dead_link_and_stays_where_it_went(spawn, rng):
    with Sky(spawn, rng, "best", [LATE, LATE]) as sky:
        sky.join()
        flow = Flow(sky)
        flow.until(lambda: len(flow.got) >= 50, "the first frames")
        chosen = 0 if sky.carried(0) else 1
        assert not sky.carried(1 - chosen)
        sky.links[chosen].kill()
        flow.carries(1 - chosen)
        sky.links[chosen].revive()
        mark = len(sky.links[chosen].forth.delivered)
        flow.until(lambda: len(sky.links[chosen].forth.delivered) > mark + 20, "heartbeats on the link that is back")
        flow.carries(1 - chosen)
        assert not sky.carried(chosen, mark)
        flow.finish()


@pytest.mark.parametrize("bad", [0, 1])
def test_best_takes_the_link_that_loses_less(spawn, rng, bad):
    profiles = [LATE, LATE]
    profiles[bad] = Profile(delay=0.005, loss=0.4)
    with Sky(spawn, rng, "best", profiles) as sky:
        sky.join()
        flow = Flow(sky)
        flow.carries(1 - bad, count=100)
        flow.finish()


def test_best_leaves_a_link_that_turns_bad_while_traffic_goes_both_ways(spawn, rng):
    """Both sides choose: the spare link carries heartbeats only, and what was never sent on it is no loss."""
    with Sky(spawn, rng, "best", [LATE, LATE]) as sky:
        sky.join()
        flow = BothWays(sky)
        flow.until(lambda: len(flow.got) >= 300, "the first frames")
        chosen = flow.carries(0, 1)
        sky.links[chosen].become(dataclasses.replace(LATE, loss=0.5))
        flow.carries(1 - chosen, count=300)
        flow.finish()


# ---- TCP -------------------------------------------------------------------------------------------------------------

def test_tcp_in_pieces_keeps_frames_whole_and_in_order(spawn, rng):
    port = routers.tcp_port()
    vehicle, station = UdpEnd((LOCALHOST, routers.udp_port())), UdpEnd(label="station")
    ground = Router(spawn, f"tcpin://{LOCALHOST}:{port}?name=in", f"udpout://{LOCALHOST}:{station.port}?name=station")
    with contextlib.closing(vehicle), contextlib.closing(station), \
            TcpImpairer((LOCALHOST, port), rng, delay=0.002, jitter=0.01, max_bytes=300) as link:
        air = Router(spawn, f"udpin://{LOCALHOST}:{vehicle.target[1]}", f"tcpout://{LOCALHOST}:{link.port}?name=out")
        air.wait_links(1)
        ground.wait_links(2)
        sent = [routers.attitude() for _ in range(500)]
        for frame in sent:
            vehicle.send(frame)
        assert station.count(len(sent)) == sent

        for _ in range(3):
            before = link.connections
            sent = [routers.attitude() for _ in range(100)]
            for number, frame in enumerate(sent):
                if number == 50:
                    link.reset()
                vehicle.send(frame)
            harness.wait_for(lambda n=before: link.connections == n + 1 and len(air.links()) == 2,
                             what="the next connection")
            last = routers.heartbeat()
            vehicle.send(last)
            got = station.until(last)  # an End asserts that frame follows frame
            assert got == [frame for frame in sent if frame in set(got)]
        assert next(e for e in air.stats("endpoint") if e["endpoint"] == "out")["reconnects"] == 3
        assert sum(link["crc_error"] for link in ground.links()) == 0


# ---- cables ----------------------------------------------------------------------------------------------------------

@pytest.fixture
def machines():
    yield from netns.two_machines()


@pytest.fixture
def spawn_in(program):
    """spawn_in(machine) -> what Router starts the program with."""
    running = []

    def on(machine):
        def start(*args, env=None):
            running.append(harness.Running(machine.command("env", *(f"{k}={v}" for k, v in (env or {}).items()),
                                                           program, *args)))
            return running[-1]
        return start
    yield on
    harness.end(running)


def on(machine, *command):
    if not shutil.which(command[0]):
        pytest.skip(f"no {command[0]} here")
    done = subprocess.run(machine.command(*command), capture_output=True, text=True)
    if done.returncode != 0:
        pytest.skip(f"{' '.join(command)}: {done.stderr.strip()}")


def machine_end(machine, target=None, port=0):
    """The far end of a UDP link, on another machine."""
    return UdpEnd(target, port=port, sock=machine.socket())


PORT = 14550


def test_what_a_cable_loses_is_the_links_own_loss(machines, spawn_in):
    """Of every three datagrams the second machine's kernel drops one: by the router's sequence tracking exactly that is
    missing."""
    here, there = machines
    on(there, "iptables", "-A", "INPUT", "-p", "udp", "--dport", str(PORT), "-m", "statistic", "--mode", "nth",
       "--every", "3", "--packet", "0", "-j", "DROP")
    vehicle, station = machine_end(here, ("127.0.0.1", PORT)), machine_end(there)
    with contextlib.closing(vehicle), contextlib.closing(station):
        Router(spawn_in(here), f"udpin://127.0.0.1:{PORT}", f"udpout://{there.host}:{PORT}?mtu=0")
        ground = Router(spawn_in(there), f"udpin://0.0.0.0:{PORT}?name=in",
                        f"udpout://127.0.0.1:{station.port}?name=station")
        sent = [routers.attitude() for _ in range(901)]  # one is dropped first: the numbers 0, 3, 6, ...
        for frame in sent:
            vehicle.send(frame)
        assert station.count(600) == [frame for number, frame in enumerate(sent) if number % 3]
        assert station.now() == []
        source = ground.stats("source")[0]
        assert source["frames"] == 600
        assert source["lost"] == 299  # the first and the last are beyond its sight


class Narrow:
    """vehicle - router - narrow cable - station. The station calls (udpin, tcpin) or is called (the others)."""

    RATE_BITS = 256_000

    def __init__(self, machines, start, scheme, options, limit=4000):
        here, self.there = machines
        self.vehicle = machine_end(here, ("127.0.0.1", PORT))
        self.here, self.scheme = here, scheme
        near = PORT + 1
        called = {"udpout": self.there.host, "udpbcast": "10.77.0.255", "udpmcast": "239.255.77.1"}
        if scheme in called:
            self.station = machine_end(self.there)
            url = f"{scheme}://{called[scheme]}:{self.station.port}"
            if scheme == "udpmcast":
                self.station.sock.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                                             socket.inet_aton(called[scheme]) + socket.inet_aton(self.there.host))
        else:
            url = f"{scheme}://0.0.0.0:{near}"
            options += "&trusted=true" if scheme == "udpin" else ""
        self.router = Router(start(here), f"udpin://127.0.0.1:{PORT}", f"{url}?name=far&{options}")
        if scheme == "udpin":
            self.station = machine_end(self.there, (here.host, near))
            self.station.send(routers.heartbeat(GROUND_STATION))  # only once, so `trusted` is needed
        elif scheme == "tcpin":
            self.station = TcpEnd(in_machine(self.there,
                                             lambda: socket.create_connection((here.host, near), timeout=60)))
        self.vehicle.send(routers.heartbeat())
        harness.wait_for(lambda: len(self.router.links()) == 2, what="both links")
        on(here, "tc", "qdisc", "replace", "dev", here.interface, "root", "tbf", "rate", f"{self.RATE_BITS}bit",
           "burst", "3000", "limit", str(limit))

    def link(self):
        return next(link for link in self.router.ask("links") if link["endpoint"] == "far")

    def widen(self):
        on(self.here, "tc", "qdisc", "change", "dev", self.here.interface, "root", "tbf", "rate", "100mbit", "burst",
           "100000", "limit", "1000000")

    def close(self):
        self.vehicle.close()
        self.station.close()


def in_machine(machine, make):
    """Calls `make` in the machine's network and returns its result."""
    made = []

    def run():
        with open(f"/run/netns/{machine.name}") as namespace:
            assert ctypes.CDLL(None, use_errno=True).setns(namespace.fileno(), netns.CLONE_NEWNET) == 0
        made.append(make())
    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    return made[0]


def bulk(count):
    """Telemetry of 280 bytes that no newer one replaces."""
    return [routers.make(frames.mavlink.MAVLink_encapsulated_data_message(i % 65536, os.urandom(252) + b"\x01"))
            for i in range(count)]


def urgent():
    """One of each kind that somebody waits for: class 0."""
    m = frames.mavlink
    return [routers.heartbeat(), routers.command(VEHICLE, (0, 0)),
            routers.make(m.MAVLink_command_ack_message(400, 0, routers.unique() % 256)),
            routers.make(m.MAVLink_statustext_message(6, b"%d" % routers.unique())),
            routers.make(m.MAVLink_param_value_message(b"P", routers.unique(), 9, 1, 0))]


@pytest.mark.parametrize("scheme, options",
                         [("udpout", ""), ("udpin", ""), ("udpbcast", "&fixed=true"), ("udpmcast", ""), ("tcpin", "")])
def test_through_a_narrow_cable_comes_first_what_somebody_waits_for(machines, spawn_in, scheme, options):
    """Much more than the cable carries: heartbeats, commands and acknowledgements all get through, telemetry is dropped
    and counted."""
    net = Narrow(machines, spawn_in, scheme, "queue_bytes=20k" + options)
    with contextlib.closing(net):
        wanted, other = [], []
        for _ in range(40):
            wanted += urgent()
            other += bulk(30)
            for frame in wanted[-5:] + other[-30:]:
                net.vehicle.send(frame)
            harness.wait_for(lambda: sum(link["frames_in"] for link in net.router.links()) >= len(wanted) + len(other),
                             what="all to be in")
        net.widen()
        last = routers.heartbeat()
        net.vehicle.send(last)
        got = net.station.until(last)
        assert [frame for frame in got if frame in set(wanted)] == wanted
        through = len([frame for frame in got if frame in set(other)])
        assert 0 < through == len(other) - net.link()["queue_bytes"] - net.link()["queue_age"]
        assert through < len(other)


@pytest.mark.parametrize("scheme", ["udpout", "tcpin"])
def test_telemetry_does_not_grow_old_in_a_queue(machines, spawn_in, scheme):
    """A queue that may hold all, for 300 ms: what is older goes, counted;
    then the cable carries what is new at once."""
    net = Narrow(machines, spawn_in, scheme, "queue_bytes=4M&queue_age=300ms")
    with contextlib.closing(net):
        sent = bulk(2500)
        for number, frame in enumerate(sent):
            net.vehicle.send(frame)
            if number % 250 == 249:
                harness.wait_for(lambda n=number: sum(link["frames_in"] for link in net.router.links()) >= n,
                                 what="all to be in")
        dropped = harness.wait_for(lambda: net.link()["queue_age"] + net.link()["frames_out"] >= len(sent)
                                   and net.link()["queue_age"], what="the old ones to go")
        assert net.link()["queue_bytes"] == 0
        net.widen()
        last = routers.attitude()
        for _ in range(10):  # while the kernel's buffer is full, on a busy machine, one may grow old, too
            net.vehicle.send(last)
            time.sleep(0.1)
        got = [frame for frame in net.station.until(last) if frame in set(sent)]
        assert got == [frame for frame in sent if frame in set(got)]
        assert len(got) == len(sent) - dropped
