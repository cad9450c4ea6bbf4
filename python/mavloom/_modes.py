# SPDX-License-Identifier: MIT
"""Flight modes by name and number.

ArduPilot: the modes in the firmware's documentation and in the enums COPTER_MODE, PLANE_MODE, ... of the dialect, under
the names that ground stations show. PX4: `custom_mode` of HEARTBEAT is (sub mode << 24 | main mode << 16), see
https://docs.px4.io (px4_custom_mode.h).
"""
from __future__ import annotations

PLANE = {
    0: "MANUAL", 1: "CIRCLE", 2: "STABILIZE", 3: "TRAINING", 4: "ACRO", 5: "FBWA", 6: "FBWB", 7: "CRUISE",
    8: "AUTOTUNE", 10: "AUTO", 11: "RTL", 12: "LOITER", 13: "TAKEOFF", 14: "AVOID_ADSB", 15: "GUIDED",
    16: "INITIALISING", 17: "QSTABILIZE", 18: "QHOVER", 19: "QLOITER", 20: "QLAND", 21: "QRTL", 22: "QAUTOTUNE",
    23: "QACRO", 24: "THERMAL", 25: "LOITERALTQLAND", 26: "AUTOLAND",
}
COPTER = {
    0: "STABILIZE", 1: "ACRO", 2: "ALT_HOLD", 3: "AUTO", 4: "GUIDED", 5: "LOITER", 6: "RTL", 7: "CIRCLE",
    8: "POSITION", 9: "LAND", 10: "OF_LOITER", 11: "DRIFT", 13: "SPORT", 14: "FLIP", 15: "AUTOTUNE", 16: "POSHOLD",
    17: "BRAKE", 18: "THROW", 19: "AVOID_ADSB", 20: "GUIDED_NOGPS", 21: "SMART_RTL", 22: "FLOWHOLD", 23: "FOLLOW",
    24: "ZIGZAG", 25: "SYSTEMID", 26: "AUTOROTATE", 27: "AUTO_RTL", 28: "TURTLE", 29: "RATE_ACRO",
}
ROVER = {
    0: "MANUAL", 1: "ACRO", 2: "LEARNING", 3: "STEERING", 4: "HOLD", 5: "LOITER", 6: "FOLLOW", 7: "SIMPLE", 8: "DOCK",
    9: "CIRCLE", 10: "AUTO", 11: "RTL", 12: "SMART_RTL", 15: "GUIDED", 16: "INITIALISING",
}
TRACKER = {0: "MANUAL", 1: "STOP", 2: "SCAN", 4: "GUIDED", 10: "AUTO", 16: "INITIALISING"}
SUB = {0: "STABILIZE", 1: "ACRO", 2: "ALT_HOLD", 3: "AUTO", 4: "GUIDED", 7: "CIRCLE", 9: "SURFACE", 16: "POSHOLD",
       19: "MANUAL"}
BLIMP = {0: "LAND", 1: "MANUAL", 2: "VELOCITY", 3: "LOITER", 4: "RTL", 5: "AUTO", 6: "HOLD"}

# MAV_TYPE: fixed wing, quadrotor, coaxial, helicopter, antenna tracker, airship, rover, boat, submarine, hexarotor,
# octorotor, tricopter, four kinds of VTOL, dodecarotor, decarotor.
ARDUPILOT = {1: PLANE, 2: COPTER, 3: COPTER, 4: COPTER, 5: TRACKER, 7: BLIMP, 10: ROVER, 11: ROVER, 12: SUB,
             13: COPTER, 14: COPTER, 15: COPTER, 19: PLANE, 20: PLANE, 21: PLANE, 29: COPTER, 35: COPTER}

# PX4: (base mode, main mode, sub mode). The base modes are those that a PX4 reports in its HEARTBEAT: custom (1) with
# manual input (64) and stabilisation (16), or with stabilisation, guidance (8) and auto (4).
MANUAL, STABILISED, AUTOMATIC = 65, 81, 29
PX4 = {
    "MANUAL": (STABILISED, 1, 0), "STABILIZED": (STABILISED, 7, 0), "ACRO": (MANUAL, 5, 0), "RATTITUDE": (MANUAL, 8, 0),
    "ALTCTL": (STABILISED, 2, 0), "POSCTL": (STABILISED, 3, 0), "LOITER": (AUTOMATIC, 4, 3),
    "MISSION": (AUTOMATIC, 4, 4), "RTL": (AUTOMATIC, 4, 5), "LAND": (AUTOMATIC, 4, 6), "RTGS": (AUTOMATIC, 4, 7),
    "FOLLOWME": (AUTOMATIC, 4, 8), "OFFBOARD": (AUTOMATIC, 6, 0), "TAKEOFF": (AUTOMATIC, 4, 2),
}
PX4_AUTO = 4  # the main mode whose sub modes are modes of their own

AUTOPILOT_ARDUPILOT, AUTOPILOT_PX4 = 3, 12
CUSTOM_MODE_ENABLED = 1  # MAV_MODE_FLAG


def px4_name(custom_mode: int) -> str:
    """The name of a PX4 mode; "UNKNOWN" if it is not in the table."""
    main, sub = custom_mode >> 16 & 0xff, custom_mode >> 24 & 0xff
    for name, (_, one_main, one_sub) in PX4.items():
        if main == one_main and (main != PX4_AUTO or sub == one_sub):
            return name
    return "UNKNOWN"


def mode_name(autopilot: int, vehicle_type: int, base_mode: int, custom_mode: int) -> str:
    """The name of the mode that a HEARTBEAT reports."""
    if autopilot == AUTOPILOT_PX4:
        return px4_name(custom_mode)
    if not base_mode & CUSTOM_MODE_ENABLED:
        return f"Mode(0x{base_mode:08x})"
    return ardupilot_name(vehicle_type, custom_mode)


def slow_link_name(autopilot: int, vehicle_type: int, custom_mode: int) -> str:
    """The name of the mode that a HIGH_LATENCY2 reports. Its 16 bits cannot hold the mode of a PX4."""
    if autopilot == AUTOPILOT_PX4:
        return f"Mode({custom_mode})"
    return ardupilot_name(vehicle_type, custom_mode)


def ardupilot_name(vehicle_type: int, custom_mode: int) -> str:
    """The name of an ArduPilot mode; "Mode(5)" if it is not in the tables."""
    return ARDUPILOT.get(vehicle_type, {}).get(custom_mode, f"Mode({custom_mode})")


def ardupilot_modes(vehicle_type: int) -> dict[str, int] | None:
    """The modes of a type of vehicle as {name: number}; None if ArduPilot has no modes for it."""
    modes = ARDUPILOT.get(vehicle_type)
    return None if modes is None else {name: number for number, name in modes.items()}
