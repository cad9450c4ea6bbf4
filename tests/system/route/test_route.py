# SPDX-License-Identifier: MIT
"""The cases of other routers' own tests, and those that nobody has, with the real program: UDP peers of one socket,
UDP, TCP and pseudo-terminals. MR: mavlink-router, P: mavp2p, G: gomavlib, S: mavlink-server, F: MAVSDK, N: nobody. Each
asserts exact bytes and exact ends.

| cases | where |
|---|---|
| MR1 to MR25, P1 to P5, G5, N17, N18, N21 to N23, F1, F2 | below, over each kind of link that has the option |
| MR26 | below; `mavloom check` in test_check.py, the grammar in the unit tests of endpoints |
| MR27, P6, G1 to G4, G6, G7, G9, S1, S2, S4, N1 to N16, N20 | below |
| N10, N12, N16 | also with `relay` in test_serial.py |
| N19 | test_route_control.py, with the recordings |
| G8 stream requests | test_request_streams.py |
| S3, and S1, S2 over WebSocket and zenoh | do not apply: no such endpoints |
| S5 ArduCopter SITL | needs ArduPilot's simulator; test_route_clients.py has commands, parameters and missions |
| S6 URL grammar | unit tests of endpoints |
| limits, private links, the best of a group | below; groups over bad networks in test_route_networks.py |
"""
import contextlib
import os
import pathlib
import select
import signal
import socket
import threading
import time

import pytest

import frames
import harness
import routers
from frames import mavlink
from routers import (Net, Router, SerialEnd, TcpEnd, UdpEnd, attitude, command, damaged, heartbeat, make, ping, raw,
                     unique, unknown)

GCS, VEHICLE = (255, 190), (1, 1)

# Links A, B, C, ... each of another kind.
MIXED = ("udpin", "tcpin", "serial", "udpout", "tcpout")

KINDS = [pytest.param("peers", marks=pytest.mark.short), "clients", "udpin", "udpout", "tcpin", "tcpout", "wsin",
         "wsout", "serial", pytest.param(MIXED, marks=pytest.mark.short, id="mixed")]
# A peer of udpin:// has spoken before it is a link.
UNHEARD = ("tcpin", "serial", "udpout", "tcpout")
UNHEARD_KINDS = [pytest.param("udpout", marks=pytest.mark.short), "tcpin", "tcpout",
                 pytest.param("serial", marks=pytest.mark.short), "clients"]


@pytest.fixture(params=KINDS)
def kind(request):
    """For tests of bytes, and one each of a broadcast and a target. The engine decides the same for every kind."""
    return request.param


@pytest.fixture(params=UNHEARD_KINDS)
def unheard_kind(request):
    return request.param


@pytest.fixture
def net(spawn):
    """net("peers", 3, options={}, rules={}) -> a router with three ends."""
    made = []

    def build(kind, count=2, **options):
        made.append(Net(spawn, kind if isinstance(kind, str) else kind[:count], count, **options))
        return made[-1]
    yield build
    for one in made:
        one.__exit__()


# ---- mavlink-router: tests/routing_test.py ---------------------------------------------------------------------------

@pytest.mark.short
@pytest.mark.parametrize("kinds", [("peers",) * 4, ("udpin", "udpin", "udpout", "udpout"),
                                   ("tcpin", "serial", "tcpout", "udpout")],
                         ids=["one socket", "udpin and udpout", "mixed"])
def test_mr1_pings_reach_exactly_their_targets(net, kinds):
    sut = net("peers" if kinds[0] == "peers" else kinds, 4)
    receivers = {3: (100, 1), 4: (101, 1)}
    answers, overheard, asked = {1: 0, 2: 0}, {1: 0, 2: 0}, {3: 0, 4: 0}

    def send(number, source, target):
        frame = ping(source, target)
        for end in sut.send(number, frame):
            if end in receivers:
                asked[end] += 1
                reply = ping(receivers[end], source)
                reached = sut.send(end, reply)
                assert reached == [number]
                answers[number] += 1
            else:
                assert target == (0, 0)
                overheard[end] += 1

    for _ in range(10):
        send(2, (2, 1), (100, 1))
        send(1, (1, 1), (0, 0))

    assert answers == {1: 20, 2: 9}
    assert asked == {3: 19, 4: 10}
    assert overheard == {1: 0, 2: 10}
    assert sut.link(2)["unknown_target"] == 1


# ---- mavlink-router: src/endpoints_test.cpp --------------------------------------------------------------------------

def test_mr2_a_broadcast_reaches_a_link_that_heard_nothing(net, unheard_kind):
    sut = net(unheard_kind)

    assert sut.send(1, attitude()) == [2]
    assert sut.link(2)["frames_in"] == 1  # the mark that came back, when all was over


@pytest.mark.short
def test_mr3_mr4_an_unseen_target_is_not_sent(net):
    sut = net(UNHEARD)

    assert sut.command(1, VEHICLE, (254, 190)) == []
    assert sut.command(1, VEHICLE, (254, 0)) == []
    assert sut.link(1)["unknown_target"] == 2


@pytest.mark.short
def test_mr5_an_unseen_system_without_a_component_field_is_not_sent(net):
    sut = net(UNHEARD)

    assert sut.send(1, make(mavlink.MAVLink_set_mode_message(254, 1, unique()))) == []
    assert sut.link(1)["unknown_target"] == 1


def test_mr6_nothing_goes_where_its_source_was_heard(net, kind):
    sut = net(kind, 3)

    def is_present():  # one frame may be forged, so the source must repeat itself
        sut.hears(2, (12, 1))
        return sut.send(1, attitude((12, 1))) == [3]
    harness.wait_for(is_present, what="the source to count as present")


@pytest.mark.short
def test_mr7_mr8_a_broadcast_reaches_a_link_with_systems(net):
    sut = net(MIXED)
    sut.hears(2, (12, 1))

    assert sut.send(1, attitude()) == [2]
    assert sut.command(1, VEHICLE, (0, 0)) == [2]


@pytest.mark.short
def test_mr9_a_system_without_component_is_reached(net):
    sut = net(MIXED, 3)
    sut.hears(2, (12, 1))

    assert sut.command(1, VEHICLE, (12, 0)) == [2]


@pytest.mark.short
def test_mr10_an_unseen_component_with_drop_is_not_sent(net):
    sut = net(MIXED, 3, rules={"unknown_component": "drop"})
    sut.hears(2, (12, 1))

    assert sut.command(1, VEHICLE, (12, 190)) == []
    assert sut.link(1)["unknown_target"] == 1


