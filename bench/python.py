#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench python: reads a recorded flight with the Python package: as objects, through mavloom.mavutil, and as numpy
columns.

Compares the speed with pymavlink's reader (mavutil, with a module that mavgen generates from our definitions) on the
same file, in turns. Before the measurement, both must return the same messages with the same values. Ratios are of
messages per second. Also measures how long `import mavloom` takes after `import numpy`."""
import argparse
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "support"))
os.environ["MAVLINK20"] = "1"
import numpy as np  # noqa: E402
import pymavlink_vectors as vectors  # noqa: E402
from pymavlink import mavutil  # noqa: E402

import mavloom  # noqa: E402
from mavloom import mavutil as our_mavutil  # noqa: E402

MESSAGE = "ATTITUDE"
FIELDS = ("time_boot_ms", "roll", "pitch", "yaw", "rollspeed", "pitchspeed", "yawspeed")


def peer_log(path):
    return mavutil.mavlink_connection(str(path))


def use(module):
    """Makes mavutil decode with this module."""
    sys.modules[f"pymavlink.dialects.v20.{module.__name__}"] = module
    mavutil.mavlink = module
    mavutil.current_dialect = module.__name__


# ---- what is measured

def our_objects(path):
    count = 0
    for _ in mavloom.read(path):
        count += 1
    return count


def peer_objects(path):
    log, count = peer_log(path), 0
    while log.recv_msg() is not None:
        count += 1
    return count


def our_dicts(path):
    count = 0
    for message in mavloom.read(path):
        message.to_dict()
        count += 1
    return count


def peer_dicts(path):
    log, count = peer_log(path), 0
    while (message := log.recv_msg()) is not None:
        message.to_dict()
        count += 1
    return count


def reader_of(fields, items=()):
    """A function that reads all fields of a message: those in `items` as msg["id"], the others as msg.roll."""
    texts = [f"m[{name!r}]" if name in items else f"m.{name}" for name in fields]
    return eval(f"lambda m: ({', '.join(texts)},)")


class Readers(dict):
    """{name of a message: function that reads its fields}."""

    def __init__(self, items=()):
        super().__init__()
        self.items_of, self.dialect = items, mavloom.Dialect()

    def __missing__(self, name):
        self[name] = reader_of([field.name for field in self.dialect[name].fields], self.items_of)
        return self[name]


BY_ATTRIBUTE, NATIVE = Readers(), Readers(("frame", "id", "name", "seq", "version"))


def our_attributes(path):
    count = 0
    for message in mavloom.read(path):
        NATIVE[message.name](message)
        count += 1
    return count


def loop(log, read):
    """The loop that scripts have."""
    count = 0
    while (message := log.recv_match()) is not None:
        read(message)
        count += 1
    return count


def read_attributes(message):
    BY_ATTRIBUTE[message.get_type()](message)


def our_loop(path):
    return loop(our_mavutil.mavlink_connection(str(path)), read_attributes)


def peer_loop(path):
    return loop(peer_log(path), read_attributes)


def our_loop_of_dicts(path):
    return loop(our_mavutil.mavlink_connection(str(path)), lambda message: message.to_dict())


def peer_loop_of_dicts(path):
    return loop(peer_log(path), lambda message: message.to_dict())


def our_columns(path):
    columns = mavloom.columns(path, MESSAGE)
    return {name: columns[name] for name in ("time_ns", *FIELDS)}


def peer_columns(path):
    log, rows = peer_log(path), []
    while (message := log.recv_match(type=MESSAGE)) is not None:
        rows.append((message._timestamp, *(getattr(message, field) for field in FIELDS)))
    times, *values = zip(*rows)
    columns = {"time_ns": np.round(np.array(times) * 1e6).astype("i8") * 1000}
    for name, column in zip(FIELDS, values):
        columns[name] = np.array(column, "u4" if name == "time_boot_ms" else "f4")
    return columns


def numpy_type(field):
    kinds = {"float": "f4", "double": "f8", "char": f"S{field.count}", "uint8_t_mavlink_version": "u1"}
    return kinds.get(field.type) or f"{field.type[0]}{vectors.INTEGER_BITS[field.type] // 8}"


def our_tables(path):
    return mavloom.tables(path)


def peer_tables(path):
    log, rows = peer_log(path), {}
    while (message := log.recv_msg()) is not None:
        rows.setdefault(message.get_type(), []).append(message)
    tables = {}
    for name, messages in rows.items():
        fields = vectors.fields_of(type(messages[0]))
        tables[name] = {}
        for field in fields:
            attribute = f"_{field.name}_raw" if field.is_text else field.name
            tables[name][field.name] = np.array([getattr(m, attribute) for m in messages], numpy_type(field))
    return tables


# ---- the answers

def same(ours, theirs):
    if isinstance(theirs, list):
        return len(ours) == len(theirs) and all(map(same, ours, theirs))
    return ours == theirs or (isinstance(theirs, float) and math.isnan(theirs) and math.isnan(ours))


def check_answers(path):
    """Returns the number of messages. Ends the program if the two readers return different messages."""
    log, count = peer_log(path), 0
    for ours in mavloom.read(path):
        theirs = log.recv_msg()
        if theirs is None or ours.header.frame != bytes(theirs.get_msgbuf()) or ours.get_type() != theirs.get_type():
            sys.exit(f"bench python: message {count}: {ours} against {theirs}")
        for field in vectors.fields_of(type(theirs)):
            if field.is_text:
                value = getattr(theirs, f"_{field.name}_raw").rstrip(b"\0").decode("utf-8", "replace")
            else:
                value = getattr(theirs, field.name)
            if not same(ours[field.name], value):
                sys.exit(f"bench python: message {count}: {field.name}: {ours[field.name]!r} against {value!r}")
        count += 1
    if log.recv_msg() is not None:
        sys.exit(f"bench python: pymavlink has more than our {count} messages")
    mine, peers = our_columns(path), peer_columns(path)
    for name, column in peers.items():
        if mine[name].tobytes() != column.tobytes():
            sys.exit(f"bench python: column {name} differs")
    ours, theirs = our_tables(path), peer_tables(path)
    if set(ours) != set(theirs):
        sys.exit("bench python: other messages")
    for name, table in theirs.items():
        for field, column in table.items():
            if ours[name][field].tobytes() != column.tobytes():
                sys.exit(f"bench python: column {name}.{field} differs")
    return count


def check_loops(path):
    """Ends the program if a loop through mavloom.mavutil reads other values than the same loop in pymavlink."""
    ours, theirs = our_mavutil.mavlink_connection(str(path)), peer_log(path)
    while (message := theirs.recv_match()) is not None:
        mine = ours.recv_match()
        if mine.get_type() != message.get_type() or not same(list(BY_ATTRIBUTE[mine.get_type()](mine)),
                                                             list(BY_ATTRIBUTE[mine.get_type()](message))):
            sys.exit(f"bench python: {mine} against {message}")
        if not same(list(mine.to_dict().values()), list(message.to_dict().values())):
            sys.exit(f"bench python: to_dict() of {mine} against {message}")
    if ours.recv_match() is not None:
        sys.exit("bench python: mavloom.mavutil has more messages than pymavlink")


# ---- the clock

def import_seconds():
    """Of mavloom and its mavutil, after numpy."""
    code = ("import numpy, time\nbegin = time.perf_counter()\nimport mavloom\nfrom mavloom import mavutil\n"
            "print(time.perf_counter() - begin)")
    return float(subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout)


def seconds(work, path, times):
    begin = time.perf_counter()
    for _ in range(times):
        work(path)
    return (time.perf_counter() - begin) / times


def report(measured, imports, count, as_json):
    for name, turns in measured.items():
        ratios = [theirs / ours for ours, theirs in turns]
        us, them = (count / statistics.median(side) for side in zip(*turns))
        if as_json:
            print(json.dumps({"bench": f"python {name}", "mavloom_per_s": round(us), "pymavlink_per_s": round(them),
                              "ratio": statistics.median(ratios), "lowest": min(ratios), "highest": max(ratios)}))
        else:
            print(f"  {name:<26} mavloom {us:12,.0f}/s   pymavlink {them:9,.0f}/s   "
                  f"ratio {statistics.median(ratios):7.1f} (lowest {min(ratios):.1f}, highest {max(ratios):.1f})")
    if as_json:
        print(json.dumps({"bench": "python import", "seconds": statistics.median(imports), "highest": max(imports)}))
    else:
        print(f"  import mavloom, mavutil    {statistics.median(imports):.3f} s "
              f"(lowest {min(imports):.3f}, highest {max(imports):.3f})")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--flight", type=pathlib.Path, default=ROOT / "tests/data/px4_gcs_flight.tlog")
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--json", action="store_true", help="print one JSON object per line")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        use(vectors.generate(pathlib.Path(folder), "2.0"))
    count = check_answers(options.flight)
    check_loops(options.flight)
    print(f"python: {count} messages of {options.flight.name}, {options.turns} turns; both gave the same values",
          file=sys.stderr, flush=True)

    # The third number is how often ours runs in each turn, because a single run is too short to measure.
    pairs = {"objects": (our_objects, peer_objects, 20),
             "objects, every field": (our_attributes, peer_loop, 5), "objects, to_dict()": (our_dicts, peer_dicts, 5),
             "mavutil, every field": (our_loop, peer_loop, 3),
             "mavutil, to_dict()": (our_loop_of_dicts, peer_loop_of_dicts, 5),
             f"columns of {MESSAGE}": (our_columns, peer_columns, 100),
             "columns of every message": (our_tables, peer_tables, 50)}
    measured = {name: [] for name in pairs}
    imports = []
    for _ in range(options.turns):
        imports.append(import_seconds())
        for name, (ours, theirs, times) in pairs.items():
            measured[name].append((seconds(ours, options.flight, times), seconds(theirs, options.flight, 1)))
    report(measured, imports, count, options.json)


if __name__ == "__main__":
    main()
