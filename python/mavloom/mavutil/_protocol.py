# SPDX-License-Identifier: MIT
"""MAVLink: encodes and decodes messages for mavloom.mavutil, and signs and verifies them."""
from __future__ import annotations

import collections
import hashlib
import threading
import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from .._core import FieldInfo, MavutilParser
from .._errors import UsageError
from .._signatures import parameter_name
from ._messages import MAVError, MAVLink_bad_data, MAVLink_message, as_bytes, parameters

if TYPE_CHECKING:
    from ._module import MavlinkModule

PROTOCOL_MARKER_V1 = 0xfe
PROTOCOL_MARKER_V2 = 0xfd
MAVLINK_IFLAG_SIGNED = 1
MAVLINK_SIGNATURE_BLOCK_LEN = 13
SIGNING_EPOCH_S = 1420070400  # 2015-01-01
TICKS_PER_S = 100_000  # signing times count 10 µs
OLDEST_TICKS = 60 * TICKS_PER_S  # how far behind the first signing time of a stream may be


def signing_time() -> int:
    return max(0, int((time.time() - SIGNING_EPOCH_S) * TICKS_PER_S))


class MAVLinkSigning:
    """The state of signing. A bad signature changes only the counters.

    `sig_count` counts the messages with a signature, good or not; a connection counts them only while it has a key.
    `unsigned_count` counts those without a good signature that the callback accepted.
    """

    def __init__(self) -> None:
        self.secret_key: bytes | None = None
        self.timestamp = 0
        self.link_id = 0
        self.sign_outgoing = False
        self.allow_unsigned_callback: Callable[[MAVLink, int], bool] | None = None
        self.stream_timestamps: dict[tuple[int, int, int], int] = {}
        self.sig_count = 0
        self.badsig_count = 0
        self.goodsig_count = 0
        self.unsigned_count = 0
        self.reject_count = 0

    def __repr__(self) -> str:
        state = "off" if self.secret_key is None else "signs" if self.sign_outgoing else "verifies"
        return f"<MAVLinkSigning {state}, link {self.link_id}, {self.goodsig_count} good, {self.reject_count} refused>"

    def next_timestamp(self) -> int:
        """The time of the next signature. Times never repeat, and follow the clock."""
        now = max(self.timestamp, signing_time())
        self.timestamp = now + 1
        return now

    def check(self, frame: bytes, source: tuple[int, int]) -> bool:
        """Whether the signature is good and newer than the last one of its stream."""
        if self.secret_key is None:
            raise UsageError("there is no key to verify with; setup_signing() sets it")
        if hashlib.sha256(self.secret_key + frame[:-6]).digest()[:6] != frame[-6:]:
            self.badsig_count += 1
            return False
        stream = (frame[-13], *source)
        sent = int.from_bytes(frame[-12:-6], "little")
        known = self.stream_timestamps.get(stream)
        if known is not None and sent <= known or known is None and sent + OLDEST_TICKS < self.timestamp:
            self.badsig_count += 1
            return False
        self.stream_timestamps[stream] = sent
        self.timestamp = max(self.timestamp, sent)
        self.goodsig_count += 1
        return True


