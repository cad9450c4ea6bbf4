# SPDX-License-Identifier: MIT
"""Whom a running router believes, over real links: docs/guide/routing.md, "Trust". The rules themselves are tested in
units; here are the ranks that links get by scheme, option and address."""
import contextlib
import socket
import struct
import threading
import time

import pytest

import harness
import netns
import routers
from frames import mavlink
from routers import Net, Router, SerialEnd, TcpEnd, UdpEnd, attitude, command, heartbeat

VEHICLE, COMPANION, CAMERA, STATION = (1, 1), (1, 240), (1, 100), (255, 190)
PORT, OTHER_PORT = 14550, 14560


# ---- on one machine --------------------------------------------------------------------------------------------------

@pytest.mark.short
@pytest.mark.parametrize("kind", ["peers", "udpin", "udpout", "tcpin", "wsin", "wsout", "serial"])
def test_a_vehicle_may_move_between_own_links(spawn, kind):
    with Net(spawn, kind, 3, rules={"route_timeout": 2}) as net:
        net.hears(1, VEHICLE)
        assert net.hears(2, VEHICLE) == [3]
        assert net.command(3, STATION, VEHICLE) == [1, 2], "commands follow with the first frame"
        assert net.command(3, STATION, (1, 0)) == [1, 2]

        def is_present():
            net.hears(2, VEHICLE)
            return net.hears(1, VEHICLE) == [3]
        harness.wait_for(is_present, what="a source on two links that is sent back to neither")

        def has_left():
            net.hears(2, VEHICLE)
            return net.command(3, STATION, VEHICLE) == [2]
        harness.wait_for(has_left, what="the end of the old route")
        assert net.hears(2, VEHICLE) == [1, 3], "the old link no longer has the source"
        assert net.command(3, STATION, (1, 0)) == [2]
        assert net.command(2, VEHICLE, STATION) == [3]


@pytest.mark.parametrize("scheme", ["udpin", "tcpin"])
def test_the_old_link_gets_copies_until_its_peer_is_forgotten(spawn, scheme):
    with Net(spawn, scheme, 3, options={1: "idle=2"}) as net:
        net[1].send(heartbeat(VEHICLE))
        net[2].send(heartbeat(VEHICLE))
        harness.wait_for(lambda: sum(r[:2] == VEHICLE for r in net.router.routes()) == 2, what="both routes")
        net[3].send(order := command(STATION, VEHICLE))
        net[1].until(order)
        net[2].until(order)
        harness.wait_for(lambda: len(net.router.links()) == 2, what="the end of the old peer")
        net[3].send(order := command(STATION, VEHICLE))
        net[2].until(order)


# ---- between machines ------------------------------------------------------------------------------------------------

@pytest.fixture(scope="module")
def machines():
    yield from netns.two_machines()


@pytest.fixture
def ends():
    with contextlib.ExitStack() as stack:
        yield stack


def spawn_on(machine, program, ends):
    def spawn(*args, env):
        running = harness.Running(machine.command(program, *args), env=harness.environment(env))
        ends.callback(running.kill)
        return running
    return spawn


@pytest.fixture
def here(machines, program, ends):
    """The machine of the router."""
    def router(*urls):
        machines[0].running = Router(spawn_on(machines[0], program, ends), *urls)
        return machines[0].running
    machines[0].router = router
    return machines[0]


def local(here, ends, port=PORT):
    return ends.enter_context(UdpEnd(("127.0.0.1", port), sock=here.socket()))


def remote(machines, ends, port=PORT, near=0):
    return ends.enter_context(UdpEnd((machines[0].host, port), port=near, sock=machines[1].socket()))


def client(machine, ends, host, port):
    sock = machine.socket(kind=socket.SOCK_STREAM)
    sock.connect((host, port))
    return ends.enter_context(TcpEnd(sock))


def beat(here, *pairs):
    """Heartbeats twice, half a second apart, so that UDP peers are confirmed. Returns once the router has all."""
    router = here.running
    there = heard_by(router)
    for n in (1, 2):
        for end, source in pairs:
            end.send(heartbeat(source))
        harness.wait_for(lambda n=n: heard_by(router) >= there + n * len(pairs), what="the heartbeats")
        if n == 1:
            time.sleep(0.6)  # time under test: a second datagram, at least 0.5 s later, confirms an address


def heard_by(router):
    return sum(link["frames_in"] for link in router.links())


def answer(target):
    return routers.make(mavlink.MAVLink_command_ack_message(400, 0, 0, routers.unique(), *target), VEHICLE)


