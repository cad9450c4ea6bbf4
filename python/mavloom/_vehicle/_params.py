# SPDX-License-Identifier: MIT
"""The parameter protocol, with the encodings of PX4 and ArduPilot.

Source: https://mavlink.io/en/services/parameter.html
"""
from __future__ import annotations

import math
import struct
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .. import _modes, enums
from .._core import Message
from .._enums import entry_name
from .._errors import ParameterError, UsageError
from ._commands import known_heartbeat
from ._exchange import Peer, Protocol, wait_until
from ._exclusive import exclusive

if TYPE_CHECKING:
    from typing_extensions import TypeGuard

ANSWERS = ("PARAM_VALUE", "PARAM_ERROR", "HEARTBEAT")
ANSWER_S = 1.0
TRIES = 4
QUIET_S = 1.0  # without a value for this long, the missing ones are requested one by one
AT_ONCE = 10  # requests for missing values that are open at the same time
ENCODES_BYTEWISE = 16  # MAV_PROTOCOL_CAPABILITY
LONGEST_NAME = 16

# MAV_PARAM_TYPE: integers of up to 4 bytes, in a field of 4 bytes.
INTEGERS = {1: "<B", 2: "<b", 3: "<H", 4: "<h", 5: "<I", 6: "<i"}
REAL32 = 9
TOLERANCE = 1e-6  # relative, of a value that a vehicle stores as float


@dataclass(frozen=True)
class Value:
    """A parameter: its value, MAV_PARAM_TYPE and place in the vehicle's list."""
    value: int | float
    type: int
    index: int


def encodes_bytewise(peer: Peer, heartbeat: Message) -> bool:
    """Whether integers are sent as the bytes of the field (PX4), and not as a float of that value (ArduPilot)."""
    if heartbeat["autopilot"] in (_modes.AUTOPILOT_PX4, _modes.AUTOPILOT_ARDUPILOT):
        return bool(heartbeat["autopilot"] == _modes.AUTOPILOT_PX4)
    version = peer.link.latest("AUTOPILOT_VERSION", system=peer.system, component=peer.component)
    return version is not None and bool(version["capabilities"] & ENCODES_BYTEWISE)


def shortest(value: float) -> float:
    """The shortest decimal number that is the same float of 32 bits: 0.15, not 0.15000000596046448."""
    same = struct.pack("<f", value)
    texts = (f"{value:.{digits}g}" for digits in (6, 7, 8))
    return next((short for text in texts if struct.pack("<f", short := float(text)) == same), value)


def decoded(message: Message, bytewise: bool) -> Value:
    kind = message["param_type"]
    value: int | float = message["param_value"]
    if kind in INTEGERS and bytewise:
        value = struct.unpack_from(INTEGERS[kind], message.raw("param_value"))[0]
    elif kind in INTEGERS and math.isfinite(value):
        value = int(value)
    elif kind == REAL32:
        value = shortest(value)
    return Value(value, kind, message["param_index"])


def encoded(name: str, value: float, kind: int, bytewise: bool) -> bytes:
    """The four bytes of `param_value`. Raises UsageError if the value does not fit the type."""
    if kind not in INTEGERS:
        return pack(name, "<f", float(value))
    if not math.isfinite(value) or value != int(value):
        raise UsageError(f"parameter {name} is an integer, not {value}")
    whole = pack(name, INTEGERS[kind], int(value))
    if bytewise:
        return whole.ljust(4, b"\0")
    data = pack(name, "<f", float(value))
    if struct.unpack("<f", data)[0] != value:
        raise UsageError(f"parameter {name}: this vehicle takes values as float, which cannot hold {value}")
    return data


def pack(name: str, layout: str, value: float) -> bytes:
    try:
        return struct.pack(layout, value)
    except (struct.error, OverflowError) as error:
        raise UsageError(f"parameter {name}: {value} does not fit its type: {error}") from None


def is_name(name: object) -> TypeGuard[str]:
    """Whether a parameter can have this name."""
    return isinstance(name, str) and name.isascii() and 1 <= len(name) <= LONGEST_NAME


def check_name(name: str) -> None:
    if not is_name(name):
        raise UsageError(f"{name!r} is not the name of a parameter: 1 to {LONGEST_NAME} ASCII characters")


def answer_about(name: str, deadline: float) -> Protocol[Message | None]:
    """Waits for the next PARAM_VALUE or PARAM_ERROR of this name."""
    while (answer := (yield from wait_until(deadline))) is not None:
        if answer.name in ("PARAM_VALUE", "PARAM_ERROR") and answer["param_id"] == name:
            return answer
    return None


def error_in(peer: Peer, answer: Message, name: str) -> ParameterError:
    reason = entry_name(enums.MAV_PARAM_ERROR, answer["error"]) or answer["error"]
    return ParameterError(f"{peer}: parameter {name}: {reason}", answer["error"])


