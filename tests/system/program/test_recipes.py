# SPDX-License-Identifier: MIT
"""docs/guide/recipes.md: the programs on the page are run as written, but for their ports. test_docs.py runs its
commands."""
import os
import re
import subprocess
import sys
import urllib.request

import frames
import harness
import pytest

PAGE = (harness.ROOT / "docs" / "guide" / "recipes.md").read_text()


def file_of(name):
    """The block that begins with the name of a file."""
    return re.search(rf"```\w+\n(# {re.escape(name)}\n.*?)```", PAGE, re.DOTALL)[1]


def environment(program, tmp_path):
    """With the package of the build, as an installed wheel would give it, and the program in PATH."""
    package = os.environ.get("PYTHONPATH", str(program.parent.parent / "python"))
    return {**os.environ, "PYTHONPATH": package, "PATH": f"{program.parent}:{os.environ['PATH']}",
            "MAVLOOM_RUN": str(tmp_path)}


@pytest.mark.unsanitized
def test_the_script_for_mavsdk_takes_off(spawn, program, udp_port, tmp_path):
    pytest.importorskip("mavsdk")
    port = udp_port()
    spawn("sim", "--to", f"udpout://127.0.0.1:{port}", "--name", f"recipe-{port}", "--seed", "1")
    script = file_of("takeoff.py").replace("14540", str(port))
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120,
                          env=environment(program, tmp_path))
    if "cannot open shared object" in done.stderr or "GLIBC" in done.stderr:
        pytest.skip("MAVSDK's library does not load here")
    assert done.returncode == 0 and re.search(r"^at [45]\.\d m$", done.stdout, re.MULTILINE), done


@pytest.mark.unsanitized
def test_the_pytest_fixture_flies_a_vehicle(program, tmp_path):
    for name in ("conftest.py", "test_flight.py"):
        (tmp_path / name).write_text(file_of(name))
    done = subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(tmp_path)], timeout=120,
                          cwd=tmp_path, capture_output=True, text=True, env=environment(program, tmp_path))
    assert done.returncode == 0 and "1 passed" in done.stdout, done


def test_each_series_of_the_queries_exists(spawn, udp_port, udp_socket):
    names = set(re.findall(r"\bmavloom_\w+", PAGE))
    assert len(names) >= 6
    port = udp_port()
    router = spawn("route", f"udpin://127.0.0.1:{port}", "--name", f"recipe-{port}", "--metrics", "127.0.0.1:0")
    metrics = router.wait_output(r"metrics on port (\d+)")[1]
    udp_socket().sendto(next(frames.heartbeats(1)), ("127.0.0.1", port))
    router.wait_output(r": up")

    def text():
        with urllib.request.urlopen(f"http://127.0.0.1:{metrics}/metrics", timeout=10) as answer:
            return answer.read().decode()
    harness.wait_for(lambda: "mavloom_system_frames_total{" in text(), what="the vehicle's series")
    assert names <= set(re.findall(r"^(mavloom_\w+)\{", text(), re.MULTILINE))
