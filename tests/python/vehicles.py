# SPDX-License-Identifier: MIT
"""The far side of a link: pymavlink's frames on a socket, or the simulator of `mavloom sim`."""
import contextlib
import os
import re
import socket
import subprocess
import tempfile
import threading
import time

import mavloom
from places import PROGRAM
from tlogs import packer

DEADLINE_S = 60
SPEED = 10  # of the simulator's time


def until(condition):
    """Waits for a condition; the test fails where it never comes true."""
    end = time.monotonic() + DEADLINE_S
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.005)


class Vehicle:
    """A UDP socket that speaks with pymavlink's frames."""

    def __init__(self, peer, port=None, system=1, component=1):
        self.peer, self.sender = peer, packer(peer, system, component)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.settimeout(DEADLINE_S)
        self.socket.bind(("127.0.0.1", 0))
        if port is not None:
            self.socket.connect(("127.0.0.1", port))

    @property
    def port(self):
        return self.socket.getsockname()[1]

    def send(self, *messages):
        self.socket.send(b"".join(self.sender.pack(message) for message in messages))

    def heartbeat(self, kind=2, autopilot=12, number=0):
        return self.peer.MAVLink_heartbeat_message(kind, autopilot, 0, number, 4, 3)

    def attitude(self, number, roll=0.0):
        return self.peer.MAVLink_attitude_message(number, roll, 0, 0, 0, 0, 0)

    def receive(self):
        """All messages of the next datagram, decoded by pymavlink."""
        return self.peer.MAVLink(None).parse_buffer(self.socket.recv(65536))


@contextlib.contextmanager
def again_and_again(work, pause_s=0.0):
    """Calls `work` in a thread of its own until the block ends."""
    stop = threading.Event()

    def run():
        while not stop.wait(pause_s):
            work()
    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()


def flood(vehicle):
    """Sends heartbeats until the test ends."""
    def send():
        with contextlib.suppress(ConnectionRefusedError):
            vehicle.send(vehicle.heartbeat())
    return again_and_again(send)


@contextlib.contextmanager
def simulator(autopilot, *options):
    """Quadrotors; the first one can be armed. Yields the port of a TCP server."""
    with tempfile.TemporaryDirectory() as folder:
        process = subprocess.Popen([PROGRAM, "sim", "--autopilot", autopilot, "--speed", str(SPEED), "--listen",
                                    "tcpin://127.0.0.1:0", *options], stdin=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   env={**os.environ, "MAVLOOM_RUN": folder}, text=True)
        try:
            port = next(int(found[1]) for line in process.stderr
                        if (found := re.search(r"listening on port (\d+)", line)))
            with mavloom.connect(f"tcpout://127.0.0.1:{port}") as link:
                vehicle = link.vehicle(timeout=DEADLINE_S)
                until(lambda: is_armed(vehicle))
                vehicle.disarm()
            yield port
        finally:
            process.terminate()
            process.communicate(timeout=30)


def is_armed(vehicle):
    with contextlib.suppress(mavloom.CommandError):
        vehicle.arm()
        return True
