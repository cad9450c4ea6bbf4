# SPDX-License-Identifier: MIT
"""Live links."""
from __future__ import annotations

import contextlib
import time
from collections.abc import AsyncIterator, Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from ._core import Dialect, LinkStats, Message, Port, RingWriter, Subscription
from ._errors import UsageError
from ._types import MessageTypes

if TYPE_CHECKING:
    from typing_extensions import Buffer

DEFAULT_BUFFER_BYTES = 16 << 20  # about 250,000 messages
DEFAULT_SOURCE = (255, 193)  # the system that ArduPilot obeys, with a component that is no ground station's (QGroundControl is 255/190)
NO_VEHICLES = frozenset({6, 18, 26, 27, 30})  # MAV_TYPE: GCS, onboard controller, gimbal, ADS-B, camera
AUTOPILOT_INVALID = 8


def is_vehicle(heartbeat: Message) -> bool:
    """Whether a HEARTBEAT is that of something with an autopilot."""
    return heartbeat["autopilot"] != AUTOPILOT_INVALID and heartbeat["type"] not in NO_VEHICLES


class Link:
    """One endpoint (docs/guide/endpoints.md) and all its peers: a port that listens, a connection that is made again whenever it breaks, a serial device,
    a ring in shared memory.

    Receiving goes on in a thread of C++, whatever Python does. What was not read yet waits in a buffer of `buffer` bytes; then the oldest is overwritten, and
    `stats.missed` tells how much. Every method may be called from any thread. Closing (`close()`, `with`, or when the object and all that was made of it, as
    iterators and subscriptions, are gone) frees the port at once; later calls raise ClosedError, and iterations end. A process that was forked off must open
    links of its own.
    """

    def __init__(self, url: str, *, source_system: int = DEFAULT_SOURCE[0], source_component: int = DEFAULT_SOURCE[1], dialect: Dialect | None = None,
                 buffer: int = DEFAULT_BUFFER_BYTES, version: int = 2) -> None:
        """Opens what can be opened at once (a port that is taken is a SystemFailure); a far side that is absent is waited for in the background, or with
        `required=true` in the address for up to 5 s, and is then a SystemFailure too."""
        self._port = Port(url, source_system, source_component, dialect, buffer, version)
        self._reader: Subscription = self._port.reader
        self.mav = Sender(self._port)

    # ---- receiving

    def __iter__(self) -> Iterator[Message]:
        """Messages in the order of their arrival, until the link is closed."""
        for message in self._reader:  # not `yield from`, which would close the reader with the iterator; the frame keeps the link
            yield message

    async def __aiter__(self) -> AsyncIterator[Message]:
        """As iteration; one task at a time, others `subscribe`."""
        async for message in self._reader:
            yield message

    def recv(self, timeout: float | None = None) -> Message | None:
        """The next message; None after `timeout` seconds (0 polls, None waits for ever)."""
        return self._reader.recv(timeout)

    def recv_match(self, condition: Callable[[Message], object] | None = None, type: MessageTypes | None = None, blocking: bool = False,
                   timeout: float | None = None, system: int | None = None, component: int | None = None) -> Message | None:
        """The next message of these types (names, or classes of mavloom.messages) for which `condition(message)` is true; what comes before it is passed over.
        None when there is none: at once, or with `blocking` after `timeout` seconds. An unknown name is a ValueError with the nearest one."""
        return self._reader.recv_match(condition, type, blocking, timeout, system, component)

    def subscribe(self, type: MessageTypes | None = None, *, system: int | None = None, component: int | None = None) -> Subscription:
        """A reader of its own, from now on: it takes nothing away from others, and keeps the link open while it is there."""
        return self._port.subscribe(type, system, component)

    def latest(self, type: MessageTypes, *, system: int | None = None, component: int | None = None, instance: int | str | None = None,
               max_age: float | None = None) -> Message | None:
        """The newest message of this type that arrived; None where there is none, or none in the last `max_age` seconds. Reads nothing away."""
        return self._port.latest(type, system, component, instance, max_age)

    def pump(self, writer: RingWriter, timeout: float | None = None) -> int:
        """Writes the frames that arrive into a ring, in C++ and without the GIL, for `timeout` seconds (None: until the link is closed). Returns how many.
        They are taken away from `recv`; a subscription has a `pump` of its own."""
        return self._reader.pump(writer, timeout)

    # ---- sending

    def send(self, message: str | Message, /, **fields: Any) -> int:
        """Sends a message by name and fields (as Dialect.encode takes them), or a Message, from this link's source and with its next sequence number. Returns how
        many peers it goes to; with 0 nothing is sent, and counted as `no_peer`. Waits for nobody but a loop that is behind."""
        return self._port.send(message, **fields)

    def forward(self, message: Message | Buffer, /) -> int:
        """Sends a Message, or the bytes of one whole frame, as it is: its own source, sequence number, version and signature (`sign=` puts the link's in its
        place). Also what has no definition. Returns as `send`. Bytes that are no frame are an InputError."""
        return self._port.forward(message)

    def serve_inlet(self, ring: str, *, mode: int = 0o600) -> None:
        """Opens the way back of a ring that is filled from this link (`pump`): programs that read the ring send frames to the Unix socket RUN/`ring`.in, and each
        goes unchanged to every peer of this link. `mode` says who may send. Counted in `stats.answers`, and in `stats.unheard_answers` where no peer was there.
        SystemFailure where another process serves that socket; UsageError for a second inlet of one link. Closing the link closes it.
        """
        self._port.serve_inlet(ring, mode)

    # ---- state

    @property
    def stats(self) -> LinkStats:
        """A snapshot of the counters; after closing the last one."""
        return self._port.stats

    @property
    def name(self) -> str:
        """The endpoint's label, with the port that was given where port 0 was asked for."""
        return self._port.name

    @property
    def port(self) -> int:
        """The bound port; 0 where there is none."""
        return self._port.port

    @property
    def version(self) -> int:
        """The MAVLink version that `send` writes, 1 or 2; both are always read."""
        return self._port.version

    @property
    def dialect(self) -> Dialect:
        return self._port.dialect

    def close(self) -> None:
        """Sends what was queued, closes, wakes who waits. May be called again."""
        self._port.close()

    def __enter__(self) -> Link:
        return self

    def __exit__(self, *args: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<Link {self.name}>"

    # ---- habits of pymavlink users

    @property
    def target_system(self) -> int:
        """System of the first vehicle that was heard; 0 before."""
        return self._port.target_system

    @property
    def target_component(self) -> int:
        """Component of the first vehicle that was heard; 0 before."""
        return self._port.target_component

    def wait_heartbeat(self, blocking: bool = True, timeout: float | None = None) -> Message | None:
        """The next heartbeat of a vehicle (not of a ground station, gimbal, camera, ADS-B receiver or onboard controller); None after `timeout` seconds."""
        return self.recv_match(is_vehicle, "HEARTBEAT", blocking, timeout)

    def wait_vehicle(self, timeout: float) -> Message:
        """As wait_heartbeat, but raises TimeoutError."""
        heartbeat = self.wait_heartbeat(timeout=timeout)
        if heartbeat is None:
            raise TimeoutError(f"{self.name}: no vehicle within {timeout} s")
        return heartbeat

    @property
    def messages(self) -> Mapping[str, Message]:
        """The newest messages of the target system: link.messages["ATTITUDE"], link.messages["BATTERY_STATUS[1]"], "NAMED_VALUE_FLOAT[name]"."""
        return Latest(self)

    def field(self, type: str, field: str, default: Any = None) -> Any:
        """The newest value of a field; `default` where there is none."""
        message = self.messages.get(type)
        return default if message is None else message[field]

    def time_since(self, type: str) -> float:
        """Seconds since the newest message of this type arrived; infinity where there is none."""
        message = self.messages.get(type)
        return float("inf") if message is None else time.time() - message.time_ns * 1e-9

    def packet_loss(self, system: int | None = None, component: int | None = None) -> float:
        """Per cent lost on the way here, of all sources or of these; late and doubled frames are no loss. `stats.sources` has each of them."""
        for what, number in (("system", system), ("component", component)):
            if number is not None and not 0 <= number <= 255:
                raise UsageError(f"{what}: {number} is out of range, 0 to 255")
        chosen = [source for source in self.stats.sources if system in (None, source.sys) and component in (None, source.comp)]
        lost = sum(source.lost for source in chosen)
        return 100.0 * lost / max(lost + sum(source.received - source.duplicate for source in chosen), 1)


class Latest(Mapping[str, Message]):
    """The newest messages of a link's target system."""

    def __init__(self, link: Link) -> None:
        self._link = link

    def __getitem__(self, key: str) -> Message:
        name, bracket, rest = key.partition("[")
        instance: int | str | None = rest.rstrip("]") if bracket else None
        if instance is not None and not any(field.instance and field.type == "char" for field in self._link.dialect[name].fields):
            with contextlib.suppress(ValueError):
                instance = int(instance)
        message = self._link.latest(name, system=self._link.target_system or None, instance=instance)
        if message is None:
            raise KeyError(key)
        return message

    def __iter__(self) -> Iterator[str]:
        system = self._link.target_system or None
        return (name for name in self._link.dialect.message_names if self._link.latest(name, system=system) is not None)

    def __len__(self) -> int:
        return sum(1 for _ in self)


class Sender:
    """link.mav: NAME_send(...) and NAME_encode(...) for every message, with the fields in the order of the definition or by name."""

    def __init__(self, port: Port) -> None:
        self._port = port  # not the Link, which has this object

    def send(self, message: Message) -> int:
        return self._port.send(message)

    def __getattr__(self, call: str) -> Callable[..., Any]:
        name, _, verb = call.rpartition("_")
        if verb not in ("send", "encode") or name.upper() not in self._port.dialect:
            raise AttributeError(f"no message for {call}: NAME_send and NAME_encode, as heartbeat_send")
        info = self._port.dialect[name.upper()]
        act: Callable[..., Any] = self._port.send if verb == "send" else self._port.dialect.message

        def run(*values: Any, **fields: Any) -> Any:
            names = [field.name for field in info.fields]
            if len(values) > len(names):
                raise TypeError(f"{info.name} has {len(names)} fields, not {len(values)}")
            return act(info.name, **dict(zip(names, values)), **fields)
        return run


def connect(url: str, *, source_system: int = DEFAULT_SOURCE[0], source_component: int = DEFAULT_SOURCE[1], dialect: Dialect | None = None,
            buffer: int = DEFAULT_BUFFER_BYTES, version: int = 2) -> Link:
    """Opens a Link: `mavloom.connect("udpin://0.0.0.0:14550")`. pymavlink's spellings (`udpin:HOST:PORT`) are taken too. `version=1` sends MAVLink 1."""
    return Link(url, source_system=source_system, source_component=source_component, dialect=dialect, buffer=buffer, version=version)