@pytest.mark.short
def test_mr10_an_unseen_component_reaches_its_system_by_default(net):
    sut = net(MIXED, 3)
    sut.hears(2, (12, 1))

    assert sut.command(1, VEHICLE, (12, 190)) == [2]


@pytest.mark.short
def test_mr11_another_system_is_not_sent(net):
    sut = net(MIXED)
    sut.hears(2, (12, 1))

    assert sut.command(1, VEHICLE, (13, 0)) == []


def test_mr12_heard_systems_are_reachable_and_no_others(net, kind):
    sut = net(kind)
    sut.hears(2, (12, 1))
    sut.hears(2, (254, 1))

    assert [sut.command(1, VEHICLE, (s, 0)) for s in (12, 254)] == [[2], [2]]
    assert [sut.command(1, VEHICLE, (s, 0)) for s in (11, 13, 253, 255)] == [[], [], [], []]


@pytest.mark.short
def test_mr13_only_heard_pairs_are_known_pairs(net):
    sut = net(MIXED, rules={"unknown_component": "drop"})
    sut.hears(2, (12, 1))
    sut.hears(2, (254, 190))

    assert [sut.command(1, VEHICLE, pair) for pair in ((12, 1), (254, 190))] == [[2], [2]]
    assert [sut.command(1, VEHICLE, pair) for pair in ((13, 1), (254, 1), (255, 190))] == [[], [], []]


# ---- filters

def by_id():
    """Ids 1, 2, 78 (which no definition has), 100 and 257."""
    return {1: make(mavlink.MAVLink_sys_status_message(1, 2, 3, 500, 11000, -1, 90, unique() % 60000, 0, 0, 0, 0, 0)),
            2: make(mavlink.MAVLink_system_time_message(unique(), 1000)),
            78: unknown(message_id=78),
            100: make(mavlink.MAVLink_optical_flow_message(unique(), 0, 1, 2, 1.0, 2.0, 200, 3.0)),
            257: make(mavlink.MAVLink_button_change_message(unique(), 1000, 1))}


def by_source(*sources):
    return {source: attitude(source) for source in sources}


FILTERS = [
    ("mr14", "out_allow=1", by_id, {1}),
    ("mr15", "out_block=100", by_id, {1, 2, 78, 257}),
    ("mr16", "out_allow=comp:1", lambda: by_source((1, 2), (1, 1), (7, 1)), {(1, 1), (7, 1)}),
    ("mr17", "out_block=comp:100", lambda: by_source((1, 100), (1, 1)), {(1, 1)}),
    ("mr18", "out_allow=sys:42", lambda: by_source((41, 1), (42, 1), (42, 7)), {(42, 1), (42, 7)}),
    ("mr19", "out_block=sys:42", lambda: by_source((42, 1), (41, 1)), {(41, 1)}),
    ("mr20", "in_allow=1", by_id, {1}),
    ("mr21", "in_block=78", by_id, {1, 2, 100, 257}),
    ("mr22", "in_allow=comp:1", lambda: by_source((1, 96), (1, 1), (7, 1)), {(1, 1), (7, 1)}),
    ("mr23", "in_block=comp:96", lambda: by_source((1, 96), (1, 1)), {(1, 1)}),
    ("mr24", "in_allow=sys:23", lambda: by_source((1, 1), (23, 1)), {(23, 1)}),
    ("mr25", "in_block=sys:23", lambda: by_source((23, 1), (1, 1)), {(1, 1)}),
]


FILTERED_KINDS = [pytest.param(*one, UNHEARD, id=one[0], marks=pytest.mark.short) for one in FILTERS]
FILTERED_KINDS += [pytest.param(*FILTERS[0], kind, id=f"mr14-{kind}") for kind in UNHEARD]


@pytest.mark.parametrize("case, option, made, passing, kinds", FILTERED_KINDS)
def test_mr14_to_mr25_filters(net, kinds, case, option, made, passing):
    sut = net(kinds, options={1 if option.startswith("in") else 2: option})
    offered = made()
    if case == "mr21":
        sut.send(1, heartbeat((0, 0)))  # a byte stream has to be in step before an id without definition is believed
    # one that passes comes last: what is before it has been judged
    ordered = sorted(offered, key=lambda key: key in passing)
    for key in ordered:
        sut[1].send(offered[key])
    expected = [offered[key] for key in ordered if key in passing]

    assert sut[2].count(len(expected)) == expected
    link = sut.link(1)
    assert link["frames_in"] - (case == "mr21") * 2 == len(offered) and link["filtered"] == len(offered) - len(passing)
    assert link["unknown_target"] == 0
    assert sut[2].now() == []


@pytest.mark.short
@pytest.mark.parametrize("url", ["udpout://:14550", "udpout://[127.0.0.1]:14550", "udpout://::1:14550",
                                 "udpout://127.0.0.1:0", "udpout://127.0.0.1", "udpin://127.0.0.1:0",
                                 "tcpin://127.0.0.1:0", "serial://?baud=57600", "serial:///dev/ttyS0?baud=0",
                                 "udp://127.0.0.1:14550", "udpboth://127.0.0.1:14550"])
