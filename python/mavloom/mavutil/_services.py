# SPDX-License-Identifier: MIT
"""The requests of a connection to its vehicle: modes, arming, parameters, waypoints."""
from __future__ import annotations

import time
from typing import Any

from .. import _modes
from .._errors import UsageError
from . import _modes as tables
from ._connection import Connection
from ._helpers import location

# MAV_CMD and MAV_MODE.
NAV_LOITER_UNLIM, NAV_RETURN_TO_LAUNCH, DO_SET_MODE, DO_SET_RELAY, DO_SET_SERVO = 17, 20, 176, 181, 183
PREFLIGHT_CALIBRATION, PREFLIGHT_REBOOT_SHUTDOWN, MISSION_START, COMPONENT_ARM_DISARM = 241, 246, 300, 400
MODE_MANUAL_ARMED, MODE_STABILIZE_ARMED = 192, 208
PARAM_TYPE_REAL32 = 9  # MAV_PARAM_TYPE
FORCE_REBOOT = 20190226  # ArduPilot reboots in flight with this in param6
PARAM_LIST_PAUSE_S = 2.0  # the least time between two requests for all parameters


def encoded(name: str | bytes) -> bytes:
    """The bytes of a parameter's name. Raises UsageError for anything that is not text."""
    if isinstance(name, (bytes, bytearray)):
        return bytes(name)
    if not isinstance(name, str):
        raise UsageError(f"a parameter has a name, for example 'RTL_ALT', not {name!r:.60}")
    try:
        return name.encode()
    except UnicodeEncodeError:
        raise UsageError(f"the name of a parameter has a lone surrogate: {name!r:.60}") from None


# Attributes of pymavlink's connections that have no meaning here, and the reason.
OWN_THREAD = "the link's own thread connects, and connects again; link.stats reports what happened"
OWN_READER = "recordings are read in C++: use recv_match(type=...), rewind() and percent"
NOT_HERE = {
    "do_connect": OWN_THREAD, "reconnect": OWN_THREAD, "handle_disconnect": OWN_THREAD, "handle_eof": OWN_THREAD,
    "init_arrays": OWN_READER, "skip_to_type": OWN_READER, "f": OWN_READER, "data_map": OWN_READER,
    "offset": OWN_READER, "offsets": OWN_READER, "type_nums": OWN_READER, "instance_offsets": OWN_READER,
    "scan_timestamp": OWN_READER,
    "last_address": "link.stats.sources lists the peers", "destination_addr": "use udpout:HOST:PORT to choose the peer",
    "clients": "link.stats.peers counts the peers", "listen": OWN_THREAD,
}


class Absent:
    """An attribute of pymavlink's connections that has no meaning here: reading it raises an error with the reason.

    Not a method `__getattr__`, which would slow down every other attribute.
    """

    def __init__(self, name: str, advice: str) -> None:
        self.name = name
        self.advice = advice

    def __get__(self, instance: object, owner: type[Any]) -> Any:
        raise AttributeError(f"{owner.__name__} has no {self.name}, because {self.advice}")