class MAVLink:
    """Writes messages to `file`, which has a method `write`, and finds messages in bytes.

    NAME_send(...) and NAME_encode(...) exist for every message. `srcSystem`, `srcComponent` and `seq` are those of the
    next message that is sent.
    """

    _module: MavlinkModule  # set in the subclass of each module

    def __init__(self, file: Any, srcSystem: int = 0, srcComponent: int = 0, use_native: bool = False) -> None:
        self.seq = 0
        self.file = file
        self.srcSystem = srcSystem
        self.srcComponent = srcComponent
        self.callback: Callable[..., object] | None = None
        self.callback_args: tuple[Any, ...] = ()
        self.callback_kwargs: dict[str, Any] = {}
        self.send_callback: Callable[..., object] | None = None
        self.send_callback_args: tuple[Any, ...] = ()
        self.send_callback_kwargs: dict[str, Any] = {}
        self.robust_parsing = False
        self.protocol_marker = PROTOCOL_MARKER_V2 if self._module.wire == 2 else PROTOCOL_MARKER_V1
        self.little_endian = True
        self.crc_extra = True
        self.sort_fields = True
        self.total_packets_sent = 0
        self.total_bytes_sent = 0
        self._packets = self._bytes = 0  # that this object received; a connection counts its own
        self._errors = 0  # that this object found; a link counts its own
        self.startup_time = time.time()
        self.signing = MAVLinkSigning()
        self._dialect = self._module.new_dialect()
        self._parser = MavutilParser(self._dialect)
        self._found: collections.deque[MAVLink_message | tuple[bytes, str]] = collections.deque()
        self._sending = threading.RLock()

    def __repr__(self) -> str:
        return f"<MAVLink {self.srcSystem}/{self.srcComponent} seq {self.seq} to {type(self.file).__name__}>"

    def _take_over(self, other: MAVLink) -> None:
        """Receives with the parser, signing and callbacks of another object, in its place."""
        self._dialect, self._parser, self._found = other._dialect, other._parser, other._found
        self.signing = other.signing
        self.callback, self.callback_args, self.callback_kwargs = (other.callback, other.callback_args,
                                                                   other.callback_kwargs)
        self.send_callback, self.send_callback_args, self.send_callback_kwargs = (
            other.send_callback, other.send_callback_args, other.send_callback_kwargs)

    @property
    def total_receive_errors(self) -> int:
        """Frames with a wrong checksum, and bytes that are not in a frame. A live connection counts only frames."""
        return self._errors + self._errors_of_link()

    @total_receive_errors.setter
    def total_receive_errors(self, value: int) -> None:
        self._errors = value - self._errors_of_link()

    @property
    def total_packets_received(self) -> int:
        """Messages that were read, including BAD_DATA."""
        return self._packets + self._totals_of_connection()[0]

    @total_packets_received.setter
    def total_packets_received(self, value: int) -> None:
        self._packets = value - self._totals_of_connection()[0]

    @property
    def total_bytes_received(self) -> int:
        """Bytes that were parsed. A live connection counts those of the messages that were read."""
        return self._bytes + self._totals_of_connection()[1]

    @total_bytes_received.setter
    def total_bytes_received(self, value: int) -> None:
        self._bytes = value - self._totals_of_connection()[1]

    def _totals_of_connection(self) -> tuple[int, int]:
        totals: Callable[[], tuple[int, int]] | None = getattr(self.file, "_totals", None)
        return (0, 0) if totals is None else totals()

    def _errors_of_link(self) -> int:
        of_link: Callable[[], int] | None = getattr(self.file, "_damaged", None)
        return 0 if of_link is None else of_link()

    # ---- sending

    def set_callback(self, callback: Callable[..., object], *args: Any, **kwargs: Any) -> None:
        """`callback(message, *args, **kwargs)` is called for each message that is received."""
        self.callback, self.callback_args, self.callback_kwargs = callback, args, kwargs

    def set_send_callback(self, callback: Callable[..., object], *args: Any, **kwargs: Any) -> None:
        """`callback(message, *args, **kwargs)` is called for each message that is sent."""
        self.send_callback, self.send_callback_args, self.send_callback_kwargs = callback, args, kwargs

    def send(self, mavmsg: MAVLink_message, force_mavlink1: bool = False) -> None:
        """Sends a message with this object's source and next sequence number."""
        if not callable(getattr(mavmsg, "pack", None)):  # messages of pymavlink's own modules pack themselves
            raise UsageError(f"send() takes a message, for example mav.heartbeat_encode(...), not {mavmsg!r}")
        with self._sending:
            frame = mavmsg.pack(self, force_mavlink1=force_mavlink1)
            self.file.write(frame)
            self.seq = (self.seq + 1) % 256
            self.total_packets_sent += 1
            self.total_bytes_sent += len(frame)
        if self.send_callback is not None:
            self.send_callback(mavmsg, *self.send_callback_args, **self.send_callback_kwargs)

    def _pack(self, message: MAVLink_message, force_mavlink1: bool) -> bytes:
        v1 = force_mavlink1 or self.protocol_marker == PROTOCOL_MARKER_V1
        key, signing = None, self.signing
        if signing.sign_outgoing and signing.secret_key is not None and not v1:
            key = signing.secret_key
        frame: bytes = message._pack(self.srcSystem, self.srcComponent, self.seq, v1, key, signing.link_id,
                                     0 if key is None else signing.next_timestamp())
        return frame

    # ---- receiving

    def buf_len(self) -> int:
        """How many bytes of an incomplete message are held."""
        return self._parser.pending

    def bytes_needed(self) -> int:
        return self._parser.needed

    def parse_char(self, c: Sequence[int] | bytes) -> MAVLink_message | None:
        """Takes any number of bytes. Returns the next message; None if there is none yet.

        Bytes that are not a message raise MAVError, or become BAD_DATA if `robust_parsing` is set.
        """
        message = self._parse(c)
        if message is None:
            return None
        message = self._checked(message)
        if self.callback is not None:
            self.callback(message, *self.callback_args, **self.callback_kwargs)
        return message

    def _parse(self, c: Sequence[int] | bytes) -> MAVLink_message | None:
        """`parse_char` without signatures and callbacks."""
        data = b"" if isinstance(c, str) and not c else as_bytes(c)  # pymavlink's own classes pass ""
        self._bytes += len(data)
        if data or not self._found:
            self._found += self._parser.feed(data, time.time_ns())
        if not self._found:
            return None
        message = self._made(self._found.popleft())
        self._packets += 1
        return message

    def _made(self, found: MAVLink_message | tuple[bytes, str]) -> MAVLink_message:
        if not isinstance(found, tuple):
            return found
        data, reason = found
        self._errors += 1
        if not self.robust_parsing:
            raise MAVError(reason if reason != "Bad prefix" else f"invalid MAVLink prefix '{data[0]}'")
        return MAVLink_bad_data(data, reason)

    def _forget_received(self) -> None:
        """Forgets the bytes of an incomplete message."""
        self._parser = MavutilParser(self._dialect)
        self._found.clear()

    def parse_buffer(self, s: Sequence[int] | bytes) -> list[MAVLink_message] | None:
        """Takes any number of bytes. Returns the messages in them; None if there are none yet."""
        messages = []
        message = self.parse_char(s)
        while message is not None:
            messages.append(message)
            message = self.parse_char(b"")
        return messages or None

    def check_signature(self, msgbuf: bytes | bytearray, srcSystem: int, srcComponent: int) -> bool:
        """Whether the signature of a frame is good. Counts it."""
        return self.signing.check(as_bytes(msgbuf), (srcSystem, srcComponent))

    def _checked(self, message: MAVLink_message) -> MAVLink_message:
        """The message, or BAD_DATA in its place if signing does not accept it."""
        if isinstance(message, MAVLink_bad_data):
            return message
        signing, frame = self.signing, message._frame
        is_signed = bool(message._frame_incompat & MAVLINK_IFLAG_SIGNED)
        signing.sig_count += is_signed
        if signing.secret_key is None:
            return message
        if is_signed and signing.check(frame, (message.get_srcSystem(), message.get_srcComponent())):
            message._signed, message._link_id = True, frame[-13]
            return message
        if signing.allow_unsigned_callback is not None and signing.allow_unsigned_callback(self, message.get_msgId()):
            signing.unsigned_count += 1
            return message
        signing.reject_count += 1
        self._errors += 1
        rejected = MAVLink_bad_data(frame, "Invalid signature")
        rejected._timestamp = message._timestamp
        return rejected

    def decode(self, msgbuf: bytes | bytearray) -> MAVLink_message:
        """Decodes one whole frame. Raises MAVError if the bytes are not exactly one frame."""
        frame = as_bytes(msgbuf)
        check_form(frame)
        found = MavutilParser(self._dialect).feed(frame, time.time_ns())
        if len(found) != 1 or isinstance(found[0], tuple):
            raise MAVError(found[0][1] if found and isinstance(found[0], tuple) else "no MAVLink frame")
        message: MAVLink_message = self._checked(found[0])
        if isinstance(message, MAVLink_bad_data):
            raise MAVError(message.reason)
        return message