def test_mr26_bad_endpoints_are_refused(run, url):
    done = run("route", url)

    assert done.status == 2 and done.stdout == ""
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.short
def test_mr26_good_addresses_are_taken(spawn):
    with socket.socket(socket.AF_INET6, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind(("::1", 0))
        except OSError:
            pytest.skip("no IPv6 here")
    router = Router(spawn, f"udpout://127.0.0.1:{routers.udp_port()}", f"udpout://[::1]:{routers.udp_port()}")

    assert len(router.wait_links(2)) == 2


@pytest.mark.short
@pytest.mark.parametrize("number, status", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_mr27_a_signal_ends_it_cleanly(spawn, number, status):
    router = Router(spawn, f"udpin://127.0.0.1:{routers.udp_port()}")

    assert router.process.stop(number).status == status


@pytest.mark.short
def test_mr27_it_ends_when_its_time_is_over(run):
    assert run("route", f"udpin://127.0.0.1:{routers.udp_port()}", "--for", "100ms").status == 0


# ---- mavp2p ----------------------------------------------------------------------------------------------------------

def odometry(source):
    zeros = [0.0] * 21
    message = mavlink.MAVLink_odometry_message(unique(), 1, 8, 1.0, 2.0, 3.0, [1.0, 0, 0, 0], 0, 0, 0, 0, 0, 0,
                                               zeros, zeros, 1, 2, 3)
    return make(message, source)


@pytest.mark.short
def test_p1_nobody_needs_to_have_spoken_first(net):
    sut = net(MIXED)

    assert sut.hears(1, (6, 7)) == [2]
    assert sut.send(2, odometry((4, 5))) == [1]


@pytest.mark.short
def test_p2_a_newcomers_command_reaches_its_target_only(net):
    sut = net(MIXED, 3)
    sut.hears(1, (6, 7))
    sut.hears(2, (8, 9))

    assert sut.command(3, (4, 5), (6, 7)) == [1]


@pytest.mark.short
def test_p3_a_command_to_an_unseen_target_is_not_sprayed(net):
    sut = net(MIXED)
    sut.hears(1, (8, 9))

    assert sut.command(2, (4, 5), (6, 7)) == []
    assert sut.router.stats("unknown_target") == [{"kind": "unknown_target", "sys": 6, "comp": 7, "frames": 1}]


@pytest.mark.short
def test_p4_a_known_target_on_its_link_only(net):
    sut = net(MIXED, 4)
    sut.hears(1, (99, 34))
    sut.hears(2, (99, 35))
    sut.hears(3, (98, 34))

    assert sut.command(4, GCS, (99, 34)) == [1]


@pytest.mark.short
def test_p5_flood_sends_an_unseen_target_to_all(net):
    sut = net(MIXED, 3, rules={"unknown_target": "flood"})

    assert sut.command(2, GCS, (99, 34)) == [1, 3]


@pytest.mark.short
def test_p6_a_recording_continues_in_a_new_file(spawn, tmp_path):
    port = routers.udp_port()
    router = Router(spawn, f"udpin://127.0.0.1:{port}", f"tlog://{tmp_path}/dump.tlog?rotate_every=1")
    end, sent = UdpEnd(("127.0.0.1", port)), []

    def second_file():
        sent.append(heartbeat())
        end.send(sent[-1])
        harness.wait_for(lambda: router.stats("recording")[0]["frames"] == len(sent), what="the record")
        return len(list(tmp_path.glob("*.tlog"))) == 2
    harness.wait_for(second_file, what="the second file")
    router.process.stop()
    end.close()

    first, second = ([frame for _, frame in frames.read_tlog(file)] for file in sorted(tmp_path.glob("*.tlog")))
    assert first + second == sent and len(second) == 1


# ---- gomavlib --------------------------------------------------------------------------------------------------------

@pytest.mark.short
@pytest.mark.parametrize("kind", ["udpout", "udpin"])
def test_g1_datagrams_with_errors_lose_no_good_frame(net, kind):
    sut = net((kind, "udpout"))
    first, second = heartbeat(), heartbeat()
    sut[1].send(b"\xfd")
    sut[1].send(raw(0, 50, bytes(9), incompat=4, source=(77, 1)))
    sut[1].send(first + b"\xfd\x01\x02\x03\x04")
    sut[1].send(second)

    assert sut[2].until(second) == [first]
    link = sut.link(1)
    assert link["unknown_flags"] == 1 and link["junk_bytes"] == 6 and link["crc_error"] == 0


@pytest.mark.short
@pytest.mark.parametrize("kind", ["udpin", "tcpin"])
def test_g2_an_idle_peer_is_forgotten(net, kind):
    sut = net((kind, "udpout"), options={1: "idle=0.5"})
    frame = attitude()
    sut[1].send(frame)
    sut[2].until(frame)

    sut.router.process.wait_output(r"A#127.0.0.1:\d+: down", stream="err")
    assert len(sut.router.links()) == 1
    assert sut.router.routes() == set()


@pytest.mark.short
def test_g3_a_connection_that_breaks_comes_back(net):
    sut = net(("tcpout", "udpout"))
    assert sut.send(2, attitude()) == [1]
    host, port = sut[1].sock.getpeername()[0], sut[1].sock.getsockname()[1]
    sut[1].close()
    sut.router.process.wait_output("A: down", stream="err")
    server = socket.create_server((host, port))
    server.settimeout(harness.DEFAULT_TIMEOUT_S)
    with server:
        sut.ends[0] = TcpEnd(server.accept()[0], "A")
    sut.router.wait_links(2)

    assert sut.send(2, attitude()) == [1]
    assert sut.send(1, attitude((7, 1))) == [2]
    assert sut.router.stats("endpoint")[0]["reconnects"] >= 1


KEY = bytes(range(32))


def write_key(path, key=KEY):
    path.write_text(key.hex() + "\n")
    path.chmod(0o600)
    return path


def ticks_now():
    """10 us since 2015."""
    return int((time.time() - 1420070400) * 100_000)


@pytest.mark.parametrize("kind", [pytest.param("udpin", marks=pytest.mark.short), "udpout", "tcpin", "tcpout",
                                  pytest.param("serial", marks=pytest.mark.short)])
def test_g4_only_what_is_signed_rightly_is_taken(net, tmp_path, kind):
    key = write_key(tmp_path / "link.key")
    good = [attitude(signing=(KEY, 3, ticks_now() + i)) for i in range(2)]
    port = routers.udp_port()
    if kind == "udpin":  # its peer is a link only when a frame is verified
        with_peer = UdpEnd(("127.0.0.1", port))
    sut = net((kind, "udpout"), options={1: f"verify={key}"}) if kind != "udpin" else \
        net(("udpout",), 1, extra=[f"udpin://127.0.0.1:{port}?verify={key}&name=V"])
    sender, receiver = (with_peer, sut[1]) if kind == "udpin" else (sut[1], sut[2])
    sender.send(good[0])
    for bad in (attitude(), attitude(version=1), attitude(signing=(bytes(32), 3, ticks_now() + 1000)),
                attitude(signing=(KEY, 3, ticks_now() - 10_000_000)),  # older than the last of this stream
                attitude((9, 9), signing=(KEY, 3, ticks_now() - 10_000_000)),  # a new stream, 100 s behind
                good[0]):
        sender.send(bad)
    sender.send(good[1])

    assert receiver.until(good[1]) == [good[0]]
    link = next(link for link in sut.router.links() if link["frames_in"])
    assert link["frames_in"] == 2 and link["bad_signature"] == 6
    if kind == "udpin":
        with_peer.close()


@pytest.mark.short
def test_g5_everybody_but_the_sender(net):
    sut = net(MIXED, 5)

    assert sut.send(3, attitude()) == [1, 2, 4, 5]


@pytest.mark.short
@pytest.mark.parametrize("between", ["udp", "tcp"])
def test_g6_a_chain_of_routers_keeps_every_byte(spawn, between):
    joint = routers.udp_port() if between == "udp" else routers.tcp_port()
    near, far = UdpEnd(), UdpEnd()
    near_port, far_port = routers.udp_port(), routers.udp_port()
    first = Router(spawn, f"udpout://127.0.0.1:{near.port}?bind=127.0.0.1:{near_port}",
                   f"{between}in://127.0.0.1:{joint}")
    second = Router(spawn, f"{between}out://127.0.0.1:{joint}",
                    f"udpout://127.0.0.1:{far.port}?bind=127.0.0.1:{far_port}")
    near.target, far.target = ("127.0.0.1", near_port), ("127.0.0.1", far_port)
    second.wait_links(2)
    far.send(heartbeat((12, 1)))  # so that the first one knows the second
    near.next()
    flight = [record for _, record in frames.read_tlog(frames.FLIGHT)][:2000]
    # Frames for a target that was not heard go nowhere, so the two of the recording are heard first.
    for number in range(0, len(flight), 20):
        near.send(b"".join(flight[number:number + 20]))
    harness.wait_for(lambda: first.link_of(near)["frames_in"] == len(flight), what="all frames")
    verdicts = ("forwarded", "nowhere", "unknown_target", "filtered", "echo", "duplicate")
    seen = {name: first.link_of(near)[name] for name in verdicts}
    got = far.count(seen["forwarded"])

    assert sum(seen.values()) == len(flight)
    assert seen["forwarded"] > 1000 and seen["echo"] + seen["filtered"] + seen["duplicate"] == 0
    at = iter(flight)
    assert all(frame in at for frame in got)  # in order, byte for byte
    assert second.process.alive
    near.close()
    far.close()


@pytest.mark.short
def test_g7_the_own_heartbeat(net):
    sut = net(("udpout",), 1, rules={"heartbeat": "7/191"})
    quick = sut[1].count(5)
    begin = time.monotonic()
    sut[1].send(heartbeat())  # from here on once a second
    sut[1].now()
    slow = sut[1].count(2)

    decoder = mavlink.MAVLink(None)
    beats = [decoder.decode(bytearray(frame)) for frame in quick + slow]
    assert {(b.get_type(), b.get_srcSystem(), b.get_srcComponent()) for b in beats} == {("HEARTBEAT", 7, 191)}
    assert {(b.type, b.autopilot, b.system_status, b.mavlink_version) for b in beats} == {
        (mavlink.MAV_TYPE_ONBOARD_CONTROLLER, mavlink.MAV_AUTOPILOT_INVALID, mavlink.MAV_STATE_ACTIVE, 3)}
    assert [b.get_seq() for b in beats[:5]] == [0, 1, 2, 3, 4]
    assert time.monotonic() - begin > 0.5  # a second between two; 100 ms at first
    assert sut.send(1, command(GCS, (7, 191)), watched=[]) == []
    sut.router.wait_counter(sut[1], "consumed", 1)


@pytest.mark.short
def test_g9_it_ends_cleanly_while_peers_write(net):
    sut = net(("udpin", "tcpin", "tcpout", "serial"), 4)
    running = True

    def write(end, source):
        while running:
            try:
                end.send(b"".join(attitude(source) for _ in range(20)))
                if select.select([end], [], [], 0)[0]:
                    end._read()
            except (OSError, AssertionError):  # the router closed
                return
    writers = [threading.Thread(target=write, args=[end, (7, number)], daemon=True)
               for number, end in enumerate(sut.ends)]
    for writer in writers:
        writer.start()
    harness.wait_for(lambda: all(link["frames_in"] > 200 for link in sut.router.links()), what="traffic on every link")
    done = sut.router.process.stop(signal.SIGTERM)
    running = False
    for writer in writers:
        writer.join(10)

    assert done.status == 143


# ---- mavlink-server --------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("kind", [pytest.param("udpin", marks=pytest.mark.short), "udpout", "tcpin",
                                  pytest.param("tcpout", marks=pytest.mark.short), "serial"])
