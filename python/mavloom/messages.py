# SPDX-License-Identifier: MIT
"""A class for each message of the built-in definitions, for isinstance() and type checkers:

    if isinstance(msg, messages.ATTITUDE): print(msg.roll)

`type=` also accepts these classes instead of names. messages.pyi lists the fields for type checkers and editors.
Every message is an instance of class Message. isinstance() with one of these classes only compares the names, so it
works for messages of any dialect.
"""
from ._core import Dialect, Message
from ._hints import near


class _Kind(type):
    def __instancecheck__(cls, instance):
        return type(instance) is Message and instance.name == cls.__name__


def __getattr__(name):
    dialect = Dialect()
    if name.startswith("_") or name not in dialect:
        raise AttributeError(f"no message {name} in the built-in definitions{near(name, dialect.message_names)}")
    return globals().setdefault(name, _Kind(name, (), {"__module__": __name__}))


def __dir__():
    return sorted(Dialect().message_names)