def reached(station, vehicle, *others, target=VEHICLE):
    """Which of these ends get a command of the station, by their places. A broadcast behind it shows the end."""
    station.send(order := command(STATION, target))
    station.send(mark := heartbeat((0, 0)))
    return [n for n, end in enumerate((vehicle, *others)) if order in end.until(mark)]


def test_a_vehicle_behind_nat_may_change_its_port(here, machines, ends):
    here.router(f"udpin://0.0.0.0:{PORT}")
    station, before, after = local(here, ends), remote(machines, ends), remote(machines, ends)
    # There is a station on the vehicle's side too, with the same id.
    beat(here, (before, STATION), (before, VEHICLE), (station, STATION), (after, (0, 0)))
    assert reached(station, before, after) == [0]
    before.send(reply := answer(STATION))
    station.until(reply)

    def moved():
        after.send(heartbeat(VEHICLE))
        return 1 in reached(station, before, after)
    began = time.monotonic()
    harness.wait_for(moved, timeout=10, what="a command at the new port")
    assert time.monotonic() - began < 4.5, "another stranger would have to wait for 5 s"
    after.send(reply := answer(STATION))
    station.until(reply)


@pytest.mark.parametrize("first_is_here", [True, False])
def test_two_stations_with_one_id_both_get_all_answers(here, machines, ends, first_is_here):
    """One on this machine and one on a tablet; or both on other machines."""
    here.router(f"udpin://0.0.0.0:{PORT}", f"udpin://127.0.0.1:{OTHER_PORT}")
    station = local(here, ends) if first_is_here else remote(machines, ends)
    tablet, vehicle = remote(machines, ends), local(here, ends, OTHER_PORT)
    beat(here, (station, STATION), (tablet, STATION), (vehicle, VEHICLE))
    for frame in (answer(STATION), attitude(VEHICLE)):
        vehicle.send(frame)
        station.until(frame)
        tablet.until(frame)


def test_a_companion_here_and_a_vehicle_far_away_are_reached(here, machines, ends):
    here.router(f"udpin://0.0.0.0:{PORT}")
    station, companion, vehicle = local(here, ends), local(here, ends), remote(machines, ends)
    beat(here, (vehicle, VEHICLE), (companion, COMPANION), (station, STATION))
    assert reached(station, vehicle, companion, target=COMPANION) == [1]
    assert reached(station, vehicle, companion, target=VEHICLE) == [0]


def test_a_camera_far_away_beside_a_vehicle_on_a_serial_line_is_reached(here, machines, ends):
    line = ends.enter_context(SerialEnd())
    here.router(f"serial://{line.device}", f"udpin://0.0.0.0:{PORT}")
    station, camera = local(here, ends), remote(machines, ends)
    beat(here, (line, VEHICLE), (camera, CAMERA), (station, STATION))
    assert 1 in reached(station, line, camera, target=CAMERA)
    assert reached(station, line, camera, target=VEHICLE) == [0]


def test_a_stranger_gets_no_vehicle_of_an_own_link(here, machines, ends):
    router = here.router(f"udpin://0.0.0.0:{PORT}")
    station, vehicle, stranger = local(here, ends), local(here, ends), remote(machines, ends)
    beat(here, (stranger, VEHICLE), (station, STATION))
    assert reached(station, vehicle_that_is_silent(here, vehicle), stranger) == [1], "nobody else has it yet"

    began = time.monotonic()
    beat(here, (vehicle, VEHICLE), (stranger, VEHICLE))
    assert reached(station, vehicle, stranger) == [0], "the first frame of the own link ends the stranger's route"
    assert router.stats("router")[0]["route_conflicts"] == 0

    def taken():
        stranger.send(heartbeat(VEHICLE))
        return reached(station, vehicle, stranger) == [0, 1]
    harness.wait_for(taken, timeout=10, what="the stranger's route, after 2 s of silence")
    assert time.monotonic() - began > 2


def vehicle_that_is_silent(here, end):
    """Makes the end a link, without a route."""
    beat(here, (end, (0, 0)))
    return end


def test_a_vehicle_may_move_between_two_machines_that_the_user_named(here, machines, ends):
    here.router(*(f"udpout://{machines[1].host}:{port}?bind=0.0.0.0:{port}" for port in (PORT + 1, PORT + 2)),
                f"udpin://127.0.0.1:{PORT}")
    before, after = (remote(machines, ends, port, port) for port in (PORT + 1, PORT + 2))
    station = local(here, ends)
    beat(here, (before, VEHICLE), (after, (0, 0)), (station, STATION))
    assert reached(station, before, after) == [0]
    there = heard_by(here.running)
    after.send(heartbeat(VEHICLE))
    harness.wait_for(lambda: heard_by(here.running) > there, what="the vehicle at its new place")
    assert reached(station, before, after) == [0, 1]


