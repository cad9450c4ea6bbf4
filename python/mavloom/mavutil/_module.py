# SPDX-License-Identifier: MIT
"""The module `mavutil.mavlink` of a dialect: constants, enums, message classes and MAVLink, made at their first use."""
from __future__ import annotations

import functools
import types
from collections.abc import Iterator
from typing import Any

from .. import _core
from .._core import Dialect
from .._errors import UsageError
from .._hints import near
from . import _messages, _protocol
from ._messages import Classes, MAVLink_message, as_bytes

FIXED = {"MAVError": _messages.MAVError, "MAVLink_header": _messages.MAVLink_header, "MAVLink_message": MAVLink_message,
         "MAVLink_bad_data": _messages.MAVLink_bad_data, "MAVLink_unknown": _messages.MAVLink_unknown,
         "MAVLinkSigning": _protocol.MAVLinkSigning,
         **{name: getattr(_protocol, name) for name in ("PROTOCOL_MARKER_V1", "PROTOCOL_MARKER_V2",
                                                        "MAVLINK_IFLAG_SIGNED", "MAVLINK_SIGNATURE_BLOCK_LEN")},
         "HEADER_LEN_V1": 6, "HEADER_LEN_V2": 10, "MAVLINK_IGNORE_CRC": 0,
         **{f"MAVLINK_TYPE_{name}": number for number, name in enumerate(
             ("CHAR", "UINT8_T", "INT8_T", "UINT16_T", "INT16_T", "UINT32_T", "INT32_T", "UINT64_T", "INT64_T", "FLOAT",
              "DOUBLE"))}}


class EnumEntry:
    """One value of an enum."""

    def __init__(self, name: str, description: str = "") -> None:
        self.name = name
        self.description = description
        self.param: dict[int, str] = {}
        self.has_location = False

    def __repr__(self) -> str:
        return f"<EnumEntry {self.name}>"


class Enum(dict[int, EnumEntry]):
    """An enum: {value: EnumEntry}."""

    is_bitmask = False


class x25crc:
    """The checksum of MAVLink (CRC-16/MCRF4XX)."""

    def __init__(self, buf: Any = None) -> None:
        self.crc = 0xffff
        if buf is not None:
            self.accumulate(buf)

    def accumulate(self, buf: Any) -> None:
        for byte in buf.encode() if isinstance(buf, str) else as_bytes(buf):
            low = (byte ^ self.crc) & 0xff
            low ^= low << 4 & 0xff
            self.crc = self.crc >> 8 ^ low << 8 ^ low << 3 ^ low >> 4

    def accumulate_str(self, buf: Any) -> None:
        self.accumulate(buf)


# Entries of MAV_TYPE that have other names now; pymavlink 2.4.50 has these.
OLD_TYPES = {"MAV_TYPE_VTOL_DUOROTOR": 19, "MAV_TYPE_VTOL_QUADROTOR": 20, "MAV_TYPE_VTOL_RESERVED2": 22,
             "MAV_TYPE_VTOL_RESERVED3": 23, "MAV_TYPE_VTOL_RESERVED4": 24}

made: dict[bytes, Classes] = {}  # by file of the dialect


def classes_of(dialect: Dialect) -> Classes:
    """The message classes of a dialect. Dialects of one file share theirs, so pickled messages keep their class."""
    key = _core.dialect_key(dialect)
    if key not in made:
        made.setdefault(key, Classes(dialect, "mavloom.mavutil.mavlink"))
    return made[key]


class MavlinkModule(types.ModuleType):
    """The definitions of a dialect in pymavlink's form, for MAVLink 1 or 2."""

    def __init__(self, name: str, classes: Classes, wire: int) -> None:
        super().__init__(name, "MAVLink messages, enums and constants in pymavlink's form.")
        self.dialect = classes.dialect
        self.classes = classes
        self.wire = wire
        self.WIRE_PROTOCOL_VERSION = f"{wire}.0"
        self.DIALECT = classes.dialect.path or "all"
        self.x25crc = x25crc
        self.EnumEntry = EnumEntry
        self.Enum = Enum
        for key, value in FIXED.items():
            setattr(self, key, value)

    def new_dialect(self) -> Dialect:
        """The dialect of one connection or parser, which makes messages of these classes."""
        return _core.mavutil_dialect(self.dialect, self.classes.of, self.wire == 1)

    def __getattr__(self, name: str) -> Any:
        value = self._make(name)
        setattr(self, name, value)
        return value

    def _make(self, name: str) -> Any:
        if name == "MAVLink":
            return _protocol.new_class(self)
        if name == "enums":
            return Enums(self.dialect)
        if name == "mavlink_map":
            return {self.dialect[one].id: self.classes.of(one) for one in self.dialect.message_names}
        if name == "MAVLink_waypoint_message":  # the old name, which pymavlink keeps
            return self.classes.of("MISSION_ITEM")
        if name.startswith("MAVLink_") and name.endswith("_message"):
            message = name[len("MAVLink_"):-len("_message")].upper()
            if message in self.dialect and name == f"MAVLink_{message.lower()}_message":
                return self.classes.of(message)
        if name in self._constants:
            return self._constants[name]
        raise AttributeError(f"the definitions have no {name}{near(name, self._constants)}")

    @functools.cached_property
    def _constants(self) -> dict[str, int]:
        found: dict[str, int] = {}
        for name in self.dialect.enum_names:
            entries = self.dialect.enum_entries(name)[1]
            found.update(entries)
            found[f"{name}_ENUM_END"] = max(entries.values(), default=0) + 1
        for name in self.dialect.message_names:
            found[f"MAVLINK_MSG_ID_{name}"] = self.dialect[name].id
        if "MAV_TYPE" in self.dialect.enum_names:
            found.update(OLD_TYPES)
        found["MAVLINK_MSG_ID_BAD_DATA"] = -1
        found["MAVLINK_MSG_ID_UNKNOWN"] = -2
        return found

    def __dir__(self) -> list[str]:
        classes = (f"MAVLink_{name.lower()}_message" for name in self.dialect.message_names)
        return sorted({*super().__dir__(), *self._constants, *classes, "MAVLink", "enums", "mavlink_map"})


class Enums(dict[str, Enum]):
    """{enum: {value: EnumEntry}}; each enum is made when it is read."""

    def __init__(self, dialect: Dialect) -> None:
        super().__init__()
        self._dialect = dialect
        self._names = dialect.enum_names

    def __missing__(self, name: str) -> Enum:
        if name not in self._names:
            raise KeyError(name)
        bitmask, entries = self._dialect.enum_entries(name)
        made = Enum({value: EnumEntry(entry) for entry, value in entries.items()})
        made[max(entries.values(), default=0) + 1] = EnumEntry(f"{name}_ENUM_END")
        made.is_bitmask = bitmask
        return self.setdefault(name, made)

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def get(self, name: str, default: Any = None) -> Any:
        return self[name] if name in self else default

    def keys(self) -> Any:
        return dict.fromkeys(self._names).keys()

    def values(self) -> Any:
        return [self[name] for name in self._names]

    def items(self) -> Any:
        return [(name, self[name]) for name in self._names]


def make_module(name: str, dialect: Dialect, wire: int) -> MavlinkModule:
    if wire not in (1, 2):
        raise UsageError(f"MAVLink has versions 1 and 2, not {wire}")
    return MavlinkModule(name, classes_of(dialect), wire)
