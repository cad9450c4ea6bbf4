# SPDX-License-Identifier: MIT
"""Iteration on an asyncio loop: one descriptor for each reader, no thread and no executor."""
from __future__ import annotations

import asyncio
import contextlib
import os
from typing import AsyncGenerator

from ._core import Message, Subscription
from ._errors import ClosedError, UsageError

MOST_AT_ONCE = 256  # messages, then others on the loop get their turn

waiting: set[int] = set()  # descriptors on which a task waits


async def messages(subscription: Subscription) -> AsyncGenerator[Message, None]:
    """What arrives, until the link or the subscription is closed."""
    descriptor = subscription.event_fd()
    check_free(descriptor)
    given = 0
    while True:
        try:
            message = subscription.recv(0)
        except ClosedError:
            return
        if message is None:
            await readable(descriptor)
            continue
        yield message
        given += 1
        if given % MOST_AT_ONCE == 0:
            await asyncio.sleep(0)


def check_free(descriptor: int) -> None:
    if descriptor in waiting:
        raise UsageError("another task waits on this reader: give each task its own, link.subscribe()")


async def readable(descriptor: int) -> None:
    """Waits until the descriptor tells. Watched no longer than that: a loop that was left is cleaned up late, and the next may have begun."""
    check_free(descriptor)
    loop = asyncio.get_running_loop()
    ready = asyncio.Event()
    loop.add_reader(descriptor, ready.set)
    waiting.add(descriptor)
    try:
        await ready.wait()
    finally:
        waiting.discard(descriptor)
        if not loop.is_closed():
            loop.remove_reader(descriptor)
    with contextlib.suppress(BlockingIOError):
        os.read(descriptor, 8)
