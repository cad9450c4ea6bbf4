# SPDX-License-Identifier: MIT
"""pymavlink's own command-line tools, with the import changed, beside the originals: equal output.

They are those that are installed with pymavlink. Nothing of them is part of this tree.
"""
import pathlib
import shutil
import struct
import sys

import pytest

import both
from tlogs import frames_of, record

pytestmark = pytest.mark.unsanitized

TOOLS = ("mavlogdump", "mavloss", "mavflightmodes", "mavtogpx", "mavparms", "mavsummarize", "mavkml")
# mavkml writes with the package simplekml. This stand-in writes what it is given.
SIMPLEKML = """
class Named:
    pass


class Kml:
    def __init__(self):
        self.lines = []

    def newlinestring(self, **fields):
        line = Named()
        line.fields, line.given, line.coords, line.style = fields, [], Named(), Named()
        line.style.linestyle = Named()
        line.coords.addcoordinates = line.given.extend
        self.lines.append(line)
        return line

    def save(self, path):
        with open(path, "w") as out:
            out.write(repr([(line.fields, line.given) for line in self.lines]))


class Color:
    pass


for _name in ("red", "green", "blue", "violet", "yellow", "orange", "burlywood", "azure", "lightblue", "lawngreen",
              "indianred", "hotpink"):
    setattr(Color, _name, _name)
"""


@pytest.fixture(scope="module")
def sides(peer, tmp_path_factory):
    scripts = pathlib.Path(sys.executable).parent
    folders = both.lay_out(tmp_path_factory.mktemp("tools"), [scripts / f"{tool}.py" for tool in TOOLS], peer)
    for folder in folders.values():
        (folder / "simplekml.py").write_text(SIMPLEKML)
    return folders


@pytest.fixture(scope="module")
def logs(flight, peer, tmp_path_factory):
    """A recorded flight, a part of it with damage, and one of an ArduPilot with parameters, GPS and several modes."""
    folder = tmp_path_factory.mktemp("logs")
    shutil.copy(flight, folder / "px4.tlog")
    records = [record(frame, i) for i, (_, frame) in enumerate(list(frames_of(flight))[:3000])]
    for place in (50, 700, 701, 2000):
        records[place] = records[place][:20] + bytes([records[place][20] ^ 0xff]) + records[place][21:]
    (folder / "damaged.tlog").write_bytes(b"".join(records[:2500]))
    (folder / "ardupilot.tlog").write_bytes(ardupilot_log(peer))
    return folder


def ardupilot_log(peer):
    vehicle, station = peer.MAVLink(None, srcSystem=1, srcComponent=1), peer.MAVLink(None, srcSystem=255)
    out = []

    def put(mav, message):
        out.append(struct.pack(">Q", 1_700_000_000_000_000 + 50_000 * len(out)) + bytes(message.pack(mav)))
        mav.seq = (mav.seq + 1) % 256
    for i in range(400):
        if i % 40 == 0:
            mode, armed = (0, 5, 4, 6, 9)[i // 80], 128 if i > 100 else 0
            put(vehicle, peer.MAVLink_heartbeat_message(2, 3, 81 | armed, mode, 4, 3))
            put(station, peer.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))
        if i % 7 == 0:
            put(vehicle, peer.MAVLink_param_value_message(b"PARAM_%d" % (i % 21), i * 0.5, 9, 3, i % 3))
        put(vehicle, peer.MAVLink_gps_raw_int_message(1_700_000_000_000_000 + i * 50_000, 3 if i > 5 else 0,
                                                      -353632621 + i * 100, 1491652374 + i * 50, 584000 + i * 10, 1, 1,
                                                      500, 9000, 12))
        put(vehicle, peer.MAVLink_global_position_int_message(i * 50, -353632621 + i * 100, 1491652374 + i * 50,
                                                              584000 + i * 10, i * 10, 100, -50, 3, 9000))
        put(vehicle, peer.MAVLink_attitude_message(i * 50, 0.1, 0.2, 0.3, 0, 0, 0))
        if i % 90 == 10:
            vehicle.seq = (vehicle.seq + 3) % 256  # lost
    return b"".join(out)


