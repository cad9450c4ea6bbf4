# SPDX-License-Identifier: MIT
"""Iteration on an asyncio loop: one descriptor for each reader, no thread and no executor."""
from __future__ import annotations

import asyncio
import contextlib
import os
from typing import AsyncGenerator

from ._core import Message, Subscription

MOST_AT_ONCE = 256  # messages, then others on the loop get their turn


async def messages(subscription: Subscription) -> AsyncGenerator[Message, None]:
    """What arrives, until the link or the subscription is closed."""
    loop = asyncio.get_running_loop()
    descriptor = subscription.event_fd()
    ready = asyncio.Event()

    def wake() -> None:
        with contextlib.suppress(BlockingIOError):
            os.read(descriptor, 8)
        ready.set()

    loop.add_reader(descriptor, wake)
    try:
        while (batch := subscription.take(MOST_AT_ONCE)) is not None:
            for message in batch:
                yield message
            if batch:
                await asyncio.sleep(0)
            else:
                await ready.wait()
                ready.clear()
    finally:
        if not loop.is_closed():
            loop.remove_reader(descriptor)
