# SPDX-License-Identifier: MIT
"""Flight modes by name and number. The table is compiled: include/mavloom/message/modes.hpp."""
from __future__ import annotations

from ._core import flight_modes, mode_number

AUTOPILOT_ARDUPILOT, AUTOPILOT_PX4 = 3, 12
CUSTOM_MODE_ENABLED = 1  # MAV_MODE_FLAG


def mode_name(autopilot: int, vehicle_type: int, base_mode: int, custom_mode: int) -> str:
    """The name of the mode that a HEARTBEAT reports; "Mode(5)" if it has none."""
    if not base_mode & CUSTOM_MODE_ENABLED:
        return f"Mode(0x{base_mode:08x})"
    return flight_modes(autopilot, vehicle_type).get(custom_mode, f"Mode({custom_mode})")


def mode_names(autopilot: int, vehicle_type: int) -> list[str]:
    return sorted(flight_modes(autopilot, vehicle_type).values())


def custom_mode_of(autopilot: int, vehicle_type: int, name: str) -> int | None:
    """The custom mode of a name: PX4's, ArduPilot's, QGroundControl's, pymavlink's or mavros'; in any case."""
    return mode_number(autopilot, vehicle_type, name)


def px4_mode(custom_mode: int) -> tuple[int, int]:
    """The main mode and the sub mode of a PX4."""
    return custom_mode >> 16 & 0xff, custom_mode >> 24 & 0xff
