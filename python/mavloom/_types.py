# SPDX-License-Identifier: MIT
"""Types of arguments."""
from __future__ import annotations

import collections.abc
from typing import Union

# The argument `type=`: a name, a class of mavloom.messages, or several.
MessageTypes = Union[str, type, collections.abc.Iterable[Union[str, type]]]
