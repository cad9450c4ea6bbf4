# SPDX-License-Identifier: MIT
"""Missions and fences in files, with the interface of pymavlink's mavwp.

MAVWPLoader reads and writes "QGC WPL 110", MAVFenceLoader the fences of old ArduPilots.
"""
from __future__ import annotations

import copy
import os
import time
from typing import Any

from . import _mission_path, mavutil
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
    """A list of MISSION_ITEM messages. `add` and `insert` copy the items that they take."""

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
        """The item with this number; None if the mission is shorter."""
        return self.wpoints[i] if i < self.count() else None

    wp = item

    def add(self, w: Any, comment: str = "") -> None:
        """Appends a copy of an item, or of each item of a list, with the next number."""
        for one in list(w) if isinstance(w, list) else [w]:
            made = commented(one, comment)
            made.seq = self.count()
            self.wpoints.append(made)
        self._changed()

    def insert(self, idx: int, w: Any, comment: str = "") -> None:
        """Inserts a copy of an item, or of each item of a list, before number `idx`."""
        self.wpoints[idx:idx] = [commented(one, comment) for one in (w if isinstance(w, list) else [w])]
        self.reindex()

    def set(self, w: Any, idx: int) -> None:
        """Replaces item number `idx`. Appends `w` if `idx` is the number of items."""
        w.seq = idx
        if idx > self.count():
            raise MAVWPError(f"there is no item {idx}: the mission has {self.count()}")
        if idx == self.count():
            return self.add(w)
        self.wpoints[idx] = w
        self._changed()

    def remove(self, w: Any) -> None:
        """Removes an item, or each item of a list."""
        for one in list(w) if isinstance(w, list) else [w]:
            self.wpoints.remove(one)
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

    def wp_is_loiter(self, i: int) -> bool:
        """Whether item number `i` loiters."""
        return self.wpoints[i].command in _mission_path.LOITERS

    def is_location_command(self, cmd: int) -> bool:
        """Whether items with this MAV_CMD have a latitude and longitude."""
        return cmd in _mission_path.WITH_PLACE

    def is_location_wp(self, w: Any) -> bool:
        """Whether the vehicle flies to an item's latitude and longitude."""
        return _mission_path.has_place(w)

    def view_indexes(self) -> list[int]:
        """The numbers of the items with a place, in the order of the flight. Each jump is followed once."""
        return _mission_path.path(self.wpoints)

    def polygon(self) -> list[tuple[float, float]]:
        """The places of `view_indexes` as (latitude, longitude)."""
        return [(self.wpoints[i].x, self.wpoints[i].y) for i in self.view_indexes()]

    def add_latlonalt(self, lat: float, lon: float, altitude: float, terrain_alt: bool = False) -> None:
        """Appends a waypoint at `lat` and `lon` in degrees.

        `altitude` is in metres above home, or above the terrain with `terrain_alt`.
        """
        frame = GLOBAL_TERRAIN_ALT if terrain_alt else GLOBAL_RELATIVE_ALT
        self.add(self._item(0, frame, NAV_WAYPOINT, 0, 0, 0, 0, 0, 0, lat, lon, altitude))

    def _item(self, *values: Any) -> Any:
        return mavutil.mavlink.MAVLink_mission_item_message(self.target_system, self.target_component, *values)

    def load(self, filename: str | os.PathLike[str]) -> int:
        """Replaces the items with those of a file, and returns how many. Raises MAVWPError if it is not a mission."""
        with open(os.fspath(filename), encoding="utf-8") as file:
            lines = file.read().splitlines()
        if not lines or lines[0].strip() != HEADER:
            raise MAVWPError(f"{os.fspath(filename)}: the first line must be {HEADER!r}")
        loaded, comment = [], ""
        for number, line in enumerate(lines[1:], 2):
            words = line.split()
            if line.startswith("#"):
                comment = line[1:].strip()
            if not words or words[0].startswith("#"):
                continue
            try:
                loaded.append(commented(self._parsed(words), comment))
                comment = ""
            except (ValueError, UsageError) as error:
                raise MAVWPError(f"{os.fspath(filename)}:{number}: {error}") from None
        self.clear()
        self.add(loaded)
        return self.count()

    def _parsed(self, words: list[str]) -> Any:
        if len(words) != FIELDS:
            raise UsageError(f"an item has {FIELDS} values, not {len(words)}")
        seq, current, frame, command = (int(word) for word in words[:4])
        params = [float(word) for word in words[4:11]]
        if seq == 0 and command == 0:  # home, as Mission Planner writes it
            command = NAV_WAYPOINT
        return self._item(seq, frame, command, current, int(float(words[11])), *params)

    def save(self, filename: str | os.PathLike[str]) -> None:
        """Writes the items to a file."""
        with open(os.fspath(filename), "w", encoding="utf-8") as file:
            file.write(HEADER + "\n")
            for w in self.wpoints:
                if text := getattr(w, "comment", ""):
                    file.write(f"# {' '.join(text.splitlines())}\n")
                file.write(f"{w.seq}\t{w.current}\t{w.frame}\t{w.command}\t{w.param1:f}\t{w.param2:f}\t{w.param3:f}\t"
                           f"{w.param4:f}\t{w.x:.10f}\t{w.y:.10f}\t{w.z:f}\t{w.autocontinue}\n")


