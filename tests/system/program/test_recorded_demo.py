# SPDX-License-Identifier: MIT
"""tools/demo.py, which ./run demo --recorded starts: OK only where every byte went through, also when it is one of our
programs that loses or changes something."""
import subprocess
import sys

import pytest

import frames
import harness


def demo(program, flight):
    return subprocess.run([sys.executable, harness.ROOT / "tools" / "demo.py", "--program", program, "--flight", flight,
                           "--speed", "20"],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=harness.DEFAULT_TIMEOUT_S,
                          env=harness.environment())


@pytest.fixture(scope="module")
def flight(tmp_path_factory):
    """The first seconds of the recorded flight."""
    return frames.write_tlog(tmp_path_factory.mktemp("demo") / "start.tlog", frames.read_tlog(frames.FLIGHT)[:1000])


def test_every_byte_arrived(program, flight):
    done = demo(program, flight)

    assert done.returncode == 0 and "demo: OK" in done.stdout, done
    assert "1000 frames reached the ground station" in done.stdout and "ATTITUDE" in done.stdout


def test_what_is_damaged_in_the_flight_is_not_asked_for(program, flight, tmp_path):
    damaged = bytearray(flight.read_bytes())
    damaged[len(damaged) // 2:len(damaged) // 2 + 200] = bytes(200)
    (tmp_path / "damaged.tlog").write_bytes(damaged)

    done = demo(program, tmp_path / "damaged.tlog")

    assert done.returncode == 0 and "1 damaged place" in done.stdout, done


@pytest.mark.parametrize("command, option, said", [
    ("replay", "--only ATTITUDE", "MISMATCH"), ("replay", "--start 1s", "MISMATCH"),
    ("replay", "--for 50ms", "MISMATCH"), ("relay", "--only ATTITUDE", "MISMATCH"),
    ("relay", "--set HEARTBEAT.custom_mode=1", "MISMATCH"), ("listen", "--only ATTITUDE", "MISMATCH"),
    ("record", "--count 10", "FAILED")])
def test_a_fault_of_ours_is_reported(program, flight, tmp_path, command, option, said):
    faulty = tmp_path / "mavloom"
    faulty.write_text(f'#!/bin/sh\n[ "$1" = {command} ] && exec "{program}" "$@" {option}\nexec "{program}" "$@"\n')
    faulty.chmod(0o755)

    done = demo(faulty, flight)

    assert done.returncode != 0 and f"demo: {said}" in done.stdout and "demo: OK" not in done.stdout, done


def test_the_way_back_is_proved(program, flight, tmp_path):
    done = demo(program, flight)
    lossy = tmp_path / "mavloom"
    lossy.write_text(f'#!/bin/sh\ncase "$*" in *shm://*) exec "{program}" "$@" --remap-system 9=255;; esac\n'
                     f'exec "{program}" "$@"\n')
    lossy.chmod(0o755)
    faulty = demo(lossy, flight)

    assert done.returncode == 0 and "demo: the way back: " in done.stdout
    assert "demo: OK: byte for byte what was sent, there and back" in done.stdout
    assert faulty.returncode == 4 and "demo: MISMATCH: the frames of the ground station" in faulty.stdout, faulty
