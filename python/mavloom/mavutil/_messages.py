# SPDX-License-Identifier: MIT
"""The message classes of mavloom.mavutil: one for each message, created when it is first used."""
from __future__ import annotations

import json
import struct
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .._core import Dialect, FieldInfo, MavutilMessage
from .._errors import Error
from .._signatures import parameter_name

if TYPE_CHECKING:
    from ._protocol import MAVLink

# The struct module's letters for the types of fields.
FORMATS = {"char": "c", "uint8_t": "B", "int8_t": "b", "uint16_t": "H", "int16_t": "h", "uint32_t": "I", "int32_t": "i",
           "uint64_t": "Q", "int64_t": "q", "float": "f", "double": "d"}


class MAVError(Error):
    """The bytes are not a valid frame."""

    def __init__(self, msg: str) -> None:
        super().__init__(msg)
        self.message = msg


class MAVLink_header:
    """The header of a frame. A copy: changing it changes no frame."""

    def __init__(self, msgId: int, incompat_flags: int = 0, compat_flags: int = 0, mlen: int = 0, seq: int = 0,
                 srcSystem: int = 0, srcComponent: int = 0) -> None:
        self.mlen = mlen
        self.seq = seq
        self.srcSystem = srcSystem
        self.srcComponent = srcComponent
        self.msgId = msgId
        self.incompat_flags = incompat_flags
        self.compat_flags = compat_flags

    def pack(self, force_mavlink1: bool = False) -> bytes:
        """Returns the bytes of the header."""
        if force_mavlink1:
            return bytes((0xfe, self.mlen, self.seq, self.srcSystem, self.srcComponent, self.msgId))
        head = (0xfd, self.mlen, self.incompat_flags, self.compat_flags, self.seq, self.srcSystem, self.srcComponent)
        return bytes(head) + self.msgId.to_bytes(3, "little")


class MAVLink_message(MavutilMessage):
    """A message. Its fields are attributes, also those called `id`, `name`, `seq` or `frame`. Attributes can be set."""

    __slots__ = ()
    id = 0
    msgname = ""
    fieldnames: list[str] = []
    ordered_fieldnames: list[str] = []
    fieldtypes: list[str] = []
    fielddisplays_by_name: dict[str, str] = {}
    fieldenums_by_name: dict[str, str] = {}
    fieldunits_by_name: dict[str, str] = {}
    native_format = bytearray(b"")
    orders: list[int] = []
    lengths: list[int] = []
    array_lengths: list[int] = []
    crc_extra = 0
    unpacker = struct.Struct("")
    instance_field: str | None = None
    instance_offset = -1
    _signed = False
    _link_id: int | None = None
    _instances: dict[Any, MAVLink_message] | None = None

    def __init__(self, msgId: int, name: str) -> None:
        MavutilMessage.__init__(self, Dialect(), None, (), False)
        self.id = msgId
        self.msgname = name

    # ---- the frame

    def get_msgbuf(self) -> bytearray:
        """The whole frame; empty before `pack`."""
        return bytearray(self._frame)

    def get_payload(self) -> bytes | None:
        """The payload as it was sent; None before `pack`."""
        return self._frame_payload if self._frame else None

    def get_crc(self) -> int | None:
        frame = self._frame
        if not frame:
            return None
        end = (10 if frame[0] == 0xfd else 6) + frame[1]
        return int.from_bytes(frame[end:end + 2], "little")

    def get_header(self) -> MAVLink_header:
        return MAVLink_header(self.get_msgId(), self._frame_incompat, self._frame_compat, self._frame_mlen,
                              self.get_seq(), self.get_srcSystem(), self.get_srcComponent())

    _header = property(get_header)
    _payload = property(get_payload)
    _msgbuf = property(get_msgbuf)
    _crc = property(get_crc)

    @property
    def _type(self) -> str:
        return self.get_type()

    @property
    def _fieldnames(self) -> list[str]:
        return self.get_fieldnames()

    def get_msgId(self) -> int:
        return type(self).id

    def get_signed(self) -> bool:
        """Whether the frame has a signature that was verified."""
        return self._signed

    def get_link_id(self) -> int | None:
        """The link id of the signature; None if it was not verified."""
        return self._link_id

    def pack(self, mav: MAVLink, force_mavlink1: bool = False) -> bytes:
        """Returns the frame, with the source and sequence number of `mav`."""
        return mav._pack(self, force_mavlink1)

    # ---- the fields

    @property
    def __dict__(self) -> dict[str, Any]:  # type: ignore[override]
        """The fields and the attributes that were set."""
        return {"_header": self._header, "_payload": self._payload, "_msgbuf": self._msgbuf, "_crc": self._crc,
                "_fieldnames": self.get_fieldnames(), "_type": self.get_type(), "_signed": self._signed,
                "_link_id": self._link_id, "_instances": self._instances, "_instance_field": self.instance_field,
                "_instance_offset": self.instance_offset, "_timestamp": self._timestamp, "_link": self._link,
                **self._fields(), **self._extras()}

    @property
    def _instance_field(self) -> str | None:
        return self.instance_field

    @property
    def _instance_offset(self) -> int:
        return self.instance_offset

    @property
    def name(self) -> str:
        """The message's name, if it has no field called `name`. pymavlink has `get_type` only."""
        return self.get_type()

    def format_attr(self, field: str) -> Any:
        """The value of a field, as `str` shows it."""
        return getattr(self, field)

    def to_json(self) -> str:
        """The fields as JSON. NaN and infinities are written as Python's json does."""
        return json.dumps(self.to_dict())

    def __getitem__(self, instance: Any) -> MAVLink_message:
        """The newest message of another instance: conn.messages["BATTERY_STATUS"][1]."""
        if self._instances is None or instance not in self._instances:
            raise IndexError(f"{self.get_type()} has no instance {instance!r}")
        return self._instances[instance]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, MAVLink_message) and self._compared() == other._compared()

    def __ne__(self, other: object) -> bool:
        return not self == other

    __hash__ = None  # type: ignore[assignment]

    def _compared(self) -> tuple[Any, ...]:
        return (self.get_seq(), self.get_srcSystem(), self.get_srcComponent(), self.to_dict())

    def __repr__(self) -> str:
        return f"<{self}>"

    def __dir__(self) -> list[str]:
        return sorted({*object.__dir__(self), *self.get_fieldnames(), *self._extras()})

    def __reduce__(self) -> tuple[Any, ...]:
        return restore, self._state()


