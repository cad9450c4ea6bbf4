# SPDX-License-Identifier: MIT
"""The Python examples of the guides: run as they are written."""
import contextlib
import pathlib
import re
import shutil
import socket
import subprocess
import sys

import pytest

from guides import PAGES, script_of
from places import ROOT, free_port
from tlogs import frames_of
from vehicles import again_and_again


@contextlib.contextmanager
def vehicle_at(port, flight):
    """Sends what a recorded vehicle sent, again and again, as fast as it is of use."""
    frames = [frame for _, frame in frames_of(flight) if frame[5] == 1 and frame[7] in (0, 30)
              and frame[8:10] == b"\0\0"]
    kinds = [next(frame for frame in frames if frame[7] == kind) for kind in (0, 30)]

    def send():
        for frame in kinds:
            sock.sendto(frame, ("127.0.0.1", port))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock, again_and_again(send, pause_s=0.01):
        yield


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_examples_run(page, flight, tmp_path, child_environment):
    shutil.copy(flight, tmp_path / "flight.tlog")
    port = free_port()
    ring, inlet = f"guides-{port}", str(tmp_path / "px4.in")
    script = script_of(page)
    for written, used in (("14550", str(port)), ('"px4"', f'"{ring}"'), ("shm://px4", f"shm://{ring}"),
                          ("/run/mavloom/px4.in", inlet)):
        script = script.replace(written, used)
    if inlet in script:
        script += """send_to_inlet(dialect.encode("HEARTBEAT", source_system=255, source_component=193))\n"""
    with (vehicle_at(port, flight),
          contextlib.ExitStack() as at_the_end,
          socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as router):
        router.bind(inlet)
        router.setblocking(False)
        at_the_end.callback(pathlib.Path(f"/dev/shm/mavloom.{ring}").unlink, missing_ok=True)
        done = subprocess.run([sys.executable, "-W", "error", "-c", script], cwd=tmp_path, env=child_environment,
                              capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (0, ""), done.stderr
        if inlet in script:
            assert [(frame[0], frame[5:10]) for frame in [router.recv(65536)]] == [(0xfd, bytes((255, 193, 0, 0, 0)))]


def numbers_in_names(word):
    """The numbers in the names of this package's tests: {"17", "3.16", ...} of test_row_17_...,
    test_rows_3_4_and_3_6_..."""
    found = set()
    for path in (ROOT / "tests" / "python").glob("test_*.py"):
        for name in re.findall(r"def (test_\w+)", path.read_text()):
            for first, more in re.findall(rf"_{word}s?_(\d+(?:_\d+)*)((?:_and_\d+(?:_\d+)*)*)(?=_|$)", name):
                for number in [first, *re.findall(r"\d[\d_]*", more)]:
                    parts = number.strip("_").split("_")
                    found |= {parts[0], ".".join(parts[:2])} | {".".join(pair) for pair in zip(parts[::2], parts[1::2])}
    return found


def test_every_row_of_the_guide_has_a_test_that_names_it():
    rows = re.findall(r"^\| (\d[\d., ]*) \|", PAGES[1].read_text(), re.MULTILINE)
    wanted = {number for row in rows for number in row.split(", ")}
    assert {"1", "18", "29", "3.1", "3.23"} <= wanted
    assert wanted - numbers_in_names("row") == set()
    assert {str(number) for number in range(1, 13)} - numbers_in_names("example") == set()