def test_a_stranger_gets_the_vehicle_of_a_serial_line_after_an_unplug(here, machines, ends):
    line = ends.enter_context(SerialEnd("line"))
    router = here.router(f"serial://{line.device}?name=line", f"udpin://0.0.0.0:{PORT}")
    station, vehicle = local(here, ends), remote(machines, ends)
    beat(here, (line, VEHICLE), (vehicle, VEHICLE), (station, STATION))
    assert reached(station, line, vehicle) == [0]
    last = time.monotonic()
    line.send(heartbeat(VEHICLE))
    harness.wait_for(lambda: router.link_of(line)["frames_in"] == 3, what="the last heartbeat")
    line.close()
    router.wait_links(2)

    def moved():
        vehicle.send(heartbeat(VEHICLE))
        return reached(station, vehicle) == [0]
    harness.wait_for(moved, timeout=10, what="a command")
    assert time.monotonic() - last > 1.9, "the line has it for 2 s, although it is gone"


def test_an_attacker_beside_a_stranger_waits_for_five_seconds(here, machines, ends):
    router = here.router(f"udpin://0.0.0.0:{PORT}")
    station, vehicle, attacker = local(here, ends), remote(machines, ends), remote(machines, ends)
    beat(here, (vehicle, VEHICLE), (station, STATION))
    began = time.monotonic()

    def is_believed():
        vehicle.send(heartbeat(VEHICLE))
        attacker.send(heartbeat(VEHICLE))
        return reached(station, vehicle, attacker) == [0, 1]
    harness.wait_for(is_believed, timeout=20, what="the attacker's route")
    assert time.monotonic() - began > 4
    assert router.stats("router")[0]["route_conflicts"] == 1
    router.process.wait_output("system 1 is alive on .* and was learned on .* too", stream="err")


def test_a_station_forged_later_keeps_no_telemetry_from_the_station(here, machines, ends):
    here.router(f"udpin://0.0.0.0:{PORT}")
    vehicle, station, forger = local(here, ends), remote(machines, ends), remote(machines, ends)
    beat(here, (vehicle, VEHICLE), (station, STATION))
    beat(here, (forger, STATION), (forger, VEHICLE))
    for frame in (answer(STATION), attitude(VEHICLE)):
        vehicle.send(frame)
        station.until(frame)


# Each of these endpoints of the router has an end, which claims to be the vehicle of an own link.
LISTENING = ("udpin://0.0.0.0:{}?", "tcpin://0.0.0.0:{}?",
             "udpbcast://10.77.0.255:{0}?fixed=true&bind=0.0.0.0:{0}&", "udpmcast://239.255.77.1:{}?iface=cable1&")


def join_group(machine, end):
    end.sock.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                        socket.inet_aton(end.target[0]) + socket.inet_aton(machine.host))
    return end


def claimants(machines, ends):
    """On the other machine."""
    udpin, tcpin, udpbcast, udpmcast = range(PORT + 1, PORT + 5)
    group = ends.enter_context(UdpEnd(("239.255.77.1", udpmcast), port=udpmcast, sock=machines[1].socket()))
    return [remote(machines, ends, udpin), client(machines[1], ends, machines[0].host, tcpin),
            remote(machines, ends, udpbcast, near=udpbcast), join_group(machines[1], group)]


@pytest.mark.parametrize("options, believed", [("", [0]), ("trusted=false", [0]), ("trusted=true", [0, 1, 2, 3, 4])])
def test_who_sends_from_another_machine_is_a_stranger_unless_trusted(here, machines, ends, options, believed):
    """trusted=true for containers, a VPN, or clients that the user knows."""
    urls = [(url.format(PORT + 1 + n) + options).rstrip("?&") for n, url in enumerate(LISTENING)]
    router = here.router(*urls, f"udpin://127.0.0.1:{PORT}")
    station, own = local(here, ends), local(here, ends)
    beat(here, (own, VEHICLE), (station, STATION))
    harness.wait_for(lambda: len(router.links()) >= 4, what="the group, and the broadcast")
    others = claimants(machines, ends)
    beat(here, *((other, VEHICLE) for other in others), (own, VEHICLE))
    assert reached(station, own, *others) == believed


