# SPDX-License-Identifier: MIT
"""Functions that pickles name: compiled ones cannot be."""
from __future__ import annotations

import functools
import os

from . import _core


def restore_message(dialect: _core.Dialect, frame: bytes, time_ns: int, link: int, link_name: str, verdict: int) -> _core.Message:
    return _core.restore_message(dialect, frame, time_ns, link, link_name, verdict)


def restore_dialect(path: str | None) -> _core.Dialect:
    """Each message of a pickle brings its dialect: a file is read once for all of them, and again when it was changed."""
    try:
        status = None if path is None else os.stat(path)
    except OSError:
        status = None  # the reader of the file says what is wrong
    return load(path, status and status.st_mtime_ns, status and status.st_size)


@functools.lru_cache(maxsize=8)
def load(path: str | None, mtime_ns: int | None, size: int | None) -> _core.Dialect:
    return _core.Dialect(path)
