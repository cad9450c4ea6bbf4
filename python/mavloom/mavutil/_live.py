# SPDX-License-Identifier: MIT
"""Live connections of mavloom.mavutil, over mavloom.Link."""
from __future__ import annotations

import errno
import os
import re
import select
import socket
import sys
import time
from collections import deque
from typing import Any

from .._errors import ClosedError, InputError, SystemFailure, UsageError
from .._link import Link
from ._connection import LONGEST_WAIT_S, wait_of
from ._services import mavfile
from ._messages import MAVLink_message, as_bytes
from ._urls import Target, host_and_port

SIGNAL = (1).to_bytes(8, sys.byteorder)  # what makes an eventfd readable
PYMAVLINK_GROUP = "239.255.145.50"
FRAMES_APART = "mtu=0"  # each frame in a datagram of its own
ENDLESS = "1000h"
KEEP_ALL = f"queue_age={ENDLESS}&queue_bytes=64MiB"  # a full queue makes the sender wait, so nothing is dropped
MAX_QUEUED_BYTES = 4096  # of a serial device
ROOM_PAUSE_S = 0.005


class mavlive(mavfile):
    """A connection over a mavloom.Link, which is its attribute `link`."""

    def __init__(self, url: str, address: str, source_system: int = 255, source_component: int = 0) -> None:
        super().__init__(None, address, source_system, source_component)
        self.url = url
        self._packets = self._bytes = 0
        self._closed = False
        self._watched = False  # whether the program waits on the descriptor
        self._held: deque[MAVLink_message] = deque()  # read when the descriptor was armed
        self.link = self._open(url)
        self._reader: Any = self.link._reader
        self.link._reader = self.link.subscribe()  # of native messages, for the link's own methods

    def _open(self, url: str) -> Link:
        return Link(url, dialect=self.mav._dialect)

    def _read(self, timeout: float) -> MAVLink_message | None:
        message: MAVLink_message | None = self._held.popleft() if self._held else self._reader.recv(timeout)
        if message is None and self._watched:
            message = self._arm()
        if message is not None:
            if self._watched:
                self._hold()
            self._change_version()
        return message

    def _take(self, timeout: float) -> MAVLink_message | None:
        message = self._read(timeout)
        if message is None:
            return None
        self._packets += 1
        self._bytes += len(message._frame)
        return self._post(message)

    def recv_msg(self) -> Any:
        return self._take(0)

    def _totals(self) -> tuple[int, int]:
        return self._packets, self._bytes

    def _damaged(self) -> int:
        """How many damaged frames the link has counted."""
        try:
            return int(self.link.stats.crc_error)
        except ClosedError:
            return 0

    def _arm(self) -> MAVLink_message | None:
        """Call after an empty read. Clears the descriptor; the next message makes it readable again."""
        descriptor = self._reader.event_fd()
        try:
            os.read(descriptor, 8)
        except BlockingIOError:
            pass
        message: MAVLink_message | None = self._reader.recv(0)
        if message is not None:
            os.write(descriptor, SIGNAL)
        return message

    def recv(self, n: int | None = None) -> bytes:
        """Returns the bytes of waiting frames: whole frames, until there are at least `n` bytes.

        Without `n`, returns one frame; b"" if none waits.
        """
        data = self._read_frame()
        while n is not None and 0 < len(data) < n and (more := self._read_frame()):
            data += more
        return data

    def _read_frame(self) -> bytes:
        message = self._read(0)
        return b"" if message is None else bytes(message.get_msgbuf())

    def write(self, buf: bytes) -> None:
        """Sends whole frames to every peer of the link."""
        left = as_bytes(buf)
        while left and not self._closed:
            length = frame_length(left)
            if not 0 < length <= len(left):
                raise UsageError(f"{self.address}: a link sends whole MAVLink frames, not {left[:16]!r}; for other "
                                 "bytes open the device or socket itself")
            try:
                self.link.forward(left[:length])
            except ClosedError:
                return
            left = left[length:]

    @property
    def fd(self) -> int:
        """A descriptor for select and poll. It is readable while there are messages."""
        if not self._watched:
            self._watched = True
            self._hold()
        descriptor: int = self._reader.event_fd()
        return descriptor

    def _hold(self) -> None:
        """Makes the descriptor readable if there is a message, and holds that message for the next read."""
        if not self._held and (message := self._arm()) is not None:
            self._held.append(message)

    def fileno(self) -> int:
        return self.fd

    def select(self, timeout: float) -> bool:
        """Waits until there is a message, for at most `timeout` seconds. Returns whether there is one."""
        self._watched = True
        self._hold()
        ready, _, _ = select.select([self.fd], [], [], wait_of(timeout))
        return bool(ready)

    @property
    def port(self) -> Port:
        """The place of the socket, which the link's thread owns."""
        return Port(self)

    def close(self) -> None:
        self._closed = True
        self._held.clear()
        self.link.close()
        super().close()


