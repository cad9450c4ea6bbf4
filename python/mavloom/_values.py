# SPDX-License-Identifier: MIT
"""Argument types for argparse: sizes and file modes, in the forms that the program `mavloom` takes.

docs/guide/endpoints.md has the grammar; src/endpoint/values.cpp parses it for the program.
"""
from __future__ import annotations

import argparse
import re

_K = 1 << 10
_UNITS = {
    "": 1, "B": 1,
    "k": _K, "K": _K, "KiB": _K, "kB": 10**3,
    "m": _K**2, "M": _K**2, "MiB": _K**2, "MB": 10**6,
    "g": _K**3, "G": _K**3, "GiB": _K**3, "GB": 10**9,
}


def size(text: str) -> int:
    """Converts a size such as 65536, 64k, 8MiB or 1GB to bytes."""
    match = re.fullmatch(r"([0-9]+)([A-Za-z]*)", text)
    if match is None or match[2] not in _UNITS:
        raise argparse.ArgumentTypeError(f"{text!r}: expected a size, for example 65536, 64k or 32MiB")
    return int(match[1]) * _UNITS[match[2]]


def mode(text: str) -> int:
    """Converts a file mode of three octal digits (640, 0640 or 0o640) to its number."""
    match = re.fullmatch(r"(?:0o?)?([0-7]{3})", text)
    if match is None:
        raise argparse.ArgumentTypeError(f"{text!r}: expected three octal digits, for example 0600 or 0640")
    return int(match[1], 8)