def test_s1_what_only_sends_makes_input_move_and_no_output(net, kind):
    sut = net((kind, "udpout"), options={1: "out_allow=sys:99"})
    before = sut.link(1)
    for _ in range(20):
        sut[1].send(attitude())
    sut.router.wait_counter(sut[1], "frames_in", before["frames_in"] + 20)
    after = sut.link(1)

    assert after["bytes_in"] > before["bytes_in"]
    assert after["frames_out"] == after["bytes_out"] == 0


@pytest.mark.parametrize("kind", [pytest.param("udpout", marks=pytest.mark.short), "tcpin",
                                  pytest.param("tcpout", marks=pytest.mark.short), "serial"])
def test_s2_what_only_listens_makes_output_move_and_no_input(net, kind):
    sut = net((kind,), 1, options={1: "heartbeat=true"}, rules={"heartbeat": "7/191"})
    sut[1].count(5)
    link = sut.link(1)

    assert link["frames_out"] >= 5 and link["bytes_out"] >= 5 * 21
    assert link["frames_in"] == link["bytes_in"] == 0


@pytest.mark.parametrize("second", ["udpin", "udpout", "tcpin", "tcpout"])
@pytest.mark.parametrize("first", ["udpin", "udpout", "tcpin", "tcpout"])
def test_s4_33_of_33_heartbeats_between_pymavlink_programs(spawn, first, second):
    from pymavlink import mavutil
    port = {side: routers.udp_port() if kind.startswith("udp") else routers.tcp_port()
            for side, kind in (("a", first), ("b", second))}
    urls = [f"{kind}://127.0.0.1:{port[side]}" for side, kind in (("a", first), ("b", second))]
    names = {"udpin": "udpout:127.0.0.1:{}", "udpout": "udpin:127.0.0.1:{}", "tcpin": "tcp:127.0.0.1:{}",
             "tcpout": "tcpin:127.0.0.1:{}"}
    early = {side: mavutil.mavlink_connection(names[kind].format(port[side]), source_system=system)
             for side, kind, system in (("a", first, 1), ("b", second, 2)) if kind.endswith("out")}
    # Two pymavlink listeners wait to be spoken to: the router's own heartbeat does.
    router = Router(spawn, *urls, rules={"heartbeat": "7/191"} if first == second == "udpout" else None)
    sides = {side: early.get(side) or mavutil.mavlink_connection(names[kind].format(port[side]), source_system=system)
             for side, kind, system in (("a", first, 1), ("b", second, 2))}
    sender, receiver = sides["a"], sides["b"]

    def meet(one, other):
        """Beats until the other side hears it: a UDP side must have spoken, a pymavlink server must have been spoken
        to."""
        def look():
            one.recv_match(blocking=False)
            for side in (one, other):
                side.mav.heartbeat_send(6, 8, 0, 0, 3)
            beat = other.recv_match(type="HEARTBEAT", blocking=True, timeout=0.2)
            return beat is not None and beat.get_srcSystem() == one.source_system
        harness.wait_for(look, what="the two to meet")
    meet(sender, receiver)
    meet(receiver, sender)
    for i in range(33):
        sender.mav.heartbeat_send(2, 12, 81, 1000 + i, 4, 3)
    got = []
    while len(got) < 33:
        beat = receiver.recv_match(type="HEARTBEAT", blocking=True, timeout=harness.DEFAULT_TIMEOUT_S)
        assert beat is not None, f"{len(got)} of 33"
        if beat.get_srcSystem() == 1 and beat.custom_mode >= 1000:
            got.append(beat.custom_mode)

    assert got == list(range(1000, 1033))
    assert router.process.alive
    for side in sides.values():
        side.close()


