# SPDX-License-Identifier: MIT
"""request_streams: an ArduPilot is asked for its streams, another autopilot is not.
(That it is asked again after 30 s is a unit test.)"""
import pytest

import frames
from frames import mavlink

pytestmark = pytest.mark.short

ARDUPILOT, PX4 = 3, 12


def beat(autopilot, system, sequence):
    return mavlink.MAVLink_heartbeat_message(2, autopilot, 81, 0, 4, 3).pack(frames.sender(system, 1, sequence))


def heard(sock, until):
    """Decoded frames up to the first for which `until` is true."""
    parser, got = mavlink.MAVLink(None), []
    while not (got and until(got)):
        got += [parser.decode(bytearray(frame)) for frame in frames.split_frames(sock.recv(65536))]
    return got


@pytest.fixture
def route(spawn, tmp_path, udp_port):
    def start(router):
        port = udp_port()
        (tmp_path / "router.toml").write_text(f'[router]\n{router}\n[[endpoint]]\nurl = "udpin://127.0.0.1:{port}"\n'
                                              'name = "air"\nheartbeat = true\n')
        running = spawn("route", "--config", tmp_path / "router.toml", "--name", f"streams-{port}")
        running.wait_output("receive buffer")
        return ("127.0.0.1", port)
    return start


def test_each_ardupilot_is_asked_once(route, udp_socket):
    address = route('heartbeat = "42/191"\nrequest_streams = 4')
    copter, px4 = udp_socket(), udp_socket()
    for sequence in range(5):
        copter.sendto(beat(ARDUPILOT, 1, sequence), address)
    for sequence in range(5):
        px4.sendto(beat(PX4, 2, sequence), address)

    got = heard(copter,
                lambda all: sum(m.get_srcSystem() == 2 for m in all) == 5 and sum(m.get_msgId() == 0 for m in all) > 6)
    asked = [m for m in got if m.get_msgId() == 66]
    assert len(asked) == 1
    assert (asked[0].get_srcSystem(), asked[0].get_srcComponent()) == (42, 191)
    assert (asked[0].target_system, asked[0].target_component, asked[0].req_stream_id, asked[0].req_message_rate,
            asked[0].start_stop) == (1, 1, 0, 4, 1)
    own = [m.get_seq() for m in got if m.get_srcSystem() == 42]
    assert own == list(range(len(own)))
    assert 66 not in {m.get_msgId() for m in heard(px4, lambda all: sum(m.get_srcSystem() == 42 for m in all) > 2)}


def test_it_is_off_by_default(route, udp_socket):
    address = route('heartbeat = "42/191"')
    copter = udp_socket()
    copter.sendto(beat(ARDUPILOT, 1, 0), address)

    assert {m.get_msgId() for m in heard(copter, lambda all: len(all) > 2)} == {0}


@pytest.mark.parametrize("text, line", [('request_streams = 4', 2), ('heartbeat = "1/1"\nrequest_streams = 0', 3),
                                        ('heartbeat = "1/1"\nrequest_streams = "fast"', 3)])
def test_a_wrong_value_is_named_with_its_line(run, tmp_path, text, line):
    (tmp_path / "router.toml").write_text(f"[router]\n{text}\n")
    done = run("check", "router.toml", cwd=tmp_path)

    assert done.status == 3
    assert f"router.toml:{line}: request_streams" in done.stderr, done
