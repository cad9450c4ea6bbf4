# SPDX-License-Identifier: MIT
"""mavloom route over bad networks: redundant links of every group mode with faults on purpose, TCP in pieces, lossy and
narrow cables."""
import collections
import contextlib
import ctypes
import os
import select
import shutil
import socket
import struct
import subprocess
import threading
import time

import pytest

import frames
import harness
import netns
import routers
from routers import Router, TcpEnd, UdpEnd

LOCALHOST = "127.0.0.1"
# Each has a delay, so that `fault_delayed` counts the frames that are not lost.
BAD = "loss:0.2,delay:10ms~5ms,reorder:0.1"
DOUBLING = BAD + ",duplicate:0.05"
LATE = "delay:7ms~3ms"
DEAD = "loss:1"
GROUND_STATION, VEHICLE = (255, 190), (1, 1)
ATTITUDE = 30


class CountingEnd(UdpEnd):
    sent = 0

    def send(self, data):
        self.sent += 1
        super().send(data)


# ---- redundant links -------------------------------------------------------------------------------------------------

class Side:
    """A router at one end of the two links, whose faults are those of what it sends."""

    def __init__(self, spawn, folder, letter, urls, end, rules):
        self.letter, self.end, self.log = letter, end, folder / f"{letter}.tsv"
        self.router = Router(spawn, *urls, "--fault-log", self.log, rules=rules)

    def counts(self, number=None):
        """The counters of link `number`, or of the link to its vehicle or station."""
        name = self.end.label if number is None else f"{self.letter}{number}"
        total = collections.Counter()
        for link in self.router.ask("links"):
            if link["endpoint"] == name:
                total.update({key: value for key, value in link.items() if type(value) is int})
        return total

    def lost(self, number=None):
        """Message id and sequence number of each frame that the faults of this link, or of both, took, in order."""
        lines = [line.split("\t") for line in self.log.read_text().splitlines()]
        return [(int(line[5]), int(line[7])) for line in lines
                if line[3] == "loss" and (number is None or is_of(line[1], f"{self.letter}{number}"))]


def is_of(link, endpoint):
    """Whether the link of that name is one of that endpoint."""
    return link.split("#")[0] == endpoint


class Sky:
    """vehicle - router == two UDP links with faults == router - station."""

    def __init__(self, spawn, folder, rng, mode, faults, rules=None):
        self.vehicle = CountingEnd((LOCALHOST, routers.udp_port()), label="vehicle")
        self.station = CountingEnd(label="station")
        ports = [routers.udp_port() for _ in faults]

        def urls(scheme, letter):
            return [f"{scheme}://{LOCALHOST}:{port}?name={letter}{i}&group=sky&group_mode={mode}&out_fault={faulty}"
                    f"&fault_seed={rng.getrandbits(32)}" for i, (port, faulty) in enumerate(zip(ports, faults))]
        self.air = Side(spawn, folder, "a", [*urls("udpout", "a"),
                                             f"udpin://{LOCALHOST}:{self.vehicle.target[1]}?name=vehicle"],
                        self.vehicle, rules)
        self.ground = Side(spawn, folder, "g", [*urls("udpin", "g"),
                                                f"udpout://{LOCALHOST}:{self.station.port}?name=station"],
                           self.station, rules)

    def __enter__(self):
        return self

    def __exit__(self, *_):
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
            return all(side.counts(i)["frames_in"] for side in (self.air, self.ground) for i in (0, 1))
        harness.wait_for(heard, what="both links")
        self.settle()
        self.station.now()
        self.vehicle.now()

    def become(self, number, faults):
        """From now on, link `number` has these faults both ways."""
        for side in (self.air, self.ground):
            side.router.ask("fault", name=f"{side.letter}{number}", out=faults)

    def settle(self):
        """Nothing is under way any more."""
        harness.wait_for(self.is_settled, what="all to have arrived")

    def is_settled(self):
        def passed(near, far, number):
            out = near.counts(number)
            return out["fault_delayed"] == out["frames_out"] == far.counts(number)["frames_in"]
        return all(side.counts()["frames_in"] == side.end.sent for side in (self.air, self.ground)) and all(
            passed(self.air, self.ground, i) and passed(self.ground, self.air, i) for i in (0, 1))

    def carried(self):
        """How much telemetry each link delivered."""
        rows = [row for row in self.ground.router.stats("message") if row["id"] == ATTITUDE]
        return [sum(row["frames"] for row in rows if is_of(row["link"], f"g{i}")) for i in (0, 1)]


