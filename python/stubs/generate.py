# SPDX-License-Identifier: MIT
"""generate.py PACKAGE: writes the stubs that describe the built-in definitions into the built package.

- messages.pyi and enums.pyi: the classes of mavloom.messages and mavloom.enums.
- _sends.pyi: Link.send, and NAME_send and NAME_encode of link.mav.
- mavutil/mavlink.pyi: the module mavutil.mavlink.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(sys.argv[1]).parent))
import mavloom  # noqa: E402

HEAD = "# SPDX-License-Identifier: MIT\n# Made by python/stubs/generate.py.\n"
SENDS = HEAD + """from collections.abc import Iterable
from typing import Any, Literal, SupportsFloat, SupportsIndex, Union, overload

from mavloom import messages
from mavloom._core import Message, Port

# Values of fields: whole numbers or names of enum entries, real numbers or their bytes, arrays, text.
Int = Union[SupportsIndex, str]
Real = Union[SupportsFloat, SupportsIndex, bytes]
Ints = Iterable[SupportsIndex]
Reals = Iterable[Union[SupportsFloat, SupportsIndex]]
Text = Union[str, bytes, bytearray, memoryview]

"""
MAVLINK = HEAD + """from typing import Any

from mavloom._core import Dialect
from mavloom.mavutil import _module, _protocol
from mavloom.mavutil._messages import MAVError as MAVError
from mavloom.mavutil._messages import MAVLink_bad_data as MAVLink_bad_data
from mavloom.mavutil._messages import MAVLink_header as MAVLink_header
from mavloom.mavutil._messages import MAVLink_message as MAVLink_message
from mavloom.mavutil._messages import MAVLink_unknown as MAVLink_unknown
from mavloom.mavutil._module import Enum as Enum
from mavloom.mavutil._module import EnumEntry as EnumEntry
from mavloom.mavutil._module import x25crc as x25crc
from mavloom.mavutil._protocol import MAVLinkSigning as MAVLinkSigning

WIRE_PROTOCOL_VERSION: str
DIALECT: str
dialect: Dialect
enums: dict[str, Enum]
mavlink_map: dict[int, type[MAVLink_message]]
"""


def python_type(field):
    if field.type == "char":
        return "str"
    number = "float" if field.type in ("float", "double") else "int"
    return f"list[{number}]" if field.array_length else number


def given_type(field):
    """The type of a value that is sent."""
    if field.type == "char":
        return "Text"
    number = "Real" if field.type in ("float", "double") else "Int"
    return number + "s" if field.array_length else number


def class_of(info):
    # A field with the name of an attribute of Message is an item only.
    fields = [field for field in info.fields if not hasattr(mavloom.Message, field.name)]
    lines = [f"    @property\n    def {field.name}(self) -> {python_type(field)}: ..." for field in fields]
    return "\n".join([f"class {info.name}(Message):", *(lines or ["    ..."])])


def messages(dialect):
    classes = [class_of(dialect[name]) for name in dialect.message_names]
    return "\n\n".join([HEAD + "from mavloom._core import Message", *classes]) + "\n"


def enums(dialect):
    classes = []
    for name in dialect.enum_names:
        kind = dialect.enum(name)
        entries = [f"    {entry} = {int(member)}" for entry, member in kind.__members__.items()]
        classes.append("\n".join([f"class {name}({kind.__base__.__name__}):", *(entries or ["    ..."])]))
    return "\n\n".join([HEAD + "from enum import IntEnum, IntFlag", *classes]) + "\n"


def sends(dialect):
    """`send` takes the names of the built-in messages only, so that a wrong field is an error."""
    infos = [dialect[name] for name in dialect.message_names]
    lines = ["class Sends:", "    _port: Port", "    def __init__(self, port: Port) -> None: ..."]
    for info in infos:
        fields = "".join(f", {field.name}: {given_type(field)} = ..." for field in info.fields)
        more = f", *{fields}" if fields else ""
        lines += ["    @overload", f'    def send(self, message: Literal["{info.name}"], /{more}) -> int: ...']
    lines += ["    @overload", "    def send(self, message: Message, /, **fields: Any) -> int: ...", "",
              "class Calls:", "    _port: Port", "    def __init__(self, port: Port) -> None: ..."]
    for info in infos:
        fields = "".join(f", {field.name}: {given_type(field)} = ..." for field in info.fields)
        lines += [f"    def {info.name.lower()}_send(self{fields}) -> int: ...",
                  f"    def {info.name.lower()}_encode(self{fields}) -> messages.{info.name}: ..."]
    return SENDS + "\n".join(lines) + "\n"


def mavlink_parameters(info, default=""):
    return "".join(f", {field.name}: Any{' = ...' if field.extension or field.name == default else ''}"
                   for field in info.fields)


def mavlink_class(info):
    lines = [f"class MAVLink_{info.name.lower()}_message(MAVLink_message):",
             f"    def __init__(self{mavlink_parameters(info)}) -> None: ..."]
    # Fields called id or name have another type than the attribute of the class.
    lines += [f"    {field.name}: {python_type(field)}{'  # type: ignore[assignment]' if field.name == 'name' else ''}"
              for field in info.fields if field.name not in ("id", "name")]
    return "\n".join(lines)


def mavlink(dialect):
    """The constants and classes of mavutil.mavlink."""
    from mavloom import mavutil
    module = mavutil.mavlink
    infos = [dialect[name] for name in dialect.message_names]
    constants = [f"{name}: int" for name in sorted({*module._constants, *(
        name for name in module.__dict__ if name.isupper() and isinstance(getattr(module, name), int))})]
    calls = ["class MAVLink(_protocol.MAVLink):"]
    for info in infos:
        name = info.name.lower()
        fields = mavlink_parameters(info, "mavlink_version")
        calls += [f"    def {name}_send(self{fields}, force_mavlink1: bool = False) -> None: ...",
                  f"    def {name}_encode(self{fields}) -> MAVLink_{name}_message: ..."]
    return "\n".join([MAVLINK, *constants, "", *(mavlink_class(info) for info in infos), "", *calls]) + "\n"


def main():
    folder, dialect = pathlib.Path(sys.argv[1]), mavloom.Dialect()
    (folder / "messages.pyi").write_text(messages(dialect))
    (folder / "enums.pyi").write_text(enums(dialect))
    (folder / "_sends.pyi").write_text(sends(dialect))
    (folder / "mavutil" / "mavlink.pyi").write_text(mavlink(dialect))


if __name__ == "__main__":
    main()
