# SPDX-License-Identifier: MIT
"""udpmcast:// between two machines, IPv4 and IPv6, and with pymavlink's own multicast."""
import socket
import struct
import sys

import pytest

import frames
import harness
from test_broadcast import machines, relay_of, start  # noqa: F401

pytestmark = pytest.mark.short

PORT = 14550
IP_RECVTTL = 12
GROUPS = ["udpmcast://239.255.145.50:14550", "udpmcast://239.255.145.50:14550?iface=cable1",
          "udpmcast://[ff02::4d41%25cable1]:14550", "udpmcast://[ff15::4d41]:14550?iface=cable1"]

PYMAVLINK_PEER = """
from pymavlink import mavutil
link = mavutil.mavlink_connection("mcast:", source_system=77)
heard = None
while heard is None or heard.get_srcSystem() != 42:
    link.mav.heartbeat_send(6, 8, 0, 0, 0)
    heard = link.recv_match(type="HEARTBEAT", blocking=True, timeout=0.2)
"""


@pytest.mark.parametrize("url", GROUPS)
def test_two_listeners_of_one_machine_hear_the_other_machine(machines, start, url):  # noqa: F811
    here, there = machines
    listening = [start(there, "listen", url.replace("cable1", "cable2"), "--count", "1", "--json") for _ in range(2)]
    beside = start(here, "listen", url, "--count", "1", "--json")
    relay, send = relay_of(here, start, url)

    def all_have():
        send(next(frames.heartbeats(1, system=42)))
        return not any(process.alive for process in [*listening, beside])
    harness.wait_for(all_have, what="a heartbeat at each listener")
    for process in [*listening, beside]:
        assert process.wait().status == 0
        assert '"sys":42' in process.stdout
    assert relay.alive


def test_hops_are_one_unless_set(machines, start):  # noqa: F811
    here, there = machines
    sock = there.socket()
    sock.setsockopt(socket.IPPROTO_IP, IP_RECVTTL, 1)
    sock.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                    struct.pack("4s4s", socket.inet_aton("239.255.145.50"), socket.inet_aton(there.host)))
    sock.bind(("", PORT))
    for url, hops in (("udpmcast://239.255.145.50:14550", 1), ("udpmcast://239.255.145.50:14550?ttl=4", 4)):
        relay, send = relay_of(here, start, url)
        send(next(frames.heartbeats(1)))
        _, ancillary, _, _ = sock.recvmsg(2048, 256)
        assert struct.unpack("i", ancillary[0][2]) == (hops,)
        relay.kill()


def test_pymavlink_is_heard_and_hears(machines, start):  # noqa: F811
    here, _ = machines
    peer = harness.Running(here.command(sys.executable, "-c", PYMAVLINK_PEER))
    try:
        listening = start(here, "listen", "udpmcast://239.255.145.50:14550", "--only", "HEARTBEAT", "--json")
        harness.wait_for(lambda: '"sys":77' in listening.stdout, what="pymavlink to be heard")
        _, send = relay_of(here, start, "udpmcast://239.255.145.50:14550")

        def has_heard():  # and ends then
            send(next(frames.heartbeats(1, system=42)))
            return not peer.alive
        harness.wait_for(has_heard, what="pymavlink to hear")
        assert peer.wait().status == 0
    finally:
        peer.kill()
