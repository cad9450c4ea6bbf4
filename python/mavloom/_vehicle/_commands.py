# SPDX-License-Identifier: MIT
"""The command protocol, and commands that change the mode or arm.

Source: https://mavlink.io/en/services/command.html
"""
from __future__ import annotations

import math
import time
from collections.abc import Callable, Generator

from .. import _modes, enums
from .._core import Message
from .._enums import entry_name
from .._errors import CommandError, UsageError
from .._hints import near
from ._exchange import Peer, Protocol, wait_until
from ._texts import Texts
from ._exclusive import exclusive

ANSWERS = ("COMMAND_ACK", "HEARTBEAT", "STATUSTEXT")
TAKEOFF_ANSWERS = (*ANSWERS, "GLOBAL_POSITION_INT")
ANSWER_S = 1.0  # how long one request waits for its answer
LONGEST_ANSWER_S = 86400
TRIES = 4
MAX_TRIES = 256  # what the field `confirmation` can count
IN_PROGRESS_S = 30.0  # how long a command in progress may report nothing
HEARTBEATS_S = 5.0  # how long a change of mode or of arming may take to appear in heartbeats
POSITION_S = 5.0  # how old the current position may be, and how long it may take to arrive

ACCEPTED, IN_PROGRESS = 0, 5  # MAV_RESULT
ARM_DISARM, DO_SET_MODE, NAV_TAKEOFF, NAV_LAND, RETURN_TO_LAUNCH, REQUEST_MESSAGE = 400, 176, 22, 21, 20, 512  # MAV_CMD
GLOBAL_POSITION_INT_ID = 33
ARMED = 128  # MAV_MODE_FLAG
COPTER_GUIDED = 4  # ArduPilot's mode
FORCE = 21196  # param2 of ARM_DISARM: without the vehicle's own checks


def number_of(command: int | str) -> int:
    """The number of a command: an int, or a name of MAV_CMD with or without its prefix."""
    if isinstance(command, int):
        return int(command)
    members = enums.MAV_CMD.__members__
    for name in (command, f"MAV_CMD_{command}"):
        if name in members:
            return int(members[name])
    hint = near(str(command).removeprefix("MAV_CMD_"), [name.removeprefix("MAV_CMD_") for name in members])
    raise UsageError(f"unknown command {command!r}{hint or '; see mavloom.enums.MAV_CMD'}")


def checked_number(what: str, value: float) -> float:
    """The value as float. Raises UsageError if the value is not a number."""
    if isinstance(value, (str, bytes, bool)):
        raise UsageError(f"{what}: a number, not {value!r}")
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise UsageError(f"{what}: a number, not {value!r}") from None


def name_of(command: int) -> str:
    return entry_name(enums.MAV_CMD, command) or f"command {command}"


def result_name(result: int) -> str:
    return entry_name(enums.MAV_RESULT, result) or f"result {result}"


def command(peer: Peer, number: int, params: tuple[float, ...], timeout: float | None = None,
            tries: int = TRIES) -> Protocol[Message]:
    """Sends a command until it is acknowledged. Returns the acknowledgement.

    Raises CommandError if the vehicle refuses it, and TimeoutError if it does not answer. An acknowledgement
    identifies its command only by number, so a second command with that number waits until the first has ended.
    """
    if len(params) > 7:
        raise UsageError(f"a command has at most 7 parameters, not {len(params)}")
    timeout = ANSWER_S if timeout is None else timeout
    if not 0 < checked_number("timeout", timeout) <= LONGEST_ANSWER_S:
        raise UsageError(f"timeout: {timeout} is out of range, more than 0 to {LONGEST_ANSWER_S} s")
    if not isinstance(tries, int) or not 1 <= tries <= MAX_TRIES:
        raise UsageError(f"tries: {tries!r} is out of range, 1 to {MAX_TRIES}")
    protocol = acknowledged(peer, number, params, timeout, tries)
    return (yield from exclusive(peer, name_of(number), tries * timeout, protocol))


def acknowledged(peer: Peer, number: int, params: tuple[float, ...], timeout: float, tries: int) -> Protocol[Message]:
    fields = {f"param{place}": value for place, value in enumerate(params, 1)}
    texts = Texts()
    for confirmation in range(tries):
        peer.send("COMMAND_LONG", command=number, confirmation=confirmation, **fields)
        answer = yield from acknowledgement(peer, number, timeout, texts)
        if answer is None:
            continue
        if answer["result"] != ACCEPTED:
            yield from texts.late_ones()
            raise refusal(peer, number, answer["result"], texts.found())
        return answer
    raise TimeoutError(f"{peer}: no answer to {name_of(number)} after {tries} tries")


def refusal(peer: Peer, number: int, result: int, texts: tuple[str, ...]) -> CommandError:
    reason = result_name(result)
    if texts:
        reason += ": " + "; ".join(texts)
    return CommandError(f"{peer}: {name_of(number)}: {reason}", result, texts)


def acknowledgement(peer: Peer, number: int, timeout: float,
                    texts: Texts) -> Generator[float, Message | None, Message | None]:
    """Returns the final answer to a command, or None if there is no answer. The command may then be repeated.

    The vehicle's texts until then are noted in `texts`.

    A command in progress must not be repeated, because the vehicle would begin it again. If the vehicle falls silent
    during such a command, raises TimeoutError.
    """
    deadline, in_progress = time.monotonic() + timeout, False
    while (answer := (yield from wait_until(deadline))) is not None:
        if answer.name == "STATUSTEXT":
            texts.note(answer)
        if answer.name != "COMMAND_ACK" or answer["command"] != number or not peer.is_for_us(answer):
            continue
        if answer["result"] != IN_PROGRESS:
            return answer
        deadline, in_progress = time.monotonic() + IN_PROGRESS_S, True
    if in_progress:
        raise TimeoutError(f"{peer}: {name_of(number)} was in progress, then silence for {IN_PROGRESS_S:g} s")
    return None


