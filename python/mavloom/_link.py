# SPDX-License-Identifier: MIT
"""Live links."""
from __future__ import annotations

import contextlib
import os
import time
from collections.abc import AsyncIterator, Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, TypeVar, overload

from . import _hints, _silence, _views
from ._core import Dialect, LinkRecorder, LinkStats, Message, Port, RingWriter, Subscription, is_vehicle
from ._errors import ClosedError, UsageError
from ._sends import Calls, Sends
from ._types import MessageTypes
from ._vehicle import AsyncVehicle, ExchangeQueues, Vehicle

if TYPE_CHECKING:
    from typing_extensions import Buffer

M = TypeVar("M", bound=Message)

DEFAULT_BUFFER_BYTES = 16 << 20  # about 250,000 messages
# ArduPilot accepts system 255 as its ground station. Ground stations do not use component 193: QGroundControl is
# 255/190.
DEFAULT_SOURCE = (255, 193)


def is_vehicle_heartbeat(heartbeat: Message) -> bool:
    """Whether a HEARTBEAT comes from a vehicle."""
    return is_vehicle(heartbeat["type"], heartbeat["autopilot"])


class Link(Sends):
    """One endpoint (docs/guide/endpoints.md) and all its peers.

    The endpoint is a listening port, a connection that is restored whenever it breaks, a serial device, or a ring in
    shared memory. A C++ thread receives messages independently of Python. Unread messages wait in a buffer of `buffer`
    bytes. When it is full, the oldest are overwritten and counted in `stats.missed`. Any thread may call any method.

    A link closes by `close()`, at the end of `with`, or when the object and its iterators and subscriptions are gone.
    Closing frees the port at once. Later calls raise ClosedError, and iterations end. A forked process must open links
    of its own.
    """

    __slots__ = ("_reader", "_exchanges", "_silence", "mav", "__weakref__")

    def __init__(self, url: str, *, source_system: int = DEFAULT_SOURCE[0], source_component: int = DEFAULT_SOURCE[1],
                 dialect: Dialect | None = None, buffer: int = DEFAULT_BUFFER_BYTES, version: int = 2) -> None:
        """Opens the endpoint at once. Raises SystemFailure if, for example, the port is in use, and UsageError for a
        wrong address or option.

        If the far side is absent, the link keeps trying in the background. With `required=true` in the address, the
        call waits up to 5 s for an answer from the far side, and raises SystemFailure if there is none. If the far side
        refuses or the device is missing, it raises SystemFailure at once.
        """
        check_url(url)
        super().__init__(Port(url, source_system, source_component, dialect, buffer, version))
        self._reader: Subscription = self._port.reader
        self._exchanges = ExchangeQueues()
        self._silence = _silence.Warned()
        self.mav = Sender(self._port)

    # ---- receiving

    def __iter__(self) -> Iterator[Message]:
        """Yields messages in the order of arrival, until the link is closed."""
        # Not `yield from`, which would close the reader with the iterator. The generator's frame keeps the link alive.
        for message in self._reader:
            yield message

    async def __aiter__(self) -> AsyncIterator[Message]:
        """Like iteration, for asyncio. Only one task at a time may wait; other tasks use `subscribe`."""
        async for message in self._reader:
            yield message

    def recv(self, timeout: float | None = None) -> Message | None:
        """Returns the next message, or None after `timeout` seconds (0 polls, None waits indefinitely).

        Raises ClosedError if the link is closed, or if it closes during the wait.
        """
        return self._reader.recv(timeout)

    @overload
    def recv_match(self, condition: Callable[[M], object] | None = None, *, type: type[M], blocking: bool | None = None,
                   timeout: float | None = None, system: int | None = None,
                   component: int | None = None) -> M | None: ...

    @overload
    def recv_match(self, condition: Callable[[Any], object] | None = None, type: MessageTypes | None = None,
                   blocking: bool | None = None, timeout: float | None = None, system: int | None = None,
                   component: int | None = None) -> Message | None: ...

    def recv_match(self, condition: Callable[[Any], object] | None = None, type: MessageTypes | None = None,
                   blocking: bool | None = None, timeout: float | None = None, system: int | None = None,
                   component: int | None = None) -> Message | None:
        """Returns the next message of these types for which `condition(message)` is true, and skips those before it.

        `type` takes names or classes of mavloom.messages. An unknown name raises a ValueError that suggests the nearest
        one. If there is no such message, returns None: after `timeout` seconds, or at once without a time-out. With
        `blocking=True` and no time-out it waits indefinitely; with `blocking=False` it never waits.
        """
        return self._reader.recv_match(condition, type, blocking, timeout, system, component)

    def subscribe(self, type: MessageTypes | None = None, *, system: int | None = None,
                  component: int | None = None) -> Subscription:
        """Returns a new reader of the messages that arrive from now on.

        Each reader gets every message. A reader keeps the link open as long as it exists.
        """
        return self._port.subscribe(type, system, component)

    @overload
    def latest(self, type: type[M], *, system: int | None = None, component: int | None = None,
               instance: int | str | None = None, max_age: float | None = None) -> M | None: ...

    @overload
    def latest(self, type: MessageTypes, *, system: int | None = None, component: int | None = None,
               instance: int | str | None = None, max_age: float | None = None) -> Message | None: ...

    def latest(self, type: MessageTypes, *, system: int | None = None, component: int | None = None,
               instance: int | str | None = None, max_age: float | None = None) -> Message | None:
        """Returns the newest message of this type; None if none arrived, or none in the last `max_age` seconds.

        `instance` selects one of several sensors that send the same message. `recv` still returns the message.
        """
        return self._port.latest(type, system, component, instance, max_age)

    def pump(self, writer: RingWriter, timeout: float | None = None) -> int:
        """Writes the frames that arrive to a ring, for `timeout` seconds (None: until the link is closed).

        Works in C++ without the GIL. Returns the number of frames written. `recv` does not return these frames. A
        subscription has its own `pump`.
        """
        if not isinstance(writer, RingWriter):
            raise UsageError(f"pump() takes a RingWriter, not {writer!r}")
        return self._reader.pump(writer, timeout)

    # ---- sending

    def forward(self, message: Message | Buffer, /) -> int:
        """Sends a Message, or the bytes of one whole frame, unchanged. Returns the number of peers, like `send`.

        Keeps source, sequence number, version and signature; with `sign=`, the link's signature replaces the original
        one. Also sends messages without a definition. Raises InputError if the bytes are not a frame.
        """
        return self._port.forward(message)

    def serve_inlet(self, ring: str, *, mode: int = 0o600) -> None:
        """Opens the inlet of a ring that this link fills with `pump`, so that readers of the ring can answer.

        Programs that read the ring send frames to the Unix socket RUN/`ring`.in. Each frame goes unchanged to every
        peer of this link. `mode` is the socket's file mode: it decides who may send. `stats.answers` counts these
        frames, and `stats.unheard_answers` those for which there was no peer. Closing the link closes the inlet. Raises
        SystemFailure if another process serves the socket, and UsageError for a second inlet of one link.
        """
        if not isinstance(ring, str):
            raise UsageError(f"serve_inlet() takes the name of a ring, not {ring!r}")
        self._port.serve_inlet(ring, mode)

    # ---- recording

    def record(self, path: str | os.PathLike[str]) -> LinkRecorder:
        """Records every frame that arrives from now on to a tlog: `with link.record("flight.tlog"): ...`.

        A thread of its own writes the file. An existing file is renamed. The recording ends with `close()`, with the
        `with` block, or with the link.
        """
        return self._port.record(path)

    # ---- vehicles

    def vehicle(self, system: int | None = None, component: int | None = None, *, timeout: float = 10.0) -> Vehicle:
        """Returns a Vehicle: arm, set_mode, takeoff, land, command, params, mission.

        Without `system`, this is the first vehicle that the link hears. Raises TimeoutError if it hears none within
        `timeout` seconds. Without `component`, the Vehicle has the component that was heard; if `system` is given, it
        has component 1.
        """
        if component is not None:
            component = target_id("component", component)
        first = (target_id("system", system), 1) if system is not None else self._first_vehicle(timeout)
        return Vehicle(self, first[0], first[1] if component is None else component)

    def vehicle_async(self, system: int, component: int = 1) -> AsyncVehicle:
        """Returns an AsyncVehicle, whose methods must be awaited."""
        return AsyncVehicle(self, target_id("system", system), target_id("component", component))

    def _first_vehicle(self, timeout: float) -> tuple[int, int]:
        beats = self.subscribe("HEARTBEAT")
        if not self.target_system:
            beats.recv_match(lambda _: self.target_system, blocking=True, timeout=timeout)
        beats.close()
        if not self.target_system:
            raise self._no_vehicle(timeout)
        return self.target_system, self.target_component

    def _no_vehicle(self, timeout: float) -> TimeoutError:
        return TimeoutError(f"{self.name}: no vehicle within {timeout:g} s: {_silence.reason(self)}")

    # ---- state

    @property
    def stats(self) -> LinkStats:
        """A snapshot of the counters. After closing, returns the last snapshot."""
        return self._port.stats

    @property
    def name(self) -> str:
        """The label of the endpoint. If the address asked for port 0, it shows the port that the system chose."""
        return self._port.name

    @property
    def port(self) -> int:
        """The bound port; 0 if there is none."""
        return self._port.port

    @property
    def version(self) -> int:
        """The MAVLink version that `send` writes, 1 or 2; both are always read."""
        return self._port.version

    @property
    def dialect(self) -> Dialect:
        """The definitions that this link decodes and encodes with."""
        return self._port.dialect

    def close(self) -> None:
        """Sends queued frames, closes the link and wakes waiting readers. May be called again."""
        self._port.close()

    def __enter__(self) -> Link:
        return self

    def __exit__(self, *args: object) -> None:
        self.close()

    if not TYPE_CHECKING:
        def __getattr__(self, name: str) -> None:
            raise _hints.no_attribute(self, name, _hints.LINK)

    def __repr__(self) -> str:
        return _views.link_text(self)

    def _repr_html_(self) -> str:
        return _views.link_html(self)

    # ---- names that pymavlink users know

    @property
    def target_system(self) -> int:
        """System id of the first vehicle heard; 0 before."""
        return self._port.target_system

    @property
    def target_component(self) -> int:
        """Component id of the first vehicle heard; 0 before."""
        return self._port.target_component

    def wait_heartbeat(self, blocking: bool = True, timeout: float | None = None) -> Message | None:
        """Returns the next heartbeat of a vehicle, or None after `timeout` seconds.

        Ground stations, gimbals, cameras, ADS-B receivers and onboard controllers are not vehicles. A heartbeat with a
        vehicle's type, such as quadrotor, comes from a vehicle even if it names no autopilot.

        If none arrives, a RuntimeWarning states why, once: after the time-out, or after 5 s of a longer wait.
        """
        def wait(seconds: float | None) -> Message | None:
            return self.recv_match(is_vehicle_heartbeat, "HEARTBEAT", blocking, seconds)
        return self._silence.watch(self, wait, timeout if blocking else 0)

    def wait_vehicle(self, timeout: float) -> Message:
        """Like wait_heartbeat, but raises TimeoutError after `timeout` seconds."""
        heartbeat = self.recv_match(is_vehicle_heartbeat, "HEARTBEAT", timeout=timeout)
        if heartbeat is None:
            raise self._no_vehicle(timeout)
        return heartbeat

    @property
    def messages(self) -> Mapping[str, Message]:
        """The newest messages of the target system, by name. Raises KeyError for a message that was not received.

        For example link.messages["ATTITUDE"], or with an instance "BATTERY_STATUS[1]" or "NAMED_VALUE_FLOAT[name]".
        """
        return Latest(self)

    def field(self, type: str, field: str, default: Any = None) -> Any:
        """Returns the newest value of a field, or `default` if no such message arrived."""
        message = self._newest(type)
        return default if message is None else message[field]

    def time_since(self, type: str) -> float:
        """Returns the seconds since the newest message of this type arrived; infinity if none did."""
        message = self._newest(type)
        return float("inf") if message is None else time.time() - message.time_ns * 1e-9

    def _newest(self, type: str) -> Message | None:
        """Raises UsageError, which suggests the nearest name, if there is no message of this name."""
        with contextlib.suppress(KeyError):
            return self.messages[type]
        return None

    def packet_loss(self, system: int | None = None, component: int | None = None) -> float:
        """Returns the percentage of frames lost before they arrived, 0 to 100, from all sources or the selected ones.

        Late and duplicate frames do not count as lost. `stats.sources` has the figures of each source.
        """
        for what, number in (("system", system), ("component", component)):
            if number is not None and (not isinstance(number, int) or not 0 <= number <= 255):
                raise UsageError(f"{what}: {number!r} is out of range, 0 to 255")
        chosen = [source for source in self.stats.sources
                  if system in (None, source.sys) and component in (None, source.comp)]
        lost = sum(source.lost for source in chosen)
        return 100.0 * lost / max(lost + sum(source.received - source.duplicate for source in chosen), 1)


