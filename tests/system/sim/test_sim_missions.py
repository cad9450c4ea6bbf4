# SPDX-License-Identifier: MIT
"""Behaviours 43 to 55 of docs/guide/sim-behaviour.md: missions, fences and rally points."""
import itertools
import math
import struct

import pytest

import mavsdks
from flights import arm, flight_time, ready_vehicle, speed_of
from simulators import HOLD, HOME, MISSION, item, metres_between, offset, place, plain
from stations import NAN, crc32, mavlink

ACCEPTED, ERROR, UNSUPPORTED_COMMAND, INVALID_SEQUENCE = 0, 1, 3, 13
NONE, NOT_STARTED, ACTIVE, PAUSED, COMPLETE = 1, 2, 3, 4, 5
FENCE, RALLY, ALL = 1, 2, 255


def fence(radius=200.0):
    corners = [(100, -100), (100, 100), (-100, 100), (-100, -100)]
    return [*(item(seq, 5001, *corner, 0, frame=5, p=(4, 0, 0, 0), plan=FENCE, current=0)
              for seq, corner in enumerate(corners)),
            item(4, 5004, 50, 50, 0, frame=5, p=(radius, 0, 0, 0), plan=FENCE, current=0)]


def rally():
    return [item(seq, 5100, 20 * seq, 0, 15, frame=6, p=(0, 0, 0, 0), plan=RALLY, current=0) for seq in range(3)]


def long_plan(count):
    """Commands, frames and parameters of every kind, NaN among them."""
    kinds = itertools.cycle([(16, 6, (1.5, 2, 0, NAN)), (16, 5, (0, 0, 0, 45.0)), (178, 2, (1, 5.5, -1, 0)),
                             (93, 2, (2, -1, -1, -1)), (19, 6, (3, 0, 5, NAN)), (195, 5, (0, 0, 0, 0)),
                             (16, 3, (0, 3, 0, NAN)), (16, 0, (0, 0, 0, -90.0))])
    return [item(seq, command, 7 * seq, -3 * seq, 10 + seq / 8, frame=frame, p=p)
            for seq, (command, frame, p) in zip(range(count), kinds)]


def int_frames(items):
    """As PX4 returns them: the frames of degrees as those of integers."""
    def changed(fields):
        return (fields[0], {0: 5, 3: 6}.get(fields[1], fields[1]), *fields[2:])
    return [changed(plain(one)) for one in items]


def start_mission(station):
    arm(station)
    mark = station.mark()
    assert station.command(176, 1, 4, 4) == 0
    station.mode_is(MISSION, since=mark)
    return mark


# ---- transfers

def test_b43_a_long_plan_comes_back_as_it_was_sent(sim):
    with sim().station() as station:
        plan = long_plan(500)
        assert station.upload(plan).type == ACCEPTED

        assert [plain(one) for one in station.download()] in (int_frames(plan), [plain(one) for one in plan])


def test_b44_transfers_survive_loss(sim, rng):
    simulator = sim()
    plan = long_plan(16)
    simulator.fault("loss:0.2", rng)
    station = simulator.station()
    assert station.upload(plan).type == ACCEPTED
    back = station.download()

    assert int_frames(back) == int_frames(plan)


def test_b45_fences_and_rally_points(sim):
    with sim().station() as station:
        for plan, items in ((FENCE, fence()), (RALLY, rally())):
            assert station.upload(items, plan).type == ACCEPTED
        assert station.upload([item(0, 16)]).type == ACCEPTED
        for plan, items in ((FENCE, fence()), (RALLY, rally())):
            assert int_frames(station.download(plan)) == int_frames(items)
        assert station.clear(FENCE) == ACCEPTED

        assert [len(station.download(plan)) for plan in (0, FENCE, RALLY)] == [1, 0, 3]


def test_b46_plans_can_be_cleared(sim):
    with sim().station() as station:
        for plan, items in ((0, [item(0, 16)]), (FENCE, fence()), (RALLY, rally())):
            assert station.upload(items, plan).type == ACCEPTED
        station.expect("MISSION_CURRENT", where=lambda m: m.total == 1 and m.mission_state == NOT_STARTED)
        assert station.upload([]).type == ACCEPTED
        station.expect("MISSION_CURRENT", where=lambda m: (m.total, m.mission_state) == (65535, NONE))
        assert [len(station.download(plan)) for plan in (0, FENCE, RALLY)] == [0, 5, 3]
        assert station.clear(ALL) == ACCEPTED

        assert [len(station.download(plan)) for plan in (0, FENCE, RALLY)] == [0, 0, 0]


