# SPDX-License-Identifier: MIT
"""Runs protocols: generators that send messages, and yield how many seconds they wait for the next answer."""
from __future__ import annotations

import time
from collections.abc import Generator, Iterable
from typing import TYPE_CHECKING, Any, TypeVar

from .. import _silence
from .._core import Message, Subscription

if TYPE_CHECKING:
    from .._link import Link

T = TypeVar("T")
# Yields the seconds to wait; is sent the next answer, or None after that time; returns the result.
Protocol = Generator[float, "Message | None", T]


class Peer:
    """The vehicle at the other end: where requests go and whose answers count."""

    def __init__(self, link: Link, system: int, component: int) -> None:
        self.link = link
        self.system = system
        self.component = component

    def send(self, name: str, **fields: Any) -> None:
        self.link._port.send(name, target_system=self.system, target_component=self.component, **fields)

    def is_for_us(self, answer: Message) -> bool:
        """Whether an answer is addressed to this link or to everybody."""
        ours = (self.link.mav.srcSystem, self.link.mav.srcComponent)
        for field, own in zip(("target_system", "target_component"), ours):
            if field in answer and answer[field] not in (0, own):
                return False
        return True

    def subscribe(self, types: Iterable[str]) -> Subscription:
        return self.link.subscribe(tuple(types), system=self.system, component=self.component)

    def heartbeat(self) -> Message | None:
        """The newest heartbeat of the vehicle."""
        return self.link.latest("HEARTBEAT", system=self.system, component=self.component)

    def __str__(self) -> str:
        return f"{self.link.name}: system {self.system}"


def wait_until(deadline: float) -> Generator[float, Message | None, Message | None]:
    """Waits for the next answer until a deadline (time.monotonic())."""
    return (yield max(0.0, deadline - time.monotonic()))


def explained(peer: Peer, error: TimeoutError) -> TimeoutError:
    """The error with what the link knows about the silence."""
    if peer.heartbeat() is not None and not peer.link.stats.hints:
        return error
    return TimeoutError(f"{error}: {_silence.reason(peer.link, peer.system)}")


def run(peer: Peer, types: Iterable[str], protocol: Protocol[T]) -> T:
    """Runs a protocol in this thread. `types` are the messages that it waits for."""
    answers = peer.subscribe(types)
    try:
        wait = next(protocol)
        while True:
            wait = protocol.send(answers.recv(wait))
    except StopIteration as end:
        result: T = end.value
        return result
    except TimeoutError as error:
        raise explained(peer, error) from None
    finally:
        protocol.close()
        answers.close()


async def run_async(peer: Peer, types: Iterable[str], protocol: Protocol[T]) -> T:
    """Runs a protocol on the asyncio loop."""
    answers = peer.subscribe(types)
    try:
        wait = next(protocol)
        while True:
            wait = protocol.send(await next_of(answers, wait))
    except StopIteration as end:
        result: T = end.value
        return result
    except TimeoutError as error:
        raise explained(peer, error) from None
    finally:
        protocol.close()
        answers.close()


async def next_of(answers: Subscription, wait: float) -> Message | None:
    import asyncio  # only for programs that use it: importing it takes longer than all of this package

    from .. import _async
    loop = asyncio.get_running_loop()
    deadline = loop.time() + wait
    while (message := answers.recv(0)) is None and (left := deadline - loop.time()) > 0:
        await _async.readable(answers.event_fd(), left)
    return message
