# SPDX-License-Identifier: MIT
"""python -m mavloom.hear URL --ring NAME: writes the frames of a link to a ring in shared memory.

Frames that readers of the ring send go to every peer of the link.
"""
from __future__ import annotations

import argparse
import json
import os
import signal
import sys
import time
from collections.abc import Callable

from . import ClosedError, Error, InputError, Link, PermissionDeniedError, RingWriter, UsageError, _core, connect

LOOK_AT_SIGNALS_S = 0.1
LOOK_AT_ANSWERS_S = 1.0
PRINT_COUNTS_S = 1.0
SAME_REQUEST_S = 0.2

DESCRIPTION = "Writes the frames of a link to a ring in shared memory, and sends the answers of its readers."

EPILOG = """\
Each record is one valid frame, byte for byte, of kind 1. It has the kernel's receive time and the number of its link.
Its verdict is 0 for unsigned, 16 for signed but not checked, 32 for signed and verified (verify= in URL). Other
processes read the ring at memory speed:

  python -m mavloom.hear udpin://0.0.0.0:14550 --ring px4
  mavloom shm read px4 --json
  python -c 'import mavloom; print(mavloom.RingReader("px4").read())'

Programs that read the ring can answer. `mavloom relay shm://NAME` and `mavloom.connect("shm://NAME").send` send to the
socket RUN/NAME.in, and every peer of URL gets these frames.

While a lossless reader keeps the ring full, frames wait in a buffer of 16 MiB. If that is full too, the oldest frame is
overwritten and counted as missed. An existing ring is continued. One of another capacity is replaced, unless another
process writes to it. If the ring is removed, it is created again.

Ctrl-C or SIGTERM ends the program cleanly (status 130, 143). It then removes the socket, and the ring unless --keep is
given. Signals that were ignored at start stay ignored, for example under nohup or in the background of a script: use
SIGTERM there.

Status: 1 failed, 2 wrong use, 3 the file is not a ring, 4 frames were missed.
"""


class Signals:
    """Records the signal that requests the end. A second one ends the program at once, unless it follows so soon that
    it is the same request: wrappers, and the kernel when a parent dies, may send several."""

    def __init__(self) -> None:
        self.received = 0
        self._received_at = 0.0
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, self._remember)

    def _remember(self, number: int, frame: object) -> None:
        now = time.monotonic()
        if not self.received:
            self.received, self._received_at = number, now
        elif now - self._received_at >= SAME_REQUEST_S:
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)


def argument(parse: Callable[[str], int]) -> Callable[[str], int]:
    """Turns a function that raises UsageError into a type for argparse."""
    def parsed(text: str) -> int:
        try:
            return parse(text)
        except UsageError as error:
            raise argparse.ArgumentTypeError(str(error)) from None
    return parsed


