# SPDX-License-Identifier: MIT
"""Where things are."""
import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / os.environ.get("MAVLOOM_PROGRAM", "build/release/bin/mavloom")
PACKAGE = PROGRAM.parent.parent / "python"  # of the same build
