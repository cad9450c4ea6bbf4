# SPDX-License-Identifier: MIT
"""MAVLink telemetry at C++ speed: links, recordings, rings in shared memory, and message definitions.

    link = mavloom.connect("udpin://0.0.0.0:14550"); print(link.recv(timeout=1.0))
    for msg in mavloom.read("flight.tlog"): print(msg.time_ns, msg.name, msg.to_dict())
    att = mavloom.columns("flight.tlog", "ATTITUDE", system=1); print(att["roll"], att.units["roll"])
    with mavloom.RingReader("px4") as ring: print(ring.read(timeout=1.0))
"""
import atexit as _atexit
import sys as _sys
import typing as _typing

from . import _errors, _hints, _signatures, enums, messages
from ._columns import Columns, columns, tables
from ._core import (Dialect, FieldInfo, Header, LinkRecorder, LinkStats, Message, MessageInfo, Parser, Record,
                    RecordBatch, Recording, RecordingStats, RecordingSummary, RecordingWriter, RingClaim, RingReader,
                    RingWriter, SenderSummary, SourceStats, Subscription, remove_ring, rings, stop_all, version)
from ._errors import (ClosedError, CommandError, Error, InputError, MissionError, NotFoundError, ParameterError,
                      PermissionDeniedError, SystemFailure, UsageError)
from ._link import Link, connect
from ._vehicle import AsyncVehicle, MissionItem, Vehicle

# Tracebacks and pickles use the names that users import.
for _name in ("Error", "UsageError", "InputError", "SystemFailure", "NotFoundError", "PermissionDeniedError",
              "ClosedError", "CommandError", "ParameterError", "MissionError"):
    getattr(_errors, _name).__module__ = "mavloom"

_signatures.install()
__version__ = version()
read = Recording
write = RecordingWriter
_atexit.register(stop_all)

if not _typing.TYPE_CHECKING:
    def __getattr__(name):
        raise AttributeError(_hints.with_hint(f"module 'mavloom' has no attribute '{name}'", name, _hints.MODULE),
                             name=name, obj=_sys.modules[__name__])

__all__ = [
    "AsyncVehicle", "ClosedError", "Columns", "CommandError", "Dialect", "Error", "FieldInfo", "Header", "InputError",
    "Link", "LinkRecorder", "LinkStats", "Message", "MessageInfo", "MissionError", "MissionItem", "NotFoundError",
    "ParameterError", "Parser", "PermissionDeniedError", "Record", "RecordBatch", "Recording", "RecordingStats",
    "RecordingSummary", "RecordingWriter", "RingClaim", "RingReader", "RingWriter", "SenderSummary", "SourceStats",
    "Subscription", "SystemFailure", "UsageError", "Vehicle", "__version__", "columns", "connect", "enums", "messages",
    "read", "remove_ring", "rings", "tables", "write",
]
