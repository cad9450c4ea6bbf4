# SPDX-License-Identifier: MIT
"""The stand-in against PX4: a recording of a whole flight in lock-step, both directions of the simulator's link."""
import pytest
from pymavlink import mavutil

import frames
import harness
import px4_stand_in
from frames import mavlink
from px4_stand_in import Options, StandIn


def messages(name, kind):
    log = mavutil.mavlink_connection(str(harness.DATA / f"px4_hil_{name}_px4.tlog"))
    found = []
    while message := log.recv_match(type=kind):
        found.append(message)
    return found


class Wire:
    """Takes the link's place and keeps what the stand-in sends."""

    def __init__(self):
        self.data = bytearray()

    def sendall(self, data):
        self.data += data

    def setsockopt(self, *_):
        pass

    def controls(self):
        return [message for message in mavlink.MAVLink(None).parse_buffer(self.data) or ()
                if message.get_type() == "HIL_ACTUATOR_CONTROLS"]


@pytest.fixture
def stand_in():
    stand_in = StandIn(0, Options())
    stand_in.link = Wire()
    return stand_in


def sensor(time_us, bits=0x1FFF, number=0):
    return mavlink.MAVLink_hil_sensor_message(time_us, 0, 0, -9.80665, 0, 0, 0, 0.2, 0, 0.4, 955, 0, 488, 15, bits,
                                              number)


def times_of(stand_in, sensors):
    """Runs steps after the boot, and returns the times of their answers."""
    for step in range(1, 37):
        stand_in.on_hil_sensor(sensor(4000 * step))
    stand_in.link.data.clear()
    for message in sensors:
        stand_in.on_hil_sensor(message)
    return [answer.time_usec for answer in stand_in.link.controls()]


def test_answers_the_steps_that_px4_answered(stand_in):
    for message in messages("to", "HIL_SENSOR"):
        stand_in.on_hil_sensor(message)
    answers, recorded = stand_in.link.controls(), messages("from", "HIL_ACTUATOR_CONTROLS")
    assert [answer.time_usec for answer in answers] == [answer.time_usec for answer in recorded]
    assert {answer.flags for answer in answers} == {answer.flags for answer in recorded}
    assert {answer.mode for answer in answers} <= {answer.mode for answer in recorded} == {1, 129}


def test_sends_px4s_first_frames(stand_in, monkeypatch):
    monkeypatch.setattr(px4_stand_in.socket, "create_connection", lambda _: stand_in.link)
    stand_in.connect()
    recorded = [frame for _, frame in frames.read_tlog(harness.DATA / "px4_hil_from_px4.tlog")][:2]
    assert bytes(stand_in.link.data) == b"".join(recorded)


def test_is_silent_while_the_time_stands_still_and_a_step_longer(stand_in):
    sensors = [sensor(time_us) for time_us in (200_000, 200_000, 204_000, 208_000)]
    assert times_of(stand_in, sensors) == [200_000, 208_000]


def test_is_silent_until_the_time_has_passed_its_newest(stand_in):
    back = [sensor(1_000_000), *(sensor(1_000_000 - 4000 * step) for step in (3, 2, 1)), sensor(1_004_000)]
    assert times_of(stand_in, [*back, sensor(1_008_000)]) == [1_000_000, 1_008_000]


def test_answers_a_jump_ahead_at_once(stand_in):
    assert times_of(stand_in, [sensor(10_000_000)]) == [10_000_000]


@pytest.mark.parametrize("silent", [sensor(200_000, 0x1FC7), sensor(200_000, 0x80000000), sensor(200_000, number=1)])
def test_is_silent_without_gyroscope_and_for_other_imus(stand_in, silent):
    assert times_of(stand_in, [silent, sensor(204_000)]) == [204_000]