def named(sent, lost):
    """Those of `sent` that a log of losses names, both in order and with running sequence numbers."""
    rest = iter(sent)
    return {next(frame for frame in rest if frame[4] == sequence) for _, sequence in lost}


# The same bytes again on one link count as a sender's repetition, unless `dedup_ms` is set (docs/guide/routing.md).
@pytest.mark.parametrize("faults, rules", [(BAD, None), (DOUBLING, {"dedup_ms": 1500})], ids=["losing", "doubling"])
def test_of_two_bad_links_each_frame_comes_once(spawn, tmp_path, rng, faults, rules):
    with Sky(spawn, tmp_path, rng, "all", [faults, faults], rules) as sky:
        sky.join()
        for side, receiver, sent in (
                (sky.air, sky.station, [routers.attitude(VEHICLE) for _ in range(1500)]),
                (sky.ground, sky.vehicle, [routers.command(GROUND_STATION, VEHICLE) for _ in range(300)])):
            before = [len(side.lost(i)) for i in (0, 1)]
            for frame in sent:
                side.end.send(frame)
            sky.settle()
            expected = set(sent) - set.intersection(*(named(sent, side.lost(i)[before[i]:]) for i in (0, 1)))
            got = receiver.count(len(expected))
            assert set(got) == expected and receiver.now() == []
            assert len(sent) * 0.9 < len(expected) < len(sent)
        links = sky.ground.router.links()
        assert sum(link["duplicate"] for link in links) > 0 and sum(link["echo"] for link in links) == 0


@pytest.mark.parametrize("victim", [0, 1])
def test_of_two_links_either_may_die(spawn, tmp_path, rng, victim):
    with Sky(spawn, tmp_path, rng, "all", [LATE, LATE]) as sky:
        sky.join()
        sent = [routers.attitude(VEHICLE) for _ in range(600)]
        for number, frame in enumerate(sent):
            if number == 300:
                sky.become(victim, DEAD)
            sky.vehicle.send(frame)
        assert sorted(sky.station.count(len(sent))) == sorted(sent)
        commands = [routers.command(GROUND_STATION, VEHICLE) for _ in range(50)]
        for frame in commands:
            sky.station.send(frame)
        assert sorted(sky.vehicle.count(len(commands))) == sorted(commands)
        assert sky.air.counts(victim)["fault_lost"] >= 300 and sky.ground.counts(victim)["fault_lost"] >= 50
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
        marks = self.sky.carried()

        def alone():
            now = self.sky.carried()
            moved = [new - old for new, old in zip(now, marks)]
            if all(moved):
                marks[:] = now
            return [n for n in numbers if moved[n] >= count and not moved[1 - n]]
        return self.until(alone, f"link {numbers} to carry")[0]

    def finish(self):
        """Each once; missing is only what a link lost. Returns that."""
        self.sky.settle()
        self.take()
        assert len(self.got) == len(set(self.got))
        missing = set(self.sent) - set(self.got)
        assert not collections.Counter((frame[7], frame[4]) for frame in missing) - collections.Counter(
            self.sky.air.lost())
        return missing


class BothWays(Flow):
    def step(self):
        super().step()
        self.sky.station.send(routers.command(GROUND_STATION, VEHICLE))


def test_primary_falls_over_and_comes_back(spawn, tmp_path, rng):
    with Sky(spawn, tmp_path, rng, "primary", [LATE, LATE]) as sky:
        sky.join()
        flow = Flow(sky)
        flow.carries(0, count=100)
        sky.become(0, DEAD)
        flow.carries(1)
        sky.become(0, LATE)
        flow.carries(0)
        assert flow.finish()


def test_best_leaves_a_dead_link_and_stays_where_it_went(spawn, tmp_path, rng):
    with Sky(spawn, tmp_path, rng, "best", [LATE, LATE]) as sky:
        sky.join()
        flow = Flow(sky)
        flow.until(lambda: len(flow.got) >= 50, "the first frames")
        chosen = 0 if sky.carried()[0] else 1
        assert not sky.carried()[1 - chosen]
        sky.become(chosen, DEAD)
        flow.carries(1 - chosen)
        sky.become(chosen, LATE)
        carried, heard = sky.carried()[chosen], sky.ground.counts(chosen)["frames_in"]
        flow.until(lambda: sky.ground.counts(chosen)["frames_in"] > heard + 20, "heartbeats on the link that is back")
        flow.carries(1 - chosen)
        assert sky.carried()[chosen] == carried
        flow.finish()


