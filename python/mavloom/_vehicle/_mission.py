# SPDX-License-Identifier: MIT
"""The mission protocol: upload, download and clear, of missions, fences and rally points.

Source: https://mavlink.io/en/services/mission.html
"""
from __future__ import annotations

import math
import time
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

from .. import _modes, enums
from .._core import MavutilMessage, Message
from .._enums import entry_name
from .._errors import MissionError, UsageError
from ._commands import checked_number, known_heartbeat, number_of
from ._exchange import Peer, Protocol, T, wait_until
from ._exclusive import exclusive

ANSWERS = ("MISSION_COUNT", "MISSION_REQUEST", "MISSION_REQUEST_INT", "MISSION_ITEM_INT", "MISSION_ACK",
           "HEARTBEAT")
ANSWER_S = 1.5
TRIES = 5
ACCEPTED = 0  # MAV_MISSION_RESULT
MISSION = 0  # MAV_MISSION_TYPE
GLOBAL_RELATIVE_ALT_INT = 6  # MAV_FRAME
DEGREES = 1e7  # of latitude and longitude in x and y
FRAMES_IN_DEGREES = frozenset({0, 3, 5, 6, 10, 11})  # MAV_FRAMEs whose x and y are latitude and longitude
DO_JUMP = 177  # MAV_CMD; param1 is the number of an item
MAX_ITEMS = 65534  # MISSION_COUNT counts to 65535, with the home of an ArduPilot


def scaled(name: str, value: float, scale: float) -> int:
    """A coordinate as the integer that is sent. Raises UsageError if the value is not a number."""
    number = checked_number(name, value)
    if not math.isfinite(number):
        raise UsageError(f"{name}: {number} is not a coordinate")
    return round(number * scale)


def degrees(name: str, value: float, most: int) -> int:
    """A latitude or longitude as the integer that is sent. Raises UsageError if it is out of range."""
    number = scaled(name, value, DEGREES)
    if abs(number) > most * DEGREES:
        raise UsageError(f"{name}: {value} is out of range, -{most} to {most} degrees")
    return number


@dataclass
class MissionItem:
    """One item of a mission. `x` and `y` are degrees * 1e7 in a global frame, else metres * 1e4."""
    command: int = 16  # MAV_CMD_NAV_WAYPOINT
    x: int = 0
    y: int = 0
    z: float = 0.0
    frame: int = GLOBAL_RELATIVE_ALT_INT
    param1: float = 0.0
    param2: float = 0.0
    param3: float = 0.0
    param4: float = 0.0
    current: int = 0
    autocontinue: int = 1

    @classmethod
    def at(cls, lat: float, lon: float, alt: float, command: int | str = 16, **fields: Any) -> MissionItem:
        """An item at a place in degrees, `alt` m above home: MissionItem.at(47.398, 8.546, 20)."""
        x, y = (degrees(name, value, most) for name, value, most in (("lat", lat, 90), ("lon", lon, 180)))
        return cls(number_of(command), x, y, checked_number("alt", alt), **fields)

    @property
    def lat(self) -> float:
        """The latitude in degrees, in a global frame."""
        return self.x / DEGREES

    @property
    def lon(self) -> float:
        """The longitude in degrees, in a global frame."""
        return self.y / DEGREES


HOME = MissionItem(frame=0)  # an ArduPilot puts its own home in its place
FIELDS = tuple(MissionItem.__dataclass_fields__)


def item_of(given: MissionItem | Message | Mapping[str, Any]) -> MissionItem:
    """An item from a MissionItem, a MISSION_ITEM_INT or MISSION_ITEM, or a mapping of the fields."""
    if isinstance(given, MissionItem):
        return given
    if isinstance(given, Message):
        return item_of_message(given.name, given.to_dict())
    if isinstance(given, MavutilMessage):
        values = given.to_dict()
        return item_of_message(values["mavpackettype"], values)
    if not isinstance(given, Mapping):
        raise UsageError(f"an item is a MissionItem, a MISSION_ITEM_INT or a mapping, not {given!r}")
    unknown = set(given) - set(FIELDS)
    if unknown:
        raise UsageError(f"an item of a mission has no {sorted(unknown)[0]!r}; it has {', '.join(FIELDS)}")
    return MissionItem(**given)


