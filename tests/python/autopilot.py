# SPDX-License-Identifier: MIT
"""A stub of an autopilot: answers commands, parameters and missions, and streams when it is asked to.

It is deterministic: the streams are a fixed sequence, sent once. Frames are made and read by pymavlink. `received` has
the frames of its client.
"""
import contextlib
import dataclasses
import math
import socket
import struct
import threading
import time

ARMED = 128
POSITION = (-353632621, 1491652374)


@dataclasses.dataclass
class Settings:
    """Whether it is an ArduPilot (the default) or a PX4, and its faults."""
    px4: bool = False
    kind: int = 2
    autopilot: int | None = None
    request_int: bool = False  # MISSION_REQUEST_INT instead of MISSION_REQUEST
    drop: frozenset = frozenset()  # types of messages of which it ignores the first one
    refuse: dict = dataclasses.field(default_factory=dict)  # MAV_CMD: MAV_RESULT
    silent: frozenset = frozenset()  # types of messages that it never answers
    lose_values: frozenset = frozenset()  # indices of parameters that it leaves out of a list
    refuse_mission: int = 0  # MAV_MISSION_RESULT of an upload
    progress: bool = False  # report a command in progress first
    beat_s: float = 0.02


ARDUPILOT_PARAMS = {"ARMING_CHECK": (1.0, 6), "FRAME_CLASS": (1.0, 2), "RTL_ALT": (1500.0, 6),
                    "SERIAL0_BAUD": (115.0, 6), "WPNAV_SPEED": (500.0, 9)}
# The bits of COM_RC_IN_MODE are those of a signalling NaN, which a conversion to double would change.
PX4_PARAMS = {"BAT_N_CELLS": (4, 6), "COM_RC_IN_MODE": (-4200000, 6), "MPC_XY_VEL_MAX": (12.0, 9),
              "MPC_TKO_SPEED": (1.5, 9), "SYS_AUTOSTART": (4001, 6)}


class Bytewise:
    """A PARAM_VALUE with these bytes as its value. As a Python float, the bits of some integers would change."""

    def __init__(self, peer, message, value):
        self.peer, self.message, self.value = peer, message, value

    def pack(self, mav, force_mavlink1=False):
        frame = bytearray(self.message.pack(mav, force_mavlink1=force_mavlink1))
        begin = 6 if force_mavlink1 else 10
        frame[begin:begin + 4] = self.value
        checksum = self.peer.x25crc(frame[1:-2])
        checksum.accumulate(bytes([self.message.crc_extra]))
        frame[-2:] = struct.pack("<H", checksum.crc)
        return bytes(frame)


