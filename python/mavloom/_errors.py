# SPDX-License-Identifier: MIT
"""The exceptions of this package. Bytes from outside never raise one: damage is counted."""


class Error(Exception):
    """Above all errors of this package."""


class UsageError(Error, ValueError):
    """A name, value, address or option that was given is wrong; the text says what to type."""


class InputError(Error, ValueError):
    """The content of a file, or of bytes given to decode, is wrong; the text names file and line where there are."""


class SystemFailure(Error, OSError):
    """The operating system refused; `errno` says why where a system call failed."""


class NotFoundError(SystemFailure, FileNotFoundError):
    """A file, device or host does not exist."""


class PermissionDeniedError(SystemFailure, PermissionError):
    """The system refused access."""


class ClosedError(Error):
    """The link or recording was closed, or was opened before a fork and is used in the child."""