@pytest.mark.parametrize("options, believed", [("", [0, 1, 2, 3]), ("?trusted=false", [0])])
def test_who_sends_from_this_machine_is_own_unless_trusted_is_false(here, machines, ends, options, believed):
    """trusted=false for a tunnel or a proxy. Two of them have an address that is not loopback."""
    here.router(f"udpin://0.0.0.0:{PORT + 1}{options}", f"tcpin://0.0.0.0:{PORT + 2}{options}",
                f"udpin://127.0.0.1:{PORT}")
    station, own = local(here, ends), local(here, ends)
    others = [local(here, ends, PORT + 1), client(here, ends, here.host, PORT + 2),
              ends.enter_context(UdpEnd((here.host, PORT + 1), sock=here.socket()))]
    beat(here, (own, VEHICLE), *((other, VEHICLE) for other in others), (station, STATION))
    assert reached(station, own, *others) == believed


def test_a_program_of_this_machine_is_heard_at_an_address_without_a_broadcast_address(here, ends):
    """After `ip addr add` without `brd`, getifaddrs() returns the address itself as its broadcast address."""
    netns.ip("-n", here.name, "addr", "replace", "10.78.0.1/24", "dev", here.interface)
    router = here.router(f"udpin://0.0.0.0:{PORT}")
    beat(here, (ends.enter_context(UdpEnd(("10.78.0.1", PORT), sock=here.socket())), VEHICLE))
    assert [link["rank"] for link in router.links()] == ["own"]


def test_forged_addresses_of_this_machine_are_not_believed(here, machines, ends):
    """The kernel drops them, except its own IPv6 addresses, which therefore are strangers."""
    router = here.router(f"udpin://[::]:{PORT}", f"udpin://127.0.0.1:{OTHER_PORT}")
    station, vehicle, honest = local(here, ends, OTHER_PORT), local(here, ends, OTHER_PORT), remote(machines, ends)
    beat(here, (vehicle, VEHICLE), (station, STATION))
    before = heard_by(router)
    for source in ("127.0.0.1", here.host, "::1", here.host6):
        vehicle.send(heartbeat(VEHICLE))  # after 2 s of silence, a stranger would be believed
        forge(machines, source, heartbeat(VEHICLE))
    honest.send(heartbeat(COMPANION))
    harness.wait_for(lambda: heard_by(router) >= before + 6, what="the frame of an honest sender, and a forged one")
    assert heard_by(router) == before + 6
    assert [r[2] for r in router.routes() if r[:2] == VEHICLE] == [router.link_of(vehicle)["link"]]
    assert any(here.host6 in link["link"] for link in router.links())


def forge(machines, source, payload):
    """The second machine sends this from an address of the first one, or from loopback."""
    here, there = machines
    is_v6 = ":" in source
    family = socket.AF_INET6 if is_v6 else socket.AF_INET
    target = here.host6 if is_v6 else here.host
    addresses = socket.inet_pton(family, source) + socket.inet_pton(family, target)
    udp = struct.pack(">HHHH", 4444, PORT, 8 + len(payload), 0) + payload
    pseudo = addresses + struct.pack(">II", len(udp), socket.IPPROTO_UDP)
    udp = udp[:6] + struct.pack(">H", checksum(pseudo + udp) or 0xffff) + udp[8:]
    head = struct.pack(">IHBB", 6 << 28, len(udp), socket.IPPROTO_UDP, 64) if is_v6 else \
        struct.pack(">BBHHHBBH", 0x45, 0, 20 + len(udp), 0, 0, 64, socket.IPPROTO_UDP, 0)
    with there.socket(family, kind=socket.SOCK_RAW, protocol=socket.IPPROTO_RAW) as sock:
        sock.sendto(head + addresses + udp, (target, 0))


def test_forged_reports_of_closed_ports_keep_nothing_from_a_local_peer(here, machines, ends):
    router = here.router(f"udpin://0.0.0.0:{PORT}")
    station, vehicle = local(here, ends), local(here, ends)
    beat(here, (vehicle, VEHICLE), (station, STATION))
    report_closed(machines, station.port)
    harness.wait_for(lambda: router.stats("endpoint")[0]["send_errors"] > 0, what="the report")
    for frame in [attitude(VEHICLE) for _ in range(20)]:
        vehicle.send(frame)
        station.until(frame)


