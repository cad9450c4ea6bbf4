# SPDX-License-Identifier: MIT
"""Clients that talk to a simulated vehicle, made with pymavlink: its own dialect, generated from dialects/all.xml, and
nothing of ours. Every frame that arrives is kept with the kernel's time of arrival."""
import contextlib
import os
import pathlib
import select
import socket
import struct
import sys
import tempfile
import threading
import time
import zlib

import harness

os.environ["MAVLINK20"] = "1"
sys.path.insert(0, str(harness.ROOT / "tests" / "support"))
import pymavlink_vectors  # noqa: E402

_folder = tempfile.TemporaryDirectory(prefix="mv-dialect-")
# pymavlink's module for all messages; see test_pymavlink_peer.py.
mavlink = pymavlink_vectors.generate(pathlib.Path(_folder.name), "2.0")

GCS = (255, 190)
RESULT_TIMEOUT_S = 10  # for an answer over loopback on a busy machine
NAN = float("nan")
HERE = 0x7FFFFFFF  # of COMMAND_INT: no position


def crc32(data: bytes) -> int:
    """The checksum of parameters, plans and files: reflected 0xEDB88320, initial value 0, not inverted."""
    return zlib.crc32(data, 0xFFFFFFFF) ^ 0xFFFFFFFF


def bits_of(value: float) -> int:
    return struct.unpack("<I", struct.pack("<f", value))[0]


def float_of(bits: int) -> float:
    return struct.unpack("<f", struct.pack("<I", bits & 0xFFFFFFFF))[0]


