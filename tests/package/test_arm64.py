# SPDX-License-Identifier: MIT
"""The Debian packages for 64-bit Arm, cross-built as by `./run package arm64`: their records, and the program under
qemu."""
import os
import shutil

import pytest
from test_debian import check_with_lintian, make_packages
from test_package import BUILD, ROOT, build_folder, call, forwarding_router

import harness

QEMU, COMPILER = "qemu-aarch64-static", "aarch64-linux-gnu-g++"

pytestmark = [pytest.mark.timeout(5400),
              pytest.mark.skipif("MAVLOOM_FULL" not in os.environ, reason="only .ci/run --full"),
              pytest.mark.skipif(not (shutil.which(QEMU) and shutil.which(COMPILER)),
                                 reason="packaging/arm64.list is not installed")]


@pytest.fixture(scope="module")
def root():
    """Headers and libraries."""
    with build_folder("arm64") as build:
        folder = build.parent / "arm64-root"
        call(ROOT / "tools" / "arm64_root.sh", folder)
    return folder


@pytest.fixture(scope="module")
def packages(root, tmp_path_factory):
    """{name: path}"""
    made = tmp_path_factory.mktemp("packages")
    with build_folder("arm64") as build:
        call("cmake", "--preset", "release", "-S", ROOT, "-B", build, "--toolchain",
             ROOT / "cmake/toolchains/arm64.cmake", f"-DMAVLOOM_ARM64_ROOT={root}",
             f"-DMAVLOOM_DIALECTGEN={BUILD}/bin/mavloom_dialectgen", "-DMAVLOOM_TESTS=OFF", "-DMAVLOOM_BENCH=OFF",
             "-DMAVLOOM_PYTHON=OFF")
        call("cmake", "--build", build)
        return make_packages(build, made, f"{root}/tools:{os.environ['PATH']}")


def test_the_packages_are_for_arm64_and_name_their_libraries(packages):
    assert set(packages) == {"mavloom", "libmavloom-dev"}
    for package in packages.values():
        assert call("dpkg-deb", "--field", package, "Architecture").strip() == "arm64"
    depends = call("dpkg-deb", "--field", packages["mavloom"], "Depends")
    for library in ("libc6 (>= 2.", "libfmt9", "libsodium23", "libncursesw6", "libstdc++6"):
        assert library in depends, depends


def test_lintian_finds_no_error(packages):
    check_with_lintian(packages)


def test_the_program_reads_a_flight_under_qemu(packages, root, tmp_path):
    call("dpkg-deb", "--extract", packages["mavloom"], tmp_path)
    ours = [harness.program_path(), "info", harness.DATA / "px4_gcs_flight.tlog", "--json"]
    theirs = [QEMU, "-L", root, tmp_path / "usr/bin/mavloom", *ours[1:]]
    assert call(*theirs) == call(*ours)


def test_the_router_forwards_under_qemu(packages, root, tmp_path):
    call("dpkg-deb", "--extract", packages["mavloom"], tmp_path)
    with forwarding_router(QEMU, "-L", root, tmp_path / "usr/bin/mavloom") as (router, check):
        check(1)
        assert router.stop().status == 130
