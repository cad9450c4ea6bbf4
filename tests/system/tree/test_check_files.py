# SPDX-License-Identifier: MIT
"""tools/check_files.py: refuses what a build leaves behind, and large files outside tests/data."""
import subprocess
import sys
import tarfile
import zipfile

import pytest

from harness import ROOT



def check(*files):
    return subprocess.run([sys.executable, ROOT / "tools" / "check_files.py", *files], capture_output=True, text=True)


@pytest.fixture
def built(tmp_path):
    """A folder with what compilers and archivers leave behind."""
    (tmp_path / "x.cpp").write_text("int main() { return 0; }\n")
    for command in (["g++", "-c", "x.cpp", "-o", "x.o"], ["g++", "x.o", "-o", "x"], ["ar", "rc", "libx.a", "x.o"],
                    ["gzip", "-k", "x.cpp"], ["xz", "-k", "x.cpp"]):
        subprocess.run(command, cwd=tmp_path, check=True)
    with tarfile.open(tmp_path / "x.tar", "w") as archive:
        archive.add(tmp_path / "x.cpp", "x.cpp")
    with zipfile.ZipFile(tmp_path / "x.whl", "w") as archive:
        archive.write(tmp_path / "x.cpp", "x.cpp")
    return tmp_path


@pytest.mark.parametrize("name", ["x.o", "x", "libx.a", "x.cpp.gz", "x.cpp.xz", "x.tar", "x.whl"])
def test_object_files_archives_and_executables_are_refused(built, name):
    done = check(built / "x.cpp", built / name)

    assert done.returncode == 1
    assert done.stdout.startswith(f"{built / name}: a") and done.stdout.count("\n") == 1


def test_a_file_over_1_MB_is_refused_outside_tests_data(tmp_path):
    large = tmp_path / "large.txt"
    large.write_bytes(b"a" * 1_000_001)

    assert check(large).stdout == f"{large}: larger than 1000000 bytes; only tests/data may have such files\n"
    large.write_bytes(b"a" * 1_000_000)
    assert check(large).returncode == 0
    assert check(ROOT / "tests" / "data" / "px4_gcs_flight.tlog").returncode == 0
