# SPDX-License-Identifier: MIT
"""Recordings of mavloom.mavutil."""
from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from typing import Any, BinaryIO

from .._core import MavutilLog, MavutilTypes
from .._errors import ClosedError, UsageError
from ._connection import Types
from ._services import mavfile
from ._messages import MAVLink_bad_data, MAVLink_message

CHUNK_BYTES = 64 * 1024
FOLLOW_PAUSE_S = 0.05


class mavlogfile(mavfile):
    """A recording that is read from the start to the end, or one that is written (`write` or `append`)."""

    def __init__(self, filename: str | os.PathLike[str], planner_format: object = None, write: bool = False,
                 append: bool = False, robust_parsing: bool = True, notimestamps: bool = False,
                 source_system: int = 255, source_component: int = 0, use_native: bool = False) -> None:
        super().__init__(None, os.fspath(filename), source_system, source_component, notimestamps)
        if planner_format:
            raise UsageError("planner_format: recordings of old planners cannot be read")
        self.filename = os.fspath(filename)
        self.planner_format = None
        self.writeable = write or append
        self.robust_parsing = robust_parsing
        self.mav.robust_parsing = robust_parsing
        self.link = None
        self._ended = False
        self._log_file: MavutilLog | None = None
        self._match: Callable[[Any, MavutilTypes | None], MAVLink_message | None] | None = None
        self._raw_file: BinaryIO | None = None
        self._raw: Iterator[MAVLink_message] = iter(())
        self._raw_totals = (0, 0)
        self._raw_damaged = 0
        self._out: BinaryIO | None = None
        if self.writeable:
            self._out = open(self.filename, "ab" if append else "wb", buffering=0)
        elif notimestamps:
            self._raw_file = open(self.filename, "rb")
            self._raw = self._read_raw(self._raw_file)
        else:
            self._log_file = MavutilLog(self.filename, self.mav._dialect, MAVLink_bad_data, self._state)
            self._match = self._log_file.match
        self.filesize = 0 if self.writeable else os.path.getsize(self.filename)

    # ---- reading

    def _read(self, timeout: float) -> MAVLink_message | None:
        if self._log_file is not None:
            found: MAVLink_message | None = self._log_file.next()
            self._change_version()
        elif self._raw_file is not None:
            found = self._next_raw(self._raw_file)
        else:
            raise UsageError(f"{self.filename} is being written; open it again to read it")
        if found is not None or not timeout or self.stop_on_EOF:
            self._ended = found is None
            return found
        time.sleep(min(timeout, FOLLOW_PAUSE_S))
        return None

    def _has_ended(self) -> bool:
        return self._ended

    def _take(self, timeout: float) -> MAVLink_message | None:
        message = self._read(timeout)
        return None if message is None else self._post(message)

    def _totals(self) -> tuple[int, int]:
        return self._raw_totals if self._log_file is None else self._log_file.totals

    def _damaged(self) -> int:
        return self._raw_damaged if self._log_file is None else self._log_file.damaged

    def _next_raw(self, file: BinaryIO) -> MAVLink_message | None:
        if file.closed:
            raise ClosedError(f"{self.filename}: the recording is closed")
        message = next(self._raw, None)
        if message is not None:
            packets, size = self._raw_totals
            self._raw_totals = packets + 1, size + len(message.get_msgbuf())
            self._raw_damaged += isinstance(message, MAVLink_bad_data)
            self._change_version()
        return message

    def _read_raw(self, file: BinaryIO) -> Iterator[MAVLink_message]:
        """The messages of a file without times. Their time is the vehicle's clock."""
        while chunk := file.read(CHUNK_BYTES):
            for found in self.mav._parser.feed(chunk, 0):
                if isinstance(found, tuple):
                    found = MAVLink_bad_data(*found)
                message: MAVLink_message = found
                boot_ms = message.to_dict().get("time_boot_ms")
                message._timestamp = self._state.uptime_s if boot_ms is None else boot_ms * 1e-3
                yield message

    def recv(self, n: int | None = None) -> bytes:
        """Returns the bytes of the next message; b"" at the end."""
        message = self._read(0)
        return b"" if message is None else bytes(message.get_msgbuf())

    def recv_match(self, condition: str | None = None, type: Types = None, blocking: bool = False,
                   timeout: float | None = None) -> Any:
        """Returns the next message of these types for which the condition is true; None at the end."""
        mav, match = self.mav, self._match
        if (match is None or not self.stop_on_EOF or self.message_hooks or self.logfile is not None
                or self.logfile_raw is not None or mav.callback is not None or mav.signing.secret_key is not None):
            return super().recv_match(condition, type, blocking and not self.stop_on_EOF, timeout)
        types = None if type is None else self._types_of(type)
        message = match(self, types)
        while condition is not None and message is not None and not self._agrees(message, condition):
            message = match(self, types)
        return message

    def recv_msg(self) -> Any:
        if self._match is not None:
            return self.recv_match()
        return super().recv_msg()

    def select(self, timeout: float) -> bool:
        """A recording is always ready."""
        return True

    @property
    def percent(self) -> float:
        """The place of the last message in the file, in percent."""
        return 0.0 if self._log_file is None else self._log_file.percent

    def rewind(self) -> None:
        """Starts again at the first message."""
        if self._log_file is not None:
            self._log_file.rewind()
        elif self._raw_file is not None:
            self._raw_file.seek(0)
            self.mav._forget_received()
            self._raw = self._read_raw(self._raw_file)
        self._ended = False

    _rewind = rewind

    # ---- writing

    def write(self, buf: bytes) -> None:
        """Appends bytes to the file, without a time."""
        if self._out is None:
            raise UsageError(f"{self.filename} is being read: nothing can be sent to a recording")
        self._out.write(buf)

    def close(self) -> None:
        if self._log_file is not None:
            self._log_file.close()
        for file in (self._raw_file, self._out):
            if file is not None:
                file.close()
        super().close()


