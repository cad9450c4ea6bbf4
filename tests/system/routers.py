# SPDX-License-Identifier: MIT
"""A running `mavloom route` and the far ends of its links, for the system tests. A Net is a router with the ends 1, 2,
3, ... around it, over any kind of link; it finds exactly which ends a frame reached, without waiting for frames that do
not come."""
import collections
import itertools
import json
import os
import select
import socket
import time

import frames
import harness
from frames import mavlink

# ---- frames ----------------------------------------------------------------------------------------------------------

_sequences = collections.Counter()
_unique = itertools.count(1)


def unique() -> int:
    """A number for a field that makes a frame different from every other: the same bytes again would be an echo or a
    copy."""
    return next(_unique)


def make(message, source=(1, 1), version=2, signing=None) -> bytes:
    """The frame of a pymavlink message, with the next sequence number of its source.
    signing=(key, link id, 10 us ticks)."""
    mav = mavlink.MAVLink(None, *source)
    mav.seq = _sequences[source] % 256
    _sequences[source] += 1
    if signing:
        mav.signing.secret_key, mav.signing.link_id, mav.signing.timestamp = signing
        mav.signing.sign_outgoing = True
    return bytes(message.pack(mav, force_mavlink1=version == 1))


def heartbeat(source=(1, 1), **options) -> bytes:
    return make(mavlink.MAVLink_heartbeat_message(2, 12, 81, unique(), 4, 3), source, **options)


def attitude(source=(1, 1), **options) -> bytes:
    return make(mavlink.MAVLink_attitude_message(unique(), 0.1, -0.2, 3.0, 0.01, 0.02, 0.03), source, **options)


def has_second_start(frame) -> bool:
    """Whether the scan of a part of the frame, or of what is left of a damaged one, could find another start."""
    return not {0xFD, 0xFE}.isdisjoint(frame[1:])


def with_one_start(source=(1, 1)) -> bytes:
    while has_second_start(frame := attitude(source)):
        pass
    return frame


def damaged() -> bytes:
    """A frame with a wrong checksum, and without a second start."""
    while True:
        frame = bytearray(attitude())
        frame[20] ^= 1
        if not has_second_start(frame):
            return bytes(frame)


def command(source, target, **options) -> bytes:
    return make(mavlink.MAVLink_command_long_message(*target, 400, 0, unique(), 0, 0, 0, 0, 0, 0), source, **options)


def ping(source, target) -> bytes:
    return make(mavlink.MAVLink_ping_message(0, unique(), *target), source)


def raw(message_id, crc_extra, payload, source=(1, 1), version=2, incompat=0) -> bytes:
    """A frame whose message need not exist."""
    sequence = _sequences[source] % 256
    _sequences[source] += 1
    head = bytes([len(payload), sequence, *source, message_id]) if version == 1 else \
        bytes([len(payload), incompat, 0, sequence, *source]) + message_id.to_bytes(3, "little")
    crc = mavlink.x25crc(head + payload + bytes([crc_extra])).crc
    return bytes([0xFE if version == 1 else 0xFD]) + head + payload + crc.to_bytes(2, "little")


def unknown(source=(1, 1), message_id=70371) -> bytes:
    """A frame of an id that no definition has."""
    return raw(message_id, 123, unique().to_bytes(4, "little") + b"unknown", source)


# ---- far ends --------------------------------------------------------------------------------------------------------

class End:
    """The far end of a link: send(bytes), next() -> the next whole frame that came.
    Only whole frames may come."""

    def __init__(self, label=None):
        self.label = label  # of the router's endpoint; None: one of several links of an endpoint
        self.got = collections.deque()
        self._partial = b""

    def next(self, timeout=harness.DEFAULT_TIMEOUT_S) -> bytes:
        deadline = time.monotonic() + timeout
        while not self.got:
            left = deadline - time.monotonic()
            assert left > 0, f"no frame within {timeout:g} s"
            if select.select([self], [], [], left)[0]:
                self._take(self._read())
        return self.got.popleft()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def until(self, last: bytes) -> list[bytes]:
        """The frames that came before this one."""
        before = []
        while (frame := self.next()) != last:
            before.append(frame)
        return before

    def count(self, number) -> list[bytes]:
        return [self.next() for _ in range(number)]

    def now(self) -> list[bytes]:
        """The frames that are there now."""
        while select.select([self], [], [], 0)[0]:
            self._take(self._read())
        there = list(self.got)
        self.got.clear()
        return there

    def _take(self, data):
        self._partial += data
        while len(self._partial) >= 3:
            assert self._partial[0] in (0xFD, 0xFE), f"no frame begins here: {self._partial[:40].hex()}"
            size = frames.frame_length(self._partial, 0)
            if len(self._partial) < size:
                break
            self.got.append(self._partial[:size])
            self._partial = self._partial[size:]

    def is_of(self, link) -> bool:
        """Whether this is the far end of that link (of the router's report)."""
        return link["link"].endswith(f":{self.port}") if self.label is None else link["endpoint"] == self.label