def test_b47_a_second_upload_is_refused_until_the_first_ends(sim):
    simulator = sim()
    with simulator.station() as first, simulator.station((254, 191)) as second:
        assert second.upload([item(0, 16, 99)]).type == ACCEPTED
        mark = first.mark()
        first.send_to_vehicle("mission_count", 5, 0)
        first.expect("MISSION_REQUEST_INT", since=mark, where=lambda m: m.seq == 0)
        assert second.upload([item(0, 16)]).type == ERROR
        assert second.upload(rally(), RALLY).type == ACCEPTED
        # The first client is silent from now on. The vehicle repeats its request and gives up after 5 s.
        given_up = first.expect("MISSION_ACK", since=mark, timeout=20)
        asked = first.times("MISSION_REQUEST_INT", mark)

        assert given_up.type == mavlink.MAV_MISSION_OPERATION_CANCELLED
        assert len(asked) > 10 and 4 < asked[-1] - asked[0] < 7
        assert int_frames(second.download()) == int_frames([item(0, 16, 99)])
        assert second.upload([item(0, 16), item(1, 16)]).type == ACCEPTED


def test_b48_an_unknown_command_keeps_the_old_plan(sim):
    with sim().station() as station:
        plan = [item(0, 16), item(1, 16, 30)]
        assert station.upload(plan).type == ACCEPTED
        refused = station.upload([item(0, 16), item(1, 31999), item(2, 16)])

        assert refused.type == UNSUPPORTED_COMMAND
        assert int_frames(station.download()) == int_frames(plan)


def test_b49_five_requests_at_once_without_an_acknowledgement(sim):
    with sim().station() as station:
        plan = long_plan(40)
        assert station.upload(plan).type == ACCEPTED
        for _ in range(2):  # the second time, the first download has no end
            mark = station.mark()
            station.send_to_vehicle("mission_request_list", 0)
            assert station.expect("MISSION_COUNT", since=mark).count == 40
            for first in range(0, 40, 5):
                for seq in range(first, first + 5):
                    station.send_to_vehicle("mission_request_int", seq, 0)
                for seq in range(first, first + 5):
                    station.expect("MISSION_ITEM_INT", since=mark, where=lambda m, s=seq: m.seq == s, timeout=5)
        mark = station.mark()
        station.send_to_vehicle("mission_request_int", 40, 0)

        assert station.expect("MISSION_ACK", since=mark).type == INVALID_SEQUENCE


def plan_id(items):
    """PX4's id of a plan, from the items as they are downloaded."""
    packed = b"".join(struct.pack("<BHB4f", m.frame, m.command, m.autocontinue, m.param1, m.param2, m.param3, m.param4)
                      + struct.pack("<2if", m.x, m.y, m.z) for m in items)
    return crc32(packed)


def test_b54_the_id_of_a_plan_follows_its_content(sim):
    with sim().station() as station:
        ids = []
        for plan in ([item(0, 16), item(1, 16, 30)], [item(0, 16), item(1, 16, 31)], [item(0, 16), item(1, 16, 30)]):
            ack = station.upload(plan)
            back = station.download()
            count = station.latest("MISSION_COUNT")
            current = station.expect("MISSION_CURRENT")
            assert ack.opaque_id == count.opaque_id == current.mission_id == plan_id(back)
            ids.append(ack.opaque_id)
        fence_id = station.upload(fence(), FENCE).opaque_id
        station.expect("MISSION_CURRENT", where=lambda m: (m.mission_id, m.fence_id) == (ids[2], fence_id))

    assert ids[0] == ids[2] != ids[1] and 0 not in ids


def test_b55_every_client_downloads_the_same_plan(sim):
    simulator = sim()
    with simulator.station() as station:
        plan = [item(seq, 16, 10 * seq, p=(0, 0, 0, 0.0)) for seq in range(12)]
        assert station.upload(plan).type == ACCEPTED
        assert station.upload(fence(), FENCE).type == station.upload(rally(), RALLY).type == ACCEPTED
        expected = [[list(plain(one)) for one in station.download(kind)] for kind in (0, FENCE, RALLY)]
    answer = mavsdks.run(simulator.port, "raw_plans", [], [], [])

    def without_current(rows):
        return [row[:3] + row[4:] for row in rows]
    assert [without_current(answer[name]) for name in ("mission", "fence", "rally")] == expected


# ---- flying

def reached(station, mark):
    """Items in the order of MISSION_ITEM_REACHED, its repetitions left out."""
    return [seq for seq, _ in itertools.groupby(m.seq for m in station.since(mark, "MISSION_ITEM_REACHED"))]


