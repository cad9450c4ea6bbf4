# SPDX-License-Identifier: MIT
"""The wheel that `./run package` packs from the release build: installed, used and removed where there is no compiler
and no library of ours."""
import os
import pathlib
import re
import subprocess
import sys
import zipfile

import pytest
from test_package import BUILD, ROOT, call, frames

sys.path.insert(0, str(ROOT / "tools"))
import shared_libraries  # noqa: E402

pytestmark = pytest.mark.timeout(600)

LARGEST_BYTES = 8_000_000
# Of PEP 600: the libraries that a manylinux wheel may leave to the system, as far as we need them.
OF_THE_SYSTEM = re.compile(r"ld-linux.*|lib(c|m|pthread|gcc_s|stdc\+\+)\.so\.\d")

# Receives a recorded frame by UDP, and takes it apart.
RECEIVE = """
import socket, sys, mavloom
frame = bytes.fromhex(sys.argv[1])
with mavloom.connect("udpin://127.0.0.1:0") as link:
    peer = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    peer.sendto(frame, ("127.0.0.1", link.port))
    message = link.recv(timeout=30.0)
    print(message.name, message.sys, message.header.seq)
"""


def make_wheel(folder):
    call(sys.executable, ROOT / "tools" / "make_wheel.py", BUILD, folder)
    return next(folder.glob("*.whl"))


def check_content(wheel):
    assert re.fullmatch(r"mavloom-[\d.]+-cp3\d+-cp3\d+-manylinux_2_\d+_x86_64\.whl", wheel.name)
    assert wheel.stat().st_size < LARGEST_BYTES
    with zipfile.ZipFile(wheel) as opened:
        names = {re.sub(r"-[\d.]+(?=\.(data|dist-info)/)", "", name) for name in opened.namelist()}
        for file in ("mavloom/__main__.py", "mavloom/messages.pyi", "mavloom/py.typed", "mavloom/bin/mavloom",
                     "mavloom.data/scripts/mavloom", "mavloom.dist-info/licenses/LICENSE"):
            assert file in names, file
        for name in opened.namelist():
            if ".so" in name or name.endswith("bin/mavloom"):
                assert b".debug_info" not in opened.read(name), name
    # A licence of each library that the wheel brings along.
    libraries = [name for name in names if name.startswith("mavloom.libs/lib")]
    licences = [name for name in names if re.match(r"mavloom\.dist-info/licenses/lib.*\.txt", name)]
    assert len(libraries) == len(licences) > 0, (libraries, licences)


def check_use(python, program):
    """`python` and `program` are functions that run these with arguments and return the output."""
    heartbeat = next(frames.heartbeats(1))
    version = python("-c", "import mavloom; print('mavloom', mavloom.__version__)")
    assert program("--version") == python("-m", "mavloom", "--version") == version
    assert "Usage: mavloom listen" in python("-m", "mavloom", "listen", "--help")
    assert python("-c", RECEIVE, heartbeat.hex()) == f"HEARTBEAT {heartbeat[5]} {heartbeat[4]}\n"


def check_libraries(packages):
    """The loader finds what the wheel needs in the wheel, and leaves to the system only what each has."""
    for elf in (packages / "mavloom/bin/mavloom", *packages.glob("mavloom/_core*.so")):
        for library in shared_libraries.libraries_of(elf):
            assert library.resolve().is_relative_to(packages) or OF_THE_SYSTEM.fullmatch(library.name), (elf, library)


def files_in(folder):
    return {path for path in folder.rglob("*") if path.is_file()}


def test_a_wheel_works_without_a_compiler_and_goes_without_a_trace(tmp_path):
    if "CMAKE_BUILD_TYPE:STRING=Release" not in (BUILD / "CMakeCache.txt").read_text():
        pytest.skip("wheels are made of a release build")
    wheel = make_wheel(tmp_path / "wheels")
    check_content(wheel)
    environment = tmp_path / "venv"
    call(sys.executable, "-m", "venv", "--without-pip", environment)
    packages = next(environment.glob("lib/python*/site-packages"))
    numpy = pathlib.Path(subprocess.run([sys.executable, "-c", "import numpy; print(numpy.__path__[0])"], check=True,
                                        capture_output=True, text=True).stdout.strip())
    (packages / "numpy").symlink_to(numpy)
    (packages / "numpy.libs").symlink_to(numpy.parent / "numpy.libs")
    before = files_in(environment)

    def pip(*arguments):
        call(sys.executable, "-m", "pip", "--python", environment / "bin" / "python", *arguments)

    def run(name, *arguments):
        done = subprocess.run([environment / "bin" / name, *arguments], stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, cwd=tmp_path, env={"PATH": str(environment / "bin"), "HOME": str(tmp_path)})
        assert done.returncode == 0, done.stderr
        return done.stdout
    pip("install", "--no-index", "--no-deps", wheel)
    check_libraries(packages)
    check_use(lambda *arguments: run("python", *arguments), lambda *arguments: run("mavloom", *arguments))
    pip("uninstall", "--yes", "mavloom")
    assert files_in(environment) == before
    assert not list(packages.glob("mavloom*"))
