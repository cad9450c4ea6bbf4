# SPDX-License-Identifier: MIT
"""Finds the path of a mission: the items that the vehicle flies to, in their order."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

# MAV_CMD. WITH_PLACE are the commands with hasLocation in the definitions that ArduPilot's missions use.
LOITERS = frozenset({17, 18, 19, 31})
WITH_PLACE = frozenset({16, 17, 18, 19, 21, 22, 23, 24, 25, 31, 34, 35, 36, 80, 81, 82, 84, 85, 94, 179, 188, 189, 192,
                        195, 201, 252})
NAV_LAND, NAV_VTOL_LAND, DO_JUMP, DO_LAND_START = 21, 85, 177, 189


def has_place(w: Any) -> bool:
    """Whether the vehicle flies to an item. DO_LAND_START only marks where a landing begins."""
    return w.command in WITH_PLACE and w.command != DO_LAND_START and bool(w.x or w.y)


def path(items: Sequence[Any]) -> list[int]:
    """Returns the numbers of the items with a place, from the first item to a landing, the end, or a repeated item.

    As in pymavlink, a jump adds its target twice.
    """
    found: list[int] = []
    seen: set[int] = set()
    at = 0
    while 0 <= at < len(items):
        begins_with_mark = items[at].command == DO_LAND_START and not found
        if begins_with_mark or has_place(items[at]):
            found.append(at)
        if at in seen or items[at].command in (NAV_LAND, NAV_VTOL_LAND):
            break
        if begins_with_mark or items[at].command != DO_LAND_START:
            seen.add(at)
        if items[at].command == DO_JUMP:
            at = int(items[at].param1)
            found += [at] if 0 <= at < len(items) and has_place(items[at]) else []
        else:
            at += 1
    return found
