# SPDX-License-Identifier: MIT
"""pymavlink's ws: and wsserver: in mavloom.mavutil, with pymavlink at the other end."""
import socket
import subprocess
import sys

import pytest
from mavloom import mavutil
from vehicles import until

PYMAVLINK = """
import sys
from pymavlink import mavutil
link = mavutil.mavlink_connection(sys.argv[1], source_system=77)
heard = None
while heard is None or heard.get_srcSystem() != 42:
    if link.port is not None:
        link.mav.heartbeat_send(6, 8, 0, 0, 0)
    heard = link.recv_match(type="HEARTBEAT", blocking=True, timeout=0.2)
"""


@pytest.mark.parametrize("kind", ["ws", "wsserver"])
def test_pymavlink_and_mavutil_talk_to_each_other(kind):
    with socket.create_server(("127.0.0.1", 0)) as free:
        address = f"127.0.0.1:{free.getsockname()[1]}"
    link = mavutil.mavlink_connection(f"{'wsserver' if kind == 'ws' else 'ws'}:{address}", source_system=42)
    peer = subprocess.Popen([sys.executable, "-c", PYMAVLINK, f"{kind}:{address}"])
    try:
        heard = link.recv_match(type="HEARTBEAT", blocking=True, timeout=20)
        assert heard.get_srcSystem() == 77

        def has_ended():
            link.mav.heartbeat_send(2, 12, 0, 0, 0)
            return peer.poll() is not None
        until(has_ended)
        assert peer.returncode == 0
    finally:
        peer.kill()
        link.close()


def test_the_first_message_of_a_client_arrives():
    with socket.create_server(("127.0.0.1", 0)) as free:
        address = f"127.0.0.1:{free.getsockname()[1]}"
    server = mavutil.mavlink_connection(f"wsserver:{address}")
    client = mavutil.mavlink_connection(f"ws:{address}:/", source_system=42)
    try:
        client.mav.command_long_send(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0)
        assert server.recv_match(type="COMMAND_LONG", blocking=True, timeout=20).get_srcSystem() == 42
        with pytest.raises(RuntimeError, match="handshake failed.*404.*this server has / "):
            mavutil.mavlink_connection(f"ws:{address}:other")
    finally:
        client.close()
        server.close()
