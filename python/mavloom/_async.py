# SPDX-License-Identifier: MIT
"""Iteration on an asyncio loop, without an executor: each reader has one descriptor that the loop watches.

The loop thread of the links signals the descriptors of links. One thread serves the descriptors of all rings.
"""
from __future__ import annotations

import asyncio
import contextlib
import os
from collections.abc import Callable
from typing import AsyncGenerator, TypeVar

from ._core import Message, Record, RecordBatch, RecordBatches, RingReader, Subscription
from ._errors import ClosedError, UsageError

T = TypeVar("T")

MAX_AT_ONCE = 256  # messages or records before other tasks on the loop get their turn
RING_POLL_S = 1.0  # deleting a ring's file by hand wakes no reader, so check at this interval

waiting: set[int] = set()  # descriptors on which a task waits now
os.register_at_fork(after_in_child=waiting.clear)


def messages(subscription: Subscription) -> AsyncGenerator[Message, None]:
    """Yields messages until the link or the subscription is closed."""
    return each(subscription, lambda: subscription.recv(0))


def records(reader: RingReader) -> AsyncGenerator[Record, None]:
    """Yields records until the ring is removed or the reader is closed."""
    return each(reader, reader.poll, poll_s=RING_POLL_S)


def batches(source: RecordBatches, timeout: float | None) -> AsyncGenerator[RecordBatch, None]:
    """Like `records`, but yields batches, and also ends if no record arrives for `timeout` seconds."""
    return each(source, source.poll, most=1, timeout=timeout, poll_s=RING_POLL_S)


async def each(source: Subscription | RingReader | RecordBatches, poll: Callable[[], T | None],
               most: int = MAX_AT_ONCE, timeout: float | None = None,
               poll_s: float | None = None) -> AsyncGenerator[T, None]:
    """Yields what `poll` returns, until it raises ClosedError or the source is silent for `timeout` seconds.

    If `poll` returns None, waits for the source's descriptor. Calls `poll` again after `poll_s` seconds at the
    latest.
    """
    descriptor = source.event_fd()
    check_free(descriptor)
    loop = asyncio.get_running_loop()
    given, deadline = 0, None
    while True:
        try:
            found = poll()
        except ClosedError:
            return
        if found is None:
            if deadline is None and timeout is not None:
                deadline = loop.time() + timeout
            left = None if deadline is None else deadline - loop.time()
            if left is not None and left <= 0:
                return
            await readable(descriptor, min((s for s in (left, poll_s) if s is not None), default=None))
            continue
        yield found
        given, deadline = given + 1, None
        if given % most == 0:
            await asyncio.sleep(0)


def check_free(descriptor: int) -> None:
    if descriptor in waiting:
        raise UsageError("another task waits on this reader: give each task its own (link.subscribe(), "
                         "or another RingReader)")


async def readable(descriptor: int, timeout: float | None) -> None:
    """Waits until the descriptor is readable, or for `timeout` seconds.

    Stops watching the descriptor after each wait, not when the generator ends. If a task leaves its loop (`break`),
    asyncio ends the generator late, when the next loop over the same reader may already be running.
    """
    check_free(descriptor)
    loop = asyncio.get_running_loop()
    ready = asyncio.Event()
    loop.add_reader(descriptor, ready.set)
    timer = None if timeout is None else loop.call_later(timeout, ready.set)
    waiting.add(descriptor)
    try:
        await ready.wait()
    finally:
        waiting.discard(descriptor)
        if timer is not None:
            timer.cancel()
        if not loop.is_closed():
            loop.remove_reader(descriptor)
    with contextlib.suppress(BlockingIOError):
        os.read(descriptor, 8)