def commented(w: Any, comment: str) -> Any:
    """Returns a copy of an item with `comment`; if that is empty, with the comment of the item."""
    made = copy.copy(w)
    made.comment = comment or getattr(w, "comment", "")
    return made


class MAVFenceError(Error):
    """The file is not a fence. The text names file and line."""

    def __init__(self, msg: str) -> None:
        super().__init__(msg)
        self.message = msg


class MAVFenceLoader:
    """A fence of FENCE_POINT messages: the return point, then a polygon whose last point is its first one again."""

    def __init__(self, target_system: int = 0, target_component: int = 0) -> None:
        self.points: list[Any] = []
        self.target_system = target_system
        self.target_component = target_component
        self.last_change = 0.0

    def __repr__(self) -> str:
        return f"<MAVFenceLoader for {self.target_system}/{self.target_component}, {self.count()} points>"

    def count(self) -> int:
        """The number of points, with the return point."""
        return len(self.points)

    __len__ = count

    def point(self, i: int) -> Any:
        """The point with this number."""
        return self.points[i]

    def add(self, p: Any) -> None:
        """Appends a copy of a point."""
        self.points.append(copy.copy(p))
        self.reindex()

    def add_latlon(self, lat: float, lon: float) -> None:
        """Appends a point at `lat` and `lon` in degrees."""
        make = mavutil.mavlink.MAVLink_fence_point_message
        self.add(make(self.target_system, self.target_component, 0, 0, lat, lon))

    def move(self, i: int, lat: float, lng: float, change_time: bool = True) -> None:
        """Moves point number `i`. The first and the last point of the polygon move together."""
        last = self.count() - 1
        for number in (1, last) if i in (1, last) else (i,):
            self.points[number].lat, self.points[number].lng = lat, lng
        if change_time:
            self.last_change = time.time()

    def remove(self, i: int, change_time: bool = True) -> None:
        """Removes point number `i`. The polygon stays closed."""
        before = self.last_change
        self.points.pop(i)
        if i == 1 and self.count() > 1:
            self.points[-1].lat, self.points[-1].lng = self.points[1].lat, self.points[1].lng
        self.reindex()
        if not change_time:
            self.last_change = before

    def clear(self) -> None:
        self.points = []
        self.last_change = time.time()

    def reindex(self) -> None:
        """Numbers the points again, from 0."""
        for number, p in enumerate(self.points):
            p.idx, p.count = number, self.count()
            p.target_system, p.target_component = self.target_system, self.target_component
        self.last_change = time.time()

    def polygon(self) -> list[tuple[float, float]]:
        """The polygon as (latitude, longitude), without the return point."""
        return [(p.lat, p.lng) for p in self.points[1:]]

    def load(self, filename: str | os.PathLike[str]) -> int:
        """Replaces the points with those of a file, "LATITUDE LONGITUDE" in each line. Returns how many."""
        with open(os.fspath(filename), encoding="utf-8") as file:
            lines = file.read().splitlines()
        places = [place_in(f"{os.fspath(filename)}:{number}", line.split()) for number, line in enumerate(lines, 1)
                  if line.strip() and not line.startswith("#")]
        self.clear()
        for place in places:
            self.add_latlon(*place)
        return self.count()

    def save(self, filename: str | os.PathLike[str]) -> None:
        """Writes the points to a file."""
        with open(os.fspath(filename), "w", encoding="utf-8") as file:
            file.writelines(f"{p.lat:f}\t{p.lng:f}\n" for p in self.points)


def place_in(where: str, words: list[str]) -> tuple[float, float]:
    try:
        lat, lng = map(float, words)
    except ValueError:
        raise MAVFenceError(f"{where}: a line has a latitude and a longitude, not {' '.join(words)!r}") from None
    return lat, lng
