# SPDX-License-Identifier: MIT
"""Frames and recordings for the system tests, made and taken apart without our own code."""
import os
import pathlib
import struct

os.environ["MAVLINK20"] = "1"
from pymavlink.dialects.v20 import common as mavlink  # noqa: E402

import harness  # noqa: E402

FLIGHT = harness.DATA / "px4_gcs_flight.tlog"


def sender(system=1, component=1, sequence=0):
    mav = mavlink.MAVLink(None, srcSystem=system, srcComponent=component)
    mav.seq = sequence
    return mav


def heartbeats(count, system=1, component=1, sequence=0):
    mav = sender(system, component, sequence)
    for i in range(count):
        frame = mavlink.MAVLink_heartbeat_message(2, 12, 81, i, 4, 3).pack(mav)
        mav.seq = (mav.seq + 1) % 256
        yield frame


def attitude(roll=0.1, system=1, component=1, sequence=0):
    return mavlink.MAVLink_attitude_message(1000, roll, -0.2, 3.0, 0.01, 0.02,
                                            0.03).pack(sender(system, component, sequence))


def statustext(text, system=1, sequence=0):
    return mavlink.MAVLink_statustext_message(6, text).pack(sender(system, 1, sequence))


def frame_length(data, at):
    return data[at + 1] + (12 + 13 * (data[at + 2] & 1) if data[at] == 0xFD else 8)


def split_frames(data):
    """The frames of bytes that hold nothing else."""
    frames, at = [], 0
    while at < len(data):
        frames.append(data[at:at + frame_length(data, at)])
        at += len(frames[-1])
    return frames


def read_tlog(path):
    """[(Unix microseconds, frame)] of an undamaged tlog."""
    data, records, at = pathlib.Path(path).read_bytes(), [], 0
    while at < len(data):
        size = frame_length(data, at + 8)
        records.append((struct.unpack_from(">Q", data, at)[0], data[at + 8:at + 8 + size]))
        at += 8 + size
    return records


def write_tlog(path, records):
    pathlib.Path(path).write_bytes(b"".join(struct.pack(">Q", time_us) + frame for time_us, frame in records))
    return path
