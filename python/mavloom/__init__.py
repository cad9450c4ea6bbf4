# SPDX-License-Identifier: MIT
"""MAVLink telemetry at C++ speed: recordings as messages or as numpy columns, frames made and read, definitions looked up.

    for msg in mavloom.read("flight.tlog"): print(msg.time_ns, msg.name, msg.to_dict())
    att = mavloom.columns("flight.tlog", "ATTITUDE", system=1); print(att["roll"], att.units["roll"])
"""
from . import _errors
from ._columns import Columns, columns
from ._core import Dialect, FieldInfo, Header, Message, MessageInfo, Parser, Recording, RecordingStats, version
from ._errors import ClosedError, Error, InputError, NotFoundError, PermissionDeniedError, SystemFailure, UsageError

# Errors are shown, and pickled, by the names that users import.
for _name in ("Error", "UsageError", "InputError", "SystemFailure", "NotFoundError", "PermissionDeniedError", "ClosedError"):
    getattr(_errors, _name).__module__ = "mavloom"

__version__ = version()
read = Recording

__all__ = [
    "ClosedError", "Columns", "Dialect", "Error", "FieldInfo", "Header", "InputError", "Message", "MessageInfo", "NotFoundError", "Parser",
    "PermissionDeniedError", "Recording", "RecordingStats", "SystemFailure", "UsageError", "__version__", "columns", "read",
]
