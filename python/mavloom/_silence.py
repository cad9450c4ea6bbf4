# SPDX-License-Identifier: MIT
"""Why no vehicle is heard on a link."""
from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING

from ._core import LinkStats, Message

if TYPE_CHECKING:
    from ._link import Link

PATIENCE_S = 5.0  # of a wait without a time-out, before it states why nothing comes
MAX_NAMED = 5


def reason(link: Link, system: int = 0) -> str:
    """Describes the fault of the link, or who was heard instead of the vehicle. `system` 0 stands for any vehicle."""
    stats = link.stats
    if stats.hints:
        return "; ".join(stats.hints)
    if stats.frames_in:
        return heard(link, stats, system or link.target_system)
    if stats.refused and not stats.bad_signature and not stats.wrong_peer:
        return "the frames sent were refused: no program listens there"
    return f"nothing heard; {link._port.silence_reason}"


def heard(link: Link, stats: LinkStats, system: int) -> str:
    """When the system was last heard, or who else was."""
    beat = link.latest("HEARTBEAT", system=system) if system else None
    if beat is not None:
        return f"its last heartbeat arrived {time.time() - beat.time_ns * 1e-9:.0f} s ago"
    senders = sorted({(source.sys, source.comp) for source in stats.sources})
    names = [f"{system}/{component}" for system, component in senders[:MAX_NAMED]]
    more = [f"{len(senders) - MAX_NAMED} more"] if len(senders) > MAX_NAMED else []
    return f"heard only {', '.join(names + more) or f'{stats.frames_in} frames'} (system/component)"


class Warned:
    """Warns once that a wait for a vehicle finds none."""

    def __init__(self) -> None:
        self._has_warned = False

    def watch(self, link: Link, wait: Callable[[float | None], Message | None],
              timeout: float | None) -> Message | None:
        """Returns what `wait(seconds)` finds within `timeout` seconds. None: waits indefinitely."""
        if self._has_warned or timeout is not None and not isinstance(timeout, (int, float)) or timeout == 0:
            return wait(timeout)
        first = PATIENCE_S if timeout is None or timeout > PATIENCE_S else timeout
        found = wait(first)
        if found is not None:
            return found
        self._has_warned = True
        warnings.warn(f"{link.name}: no vehicle for {first:g} s: {reason(link)}", RuntimeWarning, stacklevel=3)
        return wait(None if timeout is None else timeout - first)