class mavmmaplog(mavlogfile):
    """A recording whose types of messages are known once it is open: `name_to_id`, `flightmode_list()`."""

    def __init__(self, filename: str | os.PathLike[str], progress_callback: Callable[[int], object] | None = None,
                 source_system: int = 255, source_component: int = 0) -> None:
        super().__init__(filename, source_system=source_system, source_component=source_component)
        self._flightmodes: list[tuple[str, float, float]] | None = None
        assert self._log_file is not None
        self._counts: dict[str, int] = self._log_file.index(self, progress_callback)
        self._forget_indexed_instances()
        self._change_version()
        for state in self.sysid_state.values():
            state.flightmode = "UNKNOWN"
        self.data_len = self.filesize
        self.name_to_id = {name: self.mav._dialect[name].id for name in self._counts}
        self.id_to_name = {number: name for name, number in self.name_to_id.items()}

    def _forget_indexed_instances(self) -> None:
        """Forgets all but the first instance of each message. Conditions see the others only after they were read."""
        for message in self.messages.values():
            instances = getattr(message, "_instances", None) or {}
            for instance in list(instances)[1:]:
                del instances[instance]

    @property
    def _count(self) -> int:
        return sum(self._counts.values())

    @property
    def counts(self) -> dict[int, int]:
        """{message id: how many there are}."""
        return {self.name_to_id[name]: count for name, count in self._counts.items()}

    def rewind(self) -> None:
        super().rewind()
        self.flightmode = "UNKNOWN"

    _rewind = rewind

    def flightmode_list(self) -> list[tuple[str, float, float]]:
        """The flight modes of the target in order: (name, time of the first message, time of the last one).

        Reads the whole recording, so that `params` is complete, and rewinds it.
        """
        self.rewind()
        if self._flightmodes is None:
            self._flightmodes = [(name, begin, end) for name, begin, end in self._read_flightmodes()]
            self.rewind()
        return self._flightmodes

    def _read_flightmodes(self) -> list[list[Any]]:
        modes: list[list[Any]] = []
        while (message := self.recv_match(type="HEARTBEAT")) is not None:
            if not modes or modes[-1][0] != self.flightmode:
                if modes:
                    modes[-1][2] = message._timestamp
                modes.append([self.flightmode, message._timestamp, message._timestamp])
            modes[-1][2] = message._timestamp
        return modes
