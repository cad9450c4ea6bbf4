# SPDX-License-Identifier: MIT
"""Vehicle and AsyncVehicle: what users call."""
from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, MutableMapping
from typing import TYPE_CHECKING, Any

from .. import _hints, _modes
from .._core import Message
from .._errors import ClosedError, ParameterError
from . import _commands, _mission, _params
from ._exchange import Peer, run, run_async
from ._mission import MissionItem

if TYPE_CHECKING:
    from .._link import Link

Items = Iterable["MissionItem | Message | Mapping[str, Any]"]


class _Common:
    def __init__(self, link: Link, system: int, component: int) -> None:
        self._peer = Peer(link, system, component)

    @property
    def link(self) -> Link:
        return self._peer.link

    @property
    def system(self) -> int:
        return self._peer.system

    @property
    def component(self) -> int:
        return self._peer.component

    @property
    def heartbeat(self) -> Message | None:
        """The newest heartbeat; None if none arrived yet."""
        return self._peer.heartbeat()

    @property
    def mode(self) -> str | None:
        """The name of the flight mode in the newest heartbeat."""
        beat = self._peer.heartbeat()
        if beat is None:
            return None
        return _modes.mode_name(beat["autopilot"], beat["type"], beat["base_mode"], beat["custom_mode"])

    @property
    def armed(self) -> bool:
        """Whether the newest heartbeat reports armed motors."""
        beat = self._peer.heartbeat()
        return beat is not None and bool(beat["base_mode"] & _commands.ARMED)

    @property
    def modes(self) -> list[str]:
        """The names of this vehicle's modes; empty before its first heartbeat. set_mode takes other names, too."""
        beat = self._peer.heartbeat()
        return [] if beat is None else _modes.mode_names(beat["autopilot"], beat["type"])

    if not TYPE_CHECKING:
        def __getattr__(self, name: str) -> None:
            raise _hints.no_attribute(self, name, _hints.OF_VEHICLE)

        def __setattr__(self, name: str, value: object) -> None:
            if name in _hints.SET_ON_VEHICLE:
                raise AttributeError(_hints.with_hint(f"{name} cannot be set", name, _hints.SET_ON_VEHICLE))
            object.__setattr__(self, name, value)

    def _state(self) -> str:
        try:
            if self.heartbeat is None:
                return "no heartbeat yet"
            return f"{self.mode}, {'' if self.armed else 'dis'}armed"
        except ClosedError:
            return "the link is closed"

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.system}/{self.component} on {self.link.name}: {self._state()}>"


class Vehicle(_Common):
    """A vehicle on a link, from `link.vehicle()`. Its methods wait for the vehicle's answer.

    They resend lost requests. They raise CommandError, ParameterError or MissionError, with the vehicle's reason, if it
    refuses, and TimeoutError if it does not answer. A CommandError also has the texts that the vehicle sent about it.

    Any thread may call them. On one link, calls whose answers cannot be distinguished take turns: transfers of
    missions, fetches of all parameters, commands with the same number, and writes of the same parameter. A waiting call
    raises TimeoutError if the vehicle does not answer the call in front of it.
    """

    def __init__(self, link: Link, system: int, component: int) -> None:
        super().__init__(link, system, component)
        self.params = Params(self._peer)
        self.mission = Mission(self._peer)

    def command(self, command: int | str, *params: float, timeout: float = _commands.ANSWER_S,
                tries: int = _commands.TRIES) -> Message:
        """Sends a command as COMMAND_LONG; parameters that are not given are 0. Returns its COMMAND_ACK.

        `command` is a number or a name of MAV_CMD: vehicle.command("DO_SET_SERVO", 9, 1500). It is sent up to `tries`
        times, and each time the vehicle has `timeout` seconds to answer. A command in progress may take longer.
        """
        number = _commands.number_of(command)
        return run(self._peer, _commands.ANSWERS, _commands.command(self._peer, number, params, timeout, tries))

    def arm(self, *, force: bool = False) -> None:
        """Arms the motors, and waits until the heartbeats report it. `force` skips the vehicle's own checks."""
        run(self._peer, _commands.ANSWERS, _commands.arm(self._peer, True, force))

    def disarm(self, *, force: bool = False) -> None:
        """Disarms the motors. With `force`, disarms even in flight."""
        run(self._peer, _commands.ANSWERS, _commands.arm(self._peer, False, force))

    def set_mode(self, mode: str | int) -> None:
        """Changes the flight mode, and waits until the heartbeats report it.

        `modes` has the names. Other names for a mode, and any case, work too: "Hold", "LOITER" and "AUTO.LOITER".
        """
        run(self._peer, _commands.ANSWERS, _commands.set_mode(self._peer, mode))

    def takeoff(self, altitude: float) -> None:
        """Takes off to `altitude` m above the current position. The motors must be armed."""
        run(self._peer, _commands.TAKEOFF_ANSWERS, _commands.takeoff(self._peer, altitude))

    def land(self) -> None:
        """Lands at the current position."""
        run(self._peer, _commands.ANSWERS, _commands.land(self._peer))

    def return_to_launch(self) -> None:
        """Returns to the launch place, and lands there if the vehicle is set up to. Does not wait until it is there."""
        self.command(_commands.RETURN_TO_LAUNCH)


