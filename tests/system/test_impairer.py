# SPDX-License-Identifier: MIT
"""The impairer itself: what it claims to have done is what arrived, and the same seed does the same."""
import random
import socket

import pytest

import harness
from impairer import Profile, TcpImpairer, UdpImpairer

pytestmark = pytest.mark.short

ALL = Profile(delay=0.002, jitter=0.003, loss=0.2, duplicate=0.1, reorder=0.1)


def pass_through(rng, profile, count=300):
    """Sends `count` numbered datagrams. Returns those that arrived, in order, and the impairer."""
    arrived, target, caller = [], harness.udp_socket(), harness.udp_socket()
    with target, caller, UdpImpairer(target.getsockname(), rng, profile) as impairer:
        for i in range(count):
            caller.sendto(b"%d" % i, ("127.0.0.1", impairer.port))
        direction = impairer.forth
        harness.wait_for(lambda: len(set(direction.delivered)) + len(direction.lost) == count, what="the last datagram")
        copies = count - len(direction.lost) + direction.duplicated
        while len(arrived) < copies:
            datagram = target.recv(2048)
            if datagram.isdigit():  # a router of another test may still send to this port
                arrived.append(int(datagram))
        return arrived, impairer


def test_without_a_profile_nothing_changes(rng):
    arrived, impairer = pass_through(rng, Profile())

    assert arrived == list(range(300)) and not impairer.forth.lost


def test_jitter_keeps_the_order(rng):
    assert pass_through(rng, Profile(delay=0.001, jitter=0.01))[0] == list(range(300))


def test_every_fate_is_reported(rng):
    arrived, impairer = pass_through(rng, ALL)
    lost = {int(d) for d in impairer.forth.lost}

    assert set(arrived) == set(range(300)) - lost
    assert len(arrived) == len(set(arrived)) + impairer.forth.duplicated
    assert 10 < len(lost) < 120 and impairer.forth.duplicated > 0 and impairer.forth.reordered > 0
    assert arrived != sorted(arrived)


def test_the_same_seed_does_the_same():
    runs = [pass_through(random.Random(7), ALL)[1].forth for _ in range(2)]

    assert runs[0].lost == runs[1].lost
    assert (runs[0].duplicated, runs[0].reordered) == (runs[1].duplicated, runs[1].reordered)


def test_answers_go_back_and_a_dead_link_passes_nothing(rng):
    target, caller = harness.udp_socket(), harness.udp_socket()
    with target, caller, UdpImpairer(target.getsockname(), rng) as impairer:
        caller.sendto(b"question", ("127.0.0.1", impairer.port))
        question, source = target.recvfrom(2048)
        target.sendto(b"answer", source)
        assert (question, caller.recv(2048)) == (b"question", b"answer")

        impairer.kill()
        caller.sendto(b"lost", ("127.0.0.1", impairer.port))
        harness.wait_for(lambda: impairer.forth.cut == [b"lost"], what="the datagram that the dead link took")
        impairer.revive()
        caller.sendto(b"again", ("127.0.0.1", impairer.port))
        assert target.recv(2048) == b"again"


def test_a_tcp_stream_arrives_whole_and_may_break(rng):
    with socket.create_server(("127.0.0.1", 0)) as server, \
            TcpImpairer(server.getsockname(), rng, delay=0.001, jitter=0.002) as impairer:
        with socket.create_connection(("127.0.0.1", impairer.port), timeout=60) as caller:
            far, _ = server.accept()
            with far:
                sent = rng.randbytes(100_000)
                caller.sendall(sent)
                got = b""
                while len(got) < len(sent):
                    got += far.recv(1 << 16)
                assert got == sent
                impairer.reset()
                with pytest.raises(ConnectionResetError):
                    while far.recv(1):
                        pass