class Port:
    """The place of a connection's socket or device: `port.getsockname()`. It neither reads nor writes."""

    def __init__(self, connection: mavlive) -> None:
        self._connection = connection

    def getsockname(self) -> tuple[str, int]:
        """The host and port that are bound; ("", 0) if there are none."""
        host, _, _ = self._connection.link.name.partition("://")[2].rpartition(":")
        return host, self._connection.link.port

    def fileno(self) -> int:
        return self._connection.fd

    def close(self) -> None:
        self._connection.close()

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"a connection's port has no {name}: the link's thread owns the socket or device; use the "
                             "methods of the connection, or options of the endpoint")


def frame_length(data: bytes) -> int:
    """The length that a frame's header states; 0 if it is none."""
    if len(data) < 8 or data[0] not in (0xfd, 0xfe):
        return 0
    if data[0] == 0xfe:
        return 8 + data[1]
    return 12 + data[1] + (13 if data[2] & 1 else 0)


class mavudp(mavlive):
    """A UDP socket. With `input`, binds and sends to every peer it has heard. Otherwise sends to `device`.

    A peer is forgotten after `timeout` seconds of silence; 0: never.
    """

    def __init__(self, device: str, input: bool = True, broadcast: bool = False, source_system: int = 255,
                 source_component: int = 0, use_native: bool = False, timeout: float = 0) -> None:
        host, port = host_and_port(device, "UDP", "0.0.0.0" if input else "127.0.0.1")
        if input:
            socket.getaddrinfo(host.strip("[]"), port)  # raises gaierror for a host that does not exist
        scheme = "udpin" if input else "udpbcast" if broadcast else "udpout"
        options = FRAMES_APART + ("&reuse=true" if input else "")
        if scheme != "udpout":
            options += f"&trusted=true&idle={idle_of(timeout)}"
        super().__init__(f"{scheme}://{host}:{port}?{options}", device, source_system, source_component)


def idle_of(timeout: float) -> str:
    """The endpoint's option `idle` for a timeout in seconds."""
    milliseconds = round(seconds(max(timeout, 0), "udp_timeout") * 1000)
    return f"{max(milliseconds, 1)}ms" if timeout > 0 else ENDLESS


class mavmcast(mavlive):
    """A multicast group. If `device` is empty or only a port, it is the group of pymavlink."""

    def __init__(self, device: str = "", source_system: int = 255, source_component: int = 0,
                 use_native: bool = False) -> None:
        place = f":{device}" if device.isdigit() else device or ":14550"
        host, port = host_and_port(place, "multicast", PYMAVLINK_GROUP)
        super().__init__(f"udpmcast://{host}:{port}?{FRAMES_APART}", device, source_system, source_component)


def refusal(error: SystemFailure) -> OSError:
    """The error that a program expects from a socket."""
    if error.errno == errno.ECONNREFUSED:
        return ConnectionRefusedError(errno.ECONNREFUSED, os.strerror(errno.ECONNREFUSED))
    return error


def seconds(value: float, name: str) -> float:
    """A pause in seconds. Raises UsageError if the value is not a number."""
    if not isinstance(value, (int, float)) or not 0 <= value <= LONGEST_WAIT_S:
        raise UsageError(f"{name}: {value!r} is not a number of seconds, 0 to {LONGEST_WAIT_S}")
    return value


class mavtcp(mavlive):
    """A TCP connection to a server. It is opened again when it breaks."""

    def __init__(self, device: str, autoreconnect: bool = False, source_system: int = 255, source_component: int = 0,
                 retries: int = 3, reconnect_delay: float = 1, use_native: bool = False) -> None:
        host, port = host_and_port(device, "TCP", "127.0.0.1")
        self.autoreconnect = autoreconnect
        self.retries = retries
        self.reconnect_delay = seconds(reconnect_delay, "reconnect_delay")
        super().__init__(f"tcpout://{host}:{port}?required=true", f"tcp:{device}", source_system, source_component)

    def _open(self, url: str) -> Link:
        """Tries `retries` times, with a pause of `reconnect_delay` seconds."""
        for _ in range(self.retries - 1):
            try:
                return super()._open(url)
            except SystemFailure as error:
                print(f"{refusal(error)} sleeping")
                time.sleep(self.reconnect_delay)
        try:
            return super()._open(url)
        except SystemFailure as error:
            raise refusal(error) from None


