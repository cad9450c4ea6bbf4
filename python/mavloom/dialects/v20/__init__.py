# SPDX-License-Identifier: MIT
"""pymavlink's dialects for MAVLink 2: `from mavloom.dialects.v20 import ardupilotmega as mavlink`.

All names stand for the built-in definitions, which have the messages of all public dialects.
"""
import sys as _sys

from ..._core import Dialect as _Dialect
from ...mavutil._current import DIALECTS as _DIALECTS
from ...mavutil._current import module_of as _module_of

for _name in _DIALECTS:
    _sys.modules[f"{__name__}.{_name}"] = globals()[_name] = _module_of(_Dialect(), 2)
