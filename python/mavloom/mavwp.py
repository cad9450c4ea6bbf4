# SPDX-License-Identifier: MIT
"""Missions in files, with the interface of pymavlink's mavwp: MAVWPLoader reads and writes "QGC WPL 110"."""
from __future__ import annotations

import os
import time
from typing import Any

from . import mavutil
from ._errors import Error, UsageError

HEADER = "QGC WPL 110"
GLOBAL_RELATIVE_ALT, GLOBAL_TERRAIN_ALT, NAV_WAYPOINT = 3, 10, 16  # MAV_FRAME, MAV_CMD
FIELDS = 12  # of a line


class MAVWPError(Error):
    """The file is not a mission. The text names file and line."""

    def __init__(self, msg: str) -> None:
        super().__init__(msg)
        self.message = msg


class MAVWPLoader:
    """A list of MISSION_ITEM messages."""

    def __init__(self, target_system: int = 0, target_component: int = 0) -> None:
        self.wpoints: list[Any] = []
        self.target_system = target_system
        self.target_component = target_component
        self.last_change = 0.0

    def __repr__(self) -> str:
        return f"<MAVWPLoader for {self.target_system}/{self.target_component}, {self.count()} items>"

    def count(self) -> int:
        """The number of items."""
        return len(self.wpoints)

    __len__ = count

    def item(self, i: int) -> Any:
        """The item with this number."""
        return self.wpoints[i]

    wp = item

    def add(self, w: Any, comment: str = "") -> None:
        """Appends an item, and gives it the next number."""
        w.comment = comment
        w.seq = self.count()
        self.wpoints.append(w)
        self._changed()

    def insert(self, idx: int, w: Any, comment: str = "") -> None:
        """Inserts an item before number `idx`."""
        w.comment = comment
        self.wpoints[idx:idx] = [w]
        self.reindex()

    def set(self, w: Any, idx: int) -> None:
        """Replaces item number `idx`. Appends `w` if `idx` is the number of items."""
        w.seq = idx
        if idx == self.count():
            self.wpoints.append(w)
        elif idx < self.count():
            self.wpoints[idx] = w
        else:
            raise MAVWPError(f"there is no item {idx}: the mission has {self.count()}")
        self._changed()

    def remove(self, w: Any) -> None:
        self.wpoints.remove(w)
        self.reindex()

    def clear(self) -> None:
        self.wpoints = []
        self._changed()

    def reindex(self) -> None:
        """Numbers the items again, from 0."""
        for number, w in enumerate(self.wpoints):
            w.seq = number
        self._changed()

    def _changed(self) -> None:
        self.last_change = time.time()

    def mav_mission_type(self) -> int:
        return 0

    def add_latlonalt(self, lat: float, lon: float, altitude: float, terrain_alt: bool = False) -> None:
        """Appends a waypoint at `lat` and `lon` in degrees.

        `altitude` is in metres above home, or above the terrain with `terrain_alt`.
        """
        frame = GLOBAL_TERRAIN_ALT if terrain_alt else GLOBAL_RELATIVE_ALT
        self.add(self._item(0, frame, NAV_WAYPOINT, 0, 1, 0, 0, 0, 0, lat, lon, altitude))

    def _item(self, *values: Any) -> Any:
        return mavutil.mavlink.MAVLink_mission_item_message(self.target_system, self.target_component, *values)

    def load(self, filename: str | os.PathLike[str]) -> int:
        """Replaces the items with those of a file, and returns how many. Raises MAVWPError if it is not a mission."""
        with open(os.fspath(filename), encoding="utf-8") as file:
            lines = file.read().splitlines()
        if not lines or lines[0].strip() != HEADER:
            raise MAVWPError(f"{os.fspath(filename)}: the first line must be {HEADER!r}")
        loaded = []
        for number, line in enumerate(lines[1:], 2):
            words = line.split()
            if not words or words[0].startswith("#"):
                continue
            try:
                loaded.append(self._parsed(words))
            except (ValueError, UsageError) as error:
                raise MAVWPError(f"{os.fspath(filename)}:{number}: {error}") from None
        self.clear()
        for w in loaded:
            self.add(w, w.comment)
        return self.count()

    def _parsed(self, words: list[str]) -> Any:
        if len(words) != FIELDS:
            raise UsageError(f"an item has {FIELDS} values, not {len(words)}")
        seq, current, frame, command = (int(word) for word in words[:4])
        params = [float(word) for word in words[4:11]]
        w = self._item(seq, frame, command, current, int(float(words[11])), *params)
        w.comment = ""
        return w

    def save(self, filename: str | os.PathLike[str]) -> None:
        """Writes the items to a file."""
        with open(os.fspath(filename), "w", encoding="utf-8") as file:
            file.write(HEADER + "\n")
            for w in self.wpoints:
                file.write(f"{w.seq}\t{w.current}\t{w.frame}\t{w.command}\t{w.param1:f}\t{w.param2:f}\t{w.param3:f}\t"
                           f"{w.param4:f}\t{w.x:.10f}\t{w.y:.10f}\t{w.z:f}\t{w.autocontinue}\n")