def report_closed(machines, port):
    """The second machine claims that this loopback port of the first one is closed."""
    here, there = machines
    loopback = socket.inet_aton("127.0.0.1")
    ip_head = struct.pack(">BBHHHBBH", 0x45, 0, 28, 0, 0, 64, socket.IPPROTO_UDP, 0) + loopback + loopback
    quoted = ip_head + struct.pack(">HHHH", PORT, port, 8, 0)
    report = struct.pack(">BBHI", 3, 3, 0, 0) + quoted
    with there.socket(kind=socket.SOCK_RAW, protocol=socket.IPPROTO_ICMP) as sock:
        sock.sendto(report[:2] + struct.pack(">H", checksum(report)) + report[4:], (here.host, 0))


def checksum(data):
    """Of IP: the complement of the sum with end-around carry."""
    total = sum(struct.unpack(f">{(len(data) + 1) // 2}H", data + b"\0" * (len(data) % 2)))
    while total > 0xffff:
        total = (total & 0xffff) + (total >> 16)
    return total ^ 0xffff


def test_two_routers_that_two_cables_join_pass_each_frame_once(here, machines, ends, program):
    """The vehicle's router is on the other machine. A frame that comes back on a link is an echo."""
    there = machines[1]
    ports = PORT + 1, PORT + 2
    router = here.router(*(f"udpin://0.0.0.0:{port}?name=path{port}" for port in ports), f"udpin://127.0.0.1:{PORT}")
    far = Router(spawn_on(there, program, ends), *(f"udpout://{here.host}:{port}?name=path{port}" for port in ports),
                 f"udpin://127.0.0.1:{PORT}")
    station, vehicle = local(here, ends), ends.enter_context(UdpEnd(("127.0.0.1", PORT), sock=there.socket()))
    beat(here, (station, STATION))
    vehicle.send(heartbeat(VEHICLE))
    harness.wait_for(lambda: any(r[:2] == VEHICLE for r in router.routes()), what="the vehicle's route")
    sent = [attitude(VEHICLE) for _ in range(50)]
    for frame in sent:
        vehicle.send(frame)
    vehicle.send(mark := heartbeat(VEHICLE))
    assert [frame for frame in station.until(mark) if frame in sent] == sent
    station.send(order := command(STATION, VEHICLE))
    vehicle.until(order)  # a mark sent at once could overtake it on the other cable
    station.send(mark := heartbeat(STATION))
    assert order not in vehicle.until(mark)
    dropped = [sum(link["echo"] + link["duplicate"] for link in r.links()) for r in (router, far)]
    assert all(count > 0 for count in dropped), dropped
    assert sum(link["frames_in"] for link in router.links()) < 5 * len(sent)


def test_a_serial_line_that_echoes_beside_a_remote_station(here, machines, ends):
    line = ends.enter_context(SerialEnd())
    router = here.router(f"serial://{line.device}?name=line", f"udpin://0.0.0.0:{PORT}")
    station = remote(machines, ends)
    over = threading.Event()

    def echo():
        while not over.is_set():
            for frame in line.now():
                line.send(frame)
            line.send(heartbeat(VEHICLE))
            over.wait(0.05)
    thread = threading.Thread(target=echo, daemon=True)
    thread.start()
    ends.callback(lambda: (over.set(), thread.join()))
    beat(here, (station, STATION))

    def has_echoed():
        station.send(heartbeat(STATION))
        return router.link_of(routers.End("line"))["echo"] >= 5
    harness.wait_for(has_echoed, what="echoes")
    assert {r[:2] for r in router.routes() if r[2].startswith("line")} == {VEHICLE}
    assert router.stats("router")[0]["route_conflicts"] == 0


def test_a_group_of_a_serial_line_and_a_udp_port_brings_each_frame_once(here, machines, ends):
    line = ends.enter_context(SerialEnd())
    here.router(f"serial://{line.device}?group=air", f"udpin://0.0.0.0:{PORT}?group=air",
                f"udpin://127.0.0.1:{OTHER_PORT}")
    radio, station = remote(machines, ends), local(here, ends, OTHER_PORT)
    beat(here, (line, VEHICLE), (radio, VEHICLE), (station, STATION))
    sent = [attitude(VEHICLE) for _ in range(50)]
    for frame in sent:
        line.send(frame)
        radio.send(frame)
    radio.send(mark := heartbeat(VEHICLE))
    got = [frame for frame in station.until(mark) if frame in sent]
    assert sorted(got) == sorted(sent)
    assert reached(station, line, radio) == [0, 1], "links of a group do not compete"
