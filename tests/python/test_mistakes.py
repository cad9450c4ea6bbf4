# SPDX-License-Identifier: MIT
"""Typical mistakes of first-time users: the error names what to type instead."""
import pytest

import mavloom
from mavloom import mavutil

MISTAKES = [
    ('link.recv_match("ATTITUDE")', "condition= takes a callable that is given the message, not 'ATTITUDE' (text is "
                                    "never evaluated); type= takes the names of messages"),
    ('link.recv_match(type="ATTITUDE", timeout="2")', "timeout: a number of seconds, not '2'"),
    ('link.recv("ATTITUDE")', "timeout: a number of seconds, not 'ATTITUDE'"),
    ("link.recv_match(type=30)", "type= takes names of messages, not 30"),
    ("link.wait_heartbeat(5)", "blocking: True or False, not 5; timeout= takes the seconds to wait"),
    ("link.subscribe().recv_match(blocking=5)", "blocking: True or False, not 5; timeout= takes the seconds to wait"),
    ("link.recv_msg()", "'Link' object has no attribute 'recv_msg'; use link.recv(timeout=0)"),
    ('link.set_mode("GUIDED")', "'Link' object has no attribute 'set_mode'; use link.vehicle().set_mode(name)"),
    ("link.recieve()", "'Link' object has no attribute 'recieve'"),
    ("mavloom.mavlink_connection('udpin:0.0.0.0:14550')", "module 'mavloom' has no attribute 'mavlink_connection'; use "
     "mavloom.connect(url), or mavlink_connection of mavloom.mavutil"),
    ("mavloom.recieve", "module 'mavloom' has no attribute 'recieve'"),
    ("vehicle.parameters", "'Vehicle' object has no attribute 'parameters'; use vehicle.params"),
    ('setattr(vehicle, "mode", "GUIDED")', "mode cannot be set; use vehicle.set_mode(name)"),
    ('setattr(vehicle, "armed", True)', "armed cannot be set; use vehicle.arm() and vehicle.disarm()"),
    ('vehicle.command("DO_SET_SERVOO")', "unknown command 'DO_SET_SERVOO'; did you mean DO_SET_SERVO?"),
    ('vehicle.command("MAV_CMD_DO_JUMPP")', "unknown command 'MAV_CMD_DO_JUMPP'; did you mean DO_JUMP?"),
    ("vehicle.mission.upload(5)", "upload() takes a list of items, not 5"),
    ("mavloom.enums.MAV_TYPES", "no enum MAV_TYPES in the built-in definitions; did you mean MAV_TYPE?"),
    ("mavloom.messages.ATITUDE", "no message ATITUDE in the built-in definitions; did you mean ATTITUDE?"),
    ('conn.wait_heartbeat(timeout="3")', "timeout: a number of seconds, not '3'"),
    ('conn.recv_match(type="ATITUDE", blocking=True)',
     "type='ATITUDE': no such message, so this call would wait forever; did you mean ATTITUDE?"),
]


@pytest.fixture(scope="module")
def names():
    with mavloom.connect("udpin://127.0.0.1:0") as link, mavutil.mavlink_connection("udpin:127.0.0.1:0") as conn:
        yield {"link": link, "vehicle": link.vehicle(1), "conn": conn, "mavloom": mavloom}


@pytest.mark.parametrize("line, text", MISTAKES, ids=[line for line, _ in MISTAKES])
def test_a_mistake_has_an_error_that_states_what_to_type(line, text, names):
    with pytest.raises((AttributeError, TypeError, mavloom.UsageError)) as caught:
        eval(line, names)
    assert str(caught.value) == text
