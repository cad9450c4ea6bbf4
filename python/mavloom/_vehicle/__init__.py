# SPDX-License-Identifier: MIT
"""Services of a vehicle: commands, modes, parameters and missions.

Each service is a protocol, written as a generator in _commands.py, _params.py and _mission.py: it sends messages and
yields how long it waits for an answer. _exchange.py runs it, in the calling thread or on an asyncio loop.
"""
from ._exclusive import ExchangeQueues
from ._mission import MissionItem
from ._vehicle import AsyncMission, AsyncParams, AsyncVehicle, Mission, Params, Vehicle

__all__ = ["AsyncMission", "AsyncParams", "AsyncVehicle", "ExchangeQueues", "Mission", "MissionItem", "Params",
           "Vehicle"]