class Params(MutableMapping[str, "int | float"]):
    """The parameters of a vehicle as a mapping: vehicle.params["MPC_XY_VEL_MAX"] = 8.

    The first access requests the parameter; later accesses return the cached value. `fetch()` requests all of them, as
    iteration does. Setting a parameter waits for the vehicle's confirmation.

    An ArduPilot does not answer a request for a parameter that it does not have, so `params[name]`, `get` and `in`
    raise TimeoutError for such a name. After `fetch()` they know all names and request nothing.
    """

    def __init__(self, peer: Peer) -> None:
        self._peer = peer
        self._known: dict[str, _params.Value] = {}
        self._is_complete = False

    def fetch(self) -> dict[str, int | float]:
        """Requests all parameters. Returns {name: value}."""
        self._known = run(self._peer, _params.ANSWERS, _params.fetch(self._peer))
        self._is_complete = True
        return {name: one.value for name, one in self._known.items()}

    def __getitem__(self, name: str) -> int | float:
        """Raises KeyError if the vehicle has no such parameter."""
        if name not in self._known:
            if self._is_complete:
                raise KeyError(name)
            try:
                self._known[name] = run(self._peer, _params.ANSWERS, _params.read(self._peer, name))
            except ParameterError as error:
                raise KeyError(name) from error
        return self._known[name].value

    def __setitem__(self, name: str, value: float) -> None:
        known = self._known.get(name)
        self._known[name] = run(self._peer, _params.ANSWERS, _params.write(self._peer, name, value, known))

    def type_of(self, name: str) -> int:
        """The MAV_PARAM_TYPE of a parameter."""
        self[name]
        return self._known[name].type

    def __delitem__(self, name: str) -> None:
        """Forgets the cached value, so that the next access requests it again."""
        del self._known[name]
        self._is_complete = False

    def clear(self) -> None:
        """Forgets all cached values."""
        self._known = {}
        self._is_complete = False

    def __iter__(self) -> Iterator[str]:
        if not self._is_complete:
            self.fetch()
        return iter(list(self._known))

    def __len__(self) -> int:
        if not self._is_complete:
            self.fetch()
        return len(self._known)

    def __contains__(self, name: object) -> bool:
        if not _params.is_name(name):
            return False
        try:
            self[name]
        except KeyError:
            return False
        return True

    def _ipython_key_completions_(self) -> list[str]:
        return list(self._known)

    def __repr__(self) -> str:
        return f"<Params of system {self._peer.system}: {len(self._known)} known>"


class Mission:
    """The mission of a vehicle. `mission_type` is a MAV_MISSION_TYPE: 0 the mission, 1 the fence, 2 rally points.

    A mission has no home. ArduPilot keeps its home as item 0: `upload` adds that item, and `download` leaves it out.
    The number of an item, in the parameters of DO_JUMP, is its index in the list.
    """

    def __init__(self, peer: Peer) -> None:
        self._peer = peer

    def upload(self, items: Items, mission_type: int = 0) -> None:
        """Replaces the mission. Items are MissionItem, MISSION_ITEM_INT messages, or mappings of their fields."""
        run(self._peer, _mission.ANSWERS, _mission.upload(self._peer, items, mission_type))

    def download(self, mission_type: int = 0) -> list[MissionItem]:
        """Returns the items of the mission."""
        return run(self._peer, _mission.ANSWERS, _mission.download(self._peer, mission_type))

    def clear(self, mission_type: int = 0) -> None:
        """Deletes the mission."""
        run(self._peer, _mission.ANSWERS, _mission.clear(self._peer, mission_type))

    def __repr__(self) -> str:
        return f"<Mission of system {self._peer.system}>"