# ---- MAVSDK ----------------------------------------------------------------------------------------------------------

@pytest.mark.short
def test_f1_a_position_crosses(net):
    sut = net(MIXED)

    position = mavlink.MAVLink_global_position_int_message(unique(), 473977418, 85455939, 488000, 1000, 1, 2, 3, 9000)
    assert sut.send(1, make(position)) == [2]


def test_f2_n8_an_id_without_definition_crosses_byte_for_byte(net, kind):
    sut = net(kind, 3)
    sut.send(1, heartbeat((0, 0)))  # a byte stream has to be in step first
    sent = [unknown(message_id=70371), unknown(message_id=4_000_021),
            raw(255, 7, unique().to_bytes(4, "little") + b"\1", version=1)]

    assert [sut.send(1, frame) for frame in sent] == [[2, 3]] * 3
    assert sut.link(1)["unknown_ids"] == 3
    assert sut.router.routes() == set()


# ---- those that nobody has -------------------------------------------------------------------------------------------

def big(source=(1, 1)):
    """A frame of 266 bytes for nobody in particular."""
    payload = list(unique().to_bytes(4, "little") * 62 + b"end")
    return make(mavlink.MAVLink_file_transfer_protocol_message(0, 0, 0, payload), source)


@pytest.mark.short
@pytest.mark.parametrize("kind", ["peers", "udpin", "udpout"])
def test_n1_all_five_frames_of_a_long_datagram_arrive(net, kind):
    sut = net(kind)
    sent = [big() for _ in range(5)]
    assert len(b"".join(sent)) == 1330
    sut[1].send(b"".join(sent))

    assert sut[2].count(5) == sent


@pytest.mark.short
def test_n2_half_a_frame_harms_no_other_peer(net):
    sut = net("peers", 3)
    half = attitude()[:15]
    for _ in range(20):
        good = attitude((2, 1))
        sut[1].send(half)
        sut[2].send(good)

        assert sut[3].next() == good
        assert sut[1].next() == good
    assert len(sut.router.links()) == 3
    assert sut.send(1, attitude()) == [2, 3]


@pytest.mark.short
@pytest.mark.parametrize("kind", ["udpin", "udpout"])
def test_n3_a_stranger_steals_no_destination(net, kind):
    sut = net((kind, "tcpin"))
    stranger = UdpEnd(sut[1].target)
    for noise in (b"\xfd", b"\xff" * 300, attitude()[:20], b""):
        stranger.send(noise)
    if kind == "udpout":
        stranger.send(attitude((66, 6)))  # a good frame, from a wrong address

    assert sut.send(2, attitude()) == [1]
    assert sut.send(1, attitude((7, 1))) == [2]
    assert stranger.now() == []
    assert len(sut.router.links()) == 2
    counters = sut.router.stats("endpoint")[0]
    assert (counters["wrong_peer"] if kind == "udpout" else counters["stray_bytes"]) > 0
    stranger.close()


@pytest.mark.short
def test_n4_all_peers_of_a_port_receive(net):
    sut = net("peers", 6)

    assert sut.send(1, attitude()) == [2, 3, 4, 5, 6]
    assert sut.send(6, attitude((2, 1))) == [1, 2, 3, 4, 5]


@pytest.mark.short
@pytest.mark.parametrize("kind", ["tcpin", "tcpout", "serial"])
@pytest.mark.parametrize("deleted", [0, 1, 5, 12, 20])
def test_n5_a_deleted_byte_costs_one_frame(net, kind, deleted):
    sut = net((kind, "udpout"))
    sent = [heartbeat() for _ in range(10)]
    while sent[5].endswith(b"\xfd"):  # the next frame's start would be taken for the byte that is missing
        sent = [heartbeat() for _ in range(10)]
    damaged = bytearray(b"".join(sent))
    del damaged[5 * 21 + deleted]
    sut[1].send(bytes(damaged))

    assert sut[2].count(9) == sent[:5] + sent[6:]  # and nothing more was sent to make them come
    assert sut.link(1)["frames_in"] == 9


@pytest.mark.short
@pytest.mark.parametrize("kind", ["tcpin", "tcpout", "serial"])
def test_n6_noise_that_announces_a_long_frame_holds_nothing_back(net, kind):
    sut = net((kind, "udpout"))
    sent = [heartbeat() for _ in range(13)]  # 273 bytes
    sut[1].send(b"\x11\x22\xfd\xff\x00\x00" + b"".join(sent))

    assert sut[2].count(13) == sent
    assert sut.link(1)["frames_in"] == 13


def test_n7_a_damaged_frame_is_not_forwarded(net, kind):
    sut = net(kind)

    assert sut.send(1, damaged()) == []
    assert sut.link(1)["crc_error"] == 1


@pytest.mark.parametrize("stalled_kind", [pytest.param("tcpin", marks=pytest.mark.short), "tcpout",
                                          pytest.param("serial", marks=pytest.mark.short)])
def test_n9_n10_a_stalled_reader_harms_itself_only(net, stalled_kind):
    sut = net((stalled_kind, "tcpin", "udpout"), 3, options={1: "queue_bytes=64KiB"})
    sent = [big() for _ in range(200)]
    good, dropped = 0, 0
    # Until the kernel's buffers and the queue are full, and then as much again.
    while dropped < 2000:
        for at in range(0, len(sent), 4):
            sut[3].send(b"".join(sent[at:at + 4]))
        assert sut[2].count(200) == sent
        good += 200
        dropped = sut.link(1)["queue_bytes"]
        assert good < 400_000, "the stalled reader takes everything"
    assert sut.link(2)["queue_bytes"] == sut.link(2)["queue_age"] == 0
    last = heartbeat((3, 3))
    got = 0
    whole = set(sent)
    sut[3].send(last)
    assert sut[2].until(last) == []
    while (frame := sut[1].next()) != last:
        assert frame in whole
        got += 1

    link = sut.link(1)
    assert got + link["queue_bytes"] + link["queue_age"] == good
    assert sut[1].now() == []


