# SPDX-License-Identifier: MIT
"""The base classes of Link and of link.mav. Their stub, _sends.pyi, has the fields of every message."""
from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from ._core import Message, MessageInfo, Port
from ._signatures import parameter_name


class Sends:
    """The method `send` of a link."""

    __slots__ = ("_port",)

    def __init__(self, port: Port) -> None:
        self._port = port

    def send(self, message: str | Message, /, **fields: Any) -> int:
        """Sends a message, given by name and fields as for Dialect.encode, or as a Message.

        The frame has the link's source ids and its next sequence number. Returns the number of peers. If that is 0,
        nothing is sent and `stats.no_peer` counts it. Blocks only while the link's loop thread is behind.
        """
        return self._port.send(message, **fields)


class Call:
    """link.mav.NAME_send or NAME_encode: fields in the order of the definition, or by name."""

    def __init__(self, act: Callable[..., Any], info: MessageInfo, name: str) -> None:
        self._act = functools.partial(act, info.name)
        self._names = [field.name for field in info.fields]
        self.__name__ = name
        self.__doc__ = f"{'Sends' if name.endswith('_send') else 'Returns'} a {info.name}. Fields left out are 0."
        import inspect
        parameters = [inspect.Parameter(parameter_name(field), inspect.Parameter.POSITIONAL_OR_KEYWORD,
                                        default=3 if field == "mavlink_version" else 0) for field in self._names]
        self.__signature__ = inspect.Signature(parameters)

    def __call__(self, *values: Any, **fields: Any) -> Any:
        if len(values) > len(self._names):
            raise TypeError(f"{self.__name__} takes {len(self._names)} fields, not {len(values)}")
        return self._act(**dict(zip(self._names, values)), **fields)

    def __repr__(self) -> str:
        return f"<{self.__name__}{self.__signature__}>"


class Calls:
    """NAME_send(...) and NAME_encode(...) for every message."""

    __slots__ = ("_port",)

    def __init__(self, port: Port) -> None:
        self._port = port  # not the Link, which would make a reference cycle

    def __getattr__(self, call: str) -> Callable[..., Any]:
        name, _, verb = call.rpartition("_")
        if verb not in ("send", "encode") or name.upper() not in self._port.dialect:
            raise AttributeError(f"no message for {call}: use NAME_send or NAME_encode, for example heartbeat_send")
        act: Callable[..., Any] = self._port.send if verb == "send" else self._port.dialect.message
        return Call(act, self._port.dialect[name.upper()], call)

    def __dir__(self) -> list[str]:
        names = [name.lower() for name in self._port.dialect.message_names]
        return sorted({*object.__dir__(self), *(f"{name}_{verb}" for name in names for verb in ("send", "encode"))})
