# SPDX-License-Identifier: MIT
"""pymavlink's connection strings."""
from __future__ import annotations

import errno
import os
import re
from dataclasses import dataclass

from .._errors import NotFoundError, SystemFailure, UsageError

KINDS = ("udp", "udpin", "udpout", "udpbcast", "mcast", "tcp", "tcpin", "ws", "wsserver")
LOOPBACK = "127.0.0.1"  # of localhost: pymavlink's sockets have no IPv6
PROGRAM = "programs are not started here: start it yourself and connect to its port"
PROGRAM_BEGINNINGS = (b"\x7fELF", b"#!")
REFUSED = {
    "wss": "there is no TLS here: use ws:HOST:PORT to a proxy that adds it, such as stunnel",
    "csv": "CSV files are not read here: use pymavlink's CSVReader, or pandas.read_csv()",
    "unix": "there are no Unix stream sockets here: use tcp:HOST:PORT, or a ring, shm://NAME",
    "uds": "there are no Unix stream sockets here: use tcp:HOST:PORT, or a ring, shm://NAME",
}


@dataclass(frozen=True)
class Target:
    """The place that a connection string names. `kind` is one of KINDS, "serial", "file", or "url" for an endpoint."""
    kind: str
    rest: str
    baud: int | None = None


def host_and_port(device: str, what: str, default: str = "0.0.0.0") -> tuple[str, int]:
    """Splits HOST:PORT; the host may be an IPv6 address in brackets. ":PORT" is a port of the default host."""
    host, colon, port = device.rpartition(":")
    host = LOOPBACK if host == "localhost" else host or default
    if not colon:
        raise UsageError(f"{what} ports must be given as host:port, not {device!r}")
    if not re.fullmatch(r"\d{1,5}", port) or int(port) > 65535:
        raise UsageError(f"{device!r}: {port!r} is not a port, 0 to 65535")
    return host, int(port)


def is_program(path: str) -> bool:
    """Whether a file is a program or script. On some file systems, recordings are executable as well."""
    if not os.path.isfile(path) or not os.access(path, os.X_OK):
        return False
    with open(path, "rb") as file:
        return file.read(4).startswith(PROGRAM_BEGINNINGS)


def target_of(device: str | os.PathLike[str]) -> Target:
    """Interprets a connection string. Raises UsageError for a kind that does not exist here, and NotFoundError for a
    name that is neither a file nor a device."""
    text = os.fspath(device)
    if not isinstance(text, str) or not text:
        raise UsageError(f"a connection is given as text, for example 'udpin:0.0.0.0:14550', not {device!r}")
    if "://" in text:
        scheme = text.partition("://")[0]
        if scheme == "tlog":
            return Target("file", text.partition("://")[2])
        if scheme in REFUSED:
            raise UsageError(f"{text}: {REFUSED[scheme]}")
        return Target("url", text)
    kind, colon, rest = text.partition(":")
    if colon and kind in KINDS:
        return Target(kind, rest)
    if colon and kind in REFUSED:
        raise UsageError(f"{text}: {REFUSED[kind]}")
    if text.lower().endswith(".px4log"):
        raise UsageError(f"{text}: old logs of PX4 are not read here: use pymavlink's DFReader")
    if text.lower().endswith(".elf") or is_program(text):
        raise UsageError(f"{text}: {PROGRAM}")
    if os.path.isdir(text):
        raise SystemFailure(errno.EISDIR, f"{text} is a folder, neither a recording nor a device")
    if os.path.isfile(text) or text.lower().endswith((".tlog", ".log", ".bin", ".ulg")):
        return Target("file", text)
    if colon and not text.startswith("/"):
        return Target("udp", text)
    path, comma, baud = text.partition(",")
    if comma and not baud.isdigit():
        raise UsageError(f"{text}: a device is given as /dev/NAME or /dev/NAME,BAUD")
    if not path.startswith("/"):
        raise NotFoundError(errno.ENOENT, f"{text}: no such file; a device is given by its full path, for example "
                                          "/dev/ttyACM0")
    return Target("serial", path, int(baud) if comma else None)
