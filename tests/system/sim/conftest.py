# SPDX-License-Identifier: MIT
"""Fixtures of the tests that fly: simulators, and clients that talk to them."""
import pytest

from simulators import Simulator


@pytest.fixture
def sim(program):
    """sim("--vehicle", "plane", parameters={...}) -> a Simulator that ends with the test."""
    running = []

    def start(*options, **more):
        running.append(Simulator(program, *options, **more))
        return running[-1]
    yield start
    for one in running:
        one.end()


@pytest.fixture(scope="module")
def shared(program):
    """shared(*options) -> a Simulator for all tests of the file that ask for the same options. They only read, or undo
    what they change."""
    running = {}

    def get(*options):
        if options not in running:
            running[options] = Simulator(program, *options)
        return running[options]
    yield get
    for one in running.values():
        one.end()


@pytest.fixture
def px4(shared):
    """A client at a PX4 quadrotor that stands ready at its home; the vehicle is shared."""
    with shared().station() as station:
        yield station.ready()


@pytest.fixture
def ardupilot(shared):
    with shared("--autopilot", "ardupilot").station() as station:
        yield station.ready()
