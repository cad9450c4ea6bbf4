# SPDX-License-Identifier: MIT
"""Missions and fences in files: mavwp beside pymavlink's."""
import random

import pytest

from mavloom import mavutil, mavwp

COMMANDS = (16, 16, 16, 16, 177, 189, 20, 21, 85, 17, 300)
MISSION = """QGC WPL 110
# home, with more   words
0\t1\t0\t0\t0\t0\t0\t0\t1.0\t2.0\t3.0\t1
# first

1\t0\t3\t16\t0\t0\t0\t0\t1.0\t2.0\t3.0\t1
2\t0\t3\t16\t0\t0\t0\t0\t1.0\t2.0\t3.0\t1
"""


@pytest.fixture
def loaders(their_mavutil, monkeypatch):
    """(mavwp, definitions) of pymavlink and of Mavloom."""
    from pymavlink import mavwp as their_mavwp
    return (their_mavwp, their_mavutil.mavlink), (mavwp, mavutil.mavlink)


def item(mavlink, command=16, x=1.0, y=2.0, param1=0, param2=0):
    return mavlink.MAVLink_mission_item_message(1, 1, 0, 3, command, 0, 1, param1, param2, 0, 0, x, y, 3.0)


def both(loaders, act):
    """Returns the result of `act` with Mavloom, after a check that it is the same with pymavlink."""
    theirs, ours = (act(module, mavlink) for module, mavlink in loaders)
    assert ours == theirs
    return ours


def test_items_are_copied_when_they_are_added(loaders):
    def act(module, mavlink):
        loader, given = module.MAVWPLoader(), item(mavlink)
        loader.add(given, "hello")
        given.x = 9.0
        loader.add(given)
        loader.add(loader.wp(0))
        loader.set(given, 3)
        given.x = 7.0
        return [(w.seq, w.x, getattr(w, "comment", "")) for w in loader.wpoints]
    found = both(loaders, act)
    assert found == [(0, 1.0, "hello"), (1, 9.0, ""), (2, 1.0, "hello"), (3, 9.0, "")]


def test_items_are_numbered_after_they_were_inserted(loaders):
    loader, given = mavwp.MAVWPLoader(), item(mavutil.mavlink)
    loader.insert(0, [given, given])
    loader.insert(1, given, "middle")
    loader.insert(99, given)
    assert [(w.seq, w.comment) for w in loader.wpoints] == [(0, ""), (1, "middle"), (2, ""), (3, "")]
    loader.add([given, given])
    assert [w.seq for w in loader.wpoints] == [0, 1, 2, 3, 4, 5]
    loader.remove(list(loader.wpoints[:2]))
    assert [w.seq for w in loader.wpoints] == [0, 1, 2, 3]


def test_an_item_beyond_the_end_is_none(loaders):
    assert both(loaders, lambda module, mavlink: module.MAVWPLoader().item(99)) is None


def test_comments_and_the_home_of_mission_planner(loaders, tmp_path):
    (tmp_path / "given.txt").write_text(MISSION)

    def act(module, mavlink):
        loader, again = module.MAVWPLoader(), module.MAVWPLoader()
        loader.load(str(tmp_path / "given.txt"))
        loader.save(str(tmp_path / "saved.txt"))
        again.load(str(tmp_path / "saved.txt"))
        return [[(w.command, getattr(w, "comment", "").strip()) for w in one.wpoints] for one in (loader, again)]
    commands = [command for command, _ in both(loaders, act)[0]]
    assert commands == [16, 16, 16]


def test_comments_of_several_lines_stay_in_one_line(tmp_path):
    loader = mavwp.MAVWPLoader()
    loader.add(item(mavutil.mavlink), "one\n0 1 2")
    loader.save(tmp_path / "saved.txt")
    assert loader.load(tmp_path / "saved.txt") == 1 and loader.wp(0).comment == "one 0 1 2"


def test_the_path_of_a_mission(loaders):
    choose = random.Random(5)
    missions = [[(choose.choice(COMMANDS), choose.choice([0, 1, 2]), choose.choice([0, 1]), choose.randrange(size), 1)
                 for _ in range(size)] for size in range(9) for _ in range(100 if size else 1)]

    def act(module, mavlink):
        paths = []
        for mission in missions:
            loader = module.MAVWPLoader()
            for values in mission:
                loader.add(item(mavlink, *values))
            paths.append((loader.view_indexes(), [place[:2] for place in loader.polygon()]))  # theirs may have a colour
        return paths
    assert max(len(path) for path, _ in both(loaders, act)) > 6


def test_commands_with_a_place(loaders):
    def act(module, mavlink):
        loader = module.MAVWPLoader()
        loader.add([item(mavlink, command) for command in range(300)])
        return [[call(number) for number in range(300)] for call in (
            loader.is_location_command, loader.wp_is_loiter, lambda n: bool(loader.is_location_wp(loader.wp(n))))]
    assert [sum(column) for column in both(loaders, act)] == [26, 4, 25]


def test_a_fence(loaders, tmp_path):
    (tmp_path / "given.txt").write_text("# a fence\n1.5 2.5\n1.25 2.25\n\n3 4\n5 6\n1.25 2.25\n")

    def act(module, mavlink):
        fence, found = module.MAVFenceLoader(1, 1), []
        found += [fence.load(str(tmp_path / "given.txt")), fence.polygon()]
        for change in (lambda: fence.move(1, 10, 20), lambda: fence.move(4, 11, 21), lambda: fence.move(2, 12, 22),
                       lambda: fence.remove(1), lambda: fence.move(0, 5, 5), lambda: fence.add_latlon(7, 8)):
            change()
            found += [fence.polygon(), (fence.point(0).lat, fence.point(0).lng)]
        found += [(p.target_system, p.idx, p.count) for p in fence.points]
        fence.save(str(tmp_path / "saved.txt"))
        return [*found, (tmp_path / "saved.txt").read_text()]
    assert both(loaders, act)[1] == [(1.25, 2.25), (3, 4), (5, 6), (1.25, 2.25)]


@pytest.mark.parametrize("line", ["1 2 3", "a b", "1"])
def test_a_file_that_is_no_fence(line, tmp_path):
    (tmp_path / "bad.txt").write_text(f"1 2\n{line}\n")
    with pytest.raises(mavwp.MAVFenceError, match=f":2: a line has a latitude and a longitude, not '{line}'"):
        mavwp.MAVFenceLoader().load(tmp_path / "bad.txt")


def test_a_place_becomes_an_item(loaders):
    def act(module, mavlink):
        loader = module.MAVWPLoader()
        loader.add_latlonalt(47.1, 8.5, 20)
        loader.add_latlonalt(47.1, 8.5, 20, True)
        return [{name: getattr(one, name) for name in item(mavlink).get_fieldnames() if name != "mission_type"}
                for one in map(loader.wp, range(2))]
    assert both(loaders, act)[1]["frame"] == 10
