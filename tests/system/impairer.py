# SPDX-License-Identifier: MIT
"""A bad network in user space, for UDP and TCP on this machine: delay, jitter, reordering, duplication, loss, all from
one seed.

The fate of the n-th datagram of a direction depends on the seed and on n only, never on when it came.
Tests give the generator of the fixture `rng`, which prints MAVLOOM_SEED and takes it."""
import contextlib
import dataclasses
import heapq
import itertools
import random
import selectors
import socket
import struct
import threading
import time

MAX_BYTES = 65536


@dataclasses.dataclass(frozen=True)
class Profile:
    """Of one direction. Probabilities from 0 to 1, times in seconds. Jitter alone never changes the order;
    `reorder` lets those behind overtake."""
    delay: float = 0
    jitter: float = 0
    loss: float = 0
    duplicate: float = 0
    reorder: float = 0
    reorder_by: float = 0.02


class Direction:
    """Decides for one direction and keeps what became of each datagram."""

    def __init__(self, profile, seed):
        self.profile, self._random, self._last = profile, random.Random(seed), 0.0
        # datagrams; `cut`: they were under way, or came, when the link was dead
        self.delivered, self.lost, self.cut = [], [], []
        self.taken = self.reordered = self.duplicated = 0

    def times(self, now):
        """When copies of the next datagram come out; none: it is lost."""
        # the same four draws whatever becomes of it
        lost, twice, overtaken, spread = (self._random.random() for _ in range(4))
        profile = self.profile
        if lost < profile.loss:
            return []
        due = now + profile.delay + spread * profile.jitter
        if overtaken < profile.reorder:
            self.reordered += 1
            return [due + profile.reorder_by]
        due = self._last = max(due, self._last)
        if twice < profile.duplicate:
            self.duplicated += 1
            return [due, due]
        return [due]


class Impairer:
    """A thread that passes on what comes, when it is due."""

    def __init__(self):
        self._due, self._number = [], itertools.count()
        self._selector = selectors.DefaultSelector()
        self._lock = threading.Lock()
        self._poke, poked = socket.socketpair()
        self._selector.register(poked, selectors.EVENT_READ, lambda: poked.recv(64))
        self._sockets = [self._poke, poked]
        self._ended = False
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        with self._lock:
            self._ended = True
        self._poke.send(b".")
        self._thread.join()
        for sock in self._sockets:
            sock.close()
        self._selector.close()

    def _watch(self, sock, call):
        sock.setblocking(False)
        self._sockets.append(sock)
        self._selector.register(sock, selectors.EVENT_READ, call)

    def _at(self, when, call):
        heapq.heappush(self._due, (when, next(self._number), call))

    def _run(self):
        while not self._ended:
            wait = max(0.0, self._due[0][0] - time.monotonic()) if self._due else None
            ready = self._selector.select(wait)
            with self._lock:
                for key, _ in ready:
                    if key.fd >= 0:  # it may have been closed by one before it
                        key.data()
                while self._due and self._due[0][0] <= time.monotonic():
                    heapq.heappop(self._due)[2]()


class UdpImpairer(Impairer):
    """Listens at `port` of 127.0.0.1 for one caller and passes its datagrams on to `target`;
    what comes from there goes back to it."""

    def __init__(self, target, rng, forth=Profile(), back=None):
        super().__init__()
        self.target = target
        self.forth = Direction(forth, rng.getrandbits(64))
        self.back = Direction(back or forth, rng.getrandbits(64))
        self._near, self._far = (self._bound() for _ in range(2))
        self._caller, self._alive = None, True
        self.port = self._near.getsockname()[1]
        self.far_port = self._far.getsockname()[1]
        self._watch(self._near, self._from_caller)
        self._watch(self._far, lambda: self._take(self._far, self.back, self._near))

    @staticmethod
    def _bound():
        sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8 << 20)
        sock.bind(("127.0.0.1", 0))
        return sock

    def kill(self):
        """From now on nothing passes, what is under way included. It is in `cut`."""
        with self._lock:
            self._alive = False

    def revive(self):
        with self._lock:
            self._alive = True

    def become(self, profile):
        """From now on, both ways."""
        with self._lock:
            self.forth.profile = self.back.profile = profile

    @property
    def idle(self) -> bool:
        """All that was taken has met its fate."""
        with self._lock:
            return not self._due

    def _from_caller(self):
        self._take(self._near, self.forth, self._far)

    def _take(self, sock, direction, out):
        for _ in range(256):
            try:
                datagram, source = sock.recvfrom(MAX_BYTES)
            except BlockingIOError:
                return
            except ConnectionError:  # ICMP: nobody listened for an earlier one
                continue
            if sock is self._near:
                self._caller = source
            direction.taken += 1
            times = direction.times(time.monotonic())
            if not times:
                direction.lost.append(datagram)
            for when in times:
                self._at(when, lambda d=datagram: self._deliver(out, direction, d))

    def _deliver(self, out, direction, datagram):
        to = self.target if out is self._far else self._caller
        if not self._alive or to is None:
            direction.cut.append(datagram)
            return
        with contextlib.suppress(ConnectionError):
            out.sendto(datagram, to)
        direction.delivered.append(datagram)


class TcpImpairer(Impairer):
    """Accepts at `port` of 127.0.0.1 and connects each caller with `target`.
    Bytes come late and cut at random places, never out of order."""

    def __init__(self, target, rng, delay=0.0, jitter=0.0, max_bytes=1400):
        super().__init__()
        self.target, self.delay, self.jitter, self.max_bytes = target, delay, jitter, max_bytes
        self._random = random.Random(rng.getrandbits(64))
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        self._pairs = []
        self._watch(self._listener, self._accept)
        self.connections = 0

    def reset(self):
        """Breaks every connection without a goodbye; new ones are accepted."""
        with self._lock:
            for pair in list(self._pairs):
                self._close(pair, abruptly=True)

    def _accept(self):
        near, _ = self._listener.accept()
        try:
            far = socket.create_connection(self.target, timeout=10)
        except OSError:
            near.close()
            return
        self.connections += 1
        pair = {"ends": (near, far), "last": [0.0, 0.0], "open": True}
        self._pairs.append(pair)
        for side in (0, 1):
            self._watch(pair["ends"][side], lambda side=side: self._take(pair, side))

    def _take(self, pair, side):
        try:
            data = pair["ends"][side].recv(self._random.randint(1, self.max_bytes))
        except BlockingIOError:
            return
        except OSError:
            self._close(pair, abruptly=True)
            return
        due = time.monotonic() + self.delay + self._random.random() * self.jitter
        due = pair["last"][side] = max(due, pair["last"][side])
        if not data:
            self._selector.unregister(pair["ends"][side])
        self._at(due, lambda: self._pass_on(pair, 1 - side, data))

    def _pass_on(self, pair, to, data):
        if not pair["open"]:
            return
        end = pair["ends"][to]
        if not data:
            self._close(pair)
            return
        try:
            end.setblocking(True)
            end.sendall(data)
            end.setblocking(False)
        except OSError:
            self._close(pair, abruptly=True)

    def _close(self, pair, abruptly=False):
        if not pair["open"]:
            return
        pair["open"] = False
        self._pairs.remove(pair)
        for end in pair["ends"]:
            with contextlib.suppress(KeyError, ValueError):
                self._selector.unregister(end)
            if abruptly:
                end.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            end.close()