def item_of_message(message: str | None, values: Mapping[str, Any]) -> MissionItem:
    if message not in ("MISSION_ITEM_INT", "MISSION_ITEM"):
        raise UsageError(f"a mission has items, not {message}")
    fields = {name: values[name] for name in FIELDS}
    if message == "MISSION_ITEM":
        scale = DEGREES if fields["frame"] in FRAMES_IN_DEGREES else 1e4
        fields.update({name: scaled(name, fields[name], scale) for name in ("x", "y")})
    return MissionItem(**fields)


def raise_if_refused(peer: Peer, what: str, answer: Message) -> None:
    """Raises MissionError if the answer is a MISSION_ACK that refuses."""
    if answer.name == "MISSION_ACK" and (result := answer["type"]) != ACCEPTED:
        reason = entry_name(enums.MAV_MISSION_RESULT, result) or result
        raise MissionError(f"{peer}: {what}: {reason}", result)


def answer_of(peer: Peer, names: tuple[str, ...], kind: int, deadline: float) -> Protocol[Message | None]:
    """Waits for the next of these messages that is about this kind of mission."""
    while (answer := (yield from wait_until(deadline))) is not None:
        if answer.name in names and answer["mission_type"] == kind and peer.is_for_us(answer):
            return answer
    return None


def upload(peer: Peer, items: Iterable[MissionItem | Message | Mapping[str, Any]], kind: int) -> Protocol[None]:
    """Replaces the mission of the vehicle. Raises MissionError if the vehicle refuses it."""
    if not isinstance(items, Iterable):
        raise UsageError(f"upload() takes a list of items, not {items!r}")
    return transfer(peer, items_sent(peer, checked(peer, items, kind), kind))


def transfer(peer: Peer, protocol: Protocol[T]) -> Protocol[T]:
    """Runs a transfer after all earlier ones: a vehicle handles one at a time, even of different kinds of mission."""
    return exclusive(peer, "transfer of a mission", TRIES * ANSWER_S, protocol)


def begins_with_home(peer: Peer, kind: int) -> Protocol[bool]:
    """Whether the vehicle's item 0 is home. ArduPilot stores home as item 0. Callers' lists do not contain it."""
    if kind != MISSION:
        return False
    heartbeat = yield from known_heartbeat(peer)
    return bool(heartbeat["autopilot"] == _modes.AUTOPILOT_ARDUPILOT)


def renumbered(items: list[MissionItem], by: int) -> list[MissionItem]:
    """Returns the items with `by` added to the target of each jump, for a list in which `by` items come before them."""
    return [replace(item, param1=item.param1 + by) if is_jump(item) else item for item in items]


def is_jump(item: MissionItem) -> bool:
    return item.command == DO_JUMP


def with_number(item: MissionItem) -> MissionItem:
    """The item with the number of its command, which may be a name."""
    return replace(item, command=number_of(item.command)) if isinstance(item.command, str) else item


def items_sent(peer: Peer, wanted: list[MissionItem], kind: int) -> Protocol[None]:
    if wanted and (yield from begins_with_home(peer, kind)):
        wanted = [HOME, *renumbered(wanted, 1)]
    last, furthest = len(wanted) - 1, -1  # of the items, and of those that the vehicle has requested
    message: dict[str, Any] = {"name": "MISSION_COUNT", "count": len(wanted), "mission_type": kind}
    peer.send(**message)
    deadline = time.monotonic() + TRIES * ANSWER_S
    while time.monotonic() < deadline:
        answer = yield from answer_of(peer, ("MISSION_REQUEST", "MISSION_REQUEST_INT", "MISSION_ACK"), kind,
                                      time.monotonic() + ANSWER_S)
        if answer is None:
            if furthest in (-1, last):  # between them, the vehicle repeats its request
                peer.send(**message)
        elif answer.name == "MISSION_ACK":
            raise_if_refused(peer, "upload of the mission", answer)
            if furthest == last:
                return
        elif answer["seq"] <= last:
            if answer["seq"] > furthest:
                furthest, deadline = answer["seq"], time.monotonic() + TRIES * ANSWER_S
            message = {"name": "MISSION_ITEM_INT", "seq": answer["seq"], "mission_type": kind,
                       **asdict(wanted[answer["seq"]])}
            peer.send(**message)
    raise TimeoutError(f"{peer}: no answer during the upload of the mission")