class mavtcpin(mavlive):
    """A TCP server. It has any number of clients."""

    def __init__(self, device: str, source_system: int = 255, source_component: int = 0, retries: int = 3,
                 use_native: bool = False) -> None:
        host, port = host_and_port(device, "TCP")
        super().__init__(f"tcpin://{host}:{port}", f"tcpin:{device}", source_system, source_component)


class mavwebsocket(mavlive):
    """A WebSocket server. It has any number of clients."""

    def __init__(self, device: str, source_system: int = 255, source_component: int = 0,
                 use_native: bool = False) -> None:
        host, port = host_and_port(device, "WebSocket")
        super().__init__(f"wsin://{host}:{port}", f"wsserver:{device}", source_system, source_component)


class mavwebsocket_client(mavlive):
    """A WebSocket to a server. It is opened again when it breaks, or if nobody listens at first. `device`: ws:HOST:PORT
    or ws:HOST:PORT:PATH. RuntimeError: the server is no WebSocket server, or refused the path."""

    def __init__(self, device: str, source_system: int = 255, source_component: int = 0,
                 use_native: bool = False) -> None:
        address = device.removeprefix("ws:")
        with_path = re.fullmatch(r"(.*?:\d+):/?(.*)", address)
        address, path = with_path.groups() if with_path else (address, "")
        host, port = host_and_port(address, "WebSocket", "127.0.0.1")
        super().__init__(f"wsout://{host}:{port}/{path}", device, source_system, source_component)

    def _open(self, url: str) -> Link:
        """Waits for the handshake, so that what a script sends first arrives."""
        try:
            return super()._open(f"{url}?required=true")
        except InputError as error:
            raise RuntimeError(f"WebSocket handshake failed: {error}") from None
        except SystemFailure:
            return super()._open(url)


class mavserial(mavlive):
    """A serial device. It is opened again after it was unplugged. Sending waits for a slow line, as in pymavlink."""

    def __init__(self, device: str, baud: int = 115200, autoreconnect: bool = False, source_system: int = 255,
                 source_component: int = 0, use_native: bool = False, force_connected: bool = False) -> None:
        self.device = device
        self.baud = baud
        self.autoreconnect = autoreconnect
        self._room = 0  # bytes that may be sent before the queue is examined again
        required = "false" if autoreconnect or force_connected else "true"
        super().__init__(f"serial://{device}?baud={baud}&required={required}&{KEEP_ALL}", device, source_system,
                         source_component)

    def write(self, buf: bytes) -> None:
        """Sends whole frames. Returns when all but the last 4 KiB are with the driver."""
        super().write(buf)
        self._room -= len(buf)
        while self._room < 0 and not self._closed:
            self._room = MAX_QUEUED_BYTES - self.link._port.queued_bytes
            if self._room < 0:
                time.sleep(ROOM_PAUSE_S)

    def set_baudrate(self, baudrate: int) -> None:
        """Refused: the link's thread owns the device."""
        if baudrate != self.baud:
            raise UsageError(f"{self.device}: the baud rate of an open link cannot change; close it and open it again "
                             f"with baud={baudrate}")

    def reset(self) -> None:
        """Does nothing: a device that was unplugged is opened again by itself."""


def open_target(target: Target, source: tuple[int, int], options: dict[str, Any]) -> mavlive:
    """Opens what a connection string names."""
    system, component = source
    if target.kind == "udp":
        return mavudp(target.rest, options["input"], False, system, component, timeout=options["udp_timeout"])
    if target.kind in ("udpin", "udpout", "udpbcast"):
        return mavudp(target.rest, target.kind == "udpin", target.kind == "udpbcast", system, component,
                      timeout=options["udp_timeout"])
    if target.kind == "mcast":
        return mavmcast(target.rest, system, component)
    if target.kind == "tcp":
        return mavtcp(target.rest, options["autoreconnect"], system, component, options["retries"],
                      options["reconnect_delay"])
    if target.kind == "tcpin":
        return mavtcpin(target.rest, system, component, options["retries"])
    if target.kind == "ws":
        return mavwebsocket_client(f"ws:{target.rest}", system, component)
    if target.kind == "wsserver":
        return mavwebsocket(target.rest, system, component)
    if target.kind == "serial":
        return mavserial(target.rest, target.baud or options["baud"], options["autoreconnect"], system, component,
                         force_connected=options["force_connected"])
    return mavlive(target.rest, target.rest, system, component)
