# SPDX-License-Identifier: MIT
"""The Python examples of the guides: run as they are written."""
import contextlib
import pathlib
import shutil
import socket
import subprocess
import sys
import threading

import pytest

from guides import PAGES, script_of
from tlogs import frames_of


@contextlib.contextmanager
def vehicle_at(port, flight):
    """Sends what a recorded vehicle sent, again and again, as fast as it is of use."""
    frames = [frame for _, frame in frames_of(flight) if frame[5] == 1 and frame[7] in (0, 30) and frame[8:10] == b"\0\0"]
    kinds = [next(frame for frame in frames if frame[7] == kind) for kind in (0, 30)]
    stop = threading.Event()

    def send():
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
            while not stop.wait(0.01):
                for frame in kinds:
                    sock.sendto(frame, ("127.0.0.1", port))
    thread = threading.Thread(target=send)
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_examples_run(page, flight, tmp_path, child_environment):
    shutil.copy(flight, tmp_path / "flight.tlog")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    ring, inlet = f"guides-{port}", str(tmp_path / "px4.in")
    script = script_of(page).replace("14550", str(port)).replace('"px4"', f'"{ring}"').replace("/run/mavloom/px4.in", inlet)
    with vehicle_at(port, flight), contextlib.ExitStack() as at_the_end, socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as router:
        router.bind(inlet)
        router.setblocking(False)
        at_the_end.callback(pathlib.Path(f"/dev/shm/mavloom.{ring}").unlink, missing_ok=True)
        done = subprocess.run([sys.executable, "-W", "error", "-c", script], cwd=tmp_path, env=child_environment, capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (0, ""), done.stderr
        if inlet in script:
            assert [(frame[0], frame[5:10]) for frame in [router.recv(65536)]] == [(0xfd, bytes((255, 190, 0, 0, 0)))]
