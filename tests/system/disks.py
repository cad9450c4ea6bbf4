# SPDX-License-Identifier: MIT
"""File systems for the tests that fill them."""
import os
import subprocess

import pytest


class SmallDisk:
    """A file system that is full after a few records, until `free`."""

    def __init__(self, folder):
        self.folder = folder
        if os.geteuid() != 0:
            pytest.skip("a small file system needs root")
        made = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", folder], capture_output=True,
                              text=True)
        if made.returncode != 0:
            pytest.skip(f"no tmpfs here: {made.stderr.strip()}")
        (folder / "ballast").write_bytes(bytes((2 << 20) - (100 << 10)))

    def fill(self, pid):
        pass

    def free(self, pid):
        (self.folder / "ballast").unlink()

    def close(self):
        subprocess.run(["umount", "--lazy", self.folder], check=True)
