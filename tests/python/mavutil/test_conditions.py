# SPDX-License-Identifier: MIT
"""Text conditions: what pymavlink gives to eval(), evaluated without it."""
import os
import types

import pytest
from pymavlink import mavutil as theirs

import mavloom
from mavloom import mavutil



def heartbeat():
    mavlink = mavutil.mavlink
    return mavlink.MAVLink(None).decode(mavlink.MAVLink_heartbeat_message(2, 3, 81, 4, 4, 3).pack(
        mavlink.MAVLink(None, 7, 1)))


MESSAGES = {
    "ATTITUDE": types.SimpleNamespace(roll=0.5, pitch=-0.25, text="abc", values=[1, 2, 3], _timestamp=7.5),
    "MAV": types.SimpleNamespace(flightmode="AUTO", armed=128), "x": 4,
    "HEARTBEAT": heartbeat(), "BATTERY_STATUS": {1: types.SimpleNamespace(id=1)},
}

GOOD = [
    "ATTITUDE.roll > 0.1", "ATTITUDE.roll>0.1 and MAV.flightmode=='AUTO'", "not MAV.armed", "MAV.armed & 128",
    "ATTITUDE.roll if x else 0", "1 < x <= 4", "x in (1, 4)", "x not in [1, 4]", "'b' in ATTITUDE.text", "x*2+1",
    "x**2", "-x % 3", "x // 3", "x / 8", "x << 2 >> 1", "~x ^ 5", "x | 1", "sqrt(x)", "abs(ATTITUDE.pitch)",
    "max(1, x, 3)", "len(ATTITUDE.values) == 3", "ATTITUDE.values[1]", "ATTITUDE.values[9]", "BATTERY_STATUS[1].id",
    "degrees(pi)", "ATTITUDE._timestamp", "round(ATTITUDE.roll, 1)", "round(3.7)",
    "round(1234, -2)", "True", "0", "''", "None is None", "x and ATTITUDE.roll",
    "0 or x", " x > 1 ", "x{ATTITUDE.roll>0}", "x{ATTITUDE.roll>1}", "(1, 2)", "[x, 1]", "str(x) + 'a'",
    "NO_SUCH.field > 1", "x / 0", "NO_SUCH", "atan2(1, x)", "int(3.7)", "min([3, 1])", "pow(x, 2)", "pow(x, 0.5) == 2",
    "ATTITUDE.text.startswith('ab')", "MAV.flightmode.endswith(('TO', 'X'))", "HEARTBEAT.get_srcSystem() == 7",
    "HEARTBEAT.get_srcComponent() in (1, 2)", "HEARTBEAT.get_type().startswith('HEART')", "HEARTBEAT.get_seq()",
    "HEARTBEAT.get_msgId()", "NO_SUCH.get_type()",
]


@pytest.mark.parametrize("text", GOOD)
def test_expressions_have_pymavlinks_value(text):
    assert mavutil.evaluate_expression(text, MESSAGES) == theirs.evaluate_expression(text, dict(MESSAGES))
    assert mavutil.evaluate_condition(text, MESSAGES) == bool(theirs.evaluate_condition(text, dict(MESSAGES)))


def test_no_condition_is_true():
    assert mavutil.evaluate_condition(None, {}) is True


@pytest.mark.parametrize("text, reason", [
    ("x >", r"condition 'x >': not an expression: .* \(at character 4\)"), ("", "not an expression"),
    ("x = 1", "not an expression"), ("x; y", "not an expression"), ("import os", "not an expression"),
    ("x\0", "not an expression"),
    ("__import__('os').system('touch hacked')", r"this call .* is not possible \(at character 1\)"),
    ("open('hacked', 'w')", "this call"), ("ATTITUDE.__class__", "reading __class__ is not possible"),
    ("().__class__.__bases__[0].__subclasses__()", "this call"), ("[y for y in (1, 2)]", "ListComp is not possible"),
    ("lambda: 1", "Lambda is not possible"), ("f'{x}'", "JoinedStr is not possible"),
    ("(y := 1)", "NamedExpr is not"), ("ATTITUDE.text.upper()", "this call"), ("'abc'.upper", "upper is not a field"),
    ("x[1:2]", "a slice is not possible"), ("max(x, key=len)", "this call"), ("9 ** 9999", "too large"),
    ("9 ** 9 ** 9", "too large"), ("1 << 9999", "too large"), ("'a' * 2", "cannot multiply text"),
    ("str([[0] * 9999] * 9999)", "cannot multiply"), ("9999 * (x,)", "cannot multiply"),
    ("round(1, -9 ** 60)", "too long for a condition"), ("{" * 100_000, "too long"),
    ("'%999999999d' % 1", "cannot format text"),
    ("ATTITUDE.rol > 1", "has no attribute 'rol'"), ("x[0]", "not subscriptable"),
    ("'a' + 1", "can only concatenate"), ("sqrt(-1)", "math domain error"),
    ("x.get_type()", r"int has no get_type\(\)"), ("ATTITUDE.get_srcSystem()", r"SimpleNamespace has no get_srcSystem"),
    ("HEARTBEAT.to_dict()", "this call"), ("HEARTBEAT.pack(1)", "this call"), ("HEARTBEAT.get_type", "is not a field"),
    ("HEARTBEAT.startswith('x')", "has no startswith"), ("'a'.startswith(1)", "first arg must be str"),
    ("HEARTBEAT.get_type(1)", "incompatible|takes|argument"), ("HEARTBEAT.get_msgbuf()", "this call"),
    ("'a'.startswith(*x)", "Starred is not possible"), ("pow(10, 999)", "math range error"), ("pow(1)", "expected 2"),
    ("await x", "not an expression|Await"), ("x" * 20_000, "too long"),
    ("+".join(["1"] * 4000), "nested too deeply|not an expression"), ("*x", "not an expression|Starred"),
])
def test_what_is_no_condition(text, reason, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(mavloom.UsageError, match=reason):
        mavutil.evaluate_condition(text, MESSAGES)
    assert os.listdir(tmp_path) == []


def test_a_recording_with_a_wrong_condition(flight):
    log = mavutil.mavlink_connection(str(flight))
    with pytest.raises(mavloom.UsageError, match="not an expression"):
        log.recv_match(condition="ATTITUDE.roll >")
    with pytest.raises(mavloom.UsageError, match="has no field or attribute 'rol', did you mean 'roll'"):
        log.recv_match(condition="ATTITUDE.rol > 0")


def test_a_condition_is_text(flight):
    log = mavutil.mavlink_connection(str(flight))
    for wrong in (lambda message: True, 3, b"ATTITUDE.roll > 0"):
        with pytest.raises(mavloom.UsageError, match="a condition is text, such as"):
            log.recv_match(condition=wrong)
