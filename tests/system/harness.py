# SPDX-License-Identifier: MIT
"""Helpers of the system tests: run the program under a deadline, wait for a condition, find free ports.
Fixtures are in conftest.py."""
import atexit
import contextlib
import itertools
import os
import pathlib
import pty
import random
import re
import select
import shutil
import signal
import socket
import subprocess
import tempfile
import threading
import time
import tty

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = ROOT / "tests" / "data"
GOLDEN = ROOT / "tests" / "golden"

# Sanitizers and instrumented code are slower; a deadline is there to end a hang, never to judge speed.
DEFAULT_TIMEOUT_S = 60

SANITIZER_REPORT = re.compile(r"(ERROR|WARNING): \w+Sanitizer|runtime error: ")


def _run_folder() -> pathlib.Path:
    """Returns a run folder for this run of the tests and its workers, so that no test meets a router of the machine.
    The path is short, because the path of a socket must be."""
    if "MAVLOOM_RUN" not in os.environ:
        os.environ["MAVLOOM_RUN"] = tempfile.mkdtemp(prefix="mv-")
        atexit.register(shutil.rmtree, os.environ["MAVLOOM_RUN"], ignore_errors=True)
    return pathlib.Path(os.environ["MAVLOOM_RUN"])


RUN = _run_folder()


def environment(more=None) -> dict:
    """The program's environment: ours without the tests' own variables, plus `more`, where None removes a variable."""
    own = {name: value for name, value in os.environ.items()
           if name not in ("MAVLOOM_PROGRAM", "MAVLOOM_PEER_TOOL", "MAVLOOM_SEED")}
    return {name: value for name, value in (own | (more or {})).items() if value is not None}


def program_path() -> pathlib.Path:
    """MAVLOOM_PROGRAM, or the release build's program; relative paths count from the top of the checkout."""
    return ROOT / os.environ.get("MAVLOOM_PROGRAM", "build/release/bin/mavloom")


def wait_for(condition, timeout: float = DEFAULT_TIMEOUT_S, what: str = "the condition"):
    """The first true value of condition(); fails with `what` after `timeout` seconds."""
    deadline = time.monotonic() + timeout
    while not (value := condition()):
        assert time.monotonic() < deadline, f"waited {timeout:g} s in vain for {what}"
        time.sleep(0.01)  # between two looks; the verdict is the condition's
    return value


def enlarge_receive_buffer(sock: socket.socket):
    """To 8 MiB: whatever the system's limit where we are root."""
    so_rcvbufforce = 33
    try:
        sock.setsockopt(socket.SOL_SOCKET, so_rcvbufforce, 8 << 20)
    except PermissionError:
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8 << 20)


def udp_socket(host: str = "127.0.0.1", timeout: float = DEFAULT_TIMEOUT_S) -> socket.socket:
    """A bound UDP socket on a port of the kernel's choice, with a receive buffer that a burst of frames fits in."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    sock = socket.socket(family, socket.SOCK_DGRAM)
    enlarge_receive_buffer(sock)
    sock.bind((host, 0))
    sock.settimeout(timeout)
    return sock


# These ports are below those that the kernel chooses (32768 and up), so only a program that asks for one by its number
# can take it. Each worker of pytest-xdist has its own share.
WORKER = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0")[2:])
_ports = itertools.cycle(random.sample(range(20_000 + WORKER % 8, 32_000, 8), 1500))


def free_port(kind: int = socket.SOCK_DGRAM) -> int:
    """A port that was free a moment ago, and is not given again before all others were.
    Prefer port 0 if the program prints the port it got."""
    while True:
        port = next(_ports)
        with socket.socket(socket.AF_INET, kind) as sock:
            try:
                sock.bind(("127.0.0.1", port))
                return port
            except OSError:
                pass


class SerialLine:
    """A pseudo-terminal; the program gets `device`, and `far` is the test's end.

    The kernel gives the name of a closed terminal to the next one. A program that looks for this line again must not
    find that one, which belongs to another test: so `device` is a name of its own, which ends with the line. `terminal`
    is the kernel's, for a program that ends before the line."""

    def __init__(self):
        self.far, near = pty.openpty()
        self._folder = tempfile.TemporaryDirectory()
        self.device = os.path.join(self._folder.name, "tty")
        self.terminal = os.ttyname(near)
        os.symlink(self.terminal, self.device)
        tty.setraw(near)  # else it echoes and edits what is written before the program has it
        os.close(near)

    def write(self, data):
        while data:
            select.select([], [self.far], [], DEFAULT_TIMEOUT_S)
            data = data[os.write(self.far, data):]

    def unplug(self):
        self._folder.cleanup()
        if self.far >= 0:
            os.close(self.far)
        self.far = -1