class MAVLink_bad_data(MAVLink_message):
    """Bytes that are not a message, with the reason."""

    __slots__ = ()
    data: bytes | bytearray
    reason: str

    def __init__(self, data: bytes | bytearray, reason: str) -> None:
        MavutilMessage.__init__(self, Dialect(), None, (), False)
        self.data = data
        self.reason = reason

    def get_type(self) -> str:
        return "BAD_DATA"

    def get_msgId(self) -> int:
        return -1

    def get_msgbuf(self) -> bytearray:
        return bytearray(as_bytes(self.data))

    def to_dict(self) -> dict[str, Any]:
        return {"mavpackettype": "BAD_DATA", "data": self.data, "reason": self.reason}

    def __str__(self) -> str:
        return f"BAD_DATA {{{self.reason}, data:{hex_list(self.data)}}}"

    def __reduce__(self) -> tuple[Any, ...]:
        return restore_bad_data, self._state()[2:5] + (self._extras(),)


class MAVLink_unknown(MAVLink_message):
    """A message without a definition. Its frame is known, but not its checksum. As in pymavlink, its source is 0."""

    __slots__ = ()

    def __init__(self, msgid: int, data: bytes | bytearray) -> None:
        MavutilMessage.__init__(self, Dialect(), None, (), False)
        self.msgname = f"UNKNOWN_{msgid}"
        self.data = data

    def get_type(self) -> str:
        return self.msgname or super().get_type()

    def get_msgId(self) -> int:
        return -2

    def get_srcSystem(self) -> int:
        return 0

    def get_srcComponent(self) -> int:
        return 0

    def get_seq(self) -> int:
        return 0

    @property
    def data(self) -> bytes | bytearray:
        frame: bytes = self._frame
        return frame

    @data.setter
    def data(self, value: bytes | bytearray) -> None:
        """Setting an attribute of a message never gets here; the setter is for type checkers."""

    def to_dict(self) -> dict[str, Any]:
        return {"mavpackettype": self.get_type(), "data": self.data}

    def __str__(self) -> str:
        return f"{self.get_type()} {{data:{hex_list(self.data)}}}"


def as_bytes(data: Any) -> bytes:
    """The bytes of a buffer or of a sequence of numbers. Raises TypeError for anything else."""
    if isinstance(data, (int, str)):  # bytes(5) would be five zeros
        raise TypeError(f"expected bytes, not {data!r:.40}")
    return bytes(data)


def hex_list(data: bytes | bytearray) -> list[str]:
    return [f"{byte:x}" for byte in data]


