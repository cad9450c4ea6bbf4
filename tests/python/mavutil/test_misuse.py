# SPDX-License-Identifier: MIT
"""Random calls with random arguments, of everything public. Only documented exceptions may come out of them."""
import os
import pathlib
import random
import shutil
import subprocess
import sys

import pytest

CALLS = 10_000
# A program of its own: a crash ends it. Waits are ended by a signal.
PROGRAM = r"""
import asyncio, faulthandler, inspect, itertools, os, pandas, pyarrow, random, shutil, signal, sys, traceback, warnings
import mavloom
from mavloom import mavutil, mavwp, messages, quaternion
faulthandler.enable()
warnings.simplefilter("ignore")
seed, calls, flight = int(sys.argv[1]), int(sys.argv[2]), "flight.tlog"
choose = random.Random(seed)
original = shutil.copy(flight, "original.tlog")

class Waited(Exception):
    pass

def end_wait(number, frame):
    raise Waited

signal.signal(signal.SIGALRM, end_wait)
DOCUMENTED = (mavloom.Error, ImportError, TypeError, ValueError, AttributeError, LookupError, OSError, BufferError,
              StopIteration, Waited)
rings = []
mavlink = mavutil.mavlink
beat = mavloom.Dialect().message("HEARTBEAT", type=2)

def made():
    rings.append(f"misuse-{os.getppid()}-{len(rings)}")
    link = mavloom.connect("udpin://127.0.0.1:0")
    live, log = mavutil.mavlink_connection("udpin:127.0.0.1:0"), mavutil.mavlink_connection(flight)
    return [mavloom, mavutil, mavwp, quaternion, mavlink, link, link.mav, link.messages, link.subscribe(), link.stats,
            link.vehicle(1), link.vehicle(1).params, link.vehicle(1).mission, mavloom.read(flight),
            mavloom.write("written.tlog"), mavloom.Dialect(), mavloom.Dialect()["ATTITUDE"], mavloom.Parser(), beat,
            mavloom.columns(flight, "HEARTBEAT"), mavloom.RingWriter(rings[-1]), mavloom.RingReader(rings[-1]),
            live, live.mav, live.messages, live.mav.signing, log, log.mav, log.recv_match(type="ATTITUDE"),
            mavlink.MAVLink_mission_item_int_message(*range(14)), mavlink.MAVLink_bad_data(b"x", "y"),
            mavlink.enums, mavutil.mavmmaplog(flight), mavwp.MAVWPLoader(), mavwp.MAVFenceLoader(),
            quaternion.QuaternionBase([1, 0, 0, 0])]

# What ends the process, changes it for all later calls, or takes long by design.
LEFT_OUT = {"stop_all", "set_leak_warnings", "install", "set_dialect", "set_signature", "warnings", "sys", "os"}
VALUES = [None, True, 0, 1, -1, 255, 256, 2**31, 2**64, -2**70, 0.5, float("nan"), float("inf"), 1e300, "", "x", "roll",
          "HEARTBEAT", "ATTITUDE", "heartbeat_send", "udpin:127.0.0.1:0", "tcp:127.0.0.1:1", "wss:x", flight, "a\ud800",
          "\0", "STABILIZE", "ATTITUDE.roll > 0", "((", b"", b"\xfd\x01", b"\xfe" * 300, bytes(32), beat.frame,
          bytearray(b"abc"), [], [1, 2, 3], ["HEARTBEAT"], (1, 2), {}, {"a": 1}, {1}, object(), lambda *a: 1 // 0 if 0
          else None, len, int, beat, messages.ATTITUDE, memoryview(b"abcd"), range(5), 1j, slice(1), iter([1]), sys]

def methods_of(thing):
    found = []
    for name in dir(thing):
        if name in LEFT_OUT or name.startswith("_") and not name.startswith("__") or name in (
                "__class__", "__reduce__", "__reduce_ex__", "__init_subclass__", "__subclasshook__", "__getattribute__",
                "__init__", "__new__", "__builtins__", "__loader__", "__spec__", "__delattr__", "__setattr__"):
            continue
        found.append(name)
    return found

def arguments_of(function):
    # Mostly as many as it takes.
    count = choose.choice((0, 1, 1, 2, 3, 7))
    if choose.random() < 0.7:
        try:
            count = len([one for one in inspect.signature(function).parameters.values() if one.default is one.empty
                         and one.kind in (one.POSITIONAL_ONLY, one.POSITIONAL_OR_KEYWORD)])
        except (TypeError, ValueError):
            pass
    return [choose.choice(VALUES + things) for _ in range(count)]

things, names, counts, slow = made(), {}, {}, 0
for number in range(calls):
    if number % 1000 == 999:
        shutil.copy(original, flight)
        things = made()
    thing = choose.choice(things)
    key = type(thing) if not inspect.ismodule(thing) else thing
    if key not in names:
        names[key] = methods_of(thing)
    name = choose.choice(names[key])
    arguments = []
    keywords = {choose.choice(("timeout", "type", "system", "dialect", "blocking", "condition", "x", "name")):
                choose.choice(VALUES) for _ in range(choose.choice((0, 0, 0, 1, 2)))}
    what = f"call {number}: {getattr(thing, '__name__', type(thing).__name__)}.{name}"
    try:
        try:
            signal.setitimer(signal.ITIMER_REAL, 0.02)
            value = getattr(thing, name)
            if callable(value):
                arguments = arguments_of(value)
                value = value(*arguments, **keywords)
            if choose.random() < 0.1:
                repr(value)
            if choose.random() < 0.1 and not inspect.ismodule(value) and hasattr(value, "__iter__"):
                list(itertools.islice(value, 5))
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
    except Waited:
        slow += 1
    except DOCUMENTED as error:
        if "Invoked with types" in str(error):
            sys.exit(f"{what}: {error}")
        counts[type(error).__name__] = counts.get(type(error).__name__, 0) + 1
    except BaseException as error:
        traceback.print_exc()
        sys.exit(f"{what}{tuple(arguments)!r:.300} {keywords!r:.200}: {type(error).__name__}")
print(counts, slow)
"""


@pytest.mark.timeout(600)
def test_everything_that_is_misused_raises_a_documented_exception(flight, child_environment, tmp_path):
    seed = int(os.environ.get("MAVLOOM_SEED", random.randrange(2**32)))
    print("MAVLOOM_SEED", seed)
    shutil.copy(flight, tmp_path / "flight.tlog")  # which a call may write
    done = subprocess.run([sys.executable, "-c", PROGRAM, str(seed), str(CALLS)], capture_output=True, text=True,
                          env={**child_environment, "PYTHONFAULTHANDLER": "1"}, cwd=tmp_path, errors="replace")
    for ring in pathlib.Path("/dev/shm").glob(f"mavloom.misuse-{os.getpid()}-*"):
        ring.unlink()
    assert done.returncode == 0, (seed, done.returncode, done.stderr[-6000:])
    assert "TypeError" in done.stdout and "UsageError" in done.stdout
