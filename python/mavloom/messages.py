# SPDX-License-Identifier: MIT
"""A class for each message of the built-in definitions, for isinstance() and for type checkers, which then know the fields:

    if isinstance(msg, messages.ATTITUDE): print(msg.roll)

They also stand for their names in `type=`. messages.pyi shows the fields to editors. Messages are always made as class Message: these classes only tell
which one it is, whatever dialect it came with."""
from ._core import Dialect, Message


class _Kind(type):
    def __instancecheck__(cls, instance):
        return type(instance) is Message and instance.name == cls.__name__


def __getattr__(name):
    if name.startswith("_") or name not in Dialect():
        raise AttributeError(f"no message {name} in the built-in definitions")
    return globals().setdefault(name, _Kind(name, (), {"__module__": __name__}))


def __dir__():
    return sorted(Dialect().message_names)
