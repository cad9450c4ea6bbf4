# SPDX-License-Identifier: MIT
"""The exceptions of this package.

Damaged input on a link or in a recording raises none of them: it is counted.
"""


class Error(Exception):
    """Base class of all errors of this package."""


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
