# SPDX-License-Identifier: MIT
"""pymavlink's mavutil over Mavloom's links and recordings: `from mavloom import mavutil` in place of
`from pymavlink import mavutil`.

    conn = mavutil.mavlink_connection("udpin:0.0.0.0:14550")
    conn.wait_heartbeat()
    conn.mav.command_long_send(conn.target_system, conn.target_component, mavutil.mavlink.MAV_CMD_..., 0, ...)
    msg = conn.recv_match(type="ATTITUDE", blocking=True, timeout=2)

The interface is that of pymavlink 2.4.50; docs/guide/from-pymavlink.md lists what differs. A connection's `link` is the
mavloom.Link behind it. `mavlink` is the module of constants, enums and message classes.
"""
from __future__ import annotations

import copy
import operator
import os
import sys
import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .._core import Dialect
from .._errors import UsageError
from . import _current, _live, _logs, _urls
from ._conditions import evaluate_condition, evaluate_expression
from ._services import mavfile as mavfile
from ._current import NAME as _NAME
from ._helpers import (SerialPort, all_printable, auto_detect_serial, auto_detect_serial_unix, decode_bitmask,
                       dump_message_unit_decoder, dump_message_verbose, is_printable, location, periodic_event,
                       set_close_on_exec, u_ord)
from ._live import mavmcast, mavserial, mavtcp, mavtcpin, mavudp, mavwebsocket, mavwebsocket_client
from ._logs import mavlogfile, mavmmaplog
from ._messages import MAVError
from ._modes import (AP_MAV_TYPE_MODE_MAP, AP_MAV_TYPE_MODE_MAP_DEFAULT, auto_mode_flags, interpret_px4_mode,
                     mainstate_mapping_px4, mode_mapping_acm, mode_mapping_apm, mode_mapping_blimp,
                     mode_mapping_byname, mode_mapping_bynumber, mode_mapping_rover, mode_mapping_sub,
                     mode_mapping_tracker, mode_string_acm, mode_string_apm, mode_string_px4, mode_string_v10, px4_map)
from ._modes import *  # noqa: F403
from ._module import x25crc
from ._state import mavfile_state, param_state

if TYPE_CHECKING:
    from . import mavlink as mavlink
else:
    mavlink = _current.module()
    sys.modules[_NAME] = mavlink
# Names of pymavlink's module that have no meaning here, and what to use.
NOT_HERE = {
    "mavuds": _urls.REFUSED["uds"],
    "mavchildexec": "start the program yourself and connect to its port",
    "MavlinkSerialPort": "send and receive SERIAL_CONTROL messages with mavlink_connection()",
    "mavexpression": "evaluate_expression() and evaluate_condition() evaluate text",
    "auto_detect_serial_win32": "the package runs on Linux; use auto_detect_serial()",
}
if not TYPE_CHECKING:
    def __getattr__(name: str) -> Any:
        if name in NOT_HERE:
            raise AttributeError(f"mavloom.mavutil has no {name}: {NOT_HERE[name]}")
        raise AttributeError(f"module 'mavloom.mavutil' has no attribute {name!r}")

current_dialect = "all"
default_native = False
have_ascii = True
mavfile_global: mavfile | None = None
UDP_MAX_PACKET_LEN = 65535


def mavlink10() -> bool:
    """Always True, as in pymavlink: MAVLink 0.9 is not supported."""
    return True


def mavlink20() -> bool:
    """Whether MAVLINK20 is in the environment, so that connections send MAVLink 2 from the start.

    As in pymavlink, the first message of MAVLink 2 that arrives sets it.
    """
    return "MAVLINK20" in os.environ


def add_message(messages: dict[str, Any], mtype: str, msg: Any) -> None:
    """Adds a message to a dictionary: under its type, and under "TYPE[INSTANCE]" if it has instances."""
    newest, field = msg, getattr(msg, "_instance_field", None)
    if field is not None:
        instance, before = getattr(msg, field), messages.get(mtype)
        newest = copy.copy(msg)
        newest._instances = {**(getattr(before, "_instances", None) or {}), instance: msg}
        messages[f"{mtype}[{instance}]"] = msg
    messages[mtype] = newest


def set_dialect(dialect: str | Dialect | os.PathLike[str], with_type_annotations: bool | None = None) -> None:
    """Sets the definitions of `mavlink` and of the connections that are opened from now on.

    `dialect` is one of pymavlink's names (the built-in definitions have the messages of all of them), the path of an
    XML file, or a mavloom.Dialect.
    """
    global current_dialect
    _current.use(_current.module_of(_current.dialect_of(dialect), _current.version_from_environment()))
    current_dialect = dialect if isinstance(dialect, str) else _current.module().DIALECT


def _check(system: int, component: int, unknown: dict[str, Any]) -> tuple[int, int]:
    for keyword in unknown:
        warnings.warn(f"mavlink_connection() has no keyword {keyword!r}; it is ignored, as by pymavlink", stacklevel=3)
    for what, number in (("source_system", system), ("source_component", component)):
        if not hasattr(number, "__index__") or not 0 <= number <= 255:
            raise UsageError(f"{what}: {number!r} is out of range, 0 to 255")
    return operator.index(system), operator.index(component)


def mavlink_connection(device: str | os.PathLike[str], baud: int = 115200, source_system: int = 255,
                       source_component: int = 0, planner_format: object = None, write: bool = False,
                       append: bool = False, robust_parsing: bool = True, notimestamps: bool = False,
                       input: bool = True, dialect: str | Dialect | None = None, autoreconnect: bool = False,
                       zero_time_base: bool = False, retries: int = 3, reconnect_delay: float = 1,
                       use_native: bool = False, force_connected: bool = False,
                       progress_callback: Callable[[int], object] | None = None, udp_timeout: float = 0,
                       **opts: Any) -> mavfile:
    """Opens a connection or a recording.

    `device` is one of pymavlink's strings: "udpin:0.0.0.0:14550", "udpout:HOST:PORT", "udp:HOST:PORT" and "HOST:PORT"
    (which bind, or send with input=False), "udpbcast:", "mcast:", "tcp:", "tcpin:", "ws:", "wsserver:",
    "/dev/ttyACM0", "/dev/ttyACM0,57600", or the path of a recording. An endpoint of ours ("udpin://...",
    docs/guide/endpoints.md) works as well.

    `udpin:` and `udpbcast:` forget a program that was silent for `udp_timeout` seconds; 0: never.

    These are accepted and have no effect: use_native, zero_time_base, and robust_parsing without notimestamps.
    """
    global mavfile_global
    source_system, source_component = _check(source_system, source_component, opts)
    if dialect is not None:
        set_dialect(dialect)
    target = _urls.target_of(device)
    if target.kind != "file":
        mavfile_global = _live.open_target(target, (source_system, source_component), {
            "baud": baud, "input": input, "autoreconnect": autoreconnect, "retries": retries,
            "reconnect_delay": reconnect_delay, "force_connected": force_connected, "udp_timeout": udp_timeout})
    elif write or append or notimestamps or planner_format:
        mavfile_global = mavlogfile(target.rest, planner_format, write, append, robust_parsing, notimestamps,
                                    source_system, source_component)
    else:
        mavfile_global = mavmmaplog(target.rest, progress_callback, source_system, source_component)
    return mavfile_global