def check_form(frame: bytes) -> None:
    if not frame or frame[0] not in (PROTOCOL_MARKER_V1, PROTOCOL_MARKER_V2):
        raise MAVError(f"invalid MAVLink prefix '{frame[0]:#x}'" if frame else "no bytes to decode")
    head = 10 if frame[0] == PROTOCOL_MARKER_V2 else 6
    if len(frame) < head + 2:
        raise MAVError(f"invalid MAVLink message length: {len(frame)} bytes are not a frame")
    signed = head == 10 and frame[2] & MAVLINK_IFLAG_SIGNED
    got = len(frame) - head - 2 - (MAVLINK_SIGNATURE_BLOCK_LEN if signed else 0)
    if got != frame[1]:
        number = frame[5] if head == 6 else int.from_bytes(frame[7:10], "little")
        raise MAVError(f"invalid MAVLink message length. Got {got} expected {frame[1]}, msgId={number} "
                       f"headerlen={head}")


def make_call(module: MavlinkModule, name: str, verb: str, fields: list[FieldInfo]) -> Callable[..., Any]:
    """Returns the method NAME_send or NAME_encode, with the fields as its parameters."""
    names = ", ".join(parameter_name(field.name) for field in fields)
    scope: dict[str, Any] = {"_make": module.classes.of(name.upper())}
    more, body = "", f"return _make({names})"
    if verb == "send":
        more = ", force_mavlink1=False" if fields else "force_mavlink1=False"
        body = f"self.send(_make({names}), force_mavlink1=force_mavlink1)"
    exec(f"def made(self, {parameters(fields, '=3')}{more}):\n    {body}\n", scope)
    made: Callable[..., Any] = scope["made"]
    made.__name__ = f"{name}_{verb}"
    made.__qualname__ = f"MAVLink.{name}_{verb}"
    made.__module__ = module.__name__
    return made


class LateMethod:
    """The method NAME_send or NAME_encode, which is made when it is first read.

    Not a method `__getattr__`, which would slow down every other attribute.
    """

    def __init__(self, module: MavlinkModule, message: str, verb: str) -> None:
        self.module = module
        self.message = message
        self.verb = verb

    def __set_name__(self, owner: type[Any], name: str) -> None:
        self.owner = owner
        self.name = name

    def __get__(self, instance: object, owner: type[Any]) -> Any:
        made = make_call(self.module, self.message.lower(), self.verb, self.module.dialect[self.message].fields)
        setattr(self.owner, self.name, made)
        return getattr(owner if instance is None else instance, self.name)


def new_class(module: MavlinkModule) -> type[MAVLink]:
    calls = {f"{name.lower()}_{verb}": LateMethod(module, name, verb)
             for name in module.dialect.message_names for verb in ("send", "encode")}
    return type("MAVLink", (MAVLink,), {"_module": module, "__module__": module.__name__, **calls})