def arguments(words: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser("python -m mavloom.hear", description=DESCRIPTION, epilog=EPILOG,
                                     formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("url", metavar="URL",
                        help="the link to read from: udpin://0.0.0.0:14550, serial:///dev/ttyACM0?baud=57600, ...")
    parser.add_argument("--ring", required=True, metavar="NAME",
                        help="letters, digits, _ and -, at most 64")
    parser.add_argument("--capacity", type=argument(_core.ring_capacity), default=8 << 20, metavar="SIZE",
                        help="capacity of a new ring in bytes, a power of two: 64k to 64G (8M)")
    parser.add_argument("--mode", type=argument(_core.file_mode), default=0o600, metavar="OCTAL",
                        help="permissions of a new ring and of its socket, for reading and sending (0600)")
    end = parser.add_mutually_exclusive_group()
    end.add_argument("--keep", action="store_true", help="keep the ring at the end, for the next writer")
    end.add_argument("--remove", action="store_true", help="remove the ring at the end (the default)")
    parser.add_argument("--json", action="store_true",
                        help="once a second and at the end, print the counts as one JSON object on stdout")
    parser.add_argument("-q", "--quiet", action="store_true", help="print errors only")
    return parser.parse_args(words)


class Ring:
    """The ring that the program writes to. It is created again if it is removed, by `mavloom shm remove` or by hand."""

    def __init__(self, options: argparse.Namespace) -> None:
        self._options = options
        self._written = 0  # records in rings that are gone
        self._open()

    def _open(self) -> None:
        self.writer = RingWriter(self._options.ring, capacity=self._options.capacity, mode=self._options.mode)
        self._before = self.writer.records

    @property
    def written(self) -> int:
        return self._written + self.writer.records - self._before

    def fill_from(self, link: Link, seconds: float) -> None:
        try:
            link.pump(self.writer, seconds)
        except ClosedError:
            if not self.writer.removed:
                raise

    def create_again_if_removed(self) -> bool:
        """Creates the ring again if it was removed. Returns whether it was."""
        if not self.writer.removed:
            return False
        gone, self._written = self.writer, self.written
        self._open()
        gone.close()
        return True

    def close(self) -> None:
        self.writer.close(remove=not self._options.keep)


class Answers:
    """Serves the frames that readers of the ring send, and reports those that reach no peer."""

    def __init__(self, link: Link, say: Callable[[str], None]) -> None:
        self._link, self._say = link, say
        self._look_due = 0.0
        self._reported_no_peer = self._reported_refused = False

    def serve(self, ring: str, mode: int) -> None:
        try:
            self._link.serve_inlet(ring, mode=mode)
        except PermissionDeniedError as error:  # there is no folder for sockets
            self._say(f"{error.strerror}; readers of ring {ring} cannot send")

    def look(self, now: float) -> None:
        """Checks the counters about once a second. Reports each kind of failure once."""
        if now < self._look_due:
            return
        self._look_due = now + LOOK_AT_ANSWERS_S
        stats = self._link.stats
        if stats.unheard_answers and not self._reported_no_peer:
            self._reported_no_peer = True
            self._say(f"{self._link.name} has no peer: frames that readers of the ring send are dropped and counted")
        if stats.refused and not self._reported_refused:
            self._reported_refused = True
            self._say(f"a peer of {self._link.name} is gone: frames that readers of the ring send to it are refused "
                      "and counted")


class Counts:
    """Prints the counts as JSON, once a second and at the end, if that is wanted."""

    def __init__(self, link: Link, ring: Ring, wanted: bool) -> None:
        self._link, self._ring, self._wanted = link, ring, wanted
        self._due = 0.0

    def look(self, now: float) -> None:
        if self._wanted and now >= self._due:
            self._due = now + PRINT_COUNTS_S
            self.print()

    def print(self) -> None:
        if self._wanted:
            print(json.dumps({"stats": counts_of(self._link, self._ring.written)}), flush=True)


def hear(link: Link, ring: Ring, answers: Answers, counts: Counts, signals: Signals,
         say: Callable[[str], None]) -> None:
    while not signals.received:
        ring.fill_from(link, LOOK_AT_SIGNALS_S)
        answers.look(time.monotonic())
        counts.look(time.monotonic())
        if ring.create_again_if_removed():
            say(f"ring {ring.writer.name} was removed; it is created again")
    ring.fill_from(link, 0)


def counts_of(link: Link, written: int) -> dict[str, int]:
    stats = link.stats
    return {"frames_in": stats.frames_in, "written": written, "lost": stats.lost, "kernel_drop": stats.kernel_drop,
            "missed": stats.missed, "not_written": max(stats.frames_in - stats.missed - written, 0),
            "crc_error": stats.crc_error, "bad_signature": stats.bad_signature, "answers": stats.answers,
            "unheard_answers": stats.unheard_answers, "refused": stats.refused}


MEANINGS = {"lost": "lost before they arrived", "kernel_drop": "dropped by the kernel",
            "missed": "missed because the ring was full",
            "not_written": "not written because the ring was full or the program ended",
            "crc_error": "with a wrong checksum", "bad_signature": "with a wrong signature",
            "answers": "sent by readers of the ring", "unheard_answers": "of these without a peer",
            "refused": "refused by a peer that is gone"}


def summary(link: Link, name: str, written: int) -> str:
    counts = counts_of(link, written)
    listed = "".join(f"; {counts[key]} {meaning}" for key, meaning in MEANINGS.items() if counts[key])
    return f"{name}: {counts['frames_in']} frames heard, {written} written{listed}"


def run(options: argparse.Namespace, signals: Signals) -> int:
    def say(text: str) -> None:
        if not options.quiet:
            print(text, file=sys.stderr, flush=True)
    with connect(options.url) as link:
        link._reader.check_target(options.ring)
        ring = Ring(options)
        try:
            name = ring.writer.name
            answers = Answers(link, say)
            answers.serve(name, options.mode)
            existing = "" if ring.writer.created else ", which already existed"
            say(f"hearing on {link.name}, writing to ring {name}{existing}")
            counts = Counts(link, ring, options.json)
            hear(link, ring, answers, counts, signals, say)
            counts.print()
            say(summary(link, name, ring.written))
        finally:
            ring.close()
        if link.stats.missed:
            return 4
    return 128 + signals.received if signals.received else 0


def main(words: list[str] | None = None) -> int:
    signals = Signals()
    options = arguments(words)
    try:
        return run(options, signals)
    except Error as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        print(f"mavloom.hear: {reason}", file=sys.stderr)
        return 2 if isinstance(error, UsageError) else 3 if isinstance(error, InputError) else 1


if __name__ == "__main__":
    sys.exit(main())