class UdpEnd(End):
    """On loopback, or with `sock`, an unbound socket of another machine, on all addresses there or on `host`."""

    def __init__(self, target=None, label=None, port=0, sock=None, host="0.0.0.0"):
        super().__init__(label)
        self.target = target
        self.sock = sock or socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        harness.enlarge_receive_buffer(self.sock)
        self.sock.bind((host if sock else "127.0.0.1", port))
        self.port = self.sock.getsockname()[1]

    def fileno(self):
        return self.sock.fileno()

    def send(self, data):
        self.sock.sendto(data, self.target)

    def _read(self):
        data, self.source = self.sock.recvfrom(65536)
        assert b"".join(frames.split_frames(data)) == data, "a datagram holds whole frames"
        return data

    def close(self):
        self.sock.close()


class TcpEnd(End):
    def __init__(self, sock, label=None):
        super().__init__(label)
        self.sock = sock
        self.sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.port = self.sock.getsockname()[1]

    def fileno(self):
        return self.sock.fileno()

    def send(self, data):
        self.sock.sendall(data)

    def _read(self):
        data = self.sock.recv(65536)
        assert data, "the router closed the connection"
        return data

    def close(self):
        self.sock.close()


class SerialEnd(End):
    def __init__(self, label=None):
        super().__init__(label)
        self.line = harness.SerialLine()
        self.device = self.line.device

    def fileno(self):
        return self.line.far

    def send(self, data):
        self.line.write(data)

    def _read(self):
        try:
            return os.read(self.line.far, 65536)
        except OSError:  # nobody has the other end open
            time.sleep(0.01)
            return b""

    def close(self):
        self.line.unplug()


def tcp_client(port, label=None) -> TcpEnd:
    return TcpEnd(socket.create_connection(("127.0.0.1", port), timeout=harness.DEFAULT_TIMEOUT_S), label)


def udp_port() -> int:
    return harness.free_port(socket.SOCK_DGRAM)


def tcp_port() -> int:
    return harness.free_port(socket.SOCK_STREAM)


# ---- the router ------------------------------------------------------------------------------------------------------

_names = itertools.count(1)


class Router:
    """A router that runs, and its control socket."""

    def __init__(self, spawn, *args, rules=None, env=None):
        self.name = f"test-{os.getpid()}-{next(_names)}"
        self.env = {**{f"MAVLOOM_ROUTER_{k.upper()}": str(v) for k, v in (rules or {}).items()}, **(env or {})}
        self.process = spawn("route", *args, "--name", self.name, env=self.env)
        self._control = harness.wait_for(self._connect, what="the control socket").makefile("rwb")

    def _connect(self):
        if not self.process.alive:
            done = self.process.wait()
            raise AssertionError(f"ended with {done.status}: {done.stderr}")
        return self._connect_to(str(harness.RUN / f"{self.name}.ctl"))

    @staticmethod
    def _connect_to(path):
        sock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        sock.settimeout(harness.DEFAULT_TIMEOUT_S)
        try:
            sock.connect(path)
            return sock
        except OSError:
            sock.close()
            return None

    def ask(self, cmd, **arguments) -> list[dict]:
        self._control.write(json.dumps({"cmd": cmd, **arguments}).encode() + b"\n")
        self._control.flush()
        lines = []
        while True:
            line = json.loads(self._control.readline())
            if "ok" in line:
                assert line["ok"], line
                return lines
            lines.append(line)

    def stats(self, kind) -> list[dict]:
        return [line for line in self.ask("stats") if line["kind"] == kind]

    def links(self) -> list[dict]:
        return [link for link in self.ask("links") if link["up"]]

    def link_of(self, end) -> dict:
        found = [link for link in self.links() if end.is_of(link)]
        assert len(found) == 1, f"{end.label or end.port} in {self.links()}"
        return found[0]

    def routes(self) -> set:
        return {(r["sys"], r["comp"], r["link"]) for r in self.ask("routes")}

    def wait_links(self, count):
        return harness.wait_for(lambda: len(links := self.links()) == count and links, what=f"{count} links")

    def wait_counter(self, end, name, value):
        harness.wait_for(lambda: self.link_of(end)[name] >= value, what=f"{name} {value}")
        assert self.link_of(end)[name] == value


# ---- a router with ends around it ------------------------------------------------------------------------------------

# One endpoint with several links, and one endpoint for each link.
SHARED = ("peers", "clients")
SINGLE = ("udpin", "udpout", "tcpin", "tcpout", "wsin", "wsout", "serial")
LETTERS = "ABCDEFGH"