class AsyncVehicle(_Common):
    """A vehicle for asyncio, from `link.vehicle_async()`: the methods of Vehicle, as coroutines."""

    def __init__(self, link: Link, system: int, component: int) -> None:
        super().__init__(link, system, component)
        self.params = AsyncParams(self._peer)
        self.mission = AsyncMission(self._peer)

    async def command(self, command: int | str, *params: float, timeout: float = _commands.ANSWER_S,
                      tries: int = _commands.TRIES) -> Message:
        """See Vehicle.command."""
        protocol = _commands.command(self._peer, _commands.number_of(command), params, timeout, tries)
        return await run_async(self._peer, _commands.ANSWERS, protocol)

    async def arm(self, *, force: bool = False) -> None:
        """See Vehicle.arm."""
        await run_async(self._peer, _commands.ANSWERS, _commands.arm(self._peer, True, force))

    async def disarm(self, *, force: bool = False) -> None:
        """See Vehicle.disarm."""
        await run_async(self._peer, _commands.ANSWERS, _commands.arm(self._peer, False, force))

    async def set_mode(self, mode: str | int) -> None:
        """See Vehicle.set_mode."""
        await run_async(self._peer, _commands.ANSWERS, _commands.set_mode(self._peer, mode))

    async def takeoff(self, altitude: float) -> None:
        """See Vehicle.takeoff."""
        await run_async(self._peer, _commands.TAKEOFF_ANSWERS, _commands.takeoff(self._peer, altitude))

    async def land(self) -> None:
        """See Vehicle.land."""
        await run_async(self._peer, _commands.ANSWERS, _commands.land(self._peer))

    async def return_to_launch(self) -> None:
        """See Vehicle.return_to_launch."""
        await self.command(_commands.RETURN_TO_LAUNCH)


class AsyncParams:
    """The parameters of a vehicle, for asyncio."""

    def __init__(self, peer: Peer) -> None:
        self._peer = peer
        self._known: dict[str, _params.Value] = {}

    async def fetch(self) -> dict[str, int | float]:
        """Requests all parameters. Returns {name: value}."""
        self._known = await run_async(self._peer, _params.ANSWERS, _params.fetch(self._peer))
        return {name: one.value for name, one in self._known.items()}

    async def get(self, name: str) -> int | float:
        """Requests one parameter, each time. Raises KeyError if the vehicle has no such parameter."""
        try:
            self._known[name] = await run_async(self._peer, _params.ANSWERS, _params.read(self._peer, name))
        except ParameterError as error:
            raise KeyError(name) from error
        return self._known[name].value

    async def set(self, name: str, value: float) -> None:
        """Sets a parameter, and waits for the vehicle's confirmation."""
        known = self._known.get(name)
        self._known[name] = await run_async(self._peer, _params.ANSWERS, _params.write(self._peer, name, value, known))

    def __repr__(self) -> str:
        return f"<AsyncParams of system {self._peer.system}: {len(self._known)} known>"


class AsyncMission:
    """The mission of a vehicle, for asyncio. See Mission."""

    def __init__(self, peer: Peer) -> None:
        self._peer = peer

    async def upload(self, items: Items, mission_type: int = 0) -> None:
        """See Mission.upload."""
        await run_async(self._peer, _mission.ANSWERS, _mission.upload(self._peer, items, mission_type))

    async def download(self, mission_type: int = 0) -> list[MissionItem]:
        """See Mission.download."""
        return await run_async(self._peer, _mission.ANSWERS, _mission.download(self._peer, mission_type))

    async def clear(self, mission_type: int = 0) -> None:
        """See Mission.clear."""
        await run_async(self._peer, _mission.ANSWERS, _mission.clear(self._peer, mission_type))

    def __repr__(self) -> str:
        return f"<AsyncMission of system {self._peer.system}>"