CALLS = {
    "dump": ("mavlogdump",), "dump with sources": ("mavlogdump", "--show-source", "--show-seq", "--show-loss"),
    "json": ("mavlogdump", "--format", "json", "--types", "HEARTBEAT,ATTITUDE,STATUSTEXT"),
    "csv": ("mavlogdump", "--format", "csv", "--types", "ATTITUDE,GPS_RAW_INT"),
    "verbose": ("mavlogdump", "--verbose", "--types", "HEARTBEAT,GPS_RAW_INT,ATTITUDE,SYS_STATUS,BATTERY_STATUS"),
    "wildcards": ("mavlogdump", "--types", "GPS*,ATT*", "--nottypes", "ATTITUDE_*"),
    "types": ("mavlogdump", "--show-types", "-q"), "one source": ("mavlogdump", "--source-system", "255"),
    "condition": ("mavlogdump", "--condition", "ATTITUDE.roll>0.02 and MAV.flightmode!='LOITER'"),
    "loss": ("mavloss",), "loss statistics": ("mavloss", "--stats"), "loss of one": ("mavloss", "--sysid", "1"),
    "modes": ("mavflightmodes",), "parameters": ("mavparms",), "parameter changes": ("mavparms", "--changes"),
    "summary": ("mavsummarize",), "summary of a part": ("mavsummarize", "--condition", "HEARTBEAT.custom_mode>0"),
}


@pytest.mark.parametrize("log", ["px4", "ardupilot", "damaged"])
@pytest.mark.parametrize("call", CALLS)
def test_a_tool_prints_the_same(call, log, sides, logs, child_environment):
    tool, *words = CALLS[call]
    theirs, ours = (both.run(sides[side], tool, *words, logs / f"{log}.tlog", environment=child_environment)
                    for side in both.SIDES)
    assert sorted(ours.splitlines()) == sorted(theirs.splitlines()) if call == "types" else ours == theirs
    assert theirs or log == "damaged" or call.startswith("parameter")


@pytest.mark.parametrize("log", ["px4", "ardupilot"])
@pytest.mark.parametrize("tool, words, made", [
    ("mavtogpx", (), "{log}.tlog.gpx"), ("mavkml", ("-s", "GPS_RAW_INT", "-o", "{folder}/out.kml"), "out.kml"),
    ("mavlogdump", ("-q", "--types", "ATTITUDE", "-o", "{folder}/out.tlog"), "out.tlog")])
def test_a_tool_writes_the_same_file(tool, words, made, log, sides, logs, tmp_path, child_environment):
    written = []
    for side in both.SIDES:
        folder = tmp_path / side
        folder.mkdir()
        shutil.copy(logs / f"{log}.tlog", folder)
        given = [word.format(folder=folder) for word in words]
        printed = both.run(sides[side], tool, *given, folder / f"{log}.tlog", environment=child_environment,
                           status=1 if tool == "mavkml" else 0)
        path = folder / made.format(log=log)
        written.append((printed.replace(str(folder), ""), path.read_bytes() if path.exists() else None))
    assert written[0] == written[1]
    assert (written[0][1] is None) == (tool == "mavkml")


def test_mavkml_finds_no_position_of_its_default_kind(sides, logs, tmp_path, child_environment):
    """It reads PX4's and ArduPilot's own logs; a tlog has no message GPOS."""
    written = []
    for side in both.SIDES:
        path = tmp_path / f"{side}.kml"
        both.run(sides[side], "mavkml", "-o", path, logs / "px4.tlog", environment=child_environment)
        written.append(path.read_text())
    assert written[0] == written[1] == "[]"
