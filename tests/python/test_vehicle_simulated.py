# SPDX-License-Identifier: MIT
"""Services of vehicles, with the simulator of `mavloom sim` as a PX4 and as an ArduPilot."""
import asyncio
import dataclasses
import threading

import pytest

import mavloom
from vehicles import DEADLINE_S, simulator

def at_once(*calls):
    """Runs calls in threads of their own. Returns the errors that they raised."""
    errors = []

    def run(call):
        try:
            call()
        except Exception as error:
            errors.append(error)
    threads = [threading.Thread(target=run, args=(call,)) for call in calls]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return errors


@pytest.fixture(params=["px4", "ardupilot"])
def flying_link(request):
    with simulator(request.param) as port, mavloom.connect(f"tcpout://127.0.0.1:{port}") as link:
        link.vehicle(timeout=DEADLINE_S)
        yield link


def latitudes(mission):
    return {item.lat for item in mission}


def test_uploads_of_several_threads_and_tasks_are_not_mixed(flying_link):
    def items(number):
        return [mavloom.MissionItem.at(number, number, 20)] * 40

    def upload_with_asyncio(*numbers):
        async def upload():
            uploads = [flying_link.vehicle_async(1).mission.upload(items(number)) for number in numbers]
            await asyncio.gather(*uploads)
        asyncio.run(upload())
    vehicles = [flying_link.vehicle(1), flying_link.vehicle(1)]  # two objects, one vehicle
    for _ in range(3):
        errors = at_once(lambda: vehicles[0].mission.upload(items(1)), lambda: vehicles[1].mission.upload(items(2)),
                         lambda: vehicles[0].mission.download(), lambda: upload_with_asyncio(3, 4))
        assert errors == []
        assert len(latitudes(vehicles[0].mission.download())) == 1


def test_fetches_and_writes_of_several_threads(flying_link):
    vehicle = flying_link.vehicle(1)
    name = "RTL_RETURN_ALT" if "RTL_RETURN_ALT" in vehicle.params.fetch() else "RTL_ALT"
    count, found = len(vehicle.params), []

    def write(number):
        vehicle.params[name] = number

    def fetch():
        found.append(len(flying_link.vehicle(1).params.fetch()))
    assert at_once(fetch, fetch, lambda: write(40), lambda: write(50), lambda: write(60)) == []
    assert found == [count, count] and vehicle.params[name] in (40, 50, 60)


def test_a_mission_comes_back_as_it_was_uploaded(flying_link):
    """The item 0 of an ArduPilot is home. Neither side shows it. ArduPilot answers with the frames of MISSION_ITEM."""
    vehicle = flying_link.vehicle(1)
    relative = 6 if "Mission" in vehicle.modes else 3  # 6: PX4
    items = [mavloom.MissionItem.at(47.398, 8.546, 20), mavloom.MissionItem.at(47.399, 8.546, 25),
             mavloom.MissionItem(177, frame=2, param1=0, param2=2)]
    for count in (3, 1, 0):
        vehicle.mission.upload(items[:count])
        found = vehicle.mission.download()
        assert [dataclasses.replace(item, current=0) for item in found] == [
            dataclasses.replace(item, frame=relative if item.frame == 6 else item.frame) for item in items[:count]]
    vehicle.mission.upload(items)
    vehicle.mission.clear()
    assert vehicle.mission.download() == []
