# SPDX-License-Identifier: MIT
"""pymavlink's functions and tables of flight modes."""
from __future__ import annotations

from typing import Any

from .. import _modes
from .._core import flight_modes


SUBMARINE, LAST_OF_SUB = 12, 19  # pymavlink lacks two later modes of submarines


def _names(vehicle_type: int) -> dict[int, str]:
    names = flight_modes(_modes.AUTOPILOT_ARDUPILOT, vehicle_type)
    return {number: name for number, name in names.items() if vehicle_type != SUBMARINE or number <= LAST_OF_SUB}


mode_mapping_apm = _names(1)  # MAV_TYPE: a fixed wing
mode_mapping_acm = _names(2)  # a quadrotor
mode_mapping_rover = _names(10)
mode_mapping_tracker = _names(5)
mode_mapping_sub = _names(12)
mode_mapping_blimp = _names(7)
AP_MAV_TYPE_MODE_MAP_DEFAULT = {vehicle_type: _names(vehicle_type) for vehicle_type in
                                (1, 2, 3, 4, 5, 7, 10, 11, 12, 13, 14, 15, 19, 20, 21, 29, 35)}
AP_MAV_TYPE_MODE_MAP = dict(AP_MAV_TYPE_MODE_MAP_DEFAULT)

# pymavlink's names of PX4's modes: (base mode, main mode, sub mode). The base modes are those that a PX4 reports in its
# HEARTBEAT: custom (1) with manual input (64) and stabilisation (16), or with stabilisation, guidance (8) and auto (4).
MANUAL, STABILISED, AUTOMATIC = 65, 81, 29
px4_map = {
    "MANUAL": (STABILISED, 1, 0), "STABILIZED": (STABILISED, 7, 0), "ACRO": (MANUAL, 5, 0), "RATTITUDE": (MANUAL, 8, 0),
    "ALTCTL": (STABILISED, 2, 0), "POSCTL": (STABILISED, 3, 0), "LOITER": (AUTOMATIC, 4, 3),
    "MISSION": (AUTOMATIC, 4, 4), "RTL": (AUTOMATIC, 4, 5), "LAND": (AUTOMATIC, 4, 6), "RTGS": (AUTOMATIC, 4, 7),
    "FOLLOWME": (AUTOMATIC, 4, 8), "OFFBOARD": (AUTOMATIC, 6, 0), "TAKEOFF": (AUTOMATIC, 4, 2),
}
PX4_AUTO = 4  # the main mode whose sub modes are modes of their own
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
        return slow_link_name(msg.autopilot, msg.type, msg.custom_mode)
    return mode_name(msg.autopilot, msg.type, msg.base_mode, msg.custom_mode)


def mode_name(autopilot: int, vehicle_type: int, base_mode: int, custom_mode: int) -> str:
    """The name of the mode that a HEARTBEAT reports."""
    if autopilot == _modes.AUTOPILOT_PX4:
        return interpret_px4_mode(base_mode, custom_mode)
    if not base_mode & _modes.CUSTOM_MODE_ENABLED:
        return f"Mode(0x{base_mode:08x})"
    return ardupilot_name(vehicle_type, custom_mode)


def slow_link_name(autopilot: int, vehicle_type: int, custom_mode: int) -> str:
    """The name of the mode that a HIGH_LATENCY2 reports. Its 16 bits cannot hold the mode of a PX4."""
    if autopilot == _modes.AUTOPILOT_PX4:
        return f"Mode({custom_mode})"
    return ardupilot_name(vehicle_type, custom_mode)


def ardupilot_name(vehicle_type: int, custom_mode: int) -> str:
    """The name of an ArduPilot mode; "Mode(5)" if it is not in the tables."""
    return AP_MAV_TYPE_MODE_MAP_DEFAULT.get(vehicle_type, {}).get(custom_mode, f"Mode({custom_mode})")


def interpret_px4_mode(base_mode: int, custom_mode: int) -> str:
    """The name of a PX4's mode; "UNKNOWN" for one that is not in `px4_map`."""
    main, sub = _modes.px4_mode(custom_mode)
    for name, (_, one_main, one_sub) in px4_map.items():
        if main == one_main and (main != PX4_AUTO or sub == one_sub):
            return name
    return "UNKNOWN"


def px4_numbers(name: str) -> tuple[int, int, int] | None:
    """(base mode, main mode, sub mode) of a name in `px4_map` or in any vocabulary; None if there is no such mode."""
    if name in px4_map:
        return px4_map[name]
    custom_mode = _modes.custom_mode_of(_modes.AUTOPILOT_PX4, 0, name)
    if custom_mode is None:
        return None
    main, sub = _modes.px4_mode(custom_mode)
    return next((mode for mode in px4_map.values() if mode[1:] == (main, sub)), (_modes.CUSTOM_MODE_ENABLED, main, sub))


def mode_string_px4(MainState: int) -> str:
    return mainstate_mapping_px4.get(MainState, "Unknown")


def mode_string_apm(mode_number: int) -> str:
    """The name of a mode of ArduPilot's planes."""
    return mode_mapping_apm.get(mode_number, f"Mode({mode_number})")


def mode_string_acm(mode_number: int) -> str:
    """The name of a mode of ArduPilot's copters."""
    return mode_mapping_acm.get(mode_number, f"Mode({mode_number})")


def mode_mapping_bynumber(mav_type: int) -> dict[int, str] | None:
    """{number: name} of a MAV_TYPE; None if ArduPilot has no modes for it."""
    return AP_MAV_TYPE_MODE_MAP.get(mav_type)


def mode_mapping_byname(mav_type: int) -> dict[str, int] | None:
    """{name: number} of a MAV_TYPE; None if ArduPilot has no modes for it."""
    modes = mode_mapping_bynumber(mav_type)
    return None if modes is None else {name: number for number, name in modes.items()}
