# SPDX-License-Identifier: MIT
"""pymavlink's small helpers."""
from __future__ import annotations

import math
import time
from typing import Any, TextIO

from .._core import Dialect
from .._errors import UsageError
from . import _current
from ._messages import MAVLink_message

UNIX_TIME_US = 10**15  # greater times in µs are shown as dates, since 2001
SHOWN_AS_SECONDS_US = 10**6
# In pymavlink's order; it has no ttyAMA.
SERIAL_DEVICES = ("/dev/ttyS*", "/dev/ttyUSB*", "/dev/ttyACM*", "/dev/serial/by-id/*", "/dev/ttyAMA*")
# Units that dump_message_verbose converts: divisor and result.
dump_message_unit_decoder: dict[str, tuple[float, str]] = {
    "d%": (10.0, "%"), "c%": (100.0, "%"), "cA": (100.0, "A"), "cdegC": (100.0, "degC"), "cdeg": (100.0, "deg"),
    "degE5": (100000.0, "deg"), "degE7": (10000000.0, "deg"), "mG": (1000.0, "G"), "mrad/s": (1000.0, "rad/s"),
    "mV": (1000.0, "V"),
}


class location:
    """A place: latitude and longitude in degrees, altitude in m, heading in degrees."""

    def __init__(self, lat: float, lng: float, alt: float = 0, heading: float = 0) -> None:
        self.lat = lat
        self.lng = lng
        self.alt = alt
        self.heading = heading

    def __str__(self) -> str:
        return f"lat={self.lat:.6f},lon={self.lng:.6f},alt={self.alt:.1f}"

    def __repr__(self) -> str:
        return f"location({self.lat}, {self.lng}, {self.alt}, {self.heading})"


class periodic_event:
    """trigger() is true `frequency` times a second."""

    def __init__(self, frequency: float) -> None:
        self.frequency = float(frequency)
        self.last_time = time.time()

    def __repr__(self) -> str:
        return f"periodic_event({self.frequency})"

    def force(self) -> None:
        """Makes the next trigger() true."""
        self.last_time = 0

    def trigger(self) -> bool:
        now = time.time()
        if self.last_time > now:  # the clock was set back
            self.last_time = now
        if self.last_time + 1.0 / self.frequency <= now:
            self.last_time = now
            return True
        return False


def u_ord(c: Any) -> Any:
    """Converts a one-character str or bytes to its number; returns an int unchanged."""
    return ord(c) if isinstance(c, (str, bytes, bytearray)) else c


def is_printable(c: Any) -> bool:
    """Whether a byte is ASCII text, a line feed or a carriage return."""
    number = u_ord(c)
    return bool(32 <= number <= 126) or number in (9, 10, 13)


def all_printable(buf: Any) -> bool:
    return all(is_printable(c) for c in buf)


def set_close_on_exec(fd: Any) -> None:
    """Does nothing: the descriptors of links are never inherited."""


class EnumBitInfo:
    """One bit of a bitmask field."""

    def __init__(self, offset: int, value: bool, name: str | None) -> None:
        self.offset = offset
        self.value = value
        self.name = name

    def __repr__(self) -> str:
        return f"<EnumBitInfo {self.offset} {self.name} {self.value}>"


def decode_bitmask(messagetype: str, field: str, value: int, dialect: Dialect | None = None) -> list[EnumBitInfo]:
    """Returns all named bits, and the unnamed ones up to the highest bit that is set, lowest first.

    The definitions are those of `mavlink` now if `dialect` is None.
    """
    definitions = dialect or _current.module().dialect
    info = next((one for one in definitions[messagetype].fields if one.name == field), None)
    if info is None:
        raise UsageError(f"{messagetype} has no field '{field}'")
    if not info.bitmask:
        raise AttributeError(f"{messagetype}.{field} is not a bitmask")
    entries = dict(definitions.enum_entries(info.enum)[1]) if info.enum else {}
    if entries:
        entries[f"{info.enum}_ENUM_END"] = max(entries.values()) + 1  # an entry of pymavlink's enums
    names = {number.bit_length() - 1: name for name, number in entries.items() if number and not number & number - 1}
    bits = sorted({*range(value.bit_length()), *names})
    return [EnumBitInfo(bit, bool(value >> bit & 1), names.get(bit)) for bit in bits]