class Autopilot:
    """`listen` is its own UDP port; `connect_to` is where it sends first. TCP: `tcp` listens."""

    def __init__(self, peer, settings=None, connect_to=None, tcp=False, v1=False):
        self.peer, self.settings, self.v1 = peer, settings or Settings(), v1
        self.mav = peer.MAVLink(None, srcSystem=1, srcComponent=1)
        self.decoder = peer.MAVLink(None)
        self.decoder.robust_parsing = True
        self.received, self.messages = [], []
        self.params = dict(PX4_PARAMS if self.settings.px4 else ARDUPILOT_PARAMS)
        self.mission, self.upload, self.wanted = [], None, 0
        self.base_mode, self.custom_mode = 81, (3 << 16 if self.settings.px4 else 0)
        self.streamed, self.dropped, self.height = set(), set(), None
        self.lock = threading.RLock()
        self._address, self._stop = connect_to, threading.Event()
        if tcp:
            self._listener = socket.create_server(("127.0.0.1", 0))
            self.port = self._listener.getsockname()[1]
            self.socket = None
        else:
            self._listener = None
            self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            self.socket.bind(("127.0.0.1", 0))
            self.socket.settimeout(self.settings.beat_s)
            self.port = self.socket.getsockname()[1]
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._stop.set()
        self._thread.join()
        for one in (self.socket, self._listener):
            if one is not None:
                one.close()

    # ---- the wire

    def send(self, *messages):
        with self.lock:
            for message in messages:
                frame = bytes(message.pack(self.mav, force_mavlink1=self.v1))
                self.mav.seq = (self.mav.seq + 1) % 256
                with contextlib.suppress(OSError):
                    if self._listener is not None:
                        if self.socket is not None:
                            self.socket.sendall(frame)
                    elif self._address is not None:
                        self.socket.sendto(frame, self._address)

    def _run(self):
        if self._listener is not None:
            self._listener.settimeout(0.05)
            while self.socket is None and not self._stop.is_set():
                with contextlib.suppress(TimeoutError):
                    self.socket = self._listener.accept()[0]
                    self.socket.settimeout(self.settings.beat_s)
        due = 0.0
        while not self._stop.is_set():
            if time.monotonic() >= due:
                due = time.monotonic() + self.settings.beat_s
                self.send(self.heartbeat())
            self._receive()

    def _receive(self):
        try:
            if self._listener is not None:
                data = self.socket.recv(65536)
            else:
                data, self._address = self.socket.recvfrom(65536)
        except OSError:
            return
        for message in self.decoder.parse_buffer(data) or []:
            self.received.append(bytes(message.get_msgbuf()))
            self.messages.append(message)
            self._answer(message)

    def _answer(self, message):
        name = message.get_type()
        if name in self.settings.silent:
            return
        if name in self.settings.drop and name not in self.dropped:
            self.dropped.add(name)
            return
        handler = getattr(self, f"on_{name.lower()}", None)
        if handler is not None:
            handler(message)

    # ---- state

    def heartbeat(self):
        autopilot = self.settings.autopilot or (12 if self.settings.px4 else 3)
        return self.peer.MAVLink_heartbeat_message(self.settings.kind, autopilot, self.base_mode, self.custom_mode, 4,
                                                   3)

    def position(self, height):
        lat, lon = POSITION
        return self.peer.MAVLink_global_position_int_message(1000, lat, lon, 584000 + int(height * 1000),
                                                             int(height * 1000), 0, 0, 0, 9000)

    # ---- streams

    def on_request_data_stream(self, message):
        self.stream()

    def stream(self):
        """Twenty of each of some messages, once."""
        if self.streamed:
            return
        self.streamed.add(1)
        for i in range(20):
            self.send(self.peer.MAVLink_attitude_message(i * 100, i * 0.01, -i * 0.02, math.sin(i), 0.5, 0.25, -0.125),
                      self.position(i * 0.5))
        self.send(self.peer.MAVLink_statustext_message(6, b"streams have ended"))

    # ---- commands

    def on_command_long(self, message):
        result = self.settings.refuse.get(message.command, 0)
        if self.settings.progress:
            self.send(self.ack(message, 5))
        if result == 0:
            self.obey(message)
        self.send(self.ack(message, result))
        if result == 0 and message.command == 22 and not self.settings.px4:
            self.send(*(self.position(height) for height in range(11)))

    def ack(self, message, result):
        return self.peer.MAVLink_command_ack_message(message.command, result, 0, 0, message.get_srcSystem(),
                                                     message.get_srcComponent())

    def obey(self, message):
        if message.command == 400:
            self.base_mode = self.base_mode & ~ARMED | (ARMED if message.param1 else 0)
        elif message.command == 176:
            self.custom_mode = (int(message.param2) << 16 | int(message.param3) << 24 if self.settings.px4
                                else int(message.param2))
        elif message.command == 512 and message.param1 == 33:  # REQUEST_MESSAGE: GLOBAL_POSITION_INT
            self.send(self.position(10.5))

    def on_set_mode(self, message):
        self.custom_mode = message.custom_mode

    # ---- parameters

    def value(self, name):
        value, kind = self.params[name]
        index = sorted(self.params).index(name)
        bytewise = self.settings.px4 and kind == 6
        message = self.peer.MAVLink_param_value_message(name.encode(), 0.0 if bytewise else value, kind,
                                                        len(self.params), index)
        return Bytewise(self.peer, message, struct.pack("<i", value)) if bytewise else message

    def on_param_request_list(self, message):
        if self.settings.px4:
            self.send(self.peer.MAVLink_param_value_message(b"_HASH_CHECK", 1.0, 5, len(self.params), 65535))
        for index, name in enumerate(sorted(self.params)):
            if index not in self.settings.lose_values:
                self.send(self.value(name))

    def on_param_request_read(self, message):
        name = sorted(self.params)[message.param_index] if message.param_index >= 0 else message.param_id
        if name in self.params:
            self.send(self.value(name))
        elif self.settings.px4:
            self.send(self.peer.MAVLink_param_error_message(message.get_srcSystem(), message.get_srcComponent(),
                                                            name.encode(), -1, 1))

    def on_param_set(self, message):
        name = message.param_id
        if name not in self.params:
            return
        kind = self.params[name][1]
        value = message.param_value
        if self.settings.px4 and kind == 6:
            raw = message.get_msgbuf()[10:14]
            value = struct.unpack("<i", raw)[0]
        self.params[name] = (value, kind)
        self.send(self.value(name))

    # ---- missions

    def on_mission_count(self, message):
        self.upload, self.wanted = [], message.count
        self.request(message)

    def request(self, message):
        if len(self.upload) == self.wanted:
            if not self.settings.refuse_mission:
                self.mission = self.upload
            self.mission_ack(message, self.settings.refuse_mission)
            return
        kind = (self.peer.MAVLink_mission_request_int_message if self.settings.request_int
                else self.peer.MAVLink_mission_request_message)
        self.send(kind(message.get_srcSystem(), message.get_srcComponent(), len(self.upload), message.mission_type))

    def on_mission_item_int(self, message):
        if message.seq == len(self.upload):
            self.upload.append(message)
        self.request(message)

    def mission_ack(self, message, result=0):
        self.send(self.peer.MAVLink_mission_ack_message(message.get_srcSystem(), message.get_srcComponent(), result,
                                                        message.mission_type))

    def on_mission_clear_all(self, message):
        self.mission = []
        self.mission_ack(message)

    def on_mission_request_list(self, message):
        self.send(self.peer.MAVLink_mission_count_message(message.get_srcSystem(), message.get_srcComponent(),
                                                          len(self.mission), message.mission_type))

    def on_mission_request_int(self, message):
        item = self.mission[message.seq]
        fields = {name: getattr(item, name) for name in item.fieldnames}
        fields.update(target_system=message.get_srcSystem(), target_component=message.get_srcComponent())
        self.send(self.peer.MAVLink_mission_item_int_message(**fields))

    def on_mission_set_current(self, message):
        self.send(self.peer.MAVLink_mission_current_message(message.seq))

    # ---- positions, for location()

    def on_set_position_target_global_int(self, message):
        pass

    def fly(self):
        """Sends the messages that location() waits for."""
        lat, lon = POSITION
        self.send(self.peer.MAVLink_vfr_hud_message(1, 2, 270, 30, 594.5, 0),
                  self.peer.MAVLink_gps_raw_int_message(1, 3, lat, lon, 584000, 1, 1, 1, 1, 12), self.position(10.5))