def read(peer: Peer, name: str) -> Protocol[Value]:
    """Requests one parameter. Raises ParameterError if the vehicle has none of this name and reports it."""
    check_name(name)
    heartbeat = yield from known_heartbeat(peer)
    for _ in range(TRIES):
        peer.send("PARAM_REQUEST_READ", param_id=name, param_index=-1)
        answer = yield from answer_about(name, time.monotonic() + ANSWER_S)
        if answer is not None and answer.name == "PARAM_ERROR":
            raise error_in(peer, answer, name)
        if answer is not None:
            return decoded(answer, encodes_bytewise(peer, heartbeat))
    raise TimeoutError(f"{peer}: no answer about parameter {name} after {TRIES} tries; the vehicle may not have it")


def write(peer: Peer, name: str, value: float, known: Value | None) -> Protocol[Value]:
    """Sets a parameter, and waits until the vehicle confirms it. `known` is the current value; None if unknown."""
    check_name(name)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise UsageError(f"parameter {name}: a value is a number, not {value!r}")
    return exclusive(peer, f"parameter {name}", TRIES * ANSWER_S, written(peer, name, value, known))


def written(peer: Peer, name: str, value: float, known: Value | None) -> Protocol[Value]:
    heartbeat = yield from known_heartbeat(peer)
    bytewise = encodes_bytewise(peer, heartbeat)
    before = known if known is not None else (yield from read(peer, name))
    data = encoded(name, value, before.type, bytewise)
    other: Value | None = None
    for _ in range(TRIES):
        peer.send("PARAM_SET", param_id=name, param_value=data, param_type=before.type)
        answer = yield from answer_about(name, time.monotonic() + ANSWER_S)
        if answer is None:
            continue
        if answer.name == "PARAM_ERROR":
            raise error_in(peer, answer, name)
        now = decoded(answer, bytewise)
        if is_taken(value, now):
            return now
        if other is not None:  # the first one may be a late answer to an earlier request
            break
        other = now
    if other is None:
        raise TimeoutError(f"{peer}: parameter {name} was not confirmed after {TRIES} tries")
    raise ParameterError(f"{peer}: parameter {name} is {other.value}, not {value}: the vehicle did not take it")


def is_taken(sent: float, now: Value) -> bool:
    """Whether the vehicle has the value that was sent. Integers are exact; a float may be rounded."""
    if now.type in INTEGERS:
        return now.value == sent
    return math.isclose(now.value, sent, rel_tol=TOLERANCE) or math.isnan(now.value) and math.isnan(sent)


def fetch(peer: Peer) -> Protocol[dict[str, Value]]:
    """Fetches all parameters. Missing ones are requested one by one."""
    return exclusive(peer, "all parameters", TRIES * QUIET_S, fetched(peer))


def fetched(peer: Peer) -> Protocol[dict[str, Value]]:
    heartbeat = yield from known_heartbeat(peer)
    bytewise = encodes_bytewise(peer, heartbeat)
    found: dict[str, Value] = {}
    seen: set[int] = set()
    count: int | None = None
    in_vain = 0  # rounds without a new value
    while in_vain < TRIES:
        asked: set[int] = set()
        if count is None:
            peer.send("PARAM_REQUEST_LIST")
        else:
            asked.update([i for i in range(count) if i not in seen][:AT_ONCE])
        for index in sorted(asked):
            peer.send("PARAM_REQUEST_READ", param_id="", param_index=index)
        before = len(seen)
        count = yield from collect(found, seen, asked, count, bytewise)
        if count is not None and len(seen) >= count:
            return dict(sorted(found.items()))
        in_vain = 0 if len(seen) > before else in_vain + 1
    if count is None:
        raise TimeoutError(f"{peer}: no answer to the request for all parameters")
    raise TimeoutError(f"{peer}: {count - len(seen)} of {count} parameters did not arrive")


def collect(found: dict[str, Value], seen: set[int], asked: set[int], count: int | None,
            bytewise: bool) -> Protocol[int | None]:
    """Collects values until every requested index has arrived (all parameters if `asked` is empty), or until no new one
    arrives for a while. Returns how many the vehicle has."""
    deadline = time.monotonic() + (QUIET_S if count is not None else ANSWER_S * 2)
    while (answer := (yield from wait_until(deadline))) is not None:
        if answer.name != "PARAM_VALUE":
            continue
        name, index = answer["param_id"], answer["param_index"]
        if index >= answer["param_count"]:  # not one of the list: a value that was set, or PX4's _HASH_CHECK
            if name in found:
                found[name] = decoded(answer, bytewise)
            continue
        count = answer["param_count"]
        found[name] = decoded(answer, bytewise)
        if index not in seen:
            seen.add(index)
            deadline = time.monotonic() + QUIET_S
        if len(seen) >= answer["param_count"] or asked and asked <= seen:
            break
    return count
