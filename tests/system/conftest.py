# SPDX-License-Identifier: MIT
"""Fixtures of the system tests, which run the real program. The tools behind them are in harness.py."""
import os
import random
import signal
import socket
import subprocess

import pytest

import harness

# A shell without job control starts what runs in its background with SIGINT ignored, and programs inherit that.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def program():
    """Path of the program under test: MAVLOOM_PROGRAM, default build/release/bin/mavloom."""
    path = harness.program_path()
    assert path.is_file(), f"{path} is missing: ./run build makes it, or MAVLOOM_PROGRAM names another"
    return path


@pytest.fixture
def run(program):
    """run("listen", "x.tlog", input=b"", timeout=60, text=True, env={}, cwd=None) -> harness.Finished.
    Runs it to its end."""
    def call(*args, input=None, timeout=harness.DEFAULT_TIMEOUT_S, text=True, env=None, cwd=None):
        command = [str(program), *map(str, args)]
        options = {"input": input} if input is not None else {"stdin": subprocess.DEVNULL}
        encoding = {"encoding": "utf-8", "errors": "replace"} if text else {}
        done = subprocess.run(command, capture_output=True, timeout=timeout, cwd=cwd,
                              env=harness.environment(env), **options, **encoding)
        return harness.Finished(command, done.returncode, done.stdout, done.stderr)
    return call


@pytest.fixture
def spawn(program):
    """spawn("listen", "udpin://127.0.0.1:0", env={}, **Popen options) -> harness.Running, killed at the end of the test
    if it still runs. With stdout=... the caller reads it (or does not: that is how a slow pipe is made)."""
    running = []

    def start(*args, env=None, **options):
        running.append(harness.Running([program, *args], env=harness.environment(env), **options))
        return running[-1]
    yield start
    harness.end(running)


@pytest.fixture
def wait_for():
    return harness.wait_for


@pytest.fixture
def udp_port():
    return lambda: harness.free_port(socket.SOCK_DGRAM)


@pytest.fixture
def tcp_port():
    return lambda: harness.free_port(socket.SOCK_STREAM)


@pytest.fixture
def udp_socket():
    """udp_socket(host="127.0.0.1") -> a bound socket, closed at the end of the test."""
    opened = []

    def make(*args, **options):
        opened.append(harness.udp_socket(*args, **options))
        return opened[-1]
    yield make
    for sock in opened:
        sock.close()


@pytest.fixture
def data():
    return harness.DATA


@pytest.fixture
def golden():
    return harness.GOLDEN


@pytest.fixture
def rng():
    """A random generator whose seed is printed, and taken from MAVLOOM_SEED to repeat a failure."""
    seed = int(os.environ.get("MAVLOOM_SEED", random.randrange(1 << 32)))
    print(f"MAVLOOM_SEED={seed}")
    return random.Random(seed)