class Latest(Mapping[str, Message]):
    """A mapping from message names to the newest messages of a link's target system."""

    def __init__(self, link: Link) -> None:
        self._link = link

    def __getitem__(self, key: str) -> Message:
        """Raises KeyError if no such message arrived, and UsageError if there is no message of this name."""
        if not isinstance(key, str):
            raise UsageError(f"messages are found by their names, such as \"ATTITUDE\", not by {key!r}")
        name, bracket, rest = key.partition("[")
        instance: int | str | None = rest.rstrip("]") if bracket else None
        if instance is not None and not any(field.instance and field.type == "char"
                                            for field in self._link.dialect[name].fields):
            with contextlib.suppress(ValueError):
                instance = int(instance)
        message = self._link.latest(name, system=self._link.target_system or None, instance=instance)
        if message is None:
            raise KeyError(key)
        return message

    def get(self, key: str, default: Any = None) -> Any:
        """Returns the newest message, or `default` if none arrived or if there is no message of this name."""
        try:
            return self[key]
        except (KeyError, UsageError):
            return default

    def __contains__(self, key: object) -> bool:
        return self.get(key) is not None  # type: ignore[arg-type]

    def __iter__(self) -> Iterator[str]:
        system = self._link.target_system or None
        return (name for name in self._link.dialect.message_names if self._link.latest(name, system=system) is not None)

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)

    def __repr__(self) -> str:
        try:
            return f"<newest messages of system {self._link.target_system}: {', '.join(self) or 'none'}>"
        except ClosedError:
            return f"<newest messages of {self._link.name}, which is closed>"