class Classes:
    """The message classes of a dialect, by name."""

    def __init__(self, dialect: Dialect, module: str) -> None:
        self.dialect = dialect
        self.module = module
        self._made: dict[str, type[MAVLink_message]] = {}

    def of(self, name: str | None) -> type[MAVLink_message]:
        """Returns the class of a message; for None, that of messages without a definition."""
        if name is None:
            return MAVLink_unknown
        if name not in self._made:
            self._made.setdefault(name, make_class(self.dialect, name, self.module))
        return self._made[name]


def make_class(dialect: Dialect, name: str, module: str) -> type[MAVLink_message]:
    info = dialect[name]
    fields = info.fields
    wire = sorted((f for f in fields if not f.extension), key=lambda f: -struct.calcsize(FORMATS[f.type]))
    wire += [f for f in fields if f.extension]
    instance = next((f for f in fields if f.instance), None)
    layout = "<" + "".join(f"{f.array_length}s" if f.type == "char" and f.array_length else
                           f"{f.array_length or ''}{FORMATS[f.type]}" for f in wire)
    class_name = f"MAVLink_{name.lower()}_message"
    return type(class_name, (MAVLink_message,), {
        "__slots__": (), "__module__": module, "__qualname__": class_name, "__doc__": f"The message {name}.",
        "__init__": make_init(dialect, name, fields),
        "id": info.id, "msgname": name, "crc_extra": info.crc_extra,
        "fieldnames": [f.name for f in fields],
        "ordered_fieldnames": [f.name for f in wire],
        "fieldtypes": [f.type for f in fields],
        "fielddisplays_by_name": {f.name: "bitmask" for f in fields if f.bitmask},
        "fieldenums_by_name": {f.name: f.enum for f in fields if f.enum},
        "fieldunits_by_name": {f.name: f.units for f in fields if f.units},
        "native_format": bytearray(("<" + "".join(FORMATS[f.type] for f in wire)).encode()),
        "unpacker": struct.Struct(layout),
        "orders": [[w.name for w in wire].index(f.name) for f in fields],
        "lengths": [f.array_length if f.array_length and f.type != "char" else 1 for f in wire],
        "array_lengths": [f.array_length for f in wire],
        "instance_field": instance.name if instance else None,
        "instance_offset": offset_in(wire, instance) if instance else -1,
    })


def offset_in(wire: list[FieldInfo], field: FieldInfo) -> int:
    """The place of a field in the payload."""
    at = 0
    for one in wire:
        if one.name == field.name:
            break
        at += struct.calcsize(FORMATS[one.type]) * max(one.array_length, 1)
    return at


def parameters(fields: list[FieldInfo], version: str = "") -> str:
    """The fields as the parameters of a function: extension fields may be left out."""
    texts = []
    for field in fields:
        name = parameter_name(field.name)
        if name == "mavlink_version" and version:
            texts.append(f"{name}{version}")
        elif not field.extension:
            texts.append(name)
        elif field.type == "char":
            texts.append(f'{name}=b""')
        else:
            texts.append(f"{name}={'(' + '0, ' * field.array_length + ')' if field.array_length else '0'}")
    return ", ".join(texts)


def make_init(dialect: Dialect, name: str, fields: list[FieldInfo]) -> Callable[..., None]:
    """Returns the __init__ of a message class, with the fields as its parameters."""
    names = "".join(f"{parameter_name(field.name)}, " for field in fields)
    scope: dict[str, Any] = {"_start": MavutilMessage.__init__, "_dialect": dialect}
    exec(f"def __init__(self, {parameters(fields)}):\n    _start(self, _dialect, {name!r}, ({names}), False)\n", scope)
    made: Callable[..., None] = scope["__init__"]
    made.__qualname__ = f"MAVLink_{name.lower()}_message.__init__"
    return made


def restore_bad_data(frame: bytes, time_ns: int, link: int, extra: dict[str, Any]) -> MAVLink_bad_data:
    """Restores a pickled or copied BAD_DATA."""
    made = MAVLink_bad_data(extra["data"], extra["reason"])
    made._restore(frame, time_ns, link, extra)
    return made


def restore(dialect: Dialect, name: str | None, frame: bytes, time_ns: int, link: int, hides_extensions: bool,
            extra: dict[str, Any]) -> MAVLink_message:
    """Restores a pickled or copied message."""
    from ._module import classes_of
    cls = classes_of(dialect).of(name)
    made = cls.__new__(cls)
    MavutilMessage.__init__(made, dialect, name, (), hides_extensions)
    made._restore(frame, time_ns, link, extra)
    return made