@pytest.mark.short
def test_n11_a_black_hole_delays_nobody(spawn):
    # A listener whose queue is full: who calls gets no answer.
    hole = socket.socket()
    hole.bind(("127.0.0.1", 0))
    hole.listen(0)
    fillers = []
    for _ in range(3):
        fillers.append(socket.socket())
        fillers[-1].setblocking(False)
        fillers[-1].connect_ex(hole.getsockname())
    sut = Net(spawn, "udpout", 2, extra=[f"tcpout://127.0.0.1:{hole.getsockname()[1]}?name=hole"])
    try:
        for _ in range(300):
            frame = attitude()
            sut[1].send(frame)
            assert sut[2].next() == frame
        assert [link["endpoint"] for link in sut.router.links()] == ["A", "B"]
    finally:
        sut.__exit__()
        for sock in (hole, *fillers):
            sock.close()


def echo_for(sut, seconds):
    """End 1 is a ground station; end 2 sends every byte back and has a vehicle behind it."""
    end, commands = time.monotonic() + seconds, 0
    while time.monotonic() < end or commands < 20:
        for frame in (heartbeat(GCS), command(GCS, VEHICLE)):
            sut[1].send(frame)
            assert sut[2].next() == frame
            sut[2].send(frame)
        beat = heartbeat(VEHICLE)
        sut[2].send(beat)
        assert sut[1].next() == beat  # and none of its own
        commands += 1
        time.sleep(min(0.05, seconds / 100))  # the pace of a ground station, faster
    return commands


@pytest.mark.parametrize("kind, seconds", [pytest.param("serial", 1, marks=pytest.mark.short), ("udpout", 1),
                                           pytest.param("serial", 65, marks=pytest.mark.long)])
def test_n12_commands_reach_a_link_that_echoes(net, kind, seconds):
    sut = net(("udpin", kind))
    sut.send(2, heartbeat(VEHICLE))
    commands = echo_for(sut, seconds)

    assert sut.link(2)["echo"] >= 2 * commands - 1
    assert (255, 190, sut.link(2)["link"]) not in sut.router.routes()


@pytest.mark.short
def test_an_echo_of_some_frames_is_no_loss(net):
    """QGroundControl speaks to PX4 and to the router, and PX4 passes to the router what is not addressed: each fourth
    of its frames comes back."""
    sut = net(("udpin", "udpout"))
    for number in range(40):
        frame = heartbeat(GCS)
        sut[1].send(frame)
        assert sut[2].next() == frame
        if number % 4 == 0:
            sut[2].send(frame)
    sut[2].send(last := heartbeat(VEHICLE))
    assert sut[1].next() == last

    link = sut.link(2)
    assert (link["echo"], link["lost"], link["resync"]) == (10, 0, 0)
    assert GCS[0] not in {source["sys"] for source in sut.router.stats("source") if source["link"] == link["link"]}


def attitude_at(boot_ms, sequence) -> bytes:
    message = mavlink.MAVLink_attitude_message(boot_ms, 0.1, -0.2, 3.0, 0.01, 0.02, 0.03)
    return message.pack(frames.sender(*VEHICLE, sequence))


@pytest.mark.short
def test_a_vehicle_that_starts_again_loses_nothing(net):
    """It sends no SYSTEM_TIME: its clock shows in ATTITUDE, and its sequence numbers begin at 0."""
    sut = net(("udpout", "tcpin"))
    flight = [attitude_at(100_000 + 20 * i, 150 + i) for i in range(50)]
    again = [attitude_at(300 + 20 * i, i) for i in range(50)]
    for frame in (*flight, *again):
        sut[1].send(frame)
    assert sut[2].count(100) == flight + again

    link = sut.link(1)
    assert sut.router.stats("router")[0]["reboots"] == 1
    assert (link["frames_in"], link["lost"], link["late"], link["resync"]) == (100, 0, 0, 1)


@pytest.mark.short
@pytest.mark.parametrize("kind", ["udpin", "udpout", "tcpin", "serial"])
def test_n13_redundant_links_deliver_once_and_either_may_die(net, kind):
    sut = net((kind, kind, "tcpout"), 3, options={1: "group=air", 2: "group=air"})
    sut[3].now()
    sent = []
    for number in range(90):
        frame = attitude()
        if number < 30 or number >= 60:
            sut[1].send(frame)
        if number < 60:
            sut[2].send(frame)
        sent.append(frame)
        assert sut[3].next() == frame
    last = heartbeat((3, 3))
    sut[1].send(last)

    assert sut[3].until(last) == []
    assert sut.link(1)["duplicate"] + sut.link(2)["duplicate"] == 30
    order = command(GCS, VEHICLE)
    sut[3].send(order)
    for number in (1, 2):
        assert sut[number].until(order) == []  # nothing came from the other one of the group


@pytest.mark.short
@pytest.mark.parametrize("kind", ["udpout", "serial"])
def test_n14_a_copy_filtered_on_one_link_does_not_suppress_the_other(net, kind):
    sut = net((kind, kind, "udpout"), 3, options={1: "in_block=ATTITUDE"}, rules={"dedup_ms": 5000})
    frame, second = attitude(), attitude()
    sut[1].send(frame)
    sut.router.wait_counter(sut[1], "filtered", 1)
    sut[2].send(frame)
    assert sut[3].next() == frame
    sut[2].send(frame + second)  # within dedup_ms: the copy goes nowhere

    assert sut[3].next() == second
    assert sut.link(2)["duplicate"] == 1


def faketime_library():
    found = sorted(pathlib.Path("/usr/lib").glob("*/faketime/libfaketime.so.1"))
    if not found:
        pytest.skip("libfaketime is not installed (packaging/test.list)")
    return found[0]