class Sender(Calls):
    """link.mav: NAME_send(...) and NAME_encode(...) for every message.

    Fields are given in the order of the definition, or by name. `srcSystem`, `srcComponent` and `seq` are those of the
    next frame that the link sends.
    """

    __slots__ = ()

    @property
    def srcSystem(self) -> int:
        return self._port.source_system

    @srcSystem.setter
    def srcSystem(self, value: int) -> None:
        self._port.source_system = value

    @property
    def srcComponent(self) -> int:
        return self._port.source_component

    @srcComponent.setter
    def srcComponent(self, value: int) -> None:
        self._port.source_component = value

    @property
    def seq(self) -> int:
        return self._port.sequence

    @seq.setter
    def seq(self, value: int) -> None:
        self._port.sequence = value

    def send(self, message: Message) -> int:
        """Sends a message with the link's source and next sequence number. Returns the number of peers."""
        return self._port.send(message)

    def __repr__(self) -> str:
        return f"<Sender of {self._port.name}: {self.srcSystem}/{self.srcComponent}, next seq {self.seq}>"


def check_url(url: object) -> None:
    if not isinstance(url, str):
        raise UsageError(f"connect() takes an endpoint such as \"udpin://0.0.0.0:14550\", not {url!r}")


def target_id(what: str, number: int) -> int:
    if not isinstance(number, int) or isinstance(number, bool) or not 1 <= number <= 255:
        raise UsageError(f"{what}: {number!r} is out of range, 1 to 255")
    return number


def connect(url: str, *, source_system: int = DEFAULT_SOURCE[0], source_component: int = DEFAULT_SOURCE[1],
            dialect: Dialect | None = None, buffer: int = DEFAULT_BUFFER_BYTES, version: int = 2) -> Link:
    """Opens a Link: `mavloom.connect("udpin://0.0.0.0:14550")`.

    Also accepts pymavlink's spelling, `udpin:HOST:PORT`. With `version=1` the link sends MAVLink 1.
    """
    return Link(url, source_system=source_system, source_component=source_component, dialect=dialect, buffer=buffer,
                version=version)