@pytest.mark.parametrize("bad", [0, 1])
def test_best_takes_the_link_that_loses_less(spawn, tmp_path, rng, bad):
    faults = [LATE, LATE]
    faults[bad] = "loss:0.4,delay:5ms"
    with Sky(spawn, tmp_path, rng, "best", faults) as sky:
        sky.join()
        flow = Flow(sky)
        flow.carries(1 - bad, count=100)
        flow.finish()


def test_best_leaves_a_link_that_turns_bad_while_traffic_goes_both_ways(spawn, tmp_path, rng):
    """Both sides choose: the spare link carries heartbeats only, and what was never sent on it is no loss."""
    with Sky(spawn, tmp_path, rng, "best", [LATE, LATE]) as sky:
        sky.join()
        flow = BothWays(sky)
        flow.until(lambda: len(flow.got) >= 300, "the first frames")
        chosen = flow.carries(0, 1)
        sky.become(chosen, "loss:0.5," + LATE)
        flow.carries(1 - chosen, count=300)
        flow.finish()


# ---- TCP -------------------------------------------------------------------------------------------------------------

class Pieces:
    """A TCP connection whose bytes the test passes on, cut at random places, and which it can reset. Faults on purpose
    lose frames or parts of them; TCP neither does, nor keeps frames together."""

    def __init__(self, port, rng):
        self.target, self.rng = (LOCALHOST, port), rng
        self.server = socket.create_server((LOCALHOST, 0))
        self.server.settimeout(harness.DEFAULT_TIMEOUT_S)
        self.port = self.server.getsockname()[1]

    def accept(self):
        self.near, _ = self.server.accept()
        self.far = socket.create_connection(self.target, timeout=harness.DEFAULT_TIMEOUT_S)
        self.far.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def pass_on(self):
        if select.select([self.near], [], [], 0)[0]:
            self.far.sendall(self.near.recv(self.rng.randint(1, 300)))

    def reset(self):
        """Breaks the connection without a goodbye."""
        for end in (self.near, self.far):
            end.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            end.close()

    def close(self):
        self.reset()
        self.server.close()


def test_tcp_in_pieces_keeps_frames_whole_and_in_order(spawn, rng):
    port = routers.tcp_port()
    vehicle, station = UdpEnd((LOCALHOST, routers.udp_port())), UdpEnd(label="station")
    ground = Router(spawn, f"tcpin://{LOCALHOST}:{port}?name=in", f"udpout://{LOCALHOST}:{station.port}?name=station")
    with vehicle, station, contextlib.closing(Pieces(port, rng)) as pieces:
        air = Router(spawn, f"udpin://{LOCALHOST}:{vehicle.target[1]}", f"tcpout://{LOCALHOST}:{pieces.port}?name=out")

        def pass_on_until(arrived):
            got = []

            def passed():
                pieces.pass_on()
                got.extend(station.now())  # an End asserts that frame follows frame
                return arrived(got)
            harness.wait_for(passed, what="the frames")
            return got

        def send(count):
            sent = [routers.attitude() for _ in range(count)]
            for frame in sent:
                vehicle.send(frame)
            return sent

        pieces.accept()
        ground.wait_links(2)
        sent = send(500)
        assert pass_on_until(lambda got: len(got) == len(sent)) == sent

        for _ in range(3):
            sent = send(50)
            got = pass_on_until(lambda got: len(got) >= 25)
            pieces.reset()
            pieces.accept()
            harness.wait_for(lambda: len(air.links()) == 2, what="the next connection")
            sent += send(51)
            got += pass_on_until(lambda got: sent[-1] in got)
            assert got == [frame for frame in sent if frame in set(got)]
        assert next(e for e in air.stats("endpoint") if e["endpoint"] == "out")["reconnects"] == 3
        assert sum(link["crc_error"] for link in ground.ask("links")) == 0


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


