# SPDX-License-Identifier: MIT
"""Mavloom used by a project of somebody else's (outside/), installed and as a subdirectory."""
import contextlib
import fcntl
import os
import pathlib
import socket
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "support"), str(ROOT / "tests" / "system")]
import frames  # noqa: E402
import harness  # noqa: E402
import pymavlink_vectors as vectors  # noqa: E402

OUTSIDE = pathlib.Path(__file__).parent / "outside"
BUILD = (ROOT / os.environ.get("MAVLOOM_PROGRAM", "build/release/bin/mavloom")).parent.parent

pytestmark = pytest.mark.timeout(600)


def call(*command) -> str:
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True)
    assert done.returncode == 0, f"{command}:\n{done.stdout[-6000:]}"
    return done.stdout


@contextlib.contextmanager
def build_folder(name):
    """A folder beside the build's, kept from run to run. Others that want it wait: tests of one file may run in
    several processes."""
    folder = BUILD.parent / name
    folder.mkdir(exist_ok=True)
    with open(folder / "tests.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield folder


@contextlib.contextmanager
def forwarding_router(*command):
    """(a router that `command` starts, a function that checks that it forwards what a system sends)"""
    vehicle, station, port = harness.udp_socket(), harness.udp_socket(), harness.free_port(socket.SOCK_DGRAM)
    router = harness.Running([*command, "route", f"udpin://127.0.0.1:{port}",
                              f"udpout://127.0.0.1:{station.getsockname()[1]}", "--name", f"package-{port}"],
                             env=harness.environment())

    def check(system):
        sent, received = list(frames.heartbeats(10, system=system)), b""
        for frame in sent:
            vehicle.sendto(frame, ("127.0.0.1", port))
        while len(received) < sum(map(len, sent)):
            received += station.recv(65536)
        assert received == b"".join(sent)
    try:
        router.wait_output("listening")
        yield router, check
    finally:
        harness.end([router])
        vehicle.close()
        station.close()


@pytest.fixture(scope="session")
def installed(tmp_path_factory):
    prefix = tmp_path_factory.mktemp("prefix")
    call("cmake", "--install", BUILD, "--prefix", prefix, "--component", "mavloom_development")
    return prefix


def test_a_plain_install_is_a_whole_prefix_without_debug_information(tmp_path):
    call("cmake", "--install", BUILD, "--prefix", tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bin", "include", "lib", "share"]
    for file in ("share/mavloom/dialects/common.xml", "share/doc/mavloom/guide/route.md", "share/doc/mavloom/LICENSE",
                 "lib/systemd/system/mavloom-router.service", "include/mavloom/msg/attitude.hpp"):
        assert (tmp_path / file).is_file(), file
    assert call(tmp_path / "bin" / "mavloom", "--version").startswith("mavloom ")
    if "CMAKE_BUILD_TYPE:STRING=Release" in (BUILD / "CMakeCache.txt").read_text():
        for file in (tmp_path / "bin" / "mavloom", *tmp_path.glob("lib/**/libmavloom_*.a")):
            assert b".debug_info" not in file.read_bytes(), file


def build_outside(folder, *options):
    call("cmake", "-S", OUTSIDE, "-B", folder, "-G", "Ninja", *options)
    call("cmake", "--build", folder, "-j", str(os.cpu_count()))
    return call(folder / "outside")


EXPECTED = "state=3 items=513 weight=2.5\nre-encoded: same bytes\n"


def test_outside_project_finds_the_installed_package(installed, tmp_path):
    assert build_outside(tmp_path, f"-DCMAKE_PREFIX_PATH={installed}") == EXPECTED


def test_outside_project_takes_the_checkout_as_a_subdirectory(tmp_path):
    unity = "OFF" if "MAVLOOM_FULL" in os.environ else "ON"  # halves the time
    assert build_outside(tmp_path, f"-DMAVLOOM_SOURCE={ROOT}", f"-DCMAKE_UNITY_BUILD={unity}") == EXPECTED
    cache = (tmp_path / "CMakeCache.txt").read_text()
    assert "MAVLOOM_TESTS:BOOL=OFF" in cache


def test_change_of_the_definitions_rebuilds_what_uses_them(installed, tmp_path):
    source, build = tmp_path / "source", tmp_path / "build"
    call("cp", "-r", OUTSIDE, source)
    call("cmake", "-S", source, "-B", build, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={installed}")
    call("cmake", "--build", build)
    xml = source / "shop.xml"
    xml.write_text(xml.read_text().replace('type="float" name="weight"', 'type="double" name="weight"'))

    call("cmake", "--build", build)

    # Another type is another CRC_EXTRA and length: the frame is no longer one of this dialect.
    done = subprocess.run([build / "outside"], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (1, "re-encoded: other bytes\n")


def attitude_lines(flight, peer):
    """The lines expected for the attitudes among these frames, by pymavlink's module."""
    for message in map(peer.MAVLink(None).decode, map(bytearray, flight)):
        if message.get_type() == "ATTITUDE":
            values = " ".join(f"{value:.6f}" for value in (message.roll, message.pitch, message.yaw))
            yield f"{message.get_srcSystem()} {message.get_srcComponent()} {message.time_boot_ms} {values}\n"


def test_the_example_reads_a_ring(installed, tmp_path):
    """examples/ring, built as its own project, on a recorded flight in a ring."""
    call("cmake", "-S", ROOT / "examples" / "ring", "-B", tmp_path, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={installed}")
    call("cmake", "--build", tmp_path)
    flight = [frame for _, frame in frames.read_tlog(frames.FLIGHT)]
    lines = list(attitude_lines(flight, vectors.generate(tmp_path, "2.0")))
    assert len(flight) > 40_000 and len(lines) > 5_000
    name, program = f"package-{os.getpid()}", BUILD / "bin" / "mavloom"
    subprocess.run([program, "shm", "write", name, "--hex"], input="".join(frame.hex() + "\n" for frame in flight),
                   text=True, check=True, stderr=subprocess.DEVNULL)
    def read():
        return subprocess.run([tmp_path / "ring_attitude", name], stdin=subprocess.DEVNULL, capture_output=True,
                              text=True)
    try:
        done = read()
        # the length of the record behind the first (docs/formats/ring.md)
        with open(f"/dev/shm/mavloom.{name}", "r+b") as ring:
            ring.seek(16384)
            first = (24 + int.from_bytes(ring.read(4), "little") + 7) // 8 * 8
            ring.seek(16384 + first)
            ring.write(b"\xff\xff\xff\x7f")
        damaged = read()
    finally:
        call(program, "shm", "remove", name)
    assert (done.returncode, done.stderr) == (0, "0 records missed\n")
    assert done.stdout.splitlines(keepends=True) == lines
    assert (damaged.returncode, damaged.stderr.splitlines()[-1]) == (1, f"ring {name} is damaged")
    done = read()
    assert done.returncode == 1 and f"there is no ring {name}" in done.stderr


def test_the_readme_s_program_compiles(installed, tmp_path):
    """The block of C++ in README.md, as a function of what it uses."""
    text = (ROOT / "README.md").read_text().split("```cpp\n")[1].split("```")[0]
    includes = "".join(line + "\n" for line in text.splitlines() if line.startswith("#"))
    body = "".join(line + "\n" for line in text.splitlines() if not line.startswith("#"))
    (tmp_path / "readme.cpp").write_text(f"{includes}void use(float);\nvoid example(mavloom::ByteView bytes) {{\n"
                                         f"{body}}}\n")
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(readme LANGUAGES CXX)\n"
        "find_package(mavloom REQUIRED COMPONENTS wire dialect)\n"
        "add_library(readme OBJECT readme.cpp)\ntarget_link_libraries(readme PRIVATE mavloom::wire mavloom::dialect)\n")
    call("cmake", "-S", tmp_path, "-B", tmp_path / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={installed}")
    call("cmake", "--build", tmp_path / "build")


def test_components_that_do_not_exist_are_refused(installed, tmp_path):
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(x LANGUAGES CXX)\n"
        "find_package(mavloom REQUIRED COMPONENTS wire telepathy)\n")
    done = subprocess.run(["cmake", "-S", tmp_path, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={installed}"],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert done.returncode != 0 and "telepathy" in done.stderr


def test_every_installed_header_needs_only_installed_ones(installed, tmp_path):
    """`./run tidy` checks that each stands alone."""
    headers = sorted(path.relative_to(installed / "include") for path in (installed / "include/mavloom").rglob("*.hpp"))
    assert len(headers) > 300
    (tmp_path / "all.cpp").write_text("".join(f'#include "{path}"\n' for path in headers))
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(headers LANGUAGES CXX)\nfind_package(mavloom REQUIRED)\n"
        "add_library(headers OBJECT all.cpp)\ntarget_compile_options(headers PRIVATE -fsyntax-only)\n"
        "target_link_libraries(headers PRIVATE mavloom::router mavloom::feed mavloom::message)\n")
    call("cmake", "-S", tmp_path, "-B", tmp_path / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={installed}")
    call("cmake", "--build", tmp_path / "build")


@pytest.mark.long
@pytest.mark.timeout(1800)
def test_pip_install_from_the_source_distribution(tmp_path):
    """In an environment of its own, with the build tools that pyproject.toml asks for;
    then the package, its stubs and the program are used from there."""
    code = "import sys, scikit_build_core.build as backend; backend.build_sdist(sys.argv[1])"
    subprocess.run([sys.executable, "-c", code, tmp_path], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    environment = tmp_path / "venv"
    call(sys.executable, "-m", "venv", environment)
    python = environment / "bin" / "python"
    call(python, "-m", "pip", "install", "--no-input", "--disable-pip-version-check", *tmp_path.glob("*.tar.gz"))
    flight = ROOT / "tests" / "data" / "px4_gcs_flight.tlog"
    code = (f"import mavloom\nprint(sum(1 for _ in mavloom.read({str(flight)!r})), "
            f"len(mavloom.columns({str(flight)!r}, 'ATTITUDE')))\n"
            "import importlib.metadata, pathlib\n"
            "assert mavloom.__version__.startswith(importlib.metadata.version('mavloom'))\n"
            "found = {path.name for path in pathlib.Path(mavloom.__file__).parent.iterdir()}\n"
            "assert {'py.typed', '_core.pyi', 'messages.pyi', 'enums.pyi'} <= found, found\n")
    done = subprocess.run([python, "-c", code], cwd=tmp_path, capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": ""})
    assert (done.returncode, done.stdout) == (0, "40087 5312\n"), done.stderr
    assert call(environment / "bin" / "mavloom", "--version").startswith("mavloom ")
