# SPDX-License-Identifier: MIT
"""Errors for names that do not exist here: names that pymavlink and DroneKit have, and names that are misspelt."""
from __future__ import annotations

from collections.abc import Iterable
from typing import Any

VEHICLE = "link.vehicle()"
PLACE = "link.latest(\"GLOBAL_POSITION_INT\")"
LINK = {
    "recv_msg": "link.recv(timeout=0)", "write": "link.forward(frame)", "location": PLACE,
    "message_hooks": "for m in link.subscribe(\"NAME\"): ...", "setup_logfile": "link.record(path)",
    "setup_signing": "the options sign= and verify= of the endpoint", "mode": f"{VEHICLE}.mode",
    "flightmode": f"{VEHICLE}.mode", "mode_mapping": f"{VEHICLE}.modes", "set_mode": f"{VEHICLE}.set_mode(name)",
    "armed": f"{VEHICLE}.armed", "motors_armed": f"{VEHICLE}.armed", "arm": f"{VEHICLE}.arm()",
    "arducopter_arm": f"{VEHICLE}.arm()", "disarm": f"{VEHICLE}.disarm()", "arducopter_disarm": f"{VEHICLE}.disarm()",
    "takeoff": f"{VEHICLE}.takeoff(altitude)", "command": f"{VEHICLE}.command(name, ...)",
    "params": f"{VEHICLE}.params", "param_fetch_all": f"{VEHICLE}.params.fetch()",
    "param_fetch_one": f"{VEHICLE}.params[name]", "param_set_send": f"{VEHICLE}.params[name] = value",
    "mission": f"{VEHICLE}.mission", "waypoint_count_send": f"{VEHICLE}.mission.upload(items)",
    "waypoint_request_list_send": f"{VEHICLE}.mission.download()",
}
OF_VEHICLE = {
    "parameters": "vehicle.params", "commands": "vehicle.mission", "flightmode": "vehicle.mode",
    "simple_takeoff": "vehicle.takeoff(altitude)", "rtl": "vehicle.return_to_launch()", "location": PLACE,
    "simple_goto": "link.send(\"SET_POSITION_TARGET_GLOBAL_INT\", ...)", "attitude": "link.latest(\"ATTITUDE\")",
    "battery": "link.latest(\"BATTERY_STATUS\")",
}
SET_ON_VEHICLE = {"mode": "vehicle.set_mode(name)", "armed": "vehicle.arm() and vehicle.disarm()"}
MODULE = {
    "mavutil": "from mavloom import mavutil", "mavlink": "mavloom.enums, or mavutil.mavlink of mavloom.mavutil",
    "mavlink_connection": "mavloom.connect(url), or mavlink_connection of mavloom.mavutil",
    "open": "mavloom.connect(url)", "hear": "python -m mavloom.hear",
}


def no_attribute(owner: Any, name: str, hints: dict[str, str]) -> AttributeError:
    """The error for an attribute that does not exist. Python adds the nearest name."""
    what = f"'{type(owner).__name__}' object has no attribute '{name}'"
    return AttributeError(with_hint(what, name, hints), name=name, obj=owner)


def with_hint(text: str, name: str, hints: dict[str, str]) -> str:
    return f"{text}; use {hints[name]}" if name in hints else text


def near(name: str, names: Iterable[str]) -> str:
    """The end of an error about an unknown name: the nearest name, if one is near."""
    import difflib  # only for errors: the import takes time
    found = difflib.get_close_matches(name, names, 1)
    return f"; did you mean {found[0]}?" if found else ""
