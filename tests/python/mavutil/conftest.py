# SPDX-License-Identifier: MIT
"""Both modules with the same definitions, as they are when they are imported."""
import os
import sys

import pytest
from pymavlink import mavutil as theirs_module

import mavloom
from mavloom import mavutil


@pytest.fixture(autouse=True)
def as_imported():
    """mavutil.mavlink as it is when the module is imported, whatever earlier tests received."""
    version = os.environ.pop("MAVLINK20", None)
    before = mavutil.mavlink
    mavutil._current.use(mavutil._current.module_of(mavloom.Dialect(), 1))
    yield
    mavutil._current.use(before)
    os.environ.pop("MAVLINK20", None)
    if version is not None:  # tests of other folders need it
        os.environ["MAVLINK20"] = version


@pytest.fixture
def their_mavutil(peer, monkeypatch):
    """pymavlink's mavutil, with the module made from our definitions."""
    for package in ("v10", "v20"):
        monkeypatch.setitem(sys.modules, f"pymavlink.dialects.{package}.peer", peer)
    monkeypatch.setattr(theirs_module, "mavlink", peer)
    monkeypatch.setattr(theirs_module, "current_dialect", "peer")
    return theirs_module