def test_b50_a_mission_reports_its_progress(sim):
    station = ready_vehicle(sim)
    plan = [item(0, 22, 0, 0, 8), item(1, 16, 40, 0, 8), item(2, 16, 40, 30, 12), item(3, 16, 0, 30, 10)]
    assert station.upload(plan).type == ACCEPTED
    mark = start_mission(station)
    station.expect("MISSION_CURRENT", since=mark, where=lambda m: m.mission_state == ACTIVE)
    end = station.expect("MISSION_CURRENT", since=mark, where=lambda m: m.mission_state == COMPLETE)
    station.mode_is(HOLD, since=mark)

    assert reached(station, mark) == [0, 1, 2, 3]
    assert (end.seq, end.total) == (3, 4)
    assert [seq for seq, _ in itertools.groupby(m.seq for m in station.since(mark, "MISSION_CURRENT"))] == [0, 1, 2, 3]


@pytest.mark.parametrize("by", ["message", "command"])
def test_b51_the_current_item_can_be_set(sim, by):
    station = ready_vehicle(sim)
    plan = [item(0, 22, 0, 0, 8), *(item(seq, 16, 1500 * seq, 0, 8) for seq in range(1, 6))]
    assert station.upload(plan).type == ACCEPTED
    mark = start_mission(station)
    station.expect("MISSION_CURRENT", since=mark, where=lambda m: m.seq == 1)
    mark = station.mark()
    if by == "message":
        station.send_to_vehicle("mission_set_current", 4)
    else:
        assert station.command(224, 4) == 0
    station.expect("MISSION_CURRENT", since=mark, where=lambda m: m.seq == 4)
    mark = station.mark()
    if by == "message":
        station.send_to_vehicle("mission_set_current", 77)
        station.expect("STATUSTEXT", since=mark, where=lambda m: "77" in m.text, timeout=5)
        assert not station.since(mark, "MISSION_ACK")
    else:
        assert station.command(224, 77) in (2, 4)  # DENIED, FAILED
    assert station.expect("MISSION_CURRENT").seq == 4


def test_b52_jumps_delays_and_speeds(sim):
    station = ready_vehicle(sim)
    plan = [item(0, 22, 0, 0, 8), item(1, 16, 30, 0, 8, p=(0, 2, 0, NAN)), item(2, 178, frame=2, p=(1, 2.5, -1, 0)),
            item(3, 16, 30, 30, 8, p=(0, 2, 0, NAN)), item(4, 177, frame=2, p=(1, 2, 0, 0)),
            item(5, 93, frame=2, p=(6, -1, -1, -1)), item(6, 16, 0, 30, 8, p=(0, 2, 0, NAN))]
    assert station.upload(plan).type == ACCEPTED
    mark = start_mission(station)
    station.expect("MISSION_CURRENT", since=mark, where=lambda m: m.mission_state == COMPLETE)
    visits = [seq for seq in reached(station, mark) if seq in (1, 3, 6)]
    fast = [(m.seq, flight_time(station, m)) for m in station.since(mark, "MISSION_CURRENT")]
    waited = next(t for seq, t in fast if seq == 6) - max(t for seq, t in fast if seq == 4 or seq == 3)

    assert visits == [1, 3, 1, 3, 1, 3, 6]
    assert 5 < waited < 9
    first_leg = [speed_of(m) for m in between(station, mark, 0, 1)]
    last_leg = [speed_of(m) for m in between(station, mark, 6, None)]
    assert max(first_leg) > 3.5
    assert max(last_leg) < 3


def between(station, mark, first, last):
    """GLOBAL_POSITION_INT while MISSION_CURRENT showed items from `first` to `last`."""
    current, found = None, []
    for message in station.since(mark):
        if message.get_type() == "MISSION_CURRENT":
            current = message.seq
        elif message.get_type() == "GLOBAL_POSITION_INT" and current is not None and current >= first:
            if last is None or current <= last:
                found.append(message)
    return found


@pytest.mark.parametrize("end, where, stays_armed", [
    (dict(command=21, north=20, east=10, height=0), (20, 10), False),
    (dict(command=20, frame=2), (0, 0), False),
    (dict(command=16, north=40, east=20), (40, 20), True)])
def test_b53_how_missions_end(sim, end, where, stays_armed):
    station = ready_vehicle(sim, parameters={"RTL_RETURN_ALT": 15.0})
    plan = [item(0, 22, 0, 0, 8), item(1, 16, 40, 0, 8), item(2, **end)]
    assert station.upload(plan).type == ACCEPTED
    mark = start_mission(station)
    if stays_armed:
        station.expect("MISSION_CURRENT", since=mark, where=lambda m: m.mission_state == COMPLETE)
        station.mode_is(HOLD, since=mark)
        assert station.is_armed
        return
    station.armed_is(True, since=mark)
    station.armed_is(False)
    end_place = place(station.expect("GLOBAL_POSITION_INT"))
    station.landed(1)

    assert metres_between(end_place, offset(*HOME[:2], *where)) < 2
    assert not math.isnan(end_place[0])
