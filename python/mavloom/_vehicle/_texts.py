# SPDX-License-Identifier: MIT
"""The texts that a vehicle sends when it refuses a command.

Source: STATUSTEXT in common.xml. A text of more than 50 characters arrives in several messages with one `id`.
"""
from __future__ import annotations

import time
from collections.abc import Generator

from .._core import Message
from ._exchange import wait_until

AFTER_REFUSAL_S = 0.5  # ArduPilot and PX4 queue their texts, so these may follow the answer to the command
BETWEEN_TEXTS_S = 0.1
NOTICE = 5  # MAV_SEVERITY; texts of INFO and DEBUG report routine work


class Texts:
    """The texts since a command was sent."""

    def __init__(self) -> None:
        self._texts: list[str] = []
        self._long_id = 0  # of the last text, if more parts of it may follow

    def note(self, message: Message) -> None:
        """Takes a STATUSTEXT."""
        if message["severity"] > NOTICE:
            return
        if self._long_id and message["chunk_seq"] > 0 and message["id"] == self._long_id:
            self._texts[-1] += message["text"]
            return
        self._long_id = message["id"]
        self._texts.append(message["text"])

    def late_ones(self) -> Generator[float, Message | None, None]:
        """Waits for texts that follow a refusal."""
        latest = time.monotonic() + AFTER_REFUSAL_S
        end = time.monotonic() + BETWEEN_TEXTS_S if self._texts else latest
        while (answer := (yield from wait_until(end))) is not None:
            if answer.name == "STATUSTEXT":
                self.note(answer)
                end = min(time.monotonic() + BETWEEN_TEXTS_S, latest)

    def found(self) -> tuple[str, ...]:
        """The texts, each once. PX4 ends a text that it also sends as an event with a tab."""
        return tuple(dict.fromkeys(text.strip() for text in self._texts))