def heartbeat_with(peer: Peer, what: str, is_so: Callable[[Message], object], seconds: float) -> Protocol[Message]:
    """Waits for a heartbeat for which `is_so(heartbeat)` is true."""
    deadline = time.monotonic() + seconds
    while (answer := (yield from wait_until(deadline))) is not None:
        if answer.name == "HEARTBEAT" and is_so(answer):
            return answer
    raise TimeoutError(f"{peer}: {what} does not appear in its heartbeats within {seconds:g} s")


def known_heartbeat(peer: Peer) -> Protocol[Message]:
    """The newest heartbeat of the vehicle; waits for the first one."""
    heartbeat = peer.heartbeat()
    if heartbeat is None:
        heartbeat = yield from heartbeat_with(peer, "the vehicle", lambda _: True, HEARTBEATS_S)
    return heartbeat


def arm(peer: Peer, armed: bool, force: bool) -> Protocol[None]:
    """Arms or disarms the motors, and waits until the heartbeats report it."""
    yield from command(peer, ARM_DISARM, (float(armed), float(FORCE if force else 0)))
    yield from heartbeat_with(peer, "armed" if armed else "disarmed",
                              lambda beat: bool(beat["base_mode"] & ARMED) is armed, HEARTBEATS_S)


def mode_params(heartbeat: Message, mode: str | int) -> tuple[float, float, float, int]:
    """The parameters of DO_SET_MODE for a mode, and the custom mode that the heartbeats then report."""
    number = mode if isinstance(mode, int) else known_mode(heartbeat, mode)
    if heartbeat["autopilot"] == _modes.AUTOPILOT_PX4:
        main, sub = _modes.px4_mode(number)
        return _modes.CUSTOM_MODE_ENABLED, main, sub, main << 16 | sub << 24
    return _modes.CUSTOM_MODE_ENABLED, number, 0, number


def known_mode(heartbeat: Message, mode: str) -> int:
    number = _modes.custom_mode_of(heartbeat["autopilot"], heartbeat["type"], mode)
    if number is None:
        names = ", ".join(_modes.mode_names(heartbeat["autopilot"], heartbeat["type"]))
        raise UsageError(f"unknown mode {mode!r}: this vehicle has {names or 'no modes with names'}")
    return number


def set_mode(peer: Peer, mode: str | int) -> Protocol[None]:
    """Requests a mode by name or custom mode, and waits until the heartbeats report it."""
    if not isinstance(mode, (str, int)):
        raise UsageError(f"a mode is a name or a number, not {mode!r}")
    heartbeat = yield from known_heartbeat(peer)
    base, main, sub, custom_mode = mode_params(heartbeat, mode)
    yield from command(peer, DO_SET_MODE, (base, main, sub))
    yield from heartbeat_with(peer, f"mode {mode}", lambda beat: beat["custom_mode"] == custom_mode, HEARTBEATS_S)


def takeoff(peer: Peer, altitude: float) -> Protocol[None]:
    """Requests a take-off to `altitude` m above the current position. An ArduPilot is put into mode GUIDED first."""
    if not math.isfinite(checked_number("altitude", altitude)):
        raise UsageError(f"altitude: {altitude} is not an altitude")
    heartbeat = yield from known_heartbeat(peer)
    if heartbeat["autopilot"] == _modes.AUTOPILOT_PX4:
        here = yield from present_place(peer)
        nan = math.nan
        yield from command(peer, NAV_TAKEOFF, (nan, nan, nan, nan, nan, nan, here["alt"] / 1000 + altitude))
        return
    has_names = _modes.mode_names(heartbeat["autopilot"], heartbeat["type"])
    guided = known_mode(heartbeat, "GUIDED") if has_names else COPTER_GUIDED
    if heartbeat["custom_mode"] != guided:
        yield from set_mode(peer, guided)
    yield from command(peer, NAV_TAKEOFF, (0, 0, 0, 0, 0, 0, altitude))


def present_place(peer: Peer) -> Protocol[Message]:
    """A GLOBAL_POSITION_INT of the last seconds. Requests one if there is none."""
    here = peer.link.latest("GLOBAL_POSITION_INT", system=peer.system, component=peer.component, max_age=POSITION_S)
    if here is not None:
        return here
    peer.send("COMMAND_LONG", command=REQUEST_MESSAGE, param1=GLOBAL_POSITION_INT_ID)
    deadline = time.monotonic() + POSITION_S
    while (answer := (yield from wait_until(deadline))) is not None:
        if answer.name == "GLOBAL_POSITION_INT":
            return answer
    raise TimeoutError(f"{peer}: no GLOBAL_POSITION_INT within {POSITION_S:g} s: the altitude above the sea is unknown")


def land(peer: Peer) -> Protocol[None]:
    """Requests a landing at the current position."""
    heartbeat = yield from known_heartbeat(peer)
    unset = math.nan if heartbeat["autopilot"] == _modes.AUTOPILOT_PX4 else 0.0
    yield from command(peer, NAV_LAND, (0, 0, 0, unset, unset, unset, unset))
