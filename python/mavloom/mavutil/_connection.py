# SPDX-License-Identifier: MIT
"""Connection: reads messages from live connections and recordings, and keeps the state that they report."""
from __future__ import annotations

import operator
import os
import select
import struct
import time
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, BinaryIO

from .. import _modes
from .._core import MavutilState, MavutilTypes, hides_extensions, is_vehicle
from .._errors import UsageError
from .._hints import near
from . import _current
from . import _modes as tables
from ._conditions import evaluate_condition
from ._messages import MAVLink_message, as_bytes
from ._protocol import signing_time
from ._state import Systems, mavfile_state, param_state

if TYPE_CHECKING:
    from . import mavlink

POSITION_FIX = 3  # GPS_FIX_TYPE: in three dimensions
ARMED = 128  # MAV_MODE_FLAG
LONGEST_PAUSE_S = 0.05  # between two calls of idle hooks, and of `recv` of a program's own class
LONGEST_SLEEP_S = 0.5  # of `select` without a descriptor
LONGEST_WAIT_S = 1_000_000

Types = str | Iterable[str] | None


class Connection:
    """One source of messages, and the way back to it. The class mavfile adds the services of vehicles.

    A program's own class of connections derives from mavfile and defines `recv`, `write` and `close`. `fd`, if there is
    one, is the descriptor that `select` waits for.
    """

    fd: Any = None

    def __init__(self, fd: int | None, address: str, source_system: int = 255, source_component: int = 0,
                 notimestamps: bool = False, input: bool = True, use_native: bool = False) -> None:
        if fd is not None:
            self.fd = fd
        self.address = address
        self.source_system = source_system
        self.source_component = source_component
        self.notimestamps = notimestamps
        self.robust_parsing = True
        self.portdead = False
        self.first_byte = True  # True until the first bytes were examined
        self.stop_on_EOF = True
        self.start_time = time.time()
        self.param_fetch_start: float = 0
        self.target_component = 0
        self._param_system = 0
        # The script may set mav_count and mav_loss. These are added to the counters.
        self._count_offset = 0
        self._loss_offset = 0
        self._set_time: tuple[int, float] | None = None  # time_ns of the last message then, and the time that was set
        self.param_state: dict[tuple[int, int], param_state] = {(0, 0): param_state()}
        self.message_hooks: list[Callable[[Any, MAVLink_message], object]] = []
        self.idle_hooks: list[Callable[[Any], object]] = []
        # Files that are open to write, or other connections.
        self.logfile: Any = None
        self.logfile_raw: Any = None
        self._opened: list[BinaryIO] = []  # by setup_logfile()
        self.sysid_state = Systems()
        self._state = MavutilState(self.sysid_state.messages_of)
        self._types: dict[Any, MavutilTypes] = {}
        self.sysid_state[0]
        self._use(_current.module())

    def _use(self, module: Any) -> None:
        """Sends with the definitions and the MAVLink version of a module, from sequence number 0 on."""
        before = getattr(self, "mav", None)
        self.mav: mavlink.MAVLink = module.MAVLink(self, srcSystem=getattr(before, "srcSystem", self.source_system),
                                                   srcComponent=getattr(before, "srcComponent", self.source_component))
        self.mav.robust_parsing = self.robust_parsing
        self.WIRE_PROTOCOL_VERSION: str = module.WIRE_PROTOCOL_VERSION
        if before is not None:
            self.mav._take_over(before)

    def _change_version(self) -> None:
        """Sends MAVLink 2 from now on if a message of it was received."""
        if self.WIRE_PROTOCOL_VERSION != "2.0" and not hides_extensions(self.mav._dialect):
            self._use(_current.change_to_version_2())

    # ---- defined by the kinds of connections

    def _read(self, timeout: float) -> MAVLink_message | None:
        """Returns the next message that arrives within `timeout` seconds; 0 polls. May return None before that."""
        self.pre_message()
        while True:
            data = self.recv(self.mav.bytes_needed()) or b""
            if data and self.first_byte:
                self.auto_mavlink_version(data)
            message = self.mav._parse(data)
            if message is not None or not data:
                return message

    def _take(self, timeout: float) -> MAVLink_message | None:
        """Returns the next message that arrives within `timeout` seconds, and notes it. May return None before that."""
        message: MAVLink_message | None = self.recv_msg()
        if message is None and timeout > 0:
            self.select(min(timeout, LONGEST_PAUSE_S))
        return message

    def _totals(self) -> tuple[int, int]:
        """How many messages the kind of connection has found by other means than `mav`, and their bytes."""
        return 0, 0

    def _has_ended(self) -> bool:
        """Whether no more messages will come."""
        return False

    def recv(self, n: int | None = None) -> bytes:
        """Returns at most `n` bytes that have arrived; b"" if there are none now."""
        raise UsageError(f"{self.address}: {type(self).__name__} has no method recv()")

    def write(self, buf: bytes) -> Any:
        raise UsageError(f"{self.address}: nothing can be sent here")

    def pre_message(self) -> None:
        """Called before a message is read with `recv`."""

    def select(self, timeout: float) -> bool:
        """Waits until there may be a message, for at most `timeout` seconds. Returns whether there may be one."""
        if self.fd is None:
            time.sleep(min(wait_of(timeout), LONGEST_SLEEP_S))
            return True
        ready, _, _ = select.select([self.fd], [], [], wait_of(timeout))
        return bool(ready)

    def close(self) -> None:
        for file in self._opened:
            file.close()

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *args: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.address}>"

    # ---- receiving

    def recv_msg(self) -> Any:
        """Returns the next message; None if there is none now."""
        message = self._read(0)
        return None if message is None else self._post(message)

    def recv_match(self, condition: str | None = None, type: Types = None, blocking: bool = False,
                   timeout: float | None = None) -> Any:
        """Returns the next message of these types for which the condition is true, and skips those before it.

        None if there is none: at once, with `blocking` after `timeout` seconds, or at the end of a recording. A
        condition is an expression over the newest messages of the sender: "ATTITUDE.roll > 0.1".
        """
        types = self._types_of(type)
        if types is not None and blocking and timeout is None and not types.has_any and not self._has_ended():
            names = [type] if isinstance(type, str) else list(type or ())
            hint = near(names[0], self.mav._dialect.message_names) if names else ""
            raise UsageError(f"type={type!r}: no such message, so this call would wait forever{hint}")
        wait = None if timeout is None else wait_of(timeout)
        blocking = blocking and wait != 0
        end = time.monotonic() + wait if blocking and wait is not None else None
        while True:
            left = 0.0 if not blocking else 3600.0 if end is None else max(0.0, end - time.monotonic())
            message = self._take(min(left, LONGEST_PAUSE_S) if self.idle_hooks else left)
            if message is not None:
                if (types is None or types.takes(message)) and self._agrees(message, condition):
                    return message
            elif self._has_ended():
                return None
            elif blocking:
                for hook in self.idle_hooks:
                    hook(self)
            if message is None and not blocking:
                return None
            if end is not None and time.monotonic() >= end:
                return None

    def _types_of(self, type: Types) -> MavutilTypes | None:
        if type is None:
            return None
        if not isinstance(type, (str, list, tuple, set, frozenset, dict)):
            raise UsageError(f"type= takes names of messages, not {type!r}")
        key = type if isinstance(type, str) else tuple(type)
        if key not in self._types:
            if len(self._types) > 1000:
                self._types.clear()
            self._types[key] = MavutilTypes(self.mav._dialect, (key,) if isinstance(key, str) else key)
        return self._types[key]

    def _agrees(self, message: MAVLink_message, condition: str | None) -> bool:
        """Whether a condition is true of the newest messages of the sender."""
        return condition is None or evaluate_condition(condition, self._state.messages(message.get_srcSystem()))

    def check_condition(self, condition: str | None) -> bool:
        """Whether a condition is true of the newest messages."""
        return evaluate_condition(condition, self.messages)

    def post_message(self, msg: MAVLink_message) -> None:
        """Call this for messages that you parsed yourself (`recv`, `mav.parse_buffer`).

        It updates `messages` and calls the hooks. Does nothing for a message that was noted before.
        """
        concerns_connection = self._state.note(msg)
        if concerns_connection is None:
            return
        if concerns_connection:
            self._notice(msg)
        for hook in self.message_hooks:
            hook(self, msg)

    def _post(self, message: MAVLink_message) -> MAVLink_message:
        if self.mav.signing.secret_key is not None:
            message = self.mav._checked(message)
        if self.mav.callback is not None:
            self.mav.callback(message, *self.mav.callback_args, **self.mav.callback_kwargs)
        if self.logfile is not None or self.logfile_raw is not None:
            self._log(message)
        self.post_message(message)
        return message

    # ---- what some messages mean

    def _notice(self, message: MAVLink_message) -> None:
        name = message.get_type()
        if name == "HEARTBEAT":
            self._notice_heartbeat(message)
        elif name == "HIGH_LATENCY2":
            self._notice_high_latency(message)
        elif name == "PARAM_VALUE":
            source = (message.get_srcSystem(), message.get_srcComponent())
            self.param_state.setdefault(source, param_state()).params[message.param_id] = message.param_value
        elif name == "GPS_RAW_INT":
            messages = self.sysid_state[message.get_srcSystem()].messages
            if messages["HOME"].fix_type < POSITION_FIX:
                messages["HOME"] = message
        else:
            self.sysid_state[0].messages[name] = message

    def _notice_heartbeat(self, message: MAVLink_message) -> None:
        if not self.probably_vehicle_heartbeat(message):
            return
        state = self.sysid_state[message.get_srcSystem()]
        state.flightmode = tables.mode_name(message.autopilot, message.type, message.base_mode, message.custom_mode)
        state.mav_type = message.type
        state.mav_autopilot = message.autopilot
        state.armed = message.base_mode & ARMED

    def _notice_high_latency(self, message: MAVLink_message) -> None:
        """Notes what a vehicle sends in place of heartbeats on a slow link. ArduPilot has its base mode in custom0."""
        if not self.probably_vehicle_heartbeat(message):
            return
        state = self.sysid_state[message.get_srcSystem()]
        state.mav_type = message.type
        state.mav_autopilot = message.autopilot
        state.flightmode = tables.slow_link_name(message.autopilot, message.type, message.custom_mode)
        if message.autopilot == _modes.AUTOPILOT_ARDUPILOT:
            state.base_mode = message.custom0
            state.armed = message.custom0 & ARMED

    def probably_vehicle_heartbeat(self, msg: MAVLink_message) -> bool:
        """Whether a HEARTBEAT is that of a vehicle, by the rule of `Link.wait_heartbeat`."""
        return bool(is_vehicle(msg.type, msg.autopilot))

    # ---- state

    @property
    def target_system(self) -> int:
        """The system that commands go to and whose messages `messages` has: the first vehicle, or what was set."""
        return self._state.target

    @target_system.setter
    def target_system(self, value: int) -> None:
        if not hasattr(value, "__index__") or not 0 <= value <= 255:
            raise UsageError(f"target_system: {value!r} is not a system id, 0 to 255")
        self._state.target = self._param_system = operator.index(value)

    sysid = target_system

    @property
    def param_sysid(self) -> tuple[int, int]:
        """The system and component that the script set as the target; 0 for what it did not set."""
        return self._param_system, self.target_component

    @property
    def _target(self) -> mavfile_state:
        state: mavfile_state = self.sysid_state[self._state.target]
        return state

    @property
    def messages(self) -> dict[str, Any]:
        """The newest messages of the target system: "ATTITUDE", "BATTERY_STATUS[1]". "HOME" is the first position."""
        return self._state.messages(self._state.target)

    @property
    def params(self) -> dict[str, float]:
        """The parameters of the target that were received."""
        component = self.target_component or 1
        return self.param_state.setdefault((self._state.target, component), param_state()).params

    @property
    def flightmode(self) -> str:
        return self._target.flightmode

    @flightmode.setter
    def flightmode(self, value: str) -> None:
        self._target.flightmode = value

    @property
    def vehicle_type(self) -> str:
        return self._target.vehicle_type

    @vehicle_type.setter
    def vehicle_type(self, value: str) -> None:
        self._target.vehicle_type = value

    @property
    def mav_type(self) -> int:
        return self._target.mav_type

    @mav_type.setter
    def mav_type(self, value: int) -> None:
        self._target.mav_type = value

    @property
    def base_mode(self) -> int:
        return self._target.base_mode

    @base_mode.setter
    def base_mode(self, value: int) -> None:
        self._target.base_mode = value

    @property
    def mav_count(self) -> int:
        """The number of messages that were read."""
        return self._state.count + self._count_offset

    @mav_count.setter
    def mav_count(self, value: int) -> None:
        self._count_offset = value - self._state.count

    @property
    def mav_loss(self) -> int:
        """The number of messages that were lost, by sequence numbers. As in pymavlink, one duplicate counts as 255."""
        return self._state.loss + self._loss_offset

    @mav_loss.setter
    def mav_loss(self, value: int) -> None:
        self._loss_offset = value - self._state.loss

    @property
    def last_seq(self) -> dict[tuple[int, int], int]:
        """{(system, component): sequence number} of the last messages."""
        return self._state.last_sequences

    def packet_loss(self) -> float:
        """The loss since the start, or since the counters were set, in percent."""
        total = self.mav_count + self.mav_loss
        return 100.0 * self.mav_loss / total if total else 0

    @property
    def timestamp(self) -> float:
        """The time of the last message, or what was set since."""
        if self._set_time is not None and self._set_time[0] == self._state.time_ns:
            return self._set_time[1]
        return self._state.time_ns // 1000 * 1e-6

    @timestamp.setter
    def timestamp(self, value: float) -> None:
        self._set_time = self._state.time_ns, value

    @property
    def uptime(self) -> float:
        """The clock of the vehicle in seconds, from the last message that has it."""
        return self._state.uptime_s

    def time_since(self, mtype: str) -> float:
        """The seconds since a message of this type; since the start if there was none."""
        message = self.messages.get(mtype)
        return time.time() - (self.start_time if message is None else message._timestamp)

    def field(self, type: str, field: str, default: Any = None) -> Any:
        """The newest value of a field; `default` if there is none."""
        message = self.messages.get(type)
        return default if message is None else getattr(message, field, default)

    def mavlink10(self) -> bool:
        """Always True: MAVLink 0.9 is not supported."""
        return True

    def mavlink20(self) -> bool:
        """Whether messages are sent as MAVLink 2."""
        return self.WIRE_PROTOCOL_VERSION == "2.0"

    # ---- recording

    def setup_logfile(self, logfile: str | os.PathLike[str], mode: str = "wb") -> None:
        """Records every message that is read from now on, in the tlog format."""
        self.logfile = open_to_write(logfile, mode)
        self._opened.append(self.logfile)

    def setup_logfile_raw(self, logfile: str | os.PathLike[str], mode: str = "wb") -> None:
        """Records the bytes of every message that is read from now on, without times."""
        self.logfile_raw = open_to_write(logfile, mode)
        self._opened.append(self.logfile_raw)

    def _log(self, message: MAVLink_message) -> None:
        frame, is_bad = bytes(message.get_msgbuf()), message.get_type() == "BAD_DATA"
        if self.logfile_raw is not None and not (is_bad and isinstance(self.logfile_raw, Connection)):
            self.logfile_raw.write(frame)
        if self.logfile is not None and not is_bad:
            self.logfile.write(struct.pack(">Q", int(message._timestamp * 1.0e6) & ~3) + frame)

    # ---- signing

    def setup_signing(self, secret_key: bytes, sign_outgoing: bool = True,
                      allow_unsigned_callback: Callable[[Any, int], bool] | None = None,
                      initial_timestamp: int | None = None, link_id: int | None = None) -> None:
        """Signs what is sent, and replaces messages without a good signature by BAD_DATA.

        `secret_key` has 32 bytes. `initial_timestamp` counts 10 µs since 2015-01-01 UTC; the default is the current
        time. Signatures that are more than a minute older are refused. `allow_unsigned_callback(mav, message_id)`
        returns whether a message without a good signature is accepted.
        """
        key = as_bytes(secret_key)
        if len(key) != 32:
            raise UsageError(f"a signing key has 32 bytes, not {len(key)}")
        signing = self.mav.signing
        signing.secret_key = key
        signing.sign_outgoing = sign_outgoing
        signing.allow_unsigned_callback = allow_unsigned_callback
        signing.link_id = _current.next_link_id() if link_id is None else link_id
        signing.timestamp = signing_time() if initial_timestamp is None else initial_timestamp

    def disable_signing(self) -> None:
        signing = self.mav.signing
        signing.secret_key = None
        signing.sign_outgoing = False
        signing.allow_unsigned_callback = None
        signing.link_id = 0
        signing.timestamp = 0

    # ---- of serial devices

    def set_rtscts(self, enable: bool) -> None:
        """Does nothing: the endpoint's option `flow=rtscts` turns flow control on."""

    def auto_mavlink_version(self, buf: bytes) -> None:
        """Sends MAVLink 2 from now on if `buf` begins with a frame of it."""
        self.first_byte = self.first_byte and not buf
        if buf[:1] == b"\xfd" and not self.mavlink20():
            self._use(_current.change_to_version_2())


def wait_of(timeout: float) -> float:
    """A time-out in seconds that a system call accepts. Raises UsageError for NaN, and TypeError for text."""
    if isinstance(timeout, (str, bytes)):
        raise TypeError(f"timeout: a number of seconds, not {timeout!r}")
    if timeout != timeout:
        raise UsageError("timeout: nan is not a number of seconds")
    return min(max(0.0, timeout), LONGEST_WAIT_S)


def open_to_write(path: str | os.PathLike[str], mode: str) -> BinaryIO:
    if mode.replace("+", "") not in ("w", "wb", "a", "ab"):
        raise UsageError(f"mode {mode!r}: a log is opened with 'wb' or 'ab'")
    try:
        file: Any = open(os.fspath(path), mode if "b" in mode else mode + "b", buffering=0)
    except UnicodeEncodeError:
        raise UsageError(f"{path!r:.60} is not the name of a file: it has a lone surrogate") from None
    return file  # type: ignore[no-any-return]
