# SPDX-License-Identifier: MIT
"""Functions that pickles name: compiled ones cannot be."""
from __future__ import annotations

from . import _core


def restore_message(dialect: _core.Dialect, frame: bytes, time_ns: int, link: int, link_name: str, verified: bool) -> _core.Message:
    return _core.restore_message(dialect, frame, time_ns, link, link_name, verified)
