# SPDX-License-Identifier: MIT
"""Recordings made and walked without the code under test."""
import pathlib
import struct

FIRST_TIME_US = 1_700_000_000_000_000  # 14 November 2023


def record(frame: bytes, number: int = 0) -> bytes:
    """A record; one a millisecond."""
    return struct.pack(">Q", FIRST_TIME_US + 1000 * number) + frame


def write(path: pathlib.Path, frames) -> pathlib.Path:
    path.write_bytes(b"".join(record(bytes(frame), number) for number, frame in enumerate(frames)))
    return path


def frames_of(path: pathlib.Path):
    """(time in µs, frame) of every record of a file of whole, unsigned MAVLink 2 frames."""
    data, at = path.read_bytes(), 0
    while at < len(data):
        end = at + 8 + 12 + data[at + 9]
        yield struct.unpack_from(">Q", data, at)[0], data[at + 8:end]
        at = end


def packer(module, system=1, component=1):
    """A pymavlink sender: packer(m).pack(message) gives the next frame."""
    class Sender:
        mav = module.MAVLink(None, srcSystem=system, srcComponent=component)

        def pack(self, message) -> bytes:
            frame = bytes(message.pack(self.mav))
            self.mav.seq = (self.mav.seq + 1) % 256
            return frame
    return Sender()
