# SPDX-License-Identifier: MIT
"""pymavlink's functions and tables of flight modes."""
from __future__ import annotations

from typing import Any

from .. import _modes

mode_mapping_apm = _modes.PLANE
mode_mapping_acm = _modes.COPTER
mode_mapping_rover = _modes.ROVER
mode_mapping_tracker = _modes.TRACKER
mode_mapping_sub = _modes.SUB
mode_mapping_blimp = _modes.BLIMP
AP_MAV_TYPE_MODE_MAP_DEFAULT = _modes.ARDUPILOT
AP_MAV_TYPE_MODE_MAP = dict(_modes.ARDUPILOT)
px4_map = _modes.PX4
# The numbers of a mode in old recordings of PX4.
mainstate_mapping_px4 = {0: "MANUAL", 1: "ALTCTL", 2: "POSCTL", 3: "AUTO_MISSION", 4: "AUTO_LOITER", 5: "AUTO_RTL",
                         6: "ACRO", 7: "OFFBOARD", 8: "STAB", 9: "RATTITUDE", 10: "AUTO_TAKEOFF", 11: "AUTO_LAND",
                         12: "AUTO_FOLLOW_TARGET", 13: "MAX"}

PX4_CUSTOM_MAIN_MODE_MANUAL = 1
PX4_CUSTOM_MAIN_MODE_ALTCTL = 2
PX4_CUSTOM_MAIN_MODE_POSCTL = 3
PX4_CUSTOM_MAIN_MODE_AUTO = 4
PX4_CUSTOM_MAIN_MODE_ACRO = 5
PX4_CUSTOM_MAIN_MODE_OFFBOARD = 6
PX4_CUSTOM_MAIN_MODE_STABILIZED = 7
PX4_CUSTOM_MAIN_MODE_RATTITUDE = 8
PX4_CUSTOM_SUB_MODE_OFFBOARD = 0
PX4_CUSTOM_SUB_MODE_AUTO_READY = 1
PX4_CUSTOM_SUB_MODE_AUTO_TAKEOFF = 2
PX4_CUSTOM_SUB_MODE_AUTO_LOITER = 3
PX4_CUSTOM_SUB_MODE_AUTO_MISSION = 4
PX4_CUSTOM_SUB_MODE_AUTO_RTL = 5
PX4_CUSTOM_SUB_MODE_AUTO_LAND = 6
PX4_CUSTOM_SUB_MODE_AUTO_RTGS = 7
PX4_CUSTOM_SUB_MODE_AUTO_FOLLOW_TARGET = 8
auto_mode_flags = 4 | 8 | 16  # MAV_MODE_FLAG: auto, guided, stabilize


def mode_string_v10(msg: Any) -> str:
    """The name of the mode in a HEARTBEAT or HIGH_LATENCY2."""
    if msg.get_type() == "HIGH_LATENCY2":
        return _modes.slow_link_name(msg.autopilot, msg.type, msg.custom_mode)
    return _modes.mode_name(msg.autopilot, msg.type, msg.base_mode, msg.custom_mode)


def interpret_px4_mode(base_mode: int, custom_mode: int) -> str:
    """The name of a PX4's mode; "UNKNOWN" for one that is not in `px4_map`."""
    return _modes.px4_name(custom_mode)


def mode_string_px4(MainState: int) -> str:
    return mainstate_mapping_px4.get(MainState, "Unknown")


def mode_string_apm(mode_number: int) -> str:
    """The name of a mode of ArduPilot's planes."""
    return _modes.PLANE.get(mode_number, f"Mode({mode_number})")


def mode_string_acm(mode_number: int) -> str:
    """The name of a mode of ArduPilot's copters."""
    return _modes.COPTER.get(mode_number, f"Mode({mode_number})")


def mode_mapping_bynumber(mav_type: int) -> dict[int, str] | None:
    """{number: name} of a MAV_TYPE; None if ArduPilot has no modes for it."""
    return AP_MAV_TYPE_MODE_MAP.get(mav_type)


def mode_mapping_byname(mav_type: int) -> dict[str, int] | None:
    """{name: number} of a MAV_TYPE; None if ArduPilot has no modes for it."""
    modes = mode_mapping_bynumber(mav_type)
    return None if modes is None else {name: number for number, name in modes.items()}
