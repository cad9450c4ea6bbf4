# SPDX-License-Identifier: MIT
"""A client of MAVLink's file transfer protocol, for requests that no client of others sends."""
import dataclasses
import itertools
import struct

from stations import mavlink

TERMINATE, RESET, LIST, OPEN, READ, CREATE, WRITE, REMOVE, MAKE_DIR, REMOVE_DIR = range(1, 11)
CRC, BURST = 14, 15
ACK, NAK = 128, 129
FAIL, INVALID_DATA, INVALID_SESSION, NO_SESSIONS, EOF = 1, 3, 4, 5, 6
UNKNOWN, EXISTS, PROTECTED, NOT_FOUND = 7, 8, 9, 10
HEADER = struct.Struct("<HBBBBBBI")


@dataclasses.dataclass
class Reply:
    seq: int
    session: int
    opcode: int
    request: int
    burst_complete: int
    offset: int
    data: bytes

    @property
    def error(self):
        """The error of a NAK; 0: it is an ACK."""
        return 0 if self.opcode == ACK else self.data[0]


class FtpClient:
    """One session at a vehicle, with a session number of the client's choice."""

    def __init__(self, station, session=0):
        self.station, self.session = station, session
        self._numbers = itertools.cycle(range(0, 0x10000, 2))

    def send(self, opcode, data=b"", offset=0, size=None, session=None, seq=None):
        self.seq = next(self._numbers) if seq is None else seq
        payload = HEADER.pack(self.seq, self.session if session is None else session, opcode,
                              len(data) if size is None else size, 0, 0, 0, offset) + data
        self.station.send(mavlink.MAVLink_file_transfer_protocol_message(
            0, *self.station.target, list(payload.ljust(251, b"\0"))))

    def replies(self, mark):
        for message in self.station.since(mark, "FILE_TRANSFER_PROTOCOL"):
            if (message.target_system, message.target_component) == (self.station.system, self.station.component):
                payload = bytes(message.payload)
                seq, session, opcode, size, request, complete, _, offset = HEADER.unpack(payload[:12])
                yield Reply(seq, session, opcode, request, complete, offset, payload[12:12 + size])

    def ask(self, opcode, data=b"", offset=0, size=None, session=None, timeout=10, seq=None):
        mark = self.station.mark()
        self.send(opcode, data, offset, size, session, seq)
        wanted = (self.seq + 1) & 0xFFFF
        return self.station.until(lambda: next((r for r in self.replies(mark) if r.seq == wanted), None), timeout,
                                  f"an answer to FTP request {opcode}")

    def list(self, path):
        entries = []
        while True:
            reply = self.ask(LIST, path.encode(), offset=len(entries))
            if reply.error:
                assert reply.error == EOF, reply
                return entries
            entries += [entry.decode() for entry in reply.data.split(b"\0") if entry]

    def read(self, path):
        """The file, by ReadFile."""
        reply = self.ask(OPEN, path.encode())
        assert not reply.error, (path, reply)
        size, content = struct.unpack("<I", reply.data)[0], b""
        while True:
            reply = self.ask(READ, offset=len(content), size=239, session=reply.session)
            if reply.error:
                assert reply.error == EOF, reply
                break
            content += reply.data
        self.ask(TERMINATE, session=reply.session)
        assert len(content) == size
        return content

    def crc(self, path):
        reply = self.ask(CRC, path.encode())
        assert not reply.error, (path, reply)
        return struct.unpack("<I", reply.data)[0]
