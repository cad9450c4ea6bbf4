# SPDX-License-Identifier: MIT
"""The files of the container image (packaging/docker/Dockerfile), used by chroot, without a tool that builds images."""
import json
import os
import re
import socket
import sys

import pytest
from test_package import BUILD, ROOT, call, frames

import harness

pytestmark = [pytest.mark.timeout(600),
              pytest.mark.skipif("MAVLOOM_FULL" not in os.environ, reason="only .ci/run --full"),
              pytest.mark.skipif(os.geteuid() != 0, reason="only root may use chroot")]

LARGEST_BYTES = 16_000_000


@pytest.fixture(scope="module")
def image(tmp_path_factory):
    folder = tmp_path_factory.mktemp("image")
    call("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", folder, "-D", "CPACK_COMPONENTS_ALL=mavloom_runtime")
    call(sys.executable, ROOT / "tools" / "make_image_root.py", folder, *folder.glob("mavloom_*.deb"))
    return folder


def test_the_dockerfile_copies_what_is_tested_here(image):
    lines = (ROOT / "packaging/docker/Dockerfile").read_text().splitlines()
    assert "FROM scratch" in lines
    copied = {line.split()[-2] for line in lines if line.startswith("COPY ")}
    assert copied == {f"{path.name}/" for path in image.iterdir() if path.is_dir() and path.name != "_CPack_Packages"}


def test_the_image_has_a_program_its_libraries_and_their_licences(image):
    root = image / "root"
    files = {str(path.relative_to(root)) for path in root.rglob("*") if path.is_file()}
    assert sum((root / file).stat().st_size for file in files) < LARGEST_BYTES
    unexpected = [file for file in files if not re.match(
        r"usr/bin/mavloom$|(usr/)?lib(64)?/(.*-linux-gnu/)?[\w+.-]+\.so[.\d]*$|usr/share/(doc|terminfo)/", file)]
    assert not unexpected
    assert "usr/share/terminfo/x/xterm-256color" in files  # for `top`


def test_the_image_s_program_receives(image):
    def inside(*arguments):
        return ["chroot", image / "root", "/usr/bin/mavloom", *arguments]
    assert call(*inside("--version")).startswith("mavloom ")
    listening = harness.Running(inside("listen", "udpin://127.0.0.1:0", "--json", "--count", "1"))
    port = int(listening.wait_output(r"listening on port (\d+)", stream="err")[1])
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as peer:
        peer.sendto(next(frames.heartbeats(1)), ("127.0.0.1", port))
    listening.wait_output('"name"', stream="out")
    assert json.loads(listening.stdout)["name"] == "HEARTBEAT"
    assert listening.process.wait(harness.DEFAULT_TIMEOUT_S) == 0
