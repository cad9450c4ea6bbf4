# SPDX-License-Identifier: MIT
"""The state of each system, and the parameters of each component, that a connection has heard."""
from __future__ import annotations

from typing import Any

from .._core import Dialect
from ._module import classes_of

FIXED_WING = 1  # MAV_TYPE, until a heartbeat arrives


class mavfile_state:
    """The state of one system: its newest messages and its mode."""

    def __init__(self) -> None:
        self.messages: dict[str, Any] = {"MAV": self, "HOME": no_position()}
        self.flightmode = "UNKNOWN"
        self.vehicle_type = "UNKNOWN"
        self.mav_type = FIXED_WING
        self.mav_autopilot = 0
        self.base_mode = 0
        self.armed: int | bool = False


class param_state:
    """The parameters of one component."""

    def __init__(self) -> None:
        self.params: dict[str, float] = {}


def no_position() -> Any:
    make: Any = classes_of(Dialect()).of("GPS_RAW_INT")
    return make(*[0] * 10)


class Systems(dict[int, mavfile_state]):
    """The states by system id; those of new systems are made when they are needed."""

    def __missing__(self, system: int) -> mavfile_state:
        return self.setdefault(system, mavfile_state())

    def messages_of(self, system: int) -> dict[str, Any]:
        return self[system].messages