class Guest(UdpEnd):
    """A station with an address of its own on the machine `there`, with which it leaves the network."""

    def __init__(self, there, number, target):
        self.there, self.is_v6 = there, ":" in target[0]
        self.host = f"fd77::{number}" if self.is_v6 else f"10.77.0.{number}"
        self.flags = ["nodad"] if self.is_v6 else []
        self.address("add", *self.flags)
        super().__init__(target, sock=there.socket(socket.AF_INET6 if self.is_v6 else socket.AF_INET), host=self.host)
        self.send(routers.heartbeat((255, number)))

    def address(self, change, *flags):
        netns.ip("-n", self.there.name, "addr", change, f"{self.host}/{64 if self.is_v6 else 24}", *flags, "dev",
                 self.there.interface)

    def is_of(self, link):
        return self.host in link["link"]


def find_neighbours_fast(machine, family):
    """A host that is gone is missed after 1 to 4 s, not after 20 to 50; the kernel looks for it for 3 s, as usual. By
    IPv6, one solicitation may get no answer."""
    solicitations = 3 if family == "ipv6" else 1
    for key, value in {"base_reachable_time_ms": 200, "delay_first_probe_time": 0,
                       "ucast_solicit": solicitations}.items():
        on(machine, "sh", "-c", f"echo {value} > /proc/sys/net/{family}/neigh/{machine.interface}/{key}")


def miss_on_another_interface(machine, host):
    """Another program sends to the host by an interface on which nobody answers."""
    netns.ip("-n", machine.name, "link", "add", "other", "type", "veth", "peer", "name", "nobody")
    for interface in ("nobody", "other"):
        netns.ip("-n", machine.name, "link", "set", interface, "up")
    on(machine, "sh", "-c", "echo 1 > /proc/sys/net/ipv4/neigh/other/mcast_solicit")  # seconds
    with machine.socket() as program:
        program.setsockopt(socket.SOL_SOCKET, socket.SO_BINDTODEVICE, b"other")
        program.sendto(b"", (host, PORT))
    failed = ("ip", "neigh", "show", "dev", "other", "nud", "failed")
    harness.wait_for(lambda: host in subprocess.check_output(machine.command(*failed), text=True), what="the failure")


@pytest.mark.parametrize("bind, family", [("0.0.0.0", "ipv4"), ("[::]", "ipv4"), ("[::]", "ipv6")])
def test_stations_that_left_the_network_do_not_delay_the_others(machines, spawn_in, bind, family):
    """While the kernel looks for a host, it keeps the frames for it in the socket's send buffer; those for two hosts
    fill it."""
    here, there = machines
    find_neighbours_fast(here, family)
    router = Router(spawn_in(here), f"udpin://127.0.0.1:{PORT}?name=in",
                    f"udpin://{bind}:{PORT + 1}?trusted=true&idle=600&name=far")
    target = (here.host6 if family == "ipv6" else here.host, PORT + 1)
    stays, *leaving = [Guest(there, number, target) for number in (11, 12, 13, 14)]
    with machine_end(here, ("127.0.0.1", PORT)) as vehicle, stays, leaving[0], leaving[1], leaving[2]:
        vehicle.send(routers.heartbeat())
        router.wait_links(5)
        if family == "ipv4":
            miss_on_another_interface(here, stays.host)
        for station in leaving:
            station.address("del")
        sent = []

        def fly(count):
            for _ in range(count):
                sent.append(routers.attitude())
                vehicle.send(sent[-1])
                time.sleep(0.005)  # 200 frames a second; no verdict depends on it

        def counts(name):
            return [router.link_of(station)[name] for station in leaving]

        def all_are_missed():
            fly(50)
            return all(counts("queue_age"))
        harness.wait_for(all_are_missed, what="frames for all that are gone to wait")
        before = counts("frames_out")
        fly(800)
        assert stays.until(sent[-1])[-len(sent) + 1:] == sent[:-1]
        assert counts("frames_out") == before, "all wait"
        harness.wait_for(lambda: counts("queued_bytes") == [0, 0, 0], what="what waits to grow old")
        log = [line for line in router.process.stderr.splitlines() if "its host does not answer on its network" in line]
        assert all(any(station.host in line for line in log) for station in leaving), log
        assert not any(stays.host in line for line in log), log

        commands = [routers.command((1, 1), (255, number)) for number in (12, 13, 14)]
        vehicle.send(b"".join(commands))
        for station in leaving:  # they only listen
            station.address("add", *station.flags)
        for station, command in zip(leaving, commands):
            station.until(command)  # it waited for 10 s at most


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
        known = routers.heartbeat()
        self.vehicle.send(known)
        self.station.until(known)  # from now on, the kernel knows the station's host
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
