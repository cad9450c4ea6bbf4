# SPDX-License-Identifier: MIT
"""The enums of a dialect as Python enum classes."""
from __future__ import annotations

import collections.abc
import enum
from typing import TYPE_CHECKING, Any, Iterator, Mapping

from . import _core

if TYPE_CHECKING:
    from ._core import Dialect

EnumClass = type[enum.IntEnum] | type[enum.IntFlag]
# By file and name. Dialects made from one file share their classes, so that members also compare by identity.
_made: dict[tuple[bytes, str], EnumClass] = {}


def make(dialect: Dialect, name: str) -> EnumClass:
    """Returns the class of an enum. The first call creates it."""
    key = (_core.dialect_key(dialect), name)
    if key not in _made:
        bitmask, entries = dialect.enum_entries(name)
        base: Any = enum.IntFlag if bitmask else enum.IntEnum
        return _made.setdefault(key, base(name, entries, module="mavloom.enums"))  # another thread may have created it
    return _made[key]


def entry_name(kind: EnumClass, number: int) -> str | None:
    """Returns the name of an entry; None if the enum has no such number."""
    return next((name for name, member in kind.__members__.items() if member == number), None)


class Enums(Mapping[str, Mapping[int, "enum.IntEnum | enum.IntFlag"]]):
    """{"MAV_CMD": {16: <MAV_CMD.MAV_CMD_NAV_WAYPOINT>, ...}, ...}; each enum is created when it is read."""

    def __init__(self, dialect: Dialect) -> None:
        self._dialect = dialect

    def __getitem__(self, name: str) -> Mapping[int, enum.IntEnum | enum.IntFlag]:
        if name not in self._dialect.enum_names:
            raise KeyError(name)
        return {int(member): member for member in make(self._dialect, name).__members__.values()}

    def __iter__(self) -> Iterator[str]:
        return iter(self._dialect.enum_names)

    def __len__(self) -> int:
        return len(self._dialect.enum_names)