class Net:
    """net[1], net[2], ...: ends of one kind around a router; a list of kinds gives each its own.
    options={1: "in_block=ATTITUDE"}."""

    def __init__(self, spawn, kind, count=2, options=None, rules=None, extra=()):
        kinds = [kind] * count if isinstance(kind, str) else list(kind)
        self.ends, self._accept = [], []
        self.options = options or {}
        urls = self._shared(kind, count) if kind in SHARED else [self._single(k, i) for i, k in enumerate(kinds)]
        self.router = Router(spawn, *urls, *extra, rules=rules)
        self._join(kinds)

    def __getitem__(self, number) -> End:
        return self.ends[number - 1]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for end in self.ends:
            end.close()

    def _shared(self, kind, count):
        if kind == "peers":
            port = udp_port()
            self.ends = [UdpEnd(("127.0.0.1", port)) for _ in range(count)]
            return [f"udpin://127.0.0.1:{port}"]
        port = tcp_port()
        self._accept = [lambda: tcp_client(port)] * count
        return [f"tcpin://127.0.0.1:{port}"]

    def _single(self, kind, index):
        import websocket_end  # which imports TcpEnd
        label = LETTERS[index]
        query = f"name={label}&{self.options[index + 1]}" if index + 1 in self.options else f"name={label}"
        if kind == "serial":
            self.ends.append(SerialEnd(label))
            return f"serial://{self.ends[-1].device}?{query}"
        if kind == "udpin":
            port = udp_port()
            self.ends.append(UdpEnd(("127.0.0.1", port), label))
            return f"udpin://127.0.0.1:{port}?{query}"
        if kind == "udpout":
            near = udp_port()
            self.ends.append(UdpEnd(("127.0.0.1", near), label))
            return f"udpout://127.0.0.1:{self.ends[-1].port}?bind=127.0.0.1:{near}&{query}"
        if kind in ("tcpin", "wsin"):
            port = tcp_port()
            connect = tcp_client if kind == "tcpin" else websocket_end.client
            self._accept.append(lambda: connect(port, label))
            self.ends.append(None)
            return f"{kind}://127.0.0.1:{port}?{query}"
        server = socket.create_server(("127.0.0.1", 0))
        server.settimeout(harness.DEFAULT_TIMEOUT_S)

        def accept():
            with server:
                return TcpEnd(server.accept()[0], label) if kind == "tcpout" else websocket_end.accepted(server, label)
        self._accept.append(accept)
        self.ends.append(None)
        return f"{kind}://127.0.0.1:{server.getsockname()[1]}?{query}"

    def _join(self, kinds):
        """Waits until every link is up. A UDP peer is none before it has spoken: it does, as system 0, which teaches no
        route."""
        for accept in self._accept:
            end = accept()
            if None in self.ends:
                self.ends[self.ends.index(None)] = end
            else:
                self.ends.append(end)
        silent = [end for end, kind in zip(self.ends, kinds) if kind in ("peers", "udpin")]
        others = len(self.ends) - len(silent)
        for count, end in enumerate(silent, 1):
            end.send(heartbeat((0, 0)))
            harness.wait_for(lambda: len(self.router.links()) >= count, what="a peer")
        harness.wait_for(lambda: len(self.router.links()) >= others + len(silent), what="all links")
        if silent and not self.options:
            self.settle()

    def settle(self):
        """Receives and drops the frames that are on their way."""
        self._mark(1, range(1, len(self.ends) + 1))

    def _mark(self, start, watched) -> dict:
        """The frames that each watched end gets before a broadcast from `start`, and `start` itself before one from
        another end."""
        got = {}
        mark = heartbeat((0, 0))
        self[start].send(mark)
        for number in watched:
            if number != start:
                got[number] = self[number].until(mark)
        if start in watched and len(self.ends) > 1:
            back = heartbeat((0, 0))
            other = next(n for n in range(1, len(self.ends) + 1) if n != start)
            self[other].send(back)
            got[start] = self[start].until(back)
            for number in watched:
                if number not in (start, other):
                    self[number].until(back)
        return got

    def send(self, number, *sent, watched=None) -> list:
        """The ends that got the frame (of several: a list for each), byte for byte and once."""
        for frame in sent:
            self[number].send(frame)
        got = self._mark(number, watched or range(1, len(self.ends) + 1))
        for end, received in got.items():
            assert all(received.count(frame) <= 1 for frame in sent), f"twice at {end}"
            assert all(frame in sent for frame in received), f"others at {end}: {[frame.hex() for frame in received]}"
            assert received == [frame for frame in sent if frame in received], f"another order at {end}"
        reached = [sorted(end for end, received in got.items() if frame in received) for frame in sent]
        return reached[0] if len(sent) == 1 else reached

    def hears(self, number, source) -> list:
        return self.send(number, heartbeat(source))

    def command(self, number, source, target) -> list:
        return self.send(number, command(source, target))

    def link(self, number) -> dict:
        return self.router.link_of(self[number])