@contextlib.contextmanager
def woken_by(end):
    """Sends a byte that is no frame again and again: libfaketime moves the alarms of the router; they come late."""
    ended = threading.Event()

    def loop():
        while not ended.wait(0.05):
            end.send(b"x")
    thread = threading.Thread(target=loop)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def test_n15_a_clock_that_is_stepped_back_changes_nothing(spawn, tmp_path, program):
    if b"__asan_init" in program.read_bytes() or b"__tsan_init" in program.read_bytes():
        pytest.skip("a sanitizer's program takes no preloaded library")
    clock = tmp_path / "clock"

    def step(offset):
        (tmp_path / "new").write_text(offset)
        (tmp_path / "new").rename(clock)
    step("+0")
    port, out_port = routers.udp_port(), routers.udp_port()
    end, far = UdpEnd(("127.0.0.1", port)), UdpEnd()
    log = tmp_path / "out.tlog"
    router = Router(spawn, f"udpin://127.0.0.1:{port}?idle=10",
                    f"udpout://127.0.0.1:{far.port}?bind=127.0.0.1:{out_port}", f"tlog://{log}",
                    rules={"dedup_ms": 400, "route_timeout": 12},
                    env={"LD_PRELOAD": str(faketime_library()), "FAKETIME_TIMESTAMP_FILE": str(clock),
                         "FAKETIME_NO_CACHE": "1", "FAKETIME_DONT_FAKE_MONOTONIC": "1"})
    far.target = ("127.0.0.1", out_port)
    assert "libfaketime" in pathlib.Path(f"/proc/{router.process.pid}/maps").read_text()

    def copy_is_dropped_then_taken():
        frame, mark = attitude(), attitude((2, 2))
        end.send(frame + frame + mark)
        assert far.until(mark) == [frame]
        time.sleep(0.5)  # longer than dedup_ms
        end.send(frame)
        assert far.next() == frame
    copy_is_dropped_then_taken()
    step("-1h")
    copy_is_dropped_then_taken()
    with woken_by(far):
        assert len(router.links()) == 2 and (1, 1) in {(s, c) for s, c, _ in router.routes()}
    order = command(GCS, VEHICLE)
    far.send(order)
    assert end.until(order) == []
    step("+1h")
    copy_is_dropped_then_taken()
    far.send(heartbeat(GCS))
    with woken_by(far):  # the peer and its routes go when they are old by the clock that nobody steps
        harness.wait_for(lambda: len(router.links()) == 1, what="the peer to go")
        harness.wait_for(lambda: not router.routes(), what="the routes to expire")
    end.close()
    far.close()


def put_link(name, target):
    """Like udev: the name is there in one step."""
    fresh = pathlib.Path(f"{name}.new")
    fresh.symlink_to(target)
    fresh.rename(name)


@pytest.mark.short
def test_n16_g3_a_port_that_is_removed_and_made_again(spawn, tmp_path):
    name, first = tmp_path / "autopilot", SerialEnd("autopilot")
    put_link(name, first.device)
    port = routers.udp_port()
    router = Router(spawn, f"serial://{name}?name=autopilot", f"udpin://127.0.0.1:{port}")
    station = UdpEnd(("127.0.0.1", port))
    station.send(heartbeat(GCS))
    first.next()
    beat = heartbeat()
    first.send(beat)
    assert station.next() == beat
    first.close()
    name.unlink()
    router.process.wait_output("autopilot: down", stream="err")
    assert router.routes() == {(255, 190, router.link_of(station)["link"])}
    second = SerialEnd("autopilot")
    put_link(name, second.device)
    router.wait_links(2)
    beat = heartbeat()
    second.send(beat)
    assert station.next() == beat
    order = command(GCS, VEHICLE)
    station.send(order)

    assert second.next() == order
    assert router.process.alive
    second.close()
    station.close()


@pytest.mark.short
def test_n17_signed_and_version_1_frames_are_routed_like_any_other(net):
    sut = net(MIXED, 3)
    sut.hears(2, VEHICLE)
    signed = command(GCS, VEHICLE, signing=(os.urandom(32), 5, 123456))
    old = command(GCS, VEHICLE, version=1)
    broadcast = attitude((7, 7), signing=(os.urandom(32), 5, 123456))

    assert signed[2] == 1 and old[0] == 0xFE
    assert sut.send(1, signed, old, broadcast) == [[2], [2], [2, 3]]


@pytest.mark.short
def test_n18_a_target_that_is_cut_off_is_everybody(net):
    sut = net(MIXED, 3)
    short = make(mavlink.MAVLink_command_ack_message(400, 0, 0, unique() % 100 + 1))  # target 0/0 at the end: cut off
    assert short[1] < 9
    # MAVLink 1 has no extension fields
    version_1 = raw(77, 143, (unique() % 60000).to_bytes(2, "little") + b"\0", version=1)

    assert sut.send(1, short, version_1) == [[2, 3], [2, 3]]


@pytest.mark.short
@pytest.mark.parametrize("kind", ["peers", "clients"])
def test_n20_commands_follow_a_station_that_moves(spawn, kind):
    port = routers.udp_port() if kind == "peers" else routers.tcp_port()
    scheme = "udpin" if kind == "peers" else "tcpin"
    far_port, vehicle = routers.udp_port(), UdpEnd()
    router = Router(spawn, f"{scheme}://127.0.0.1:{port}?idle=2",
                    f"udpout://127.0.0.1:{vehicle.port}?bind=127.0.0.1:{far_port}", rules={"route_timeout": 2})
    vehicle.target = ("127.0.0.1", far_port)

    def station():
        return UdpEnd(("127.0.0.1", port)) if kind == "peers" else routers.tcp_client(port)
    old, new = station(), station()
    old.send(heartbeat(GCS))
    vehicle.next()
    answer = command(VEHICLE, GCS)
    vehicle.send(answer)
    assert old.next() == answer
    new.send(heartbeat(GCS))
    vehicle.next()
    answer = command(VEHICLE, GCS)
    vehicle.send(answer)
    for end in (old, new):  # both are fresh
        end.until(answer)

    def moved():
        new.send(heartbeat(GCS))
        return len(router.links()) == 2
    harness.wait_for(moved, what="the old place to be forgotten")
    answer = command(VEHICLE, GCS)
    vehicle.send(answer)
    new.until(answer)
    if kind == "peers":
        assert answer not in old.now()
    for end in (old, new, vehicle):
        end.close()


@pytest.mark.short
def test_n21_two_stations_of_one_id_both_hear_all_and_get_answers(net):
    sut = net(MIXED, 3)
    for _ in range(3):
        sut.hears(1, GCS)
        sut.hears(2, GCS)
        assert sut.hears(3, VEHICLE) == [1, 2]
        assert sut.command(3, VEHICLE, GCS) == [1, 2]

    def are_present():
        sut.hears(2, GCS)
        return sut.hears(1, GCS) == [3]
    harness.wait_for(are_present, what="both to count as present")
    sut.router.process.wait_output("255/190 is heard on .* and on .*: two senders with one id", stream="err")
    assert sut.router.stats("router")[0]["duplicate_ids"] == 1


@pytest.mark.short
def test_n22_system_0_is_forwarded_and_never_learnt(net):
    sut = net(MIXED)

    assert sut.send(1, attitude((0, 1))) == [2]
    assert sut.router.routes() == set()
    assert sut.send(2, attitude((0, 1))) == [1]


@pytest.mark.short
def test_n23_a_whole_system_is_reached_on_all_its_links(net):
    sut = net(MIXED, 3)

    sut.hears(1, (1, 1))
    sut.hears(2, (1, 154))
    assert sut.command(3, GCS, (1, 0)) == [1, 2]
    assert sut.command(3, GCS, (1, 154)) == [2]


