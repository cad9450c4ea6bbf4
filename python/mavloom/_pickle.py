# SPDX-License-Identifier: MIT
"""The functions that pickles refer to by name; compiled functions cannot be pickled."""
from __future__ import annotations

import functools
import os

from . import _core


def restore_message(dialect: _core.Dialect, frame: bytes, time_ns: int, link: int, link_name: str,
                    verdict: int) -> _core.Message:
    return _core.restore_message(dialect, frame, time_ns, link, link_name, verdict)


def restore_dialect(path: str | None) -> _core.Dialect:
    """Restores the dialect that each pickled message refers to.

    The XML file is read once for all messages, and again after it has changed.
    """
    try:
        status = None if path is None else os.stat(path)
    except OSError:
        status = None  # reading the file raises the error
    place = None if path is None else os.path.abspath(path)
    return load(path, place, status and status.st_mtime_ns, status and status.st_size)


@functools.lru_cache(maxsize=8)
def load(path: str | None, place: str | None, mtime_ns: int | None, size: int | None) -> _core.Dialect:
    return _core.Dialect(path)
