# SPDX-License-Identifier: MIT
"""The exceptions of this package.

Damaged input on a link or in a recording does not raise an error. It is counted.
"""
from __future__ import annotations


class Error(Exception):
    """Base class of all errors of this package."""
    # No __init__ in Python, because the compiled module raises these errors. When Python exits, it ends daemon threads
    # while they run Python code. If C++ had called that code, this would end the process.


class UsageError(Error, ValueError):
    """A name, value, address or option is wrong. The text states what to use instead."""


class InputError(Error, ValueError):
    """The content of a file, or of bytes to decode, is wrong. The text names file and line if there are any."""


class SystemFailure(Error, OSError):
    """The operating system refused an operation. If a system call failed, `errno` is its error number."""


class NotFoundError(SystemFailure, FileNotFoundError):
    """A file, device or host does not exist."""


class PermissionDeniedError(SystemFailure, PermissionError):
    """The operating system denied access."""


class ClosedError(Error):
    """The object was closed, its ring was removed, or it was opened before a fork and is used in the child."""


class CommandError(Error):
    """A vehicle refused a command. `result` is its MAV_RESULT, and `texts` are its texts (STATUSTEXT) about it."""

    def __init__(self, text: str, result: int | None = None, texts: tuple[str, ...] = ()) -> None:
        super().__init__(text)
        self.result = result
        self.texts = texts


class ParameterError(Error):
    """A vehicle refused to read or write a parameter. `result` is its MAV_PARAM_ERROR, if it sent one."""

    def __init__(self, text: str, result: int | None = None) -> None:
        super().__init__(text)
        self.result = result


class MissionError(Error):
    """A vehicle refused a mission. `result` is its MAV_MISSION_RESULT."""

    def __init__(self, text: str, result: int | None = None) -> None:
        super().__init__(text)
        self.result = result