class Finished:
    """A run of the program that has ended: `status` (negative: the signal that killed it), `stdout`, `stderr`, `lines`
    of stdout."""

    def __init__(self, args, status, stdout, stderr):
        self.args, self.status, self.stdout, self.stderr = args, status, stdout, stderr
        report = stderr if isinstance(stderr, str) else stderr.decode(errors="replace")
        assert not SANITIZER_REPORT.search(report), f"sanitizer report from {args}:\n{report}"

    @property
    def lines(self):
        return self.stdout.splitlines()

    def __repr__(self):
        return (f"status {self.status} from {self.args}\nstdout: {self.stdout[-4000:]!r}\n"
                f"stderr: {self.stderr[-4000:]!r}")


class Running:
    """A running program whose output is gathered in the background, so that it never stalls on a full pipe."""

    def __init__(self, args, **options):
        self.args = [str(arg) for arg in args]
        self.keeps_stdout = "stdout" not in options
        options.setdefault("stdout", subprocess.PIPE)
        options.setdefault("stdin", subprocess.DEVNULL)
        self.process = subprocess.Popen(self.args, stderr=subprocess.PIPE, **options)
        self._out, self._err = bytearray(), bytearray()
        self._readers = [self._gather(self.process.stderr, self._err)]
        if self.keeps_stdout:
            self._readers.append(self._gather(self.process.stdout, self._out))

    @staticmethod
    def _gather(pipe, into):
        def loop():
            while chunk := pipe.read1(1 << 16):
                into.extend(chunk)
        thread = threading.Thread(target=loop, daemon=True)
        thread.start()
        return thread

    @property
    def stdout(self) -> str:
        return bytes(self._out).decode(errors="replace")

    @property
    def stderr(self) -> str:
        return bytes(self._err).decode(errors="replace")

    @property
    def pid(self) -> int:
        return self.process.pid

    @property
    def alive(self) -> bool:
        return self.process.poll() is None

    def wait_output(self, pattern: str, timeout: float = DEFAULT_TIMEOUT_S, stream: str = "both"):
        """The match of `pattern` in stdout or stderr ("out", "err", "both");
        fails at once when the program ends without it."""
        def look():
            ended = not self.alive
            if ended:
                self._join()
            text = (self.stdout if stream != "err" else "") + (self.stderr if stream != "out" else "")
            match = re.search(pattern, text, re.MULTILINE)
            assert match or not ended, (f"ended with {self.process.returncode} without saying {pattern!r}:\n"
                                        f"{text[-4000:]}")
            return match
        return wait_for(look, timeout, f"{pattern!r} from {self.args}")

    def send(self, number: int):
        """Sends a signal. SIGSTOP: returns when every thread has stopped, which may be later."""
        self.process.send_signal(number)
        if number == signal.SIGSTOP:
            wait_for(self._is_stopped, what="the program to stop")

    def _is_stopped(self) -> bool:
        states = [stat.read_text().rpartition(")")[2].split()[0]
                  for stat in pathlib.Path(f"/proc/{self.pid}/task").glob("*/stat")]
        return all(state in "TtZX" for state in states)

    def wait(self, timeout: float = DEFAULT_TIMEOUT_S) -> Finished:
        """Waits for the program's own end."""
        self.process.wait(timeout)
        self._join()
        return Finished(self.args, self.process.returncode, self.stdout, self.stderr)

    def stop(self, number: int = signal.SIGINT, timeout: float = DEFAULT_TIMEOUT_S) -> Finished:
        """Asks the program to end as a user does, and waits for it."""
        self.send(number)
        return self.wait(timeout)

    def kill(self):
        """Ends it whatever it does; for the end of a test."""
        if self.alive:
            self.process.kill()
        self.process.wait()
        for reader in self._readers:
            reader.join(timeout=5)
        if not any(reader.is_alive() for reader in self._readers):  # closing would wait for one that reads
            for pipe in (self.process.stdin, self.process.stdout, self.process.stderr):
                if pipe:
                    pipe.close()

    def _join(self):
        for reader in self._readers:
            reader.join(DEFAULT_TIMEOUT_S)
            assert not reader.is_alive(), f"{self.args} has ended, and somebody still holds its output open"


def end(processes):
    """Kills what still runs, and removes the sockets, rings and pages that a killed program leaves."""
    for process in processes:
        process.kill()
        if process.process.returncode != -signal.SIGKILL:
            continue
        names = [process.args[process.args.index(option) + 1] for option in ("--name", "--ring")
                 if option in process.args]
        sockets = (RUN / f"{name}.{suffix}" for name in names for suffix in ("ctl", "ctl.lock", "in"))
        rings = (pathlib.Path(f"/dev/shm/mavloom.{name}{suffix}") for name in names for suffix in ("", ".stat"))
        for left in (*sockets, *rings):
            with contextlib.suppress(OSError):
                os.unlink(left)
