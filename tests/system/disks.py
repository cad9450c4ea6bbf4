# SPDX-License-Identifier: MIT
"""File systems for the tests that fill them."""
import os
import subprocess

import pytest


def mount_tmpfs(folder, options):
    if os.geteuid() != 0:
        pytest.skip("a small file system needs root")
    made = subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", folder], capture_output=True, text=True)
    if made.returncode != 0:
        pytest.skip(f"no tmpfs here: {made.stderr.strip()}")


class SmallDisk:
    """A file system that is full after a few records, until `free`."""

    def __init__(self, folder):
        self.folder = folder
        mount_tmpfs(folder, "size=2m")
        (folder / "ballast").write_bytes(bytes((2 << 20) - (100 << 10)))

    def fill(self, pid):
        pass

    def free(self, pid):
        (self.folder / "ballast").unlink()

    def close(self):
        subprocess.run(["umount", "--lazy", self.folder], check=True)


class FewFilesDisk(SmallDisk):
    """A file system that has inodes for two files, and for five after `free`."""

    def __init__(self, folder):
        self.folder = folder
        mount_tmpfs(folder, "nr_inodes=6")  # one is the folder's own
        for number in range(3):
            (folder / f"filler{number}").touch()

    def free(self, pid):
        for filler in self.folder.glob("filler*"):
            filler.unlink()
