# SPDX-License-Identifier: MIT
"""The enums of the built-in definitions: `from mavloom.enums import MAV_TYPE`.

Each class is created at its first use. enums.pyi lists them for editors.
"""
from . import _enums
from ._core import Dialect
from ._hints import near


def __getattr__(name):
    dialect = Dialect()
    if name not in dialect.enum_names:
        raise AttributeError(f"no enum {name} in the built-in definitions{near(name, dialect.enum_names)}")
    return _enums.make(dialect, name)


def __dir__():
    return sorted(Dialect().enum_names)
