# SPDX-License-Identifier: MIT
"""Recordings as pymavlink's own reader (mavutil) sees them: what we read, and what we write."""
import json
import os

os.environ["MAVLINK20"] = "1"
from pymavlink import mavutil  # noqa: E402  the variable must be set before


def id_and_sequence(frame):
    """Of a MAVLink 2 frame: what tests/data holds."""
    return int.from_bytes(frame[7:10], "little"), frame[4]


def read_by_peer(path):
    """(time in µs, id, sequence) of every record that mavutil finds, those that its dialect does not know included."""
    log = mavutil.mavlink_connection(str(path))
    found = []
    while (message := log.recv_match()) is not None:
        if message.get_type() != "BAD_DATA":
            found.append((round(message._timestamp * 1e6), *id_and_sequence(bytes(message.get_msgbuf()))))
    return found


def read_by_us(run, path):
    done = run("listen", path, "--json", timeout=100)
    assert done.status == 0, done
    return [(m["time_us"], m["id"], m["seq"]) for m in map(json.loads, done.lines)]


def test_both_readers_find_the_same_records_in_a_flight(run, data):
    path = data / "px4_gcs_flight.tlog"
    theirs = read_by_peer(path)

    assert len(theirs) == 40087
    assert read_by_us(run, path) == theirs


def test_the_peer_reads_what_we_record(run, data, tmp_path):
    path = data / "px4_gcs_flight.tlog"
    done = run("record", path, "-o", tmp_path / "copy.tlog")

    assert done.status == 0, done
    assert (tmp_path / "copy.tlog").read_bytes() == path.read_bytes()
    assert len(read_by_peer(tmp_path / "copy.tlog")) == 40087


def test_we_find_every_intact_record_of_a_damaged_file(run, data, tmp_path, rng):
    content = bytearray((data / "px4_gcs_flight.tlog").read_bytes())
    starts = [0]
    while starts[-1] < len(content):
        starts.append(starts[-1] + 8 + content[starts[-1] + 9] + 12)
    records = [bytes(content[a:b]) for a, b in zip(starts, starts[1:])]
    damaged = set(rng.sample(range(len(records)), 500))
    for number in damaged:
        # Not in the time, which no checksum protects, nor in the id: one wrong id in 256 could be a frame of a message
        # nobody knows.
        places = [*range(starts[number] + 8, starts[number] + 15), *range(starts[number] + 18, starts[number + 1])]
        content[rng.choice(places)] ^= rng.randrange(1, 256)
    (tmp_path / "x.tlog").write_bytes(content)

    intact = [(int.from_bytes(r[:8], "big"), *id_and_sequence(r[8:])) for number, r in enumerate(records)
              if number not in damaged]
    assert read_by_us(run, tmp_path / "x.tlog") == intact
