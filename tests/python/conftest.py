# SPDX-License-Identifier: MIT
"""Fixtures of the Python package's tests. The package is the one of the build under test;
the program beside it comes from MAVLOOM_PROGRAM or build/release."""
import os
import signal
import sys

import pytest

from places import PACKAGE, ROOT

sys.path[:0] = [str(PACKAGE), str(ROOT / "tests" / "support"), str(ROOT / "tests" / "system")]

import harness  # noqa: E402, F401  (sets MAVLOOM_RUN)
import pymavlink_vectors as vectors  # noqa: E402

# A shell that starts the tests in the background has them ignore Ctrl-C, and what they start would inherit that.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def flight():
    """A recorded PX4 flight: 40,087 frames of 37 messages (tests/data/README.md)."""
    return ROOT / "tests" / "data" / "px4_gcs_flight.tlog"


@pytest.fixture(scope="session")
def peer(tmp_path_factory):
    """pymavlink's module, generated from our definitions."""
    return vectors.generate(tmp_path_factory.mktemp("peer"), "2.0")


@pytest.fixture(scope="session")
def peer_v1(tmp_path_factory):
    return vectors.generate(tmp_path_factory.mktemp("peer"), "1.0")


@pytest.fixture
def child_environment():
    """For Python programs that are started by a test."""
    return {**os.environ, "PYTHONPATH": str(PACKAGE), "PYTHONDONTWRITEBYTECODE": "1"}