def dump_message_verbose(f: TextIO, m: MAVLink_message) -> None:
    """Writes a message with one line for each field, with units and names of enum entries."""
    seconds = m._timestamp
    when = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(seconds))
    signed = f"Yes; out-link={m.get_link_id()}" if m.get_signed() else "No"
    f.write(f"{when}.{int(seconds * 100.0) % 100:02d}: {m.get_type()} (id={m.get_msgId()}) (seq={m.get_seq()}) "
            f"(src={m.get_srcSystem()}/{m.get_srcComponent()}) (in-link={m._link}) (signed={signed})\n")
    if m.get_type() == "BAD_DATA":
        return
    for name in m.get_fieldnames():
        value = m.format_attr(name)
        if m.fielddisplays_by_name.get(name) == "bitmask" and isinstance(value, int):
            f.write(f"    {name}: 0x{value:x} ({value})\n")
            for bit in decode_bitmask(m.get_type(), name, value):
                f.write(f"      {' ' if bit.value else '!'} {bit.name or '[UNKNOWN]'}\n")
        else:
            f.write(f"    {name}: {with_unit(m, name, value)}\n")


def with_unit(m: MAVLink_message, name: str, value: Any) -> str:
    unit = m.fieldunits_by_name.get(name)
    if unit is None:
        return f"{value}{enum_name(m, name, value)}"
    if unit in dump_message_unit_decoder:
        divisor, unit = dump_message_unit_decoder[unit]
        value = [one / divisor for one in value] if isinstance(value, list) else value / divisor
    text = f"{value}{unit}"
    if unit in ("rad", "rad/s") and not isinstance(value, list):
        text += f" ({math.degrees(value)}{unit.replace('rad', 'deg')})"
    if unit == "us" and not isinstance(value, list):
        text += as_time(value)
    return text


def as_time(value_us: int) -> str:
    if value_us > UNIX_TIME_US:
        seconds, rest = divmod(value_us, 10**6)
        local = time.localtime(seconds)
        return f" ({time.strftime('%Y-%m-%d %H:%M:%S', local)}.{rest:06d} {time.strftime('%Z', local)})"
    return f" ({value_us / 1e6}s)" if value_us > SHOWN_AS_SECONDS_US else ""


def enum_name(m: MAVLink_message, name: str, value: Any) -> str:
    enum = m.fieldenums_by_name.get(name)
    if enum is None or isinstance(value, list):
        return ""
    definitions = _current.module().dialect
    entries = definitions.enum_entries(enum)[1] if enum in definitions.enum_names else {}
    return f" ({next((entry for entry, number in entries.items() if number == value), '[UNKNOWN]')})"


class SerialPort:
    """A serial device of this machine."""

    def __init__(self, device: str, description: str | None = None, hwid: str | None = None) -> None:
        self.device = device
        self.description = description
        self.hwid = hwid

    def __str__(self) -> str:
        texts = [self.device, *(f" : {text}" for text in (self.description, self.hwid) if text is not None)]
        return "".join(texts)


def auto_detect_serial(preferred_list: Any = ("*",)) -> list[SerialPort]:
    """Returns the serial devices that match a pattern of `preferred_list`; all of them if none matches."""
    import fnmatch
    import glob
    devices = [path for pattern in SERIAL_DEVICES for path in sorted(glob.glob(pattern))]
    preferred = [one for one in devices if any(fnmatch.fnmatch(one, pattern) for pattern in preferred_list)]
    return [SerialPort(device) for device in preferred or devices]


auto_detect_serial_unix = auto_detect_serial