class mavfile(Connection):
    """One source of messages, and the way back to it, with pymavlink's interface.

    `link` is the native connection behind it (None for a recording). `mav` sends: `mav.heartbeat_send(...)`. `messages`
    has the newest message of each name from the target system. `target_system` is the first vehicle that was heard.
    """

    def _command(self, command: int, *params: float) -> None:
        send: Any = self.mav.command_long_send
        send(self.target_system, self.target_component, command, 0, *params, *[0] * (7 - len(params)))

    # ---- modes

    def mode_mapping(self) -> Any:
        """{name: mode} of the vehicle: numbers for ArduPilot, (base mode, main mode, sub mode) for PX4."""
        if self._target.mav_autopilot == _modes.AUTOPILOT_PX4:
            return tables.px4_map
        return tables.mode_mapping_byname(self.mav_type)

    def set_mode(self, mode: str | int, custom_mode: int = 0, custom_sub_mode: int = 0) -> None:
        """Requests a flight mode by name or number; of a PX4 also by its three numbers."""
        if self._target.mav_autopilot == _modes.AUTOPILOT_PX4:
            self.set_mode_px4(mode, custom_mode, custom_sub_mode)
        else:
            self.set_mode_apm(mode)

    def set_mode_apm(self, mode: str | int) -> None:
        """Requests a mode of ArduPilot."""
        number: Any = mode
        if isinstance(mode, str):
            number = (self.mode_mapping() or {}).get(mode)  # a script may have changed pymavlink's tables
            if number is None:
                number = _modes.custom_mode_of(_modes.AUTOPILOT_ARDUPILOT, self.mav_type, mode)
            if number is None:
                print(f"Unknown mode '{mode}'")
                return
        self._command(DO_SET_MODE, _modes.CUSTOM_MODE_ENABLED, number)

    def set_mode_px4(self, mode: str | int, custom_mode: int, custom_sub_mode: int) -> None:
        """Requests a mode of PX4, by name or by its three numbers."""
        base_mode: Any = mode
        if isinstance(mode, str):
            numbers = tables.px4_numbers(mode)
            if numbers is None:
                print(f"Unknown mode '{mode}'")
                return
            base_mode, custom_mode, custom_sub_mode = numbers
        self._command(DO_SET_MODE, base_mode, custom_mode, custom_sub_mode)

    def set_mode_flag(self, flag: int, enable: bool) -> None:
        """Requests that a flag of the base mode is set or cleared."""
        self._command(DO_SET_MODE, self.base_mode | flag if enable else self.base_mode & ~flag)

    def set_mode_auto(self) -> None:
        """Starts the mission."""
        self._command(MISSION_START)

    def set_mode_rtl(self) -> None:
        """Requests the return to the launch site."""
        self._command(NAV_RETURN_TO_LAUNCH)

    def set_mode_loiter(self) -> None:
        """Requests circling or hovering at the current position, without a time limit."""
        self._command(NAV_LOITER_UNLIM)

    def set_mode_manual(self) -> None:
        """Requests manual mode, with armed motors."""
        self._command(DO_SET_MODE, MODE_MANUAL_ARMED)

    def set_mode_fbwa(self) -> None:
        """Requests stabilised flight, with armed motors."""
        self._command(DO_SET_MODE, MODE_STABILIZE_ARMED)

    # ---- commands

    def set_servo(self, channel: int, pwm: int) -> None:
        """Sets an output to a pulse length in µs."""
        self._command(DO_SET_SERVO, channel, pwm)

    def set_relay(self, relay_pin: int = 0, state: bool = True) -> None:
        """Switches a relay on or off."""
        self._command(DO_SET_RELAY, relay_pin, bool(state))

    def calibrate_level(self) -> None:
        """Requests the calibration of gyroscope and magnetometer, as in pymavlink."""
        self._command(PREFLIGHT_CALIBRATION, 1, 1)

    def calibrate_pressure(self) -> None:
        """Requests the calibration of the pressure on the ground."""
        self._command(PREFLIGHT_CALIBRATION, 0, 0, 1)

    def reboot_autopilot(self, hold_in_bootloader: bool = False, force: bool = False) -> None:
        """Restarts the autopilot. With `force`, an ArduPilot restarts even in flight."""
        self._command(PREFLIGHT_REBOOT_SHUTDOWN, 3 if hold_in_bootloader else 1, 0, 0, 0, 0,
                      FORCE_REBOOT if force else 0)

    # ---- arming

    def arducopter_arm(self) -> None:
        """Requests that the motors be armed. Works with any autopilot."""
        self._command(COMPONENT_ARM_DISARM, 1)

    def arducopter_disarm(self) -> None:
        """Requests that the motors be disarmed. Works with any autopilot."""
        self._command(COMPONENT_ARM_DISARM, 0)

    def motors_armed(self) -> int | bool:
        """The armed flag (128) of the newest heartbeat; 0 or False if disarmed."""
        armed: int | bool = self.sysid_state[self.target_system].armed
        return armed

    def motors_armed_wait(self) -> None:
        """Waits for the next heartbeat after which the motors are armed."""
        self.wait_heartbeat()
        while not self.motors_armed():
            self.wait_heartbeat()

    def motors_disarmed_wait(self) -> None:
        """Waits for the next heartbeat after which the motors are disarmed."""
        self.wait_heartbeat()
        while self.motors_armed():
            self.wait_heartbeat()

    # ---- waiting

    def wait_heartbeat(self, blocking: bool = True, timeout: float | None = None) -> Any:
        """Returns the next heartbeat of any component; None after `timeout` seconds."""
        return self.recv_match(type="HEARTBEAT", blocking=blocking, timeout=timeout)

    def wait_gps_fix(self) -> None:
        """Waits for a position from GPS in three dimensions."""
        self.recv_match(type="VFR_HUD", blocking=True)
        self.recv_match(type="GPS_RAW_INT", blocking=True,
                        condition="GPS_RAW_INT.fix_type >= 3 and GPS_RAW_INT.lat != 0")

    def location(self, relative_alt: bool = False) -> location:
        """Waits for a position and returns it. `relative_alt`: above home, not above the sea."""
        self.wait_gps_fix()
        self.recv_match(type="VFR_HUD", blocking=True)
        self.recv_match(type="GLOBAL_POSITION_INT", blocking=True)
        hud = self.messages["VFR_HUD"]
        alt = self.messages["GLOBAL_POSITION_INT"].relative_alt * 0.001 if relative_alt else hud.alt
        gps = self.messages["GPS_RAW_INT"]
        return location(gps.lat * 1.0e-7, gps.lon * 1.0e-7, alt, hud.heading)

    # ---- parameters

    def param_fetch_all(self) -> None:
        """Requests all parameters, which then appear in `params`. Does nothing within 2 s of the last request."""
        if time.time() - self.param_fetch_start > PARAM_LIST_PAUSE_S:
            self.param_fetch_start = time.time()
            self.mav.param_request_list_send(self.target_system, self.target_component)

    def param_fetch_one(self, name: str | bytes | int) -> None:
        """Requests one parameter, by name or index. A name that is a number, such as "5", is an index."""
        text: Any = name
        try:
            index, text = int(name), b""
        except (TypeError, ValueError, OverflowError):
            index, text = -1, encoded(text)
        self.mav.param_request_read_send(self.target_system, self.target_component, text, index)

    def param_set_send(self, parm_name: str | bytes, parm_value: float, parm_type: int | None = None) -> None:
        """Sends a new value of a parameter. The type is REAL32 if it is not given."""
        self.mav.param_set_send(self.target_system, self.target_component, encoded(parm_name), parm_value,
                                PARAM_TYPE_REAL32 if parm_type is None else parm_type)

    def param(self, name: str, default: Any = None) -> Any:
        """The last value of a parameter that was received."""
        return self.params.get(name, default)

    # ---- waypoints

    def waypoint_request_list_send(self) -> None:
        """Requests the number of waypoints; the vehicle answers with MISSION_COUNT."""
        self.mav.mission_request_list_send(self.target_system, self.target_component)

    def waypoint_clear_all_send(self) -> None:
        """Requests that all waypoints are deleted."""
        self.mav.mission_clear_all_send(self.target_system, self.target_component)

    def waypoint_request_send(self, seq: int) -> None:
        """Requests one waypoint; the vehicle answers with MISSION_ITEM."""
        self.mav.mission_request_send(self.target_system, self.target_component, seq)

    def waypoint_set_current_send(self, seq: int) -> None:
        """Requests that the vehicle flies to this waypoint next."""
        self.mav.mission_set_current_send(self.target_system, self.target_component, seq)

    def waypoint_current(self) -> int:
        """Waits for the number of the current waypoint."""
        message: Any = self.recv_match(type="MISSION_CURRENT", blocking=True)
        number: int = message.seq
        return number

    def waypoint_count_send(self, seq: int) -> None:
        """Begins an upload of `seq` waypoints; the vehicle requests each."""
        self.mav.mission_count_send(self.target_system, self.target_component, seq)


for _name, _advice in NOT_HERE.items():
    setattr(mavfile, _name, Absent(_name, _advice))