def checked(peer: Peer, given: Iterable[MissionItem | Message | Mapping[str, Any]], kind: int) -> list[MissionItem]:
    """Returns the items. Raises UsageError, before anything is sent, if one has a value that cannot be sent."""
    check_kind(peer, kind)
    items = [with_number(item_of(item)) for item in given]
    if len(items) > MAX_ITEMS:
        raise UsageError(f"a mission has at most {MAX_ITEMS} items, not {len(items)}")
    for number, item in enumerate(items):
        try:
            peer.link.dialect.encode("MISSION_ITEM_INT", seq=number, mission_type=kind, **asdict(item))
        except (UsageError, TypeError) as error:
            raise UsageError(f"item {number} of the mission: {error}") from None
    return items


def check_kind(peer: Peer, kind: int) -> None:
    """Raises UsageError for a kind that cannot be sent.

    MAVLink 1 has no field for it: the vehicle would clear or replace its mission instead of the fence.
    """
    if not isinstance(kind, int) or not 0 <= kind <= 255:
        raise UsageError(f"mission_type: a MAV_MISSION_TYPE, 0 to 255, not {kind!r}")
    if kind != MISSION and peer.link.version == 1:
        raise UsageError(f"{peer}: fences and rally points need MAVLink 2; open the link with version=2")


def download(peer: Peer, kind: int) -> Protocol[list[MissionItem]]:
    """Fetches the mission of the vehicle."""
    check_kind(peer, kind)
    return transfer(peer, items_received(peer, kind))


def items_received(peer: Peer, kind: int) -> Protocol[list[MissionItem]]:
    has_home = yield from begins_with_home(peer, kind)
    count = yield from request(peer, "MISSION_REQUEST_LIST", {}, ("MISSION_COUNT",), kind, None)
    items: list[MissionItem] = []
    for seq in range(count["count"]):
        item = yield from request(peer, "MISSION_REQUEST_INT", {"seq": seq}, ("MISSION_ITEM_INT",), kind, seq)
        items.append(item_of(item))
    peer.send("MISSION_ACK", type=ACCEPTED, mission_type=kind)
    return renumbered(items[1:], -1) if has_home else items


def request(peer: Peer, name: str, fields: dict[str, int], answers: tuple[str, ...], kind: int,
            seq: int | None) -> Protocol[Message]:
    """Sends a request until it is answered."""
    for _ in range(TRIES):
        peer.send(name, mission_type=kind, **fields)
        deadline = time.monotonic() + ANSWER_S
        while (answer := (yield from answer_of(peer, (*answers, "MISSION_ACK"), kind, deadline))) is not None:
            raise_if_refused(peer, "download of the mission", answer)
            if answer.name in answers and (seq is None or answer["seq"] == seq):
                return answer
    raise TimeoutError(f"{peer}: no answer to {name} after {TRIES} tries")


def clear(peer: Peer, kind: int) -> Protocol[None]:
    """Deletes the mission of the vehicle."""
    check_kind(peer, kind)
    return transfer(peer, cleared(peer, kind))


def cleared(peer: Peer, kind: int) -> Protocol[None]:
    for _ in range(TRIES):
        peer.send("MISSION_CLEAR_ALL", mission_type=kind)
        answer = yield from answer_of(peer, ("MISSION_ACK",), kind, time.monotonic() + ANSWER_S)
        if answer is not None:
            raise_if_refused(peer, "clearing the mission", answer)
            return
    raise TimeoutError(f"{peer}: no answer to MISSION_CLEAR_ALL after {TRIES} tries")
