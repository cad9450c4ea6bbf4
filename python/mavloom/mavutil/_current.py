# SPDX-License-Identifier: MIT
"""The module that mavutil.mavlink is now: its dialect and its MAVLink version, as pymavlink has them for a process."""
from __future__ import annotations

import os
import threading

from .._core import Dialect, dialect_key
from .._errors import UsageError
from ._module import MavlinkModule, make_module

NAME = "mavloom.mavutil.mavlink"
VERSION_2 = "MAVLINK20"  # the environment variable
# pymavlink's dialects. Ours has the messages of all of them.
DIALECTS = frozenset({"ASLUAV", "AVSSUAS", "all", "ardupilotmega", "autoquad", "common", "csAirLink",
                      "cubepilot", "development", "icarous", "loweheiser", "marsh", "matrixpilot", "minimal",
                      "paparazzi", "standard", "stemstudios", "storm32", "test", "uAvionix", "ualberta"})

lock = threading.Lock()
modules: dict[tuple[bytes, int], MavlinkModule] = {}  # by file of the dialect, and version
link_ids = 0


def version_from_environment() -> int:
    return 2 if VERSION_2 in os.environ else 1


def module_of(dialect: Dialect, version: int) -> MavlinkModule:
    key = (dialect_key(dialect), version)
    if key not in modules:
        modules.setdefault(key, make_module(NAME, dialect, version))
    return modules[key]


current = module_of(Dialect(), version_from_environment())


def module() -> MavlinkModule:
    return current


def use(new: MavlinkModule) -> MavlinkModule:
    from .. import mavutil
    global current
    current = new
    setattr(mavutil, "mavlink", new)
    return new


def change_to_version_2() -> MavlinkModule:
    os.environ[VERSION_2] = "1"
    return use(module_of(current.dialect, 2))


def dialect_of(given: str | Dialect | os.PathLike[str]) -> Dialect:
    """The dialect of an argument: one of pymavlink's names, a path of an XML file, or a Dialect."""
    if isinstance(given, Dialect):
        return given
    if isinstance(given, str) and given in DIALECTS:
        return Dialect()
    if os.fspath(given).endswith(".xml"):
        return Dialect(given)
    raise UsageError(f"no dialect {given!r}: the built-in definitions have all public messages; for your own, pass the "
                     "path of an XML file or a mavloom.Dialect")


def next_link_id() -> int:
    """A signing link id of its own for each connection of the process."""
    global link_ids
    with lock:
        link_id, link_ids = link_ids, (link_ids + 1) % 256
    return link_id