# ---- limits, private links, the best of a group ----------------------------------------------------------------------

def vfr_hud():
    return make(mavlink.MAVLink_vfr_hud_message(unique(), 1, 2, 3, 4, 5))


@pytest.mark.short
def test_max_rate_holds_back_what_it_names_and_nothing_else(net):
    sut = net(UNHEARD, options={2: "max_rate=ATTITUDE:10"})
    offered, got, begin = [], [], time.monotonic()

    def ten_came():
        offered.extend((attitude(), attitude()))
        other = vfr_hud()
        for frame in (*offered[-2:], other):
            sut[1].send(frame)
        got.extend(sut[2].until(other))
        return len(got) >= 10
    harness.wait_for(ten_came, what="ten of them")

    assert time.monotonic() - begin > 0.85  # nine intervals
    assert set(got) < set(offered)
    held = len(offered) - len(got)
    link = sut.link(2)
    assert (link["out_rate_limited"], link["out_bytes_limited"]) == (held, 0)
    assert sut.link(1)["rate_limited"] == held


@pytest.mark.short
def test_max_rate_is_of_each_source_and_holds_for_a_heartbeat_that_it_names(net):
    sut = net(UNHEARD, options={2: "max_rate=HEARTBEAT:0.01"})
    sent = [heartbeat((system, 1)) for _ in range(5) for system in (1, 2)]
    last = attitude()
    for frame in (*sent, last):
        sut[1].send(frame)

    assert sut[2].until(last) == sent[:2]
    assert sut.link(2)["out_rate_limited"] == 8


@pytest.mark.short
def test_max_bytes_lets_so_many_out_in_a_second(net):
    sut = net(UNHEARD, options={2: "max_bytes=4000"})
    burst, begin = 1000, time.monotonic()
    offered, got, marks = [], [], []

    def a_second_of_bytes_came():
        offered.extend(attitude() for _ in range(10))
        marks.append(heartbeat())
        for frame in (*offered[-10:], marks[-1]):
            sut[1].send(frame)
        got.extend(sut[2].until(marks[-1]))
        return len(b"".join(got + marks)) >= burst + 4000
    harness.wait_for(a_second_of_bytes_came, what="a second's bytes")

    assert time.monotonic() - begin > 0.9
    assert set(got) < set(offered)
    held = len(offered) - len(got)
    link = sut.link(2)
    assert (link["out_rate_limited"], link["out_bytes_limited"]) == (0, held)
    assert sut.link(1)["rate_limited"] == held


@pytest.mark.short
@pytest.mark.parametrize("option, counter",
                         [("max_rate=*:1", "out_rate_limited"), ("max_bytes=560", "out_bytes_limited")])
def test_commands_and_heartbeats_pass_the_limits_of_all(net, option, counter):
    sut = net(("udpout", "tcpin"), options={2: option})
    sut.hears(2, (12, 1))
    urgent, telemetry = [], []
    for _ in range(40):
        urgent += [command(VEHICLE, (12, 1)), heartbeat()]
        telemetry.append(attitude())
        for frame in (*urgent[-2:], telemetry[-1]):
            sut[1].send(frame)
    last = heartbeat()
    sut[1].send(last)
    got = sut[2].until(last)

    assert [frame for frame in got if frame not in telemetry] == urgent
    held = len(telemetry) + len(urgent) - len(got)
    assert held > 0
    assert sut.link(2)[counter] == sut.link(1)["rate_limited"] == held


@pytest.mark.short
def test_a_private_link_gets_what_is_for_exactly_a_pair_heard_there(net):
    sut = net(UNHEARD, 3, options={3: "private=true"}, rules={"unknown_target": "flood"})
    sut[3].send(heartbeat((7, 1)))
    sut.router.wait_counter(sut[3], "private_link", 1)
    others = [attitude(), unknown(), command(VEHICLE, (0, 0)), command(VEHICLE, (66, 6))]
    whole_system = [command(VEHICLE, (7, component)) for component in (0, 2)]
    exact = command(VEHICLE, (7, 1))
    # a byte stream has to be in step before an id without definition is believed
    sut.send(1, heartbeat((0, 0)), watched=[1, 2])

    assert sut.send(1, *others, *whole_system, exact, watched=[1, 2]) == [[2]] * 4 + [[]] * 3
    assert sut[3].until(exact) == []


@pytest.mark.short
def test_nothing_from_a_private_link_is_forwarded(net):
    sut = net(UNHEARD, 3, options={3: "private=true"})
    sut.send(2, heartbeat(VEHICLE), watched=[1, 2])
    said = [heartbeat((7, 1)), attitude((7, 1)), command((7, 1), VEHICLE), unknown((7, 1))]
    for frame in said:
        sut[3].send(frame)
    sut.router.wait_counter(sut[3], "private_link", len(said))

    assert sut.send(1, attitude((9, 9)), watched=[1, 2]) == [2]  # and nothing else came


class BestOfTwo:
    """The vehicle behind links 1 and 2 of a group, the ground station on link 3."""

    def __init__(self, net):
        self.sut = net("udpout", 3, options={number: "group=air&group_mode=best" for number in (1, 2)})
        for _ in range(3):
            self.brings(heartbeat(VEHICLE), 1, 2)

    def brings(self, frame, *members):
        for number in members:
            self.sut[number].send(frame)
        self.sut[3].until(frame)

    def carrier(self):
        """The one member that a command takes."""
        order, mark = command(GCS, VEHICLE), heartbeat(GCS)
        self.sut[3].send(order)
        self.sut[3].send(mark)
        (number,) = [number for number in (1, 2) if order in self.sut[number].until(mark)]
        return number


def test_best_takes_the_member_that_brings_more_heartbeats_and_goes_back(net):
    group = BestOfTwo(net)
    first = group.carrier()

    def changes_after(worse, better):
        beats = 0
        while group.carrier() == worse and beats < 20:
            group.brings(heartbeat(VEHICLE), better)
            group.brings(attitude(VEHICLE), worse)  # it is not silent
            beats += 1
        return beats
    assert 4 <= changes_after(first, 3 - first) <= 6
    assert 9 <= changes_after(3 - first, first) <= 11


def test_best_leaves_a_silent_member_and_goes_back(net):
    group = BestOfTwo(net)
    first = group.carrier()
    for silent, heard in ((first, 3 - first), (3 - first, first)):
        begin = time.monotonic()
        group.brings(attitude(VEHICLE), silent)
        assert group.carrier() == silent

        def is_left():
            group.brings(attitude(VEHICLE), heard)
            return group.carrier() == heard
        harness.wait_for(is_left, what="the other member")
        assert time.monotonic() - begin > 2.9
