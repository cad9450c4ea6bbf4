# SPDX-License-Identifier: MIT
"""Exclusive exchanges: transfers with one vehicle that would interfere if two ran at once. They take turns.

The turns of a link are shared by all its Vehicle and AsyncVehicle objects, and by all threads and tasks.
"""
from __future__ import annotations

import threading
import time
from collections import defaultdict, deque
from collections.abc import Hashable

from .._core import Message
from ._exchange import Peer, Protocol, T

POLL_S = 0.01  # how often a waiting exchange checks whether it is its turn


class ExchangeQueues:
    """The queues of exchanges, one for each kind. The first of a queue has its turn."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._queues: dict[Hashable, deque[object]] = defaultdict(deque)
        self._progress: dict[Hashable, float] = {}

    def join(self, key: Hashable, ticket: object) -> None:
        with self._lock:
            self._queues[key].append(ticket)

    def leave(self, key: Hashable, ticket: object) -> None:
        with self._lock:
            self._queues[key].remove(ticket)
            if not self._queues[key]:
                del self._queues[key]
                self._progress.pop(key, None)

    def is_first(self, key: Hashable, ticket: object) -> bool:
        with self._lock:
            return self._queues[key][0] is ticket

    def note_progress(self, key: Hashable) -> None:
        self._progress[key] = time.monotonic()

    def progress(self, key: Hashable) -> float:
        """When the vehicle last answered the exchange that has its turn (time.monotonic()); 0 if never."""
        return self._progress.get(key, 0.0)


def exclusive(peer: Peer, what: str, patience_s: float, protocol: Protocol[T]) -> Protocol[T]:
    """Runs a protocol when no other exchange of this kind runs with the vehicle.

    Raises TimeoutError if the exchange in front gets no answer for `patience_s`.
    """
    queues, key, ticket = peer.link._exchanges, (peer.system, peer.component, what), object()
    queues.join(key, ticket)
    try:
        yield from wait_for_turn(peer, queues, key, ticket, patience_s)
        answer: Message | None = None
        while True:
            answer = yield protocol.send(answer)
            if answer is not None and answer.name not in ("HEARTBEAT", "STATUSTEXT"):
                queues.note_progress(key)
    except StopIteration as end:
        result: T = end.value
        return result
    finally:
        protocol.close()
        queues.leave(key, ticket)


def wait_for_turn(peer: Peer, queues: ExchangeQueues, key: tuple[int, int, str], ticket: object,
                  patience_s: float) -> Protocol[None]:
    """Waits for the turn, then discards the answers to earlier exchanges."""
    begin = time.monotonic()
    waited = False
    while not queues.is_first(key, ticket):
        waited = True
        if time.monotonic() > max(begin, queues.progress(key)) + patience_s:
            raise TimeoutError(f"{peer}: {key[2]}: another call that does the same has had no answer for "
                               f"{patience_s:g} s")
        yield POLL_S
    while waited and (yield 0.0) is not None:
        pass
