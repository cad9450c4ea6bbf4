# SPDX-License-Identifier: MIT
"""A recorded PX4 as a peer: it sends the telemetry that the real one sent, at its pace, and answers each request with
the frames that the real one answered with (tests/data/px4_gcs_session.tlog). And the ground station's side of that
session, spoken by pymavlink."""
import collections
import itertools
import select
import socket
import struct
import threading
import time

import frames
import harness
from frames import mavlink
from pymavlink import mavutil
from pymavlink.generator.mavcrc import x25crc

SESSION = harness.DATA / "px4_gcs_session.tlog"
VEHICLE, STATION = 1, 255
PARAMETERS = 952
# The vehicle sends these only as answers: PING, PARAM_VALUE, missions, COMMAND_ACK, FILE_TRANSFER_PROTOCOL,
# TIMESYNC, LOG_ENTRY, LOG_DATA, AUTOPILOT_VERSION, PROTOCOL_VERSION, COMPONENT_METADATA, AVAILABLE_MODES.
ANSWERS = {4, 22, 44, 47, 51, 73, 77, 110, 111, 118, 120, 148, 300, 397, 435}
BURST, BURST_PAUSE_S = 20, 0.02  # parameters: twenty at a time, each 20 ms, as the recorded PX4


def message_id(frame):
    return frame[7] | frame[8] << 8 | frame[9] << 16


def payload(frame):
    return bytes(frame[10:10 + frame[1]])


def checksum(frame, crc_extra):
    crc = x25crc(frame[1:-2])
    crc.accumulate(bytes([crc_extra]))
    return struct.pack("<H", crc.crc)


# {id: CRC_EXTRA} as the recorded frames were made: no definition is needed.
EXTRAS = {}


def resequenced(frame, sequence):
    """The same frame with another sequence number."""
    if message_id(frame) not in EXTRAS:
        EXTRAS[message_id(frame)] = next(extra for extra in range(256) if checksum(frame, extra) == frame[-2:])
    changed = frame[:4] + bytes([sequence]) + frame[5:]
    return changed[:-2] + checksum(changed, EXTRAS[message_id(frame)])


def recorded_answers():
    """{(id, payload) of a request: the vehicle's answers to it}, telemetry left out."""
    answers, request = collections.defaultdict(list), None
    for _, frame in frames.read_tlog(SESSION):
        if frame[5] == STATION:
            request = (message_id(frame), payload(frame))
        elif request and message_id(frame) in ANSWERS:
            answers[request].append(frame)
    return answers


def recorded_telemetry():
    """[(seconds since the first, frame)] of the vehicle before anybody asked for anything."""
    records = frames.read_tlog(SESSION)
    begin = records[0][0]
    before = itertools.takewhile(lambda record: record[1][5] == VEHICLE, records)
    return [((time_us - begin) / 1e6, frame) for time_us, frame in before if message_id(frame) not in ANSWERS]


class RecordedPx4:
    """Speaks to one UDP port from `with` to its end. `unanswered`: requests that the recording has no answer to."""

    def __init__(self, port, host="127.0.0.1"):
        self.socket = harness.udp_socket()
        self.socket.connect((host, port))
        self.unanswered, self.heard = [], []
        self.sent = 0
        self._answers, self._telemetry = recorded_answers(), recorded_telemetry()
        self._queue = collections.deque()  # (when, frame), of a long answer
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._over.set()
        self._thread.join(10)
        self.socket.close()

    def _send(self, frame):
        self.socket.send(resequenced(frame, self.sent % 256))
        self.sent += 1

    def _run(self):
        begin, played = time.monotonic(), 0
        length = self._telemetry[-1][0]
        while not self._over.is_set():
            now = time.monotonic()
            rounds, index = divmod(played, len(self._telemetry))
            due = begin + rounds * length + self._telemetry[index][0]
            if self._queue:
                due = min(due, self._queue[0][0])
            try:
                if select.select([self.socket], [], [], min(max(due - now, 0), 0.05))[0]:
                    self._hear(self.socket.recv(65536))
                while self._queue and self._queue[0][0] <= time.monotonic():
                    self._send(self._queue.popleft()[1])
                if begin + rounds * length + self._telemetry[index][0] <= time.monotonic():
                    self._send(self._telemetry[index][1])
                    played += 1
            except ConnectionRefusedError:
                pass  # nobody listens there yet, or any more

    def _hear(self, datagram):
        for frame in frames.split_frames(datagram):
            self.heard.append(frame)
            request = (message_id(frame), payload(frame))
            answers = self._answers.get(request)
            if answers is None and message_id(frame) != mavlink.MAVLINK_MSG_ID_HEARTBEAT:
                self.unanswered.append(request)
            now = time.monotonic()
            self._queue.extend((now + BURST_PAUSE_S * (i // BURST), answer) for i, answer in enumerate(answers or ()))


class Station:
    """pymavlink at the other end, with the requests of the recorded ground station."""

    def __init__(self, url):
        self.connection = mavutil.mavlink_connection(url, source_system=255, source_component=190)
        if isinstance(getattr(self.connection, "port", None), socket.socket):
            harness.enlarge_receive_buffer(self.connection.port)

    @property
    def mav(self):
        return self.connection.mav

    def close(self):
        self.connection.close()

    def wait_vehicle(self):
        """A heartbeat of the vehicle; answers it, so that the program between them hears the station."""
        assert self.match("HEARTBEAT", lambda m: m.get_srcSystem() == VEHICLE)
        self.connection.target_system, self.connection.target_component = 1, 1
        self.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 4)

    def match(self, kind, condition=lambda m: True, timeout=harness.DEFAULT_TIMEOUT_S):
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            message = self.connection.recv_match(type=kind, blocking=True, timeout=0.2)
            if message is not None and condition(message):
                return message
        return None

    def fetch_parameters(self, silence_s=3.0):
        """{index: name}: what comes after one request, until nothing new comes. Nothing is asked for again."""
        self.mav.param_request_list_send(1, 1)
        got = {}
        while len(got) < PARAMETERS + 1 and (message := self.match("PARAM_VALUE", timeout=silence_s)):
            got[message.param_index] = message.param_id
        return got

    def upload_mission(self):
        """The recorded mission of six items. The acknowledgement's type, and how many items were asked for."""
        recorded = [frame for _, frame in frames.read_tlog(SESSION) if frame[5] == STATION]
        decode = mavlink.MAVLink(None).decode
        items = {m.seq: m for m in (decode(bytearray(f)) for f in recorded if message_id(f) == 73)}
        self.mav.mission_count_send(1, 1, len(items), 0)
        asked = 0
        while (message := self.match(["MISSION_REQUEST_INT", "MISSION_REQUEST",
                                      "MISSION_ACK"])).get_type() != "MISSION_ACK":
            asked += 1
            self.mav.send(items[message.seq])
        return message.type, asked

    def arm(self):
        """The result of the command."""
        self.mav.command_long_send(1, 1, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0)
        return self.match("COMMAND_ACK", lambda m: m.command == mavlink.MAV_CMD_COMPONENT_ARM_DISARM).result