class Station:
    """A client at a UDP or TCP port of a simulator or router. A thread reads what comes and sends a heartbeat each
    second. `log` holds (time of arrival, message) of all frames; messages keep their bytes (`get_msgbuf`)."""

    def __init__(self, port, identity=GCS, scheme="udp", beats=True, keeps=None, sock=None):
        self.system, self.component = identity
        self.target = (1, 1)
        self.log, self._latest, self.keeps = [], {}, keeps
        self.damaged = self.at = 0
        self._news = threading.Condition()
        self._sending = threading.Lock()
        self._coder = mavlink.MAVLink(self, srcSystem=self.system, srcComponent=self.component)
        self._parser = mavlink.MAVLink(None)
        self._parser.robust_parsing = True
        self._last_numbers, self.lost = {}, 0
        self._listens = sock is not None
        self._peer = None
        self._sock = sock or self._connect(port, scheme)
        self._beats, self._ended = beats, False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    @staticmethod
    def _connect(port, scheme):
        if scheme == "tcp":
            return socket.create_connection(("127.0.0.1", port), timeout=harness.DEFAULT_TIMEOUT_S)
        sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        harness.enlarge_receive_buffer(sock)
        so_timestampns = 35
        sock.setsockopt(socket.SOL_SOCKET, so_timestampns, 1)
        sock.connect(("127.0.0.1", port))
        return sock

    @classmethod
    def listening(cls, **options):
        """A client that the simulator calls (--to udpout://): it answers where frames come from."""
        sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        harness.enlarge_receive_buffer(sock)
        sock.setsockopt(socket.SOL_SOCKET, 35, 1)
        sock.bind(("127.0.0.1", 0))
        return cls(None, sock=sock, **options)

    @property
    def port(self):
        return self._sock.getsockname()[1]

    @property
    def vehicle_port(self):
        return self._sock.getpeername()[1]

    @property
    def url(self):
        return f"udpout://127.0.0.1:{self.port}"

    def close(self):
        self._ended = True
        self._thread.join(harness.DEFAULT_TIMEOUT_S)
        self._sock.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    # ---- sending

    def write(self, data):
        """For pymavlink: sends a packed frame, or any bytes."""
        with contextlib.suppress(ConnectionError):  # nobody listens (any more)
            if self._listens:
                if self._peer:
                    self._sock.sendto(data, self._peer)
            elif self._sock.type == socket.SOCK_DGRAM:
                self._sock.send(data)
            else:
                self._sock.sendall(data)

    def send(self, message):
        with self._sending:
            self._coder.send(message)

    def send_to_vehicle(self, name, *fields, **named):
        """send_to_vehicle("param_request_list") sends the message with the target in its first two fields."""
        self.send(getattr(mavlink, f"MAVLink_{name}_message")(*self.target, *fields, **named))

    def heartbeat(self):
        self.send(mavlink.MAVLink_heartbeat_message(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 4, 3))

    # ---- receiving

    def _run(self):
        due = 0.0
        while not self._ended:
            if self._beats and time.monotonic() >= due:
                self.heartbeat()
                due = time.monotonic() + 1
            wait = max(0.0, min(0.1, due - time.monotonic())) if self._beats else 0.1
            if select.select([self._sock], [], [], wait)[0]:
                self._read()

    def _read(self):
        for _ in range(64):  # then, heartbeats may be due
            try:
                data, ancillary, _, peer = self._sock.recvmsg(65536, 64, socket.MSG_DONTWAIT)
            except (BlockingIOError, InterruptedError):
                return
            except ConnectionError:
                if self._sock.type == socket.SOCK_STREAM:
                    self._ended = True
                return
            if not data and self._sock.type == socket.SOCK_STREAM:
                self._ended = True
                return
            if self._listens:
                self._peer = peer
            self._take(data, self._arrival(ancillary))

    @staticmethod
    def _arrival(ancillary):
        for _, _, value in ancillary:
            seconds, nanoseconds = struct.unpack("qq", value[:16])
            return seconds + nanoseconds * 1e-9
        return time.time()

    def _take(self, data, when):
        for message in self._parser.parse_buffer(data) or []:
            if message.get_type() == "BAD_DATA":
                self.damaged += 1
                continue
            self._count_lost(message)
            with self._news:
                if self.keeps is None or message.get_type() in self.keeps:
                    self.log.append((when, message))
                self._latest[message.get_type(), message.get_srcSystem()] = message
                self._news.notify_all()

    def _count_lost(self, message):
        source = (message.get_srcSystem(), message.get_srcComponent())
        number = message.get_seq()
        if source in self._last_numbers:
            self.lost += (number - self._last_numbers[source] - 1) % 256
        self._last_numbers[source] = number

    def mark(self):
        """A place in the log; `expect` looks from there on."""
        with self._news:
            return len(self.log)

    def latest(self, name, system=None):
        """The newest message of this name, or None."""
        with self._news:
            return self._latest.get((name, system or self.target[0]))

    def since(self, mark, *names):
        with self._news:
            return [message for _, message in self.log[mark:] if not names or message.get_type() in names]

    def times(self, name, mark=0, system=None):
        """When the messages of this name arrived."""
        with self._news:
            return [when for when, m in self.log[mark:]
                    if m.get_type() == name and m.get_srcSystem() == (system or self.target[0])]

    def expect(self, *names, since=None, where=lambda m: True, timeout=harness.DEFAULT_TIMEOUT_S, what=None):
        """The first message of one of these names for which `where` holds; from `since` on, or from now on. `at` is
        then the place behind it."""
        at = self.mark() if since is None else since
        deadline = time.monotonic() + timeout
        with self._news:
            while True:
                while at < len(self.log):
                    message = self.log[at][1]
                    at += 1
                    if message.get_type() in names and message.get_srcSystem() == self.target[0] and where(message):
                        self.at = at
                        return message
                left = deadline - time.monotonic()
                assert left > 0, f"no {' or '.join(names)} {what or ''} within {timeout:g} s; latest: " + \
                    "; ".join(str(self._latest.get((n, self.target[0]))) for n in names) + f"; texts: {self._texts()}"
                self._news.wait(min(left, 1))

    def _texts(self):
        return [m.text for _, m in self.log if m.get_type() == "STATUSTEXT"][-8:]

    def texts(self, since=0):
        return [m.text for m in self.since(since, "STATUSTEXT")]

    def until(self, condition, timeout=harness.DEFAULT_TIMEOUT_S, what="the condition"):
        return harness.wait_for(condition, timeout, what)

    def meet(self, timeout=harness.DEFAULT_TIMEOUT_S):
        """Waits for the vehicle's heartbeat; the vehicle hears ours."""
        self.expect("HEARTBEAT", since=0, timeout=timeout)
        return self

    # ---- commands

    def command(self, command, *params, p7=0, form="long", frame=0, x=0, y=0, timeout=RESULT_TIMEOUT_S, target=None,
                wants_final=True):
        """Sends a command with parameters 1 to 4 (COMMAND_INT: x and y as sent), or 1 to 7, and returns its result."""
        mark = self.mark()
        to = target or self.target
        values = list(params) + [0] * (7 - len(params))
        if form == "int":
            self.send(mavlink.MAVLink_command_int_message(*to, frame, command, 0, 0, *values[:4], x, y, p7))
        else:
            self.send(mavlink.MAVLink_command_long_message(*to, command, 0, *values))
        return self.expect("COMMAND_ACK", since=mark, timeout=timeout, what=f"of command {command}",
                           where=lambda m: m.command == command and not (wants_final and m.result == 5)).result

    def ask_for(self, message_id, name, p2=0, timeout=RESULT_TIMEOUT_S):
        """The message that REQUEST_MESSAGE brings; its acknowledgement must be ACCEPTED."""
        mark = self.mark()
        assert self.command(512, message_id, p2, timeout=timeout) == 0
        return self.expect(name, since=mark, timeout=timeout)

    def set_interval(self, message_id, microseconds):
        return self.command(511, message_id, microseconds)

    # ---- parameters

    def parameters(self, timeout=harness.DEFAULT_TIMEOUT_S, patience=0.5):
        """{name: PARAM_VALUE} of the whole list. If none arrives for `patience` seconds, lost ones are requested by
        index."""
        mark = self.mark()
        self.send_to_vehicle("param_request_list")
        deadline, got = time.monotonic() + timeout, {}
        while time.monotonic() < deadline:
            latest = self.mark()
            got = {m.param_index: m for m in self.since(mark, "PARAM_VALUE") if m.param_index != 0xFFFF}
            count = next(iter(got.values())).param_count if got else None
            if count and len(got) == count:
                return {m.param_id: m for m in got.values()}
            with contextlib.suppress(AssertionError):
                self.expect("PARAM_VALUE", since=latest, timeout=patience)
                continue
            if not got:
                self.send_to_vehicle("param_request_list")
            else:
                for index in sorted(set(range(count)) - set(got))[:20]:
                    self.send_to_vehicle("param_request_read", b"", index)
        raise AssertionError(f"{len(got)} parameters within {timeout:g} s")

    def parameter(self, name, timeout=RESULT_TIMEOUT_S):
        mark = self.mark()
        self.send_to_vehicle("param_request_read", name.encode(), -1)
        return self.expect("PARAM_VALUE", "PARAM_ERROR", since=mark, timeout=timeout,
                           where=lambda m: m.param_id == name)

    def set_parameter(self, name, value, kind=9, timeout=RESULT_TIMEOUT_S):
        """Sends the value as it is: the caller converts integers of PX4 (float_of). The first answer."""
        mark = self.mark()
        self.send_to_vehicle("param_set", name.encode(), value, kind)
        return self.expect("PARAM_VALUE", "PARAM_ERROR", since=mark, timeout=timeout,
                           where=lambda m: m.param_id == name)

    # ---- plans

    def upload(self, items, plan=0, timeout=harness.DEFAULT_TIMEOUT_S, sends=None):
        """Uploads MISSION_ITEM_INT messages, lost ones again, and returns the MISSION_ACK."""
        at = self.mark()
        deadline = time.monotonic() + timeout

        def step(seq=None):
            if seq is None:
                self.send_to_vehicle("mission_count", len(items), plan)
            else:
                self.send(items[seq])
        last = None
        step()
        while True:
            assert time.monotonic() < deadline, f"no end of the upload within {timeout:g} s"
            try:
                answer = self.expect("MISSION_REQUEST_INT", "MISSION_REQUEST", "MISSION_ACK", since=at, timeout=1.5,
                                     where=lambda m: (m.target_system, m.target_component, m.mission_type) ==
                                     (self.system, self.component, plan))
            except AssertionError:
                step(last)  # it was lost, or the answer to it
                continue
            at = next(i for i in range(at, self.mark()) if self.log[i][1] is answer) + 1
            if answer.get_type() == "MISSION_ACK":
                return answer
            if sends is not None:
                sends(answer.seq)
            last = answer.seq
            step(last)

    def download(self, plan=0, timeout=harness.DEFAULT_TIMEOUT_S, acknowledges=True):
        """The items of a plan, requested one by one and again when one is lost."""
        deadline = time.monotonic() + timeout

        def ask(request, *names, where=lambda m: True):
            while True:
                assert time.monotonic() < deadline, f"no download within {timeout:g} s"
                mark = self.mark()
                request()
                with contextlib.suppress(AssertionError):
                    return self.expect(*names, since=mark, timeout=0.3, where=lambda m: m.mission_type == plan and
                                       m.target_system == self.system and where(m))
        count = ask(lambda: self.send_to_vehicle("mission_request_list", plan), "MISSION_COUNT")
        items = [ask(lambda: self.send_to_vehicle("mission_request_int", seq, plan), "MISSION_ITEM_INT",
                     where=lambda m: m.seq == seq) for seq in range(count.count)]
        if acknowledges:
            self.send_to_vehicle("mission_ack", mavlink.MAV_MISSION_ACCEPTED, plan)
        return items

    def clear(self, plan=0):
        mark = self.mark()
        self.send_to_vehicle("mission_clear_all", plan)
        return self.expect("MISSION_ACK", since=mark, timeout=RESULT_TIMEOUT_S).type

    # ---- flying

    @property
    def is_armed(self):
        beat = self.latest("HEARTBEAT")
        return bool(beat and beat.base_mode & 128)

    def ready(self, timeout=harness.DEFAULT_TIMEOUT_S):
        """Waits until the vehicle can be armed."""
        self.expect("SYS_STATUS", since=0, timeout=timeout, what="with a good pre-arm check",
                    where=lambda m: m.onboard_control_sensors_health & mavlink.MAV_SYS_STATUS_PREARM_CHECK)
        return self

    def landed(self, *states, timeout=harness.DEFAULT_TIMEOUT_S, since=None):
        return self.expect("EXTENDED_SYS_STATE", since=since, timeout=timeout, what=f"with landed state {states}",
                           where=lambda m: m.landed_state in states)

    def mode_is(self, custom_mode, timeout=harness.DEFAULT_TIMEOUT_S, since=None):
        return self.expect("HEARTBEAT", since=since, where=lambda m: m.custom_mode == custom_mode, timeout=timeout,
                           what=f"with mode {custom_mode:#x}")

    def armed_is(self, armed, timeout=harness.DEFAULT_TIMEOUT_S, since=None):
        return self.expect("HEARTBEAT", since=since, where=lambda m: bool(m.base_mode & 128) == armed, timeout=timeout,
                           what=f"with armed {armed}")

    def height_is(self, metres, tolerance=0.5, timeout=harness.DEFAULT_TIMEOUT_S):
        return self.expect("GLOBAL_POSITION_INT", timeout=timeout, what=f"at {metres} m",
                           where=lambda m: abs(m.relative_alt / 1000 - metres) < tolerance)
