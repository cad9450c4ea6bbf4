# SPDX-License-Identifier: MIT
"""The services of vehicles: link.vehicle() and link.vehicle_async(), against a stub of an autopilot."""
import asyncio
import contextlib
import math
import socket
import struct
import threading

import pytest

import mavloom
from autopilot import ARDUPILOT_PARAMS, ARMED, PX4_PARAMS, Autopilot, Settings
from mavloom import _silence, mavutil
from mavloom._vehicle import _commands, _mission, _params
from places import free_port
from vehicles import Vehicle, again_and_again, until


@pytest.fixture
def quick(monkeypatch):
    """Short waits, for tests of answers that never come."""
    for module, name, seconds in ((_commands, "ANSWER_S", 0.4), (_commands, "HEARTBEATS_S", 0.4),
                                  (_commands, "POSITION_S", 0.2), (_commands, "IN_PROGRESS_S", 0.2),
                                  (_params, "ANSWER_S", 0.4), (_params, "QUIET_S", 0.15),
                                  (_mission, "ANSWER_S", 0.4)):
        monkeypatch.setattr(module, name, seconds)


@contextlib.contextmanager
def flown(peer, **settings):
    """A link, the stub at its other end, and the Vehicle."""
    with (mavloom.connect("udpin://127.0.0.1:0") as link,
          Autopilot(peer, Settings(**settings), connect_to=("127.0.0.1", link.port)) as stub):
        yield link.vehicle(timeout=30), stub


both_autopilots = pytest.mark.parametrize("px4", [False, True], ids=["ardupilot", "px4"])


# ---- the vehicle

def test_the_first_vehicle_is_found(peer):
    with flown(peer) as (vehicle, _):
        assert (vehicle.system, vehicle.component, vehicle.mode, vehicle.armed) == (1, 1, "STABILIZE", False)
        assert repr(vehicle) == f"<Vehicle 1/1 on {vehicle.link.name}: STABILIZE, disarmed>"
        assert "GUIDED" in vehicle.modes


def test_no_vehicle_is_a_timeout():
    with mavloom.connect("udpin://127.0.0.1:0") as link:
        with pytest.raises(TimeoutError, match=r"no vehicle within 0\.05 s"):
            link.vehicle(timeout=0.05)
        with pytest.raises(mavloom.UsageError, match="system: 256 is out of range, 1 to 255"):
            link.vehicle(256)
        vehicle = link.vehicle(7)
        assert (vehicle.mode, vehicle.armed, vehicle.modes) == (None, False, [])
        assert "no heartbeat yet" in repr(vehicle)


def test_closed_links_can_be_shown(peer):
    with flown(peer) as (vehicle, _):
        messages = vehicle.link.messages
    assert repr(vehicle) == f"<Vehicle 1/1 on {vehicle.link.name}: the link is closed>"
    assert repr(messages) == f"<newest messages of {vehicle.link.name}, which is closed>"
    with pytest.raises(mavloom.ClosedError):
        vehicle.arm()


def test_a_home_made_board_is_a_vehicle(peer):
    with flown(peer, autopilot=8) as (vehicle, _):
        assert vehicle.heartbeat.autopilot == 8
        assert vehicle.link.wait_heartbeat(timeout=30).autopilot == 8


# ---- commands

@both_autopilots
def test_arm_and_disarm(px4, peer):
    with flown(peer, px4=px4) as (vehicle, stub):
        vehicle.arm()
        assert vehicle.armed and stub.base_mode & ARMED
        vehicle.disarm(force=True)
        assert not vehicle.armed
        assert [(m.command, m.param1, m.param2) for m in stub.messages] == [(400, 1, 0), (400, 0, 21196)]


@pytest.mark.parametrize("px4, mode, params", [(False, "guided", (1, 4, 0)), (False, 6, (1, 6, 0)),
                                               (True, "MISSION", (1, 4, 4)), (True, 6 << 16, (1, 6, 0)),
                                               (True, "Return", (1, 4, 5)), (True, "AUTO.RTL", (1, 4, 5)),
                                               (False, "Position Hold", (1, 16, 0))])
def test_modes_by_name_and_number(px4, mode, params, peer):
    with flown(peer, px4=px4) as (vehicle, stub):
        vehicle.set_mode(mode)
        assert (stub.messages[0].param1, stub.messages[0].param2, stub.messages[0].param3) == params
        assert vehicle.mode == {"guided": "GUIDED", 6: "RTL", "MISSION": "Mission", 6 << 16: "Offboard",
                                "Return": "Return", "AUTO.RTL": "Return", "Position Hold": "POSHOLD"}[mode]


def test_modes_and_kinds_of_missions_that_are_none(peer):
    with flown(peer) as (vehicle, stub):
        with pytest.raises(mavloom.UsageError, match="a mode is a name or a number, not None"):
            vehicle.set_mode(None)
        for kind in ("MAV_MISSION_TYPE_FENCE", 256, None):
            with pytest.raises(mavloom.UsageError, match="mission_type: a MAV_MISSION_TYPE, 0 to 255, not"):
                vehicle.mission.clear(kind)
        vehicle.mission.clear(mavloom.enums.MAV_MISSION_TYPE.MAV_MISSION_TYPE_FENCE)
        assert [m.mission_type for m in stub.messages] == [1]


def test_an_unknown_mode_is_an_error_that_lists_the_modes(peer):
    with flown(peer) as (vehicle, stub):
        with pytest.raises(mavloom.UsageError, match="unknown mode 'FLOAT': this vehicle has ACRO, ALT_HOLD, AUTO"):
            vehicle.set_mode("FLOAT")
        assert stub.messages == []


def test_takeoff_and_land_of_an_ardupilot(peer):
    with flown(peer) as (vehicle, stub):
        vehicle.takeoff(12.5)
        vehicle.land()
        vehicle.return_to_launch()
        assert [(m.command, m.param2 if m.command == 176 else m.param7) for m in stub.messages] == [
            (176, 4), (22, 12.5), (21, 0), (20, 0)]


def test_takeoff_of_a_px4_is_above_sea_level(peer):
    with flown(peer, px4=True) as (vehicle, stub):
        vehicle.takeoff(10)
        vehicle.takeoff(20)
        requested, first, second = stub.messages
        assert (requested.command, requested.param1) == (512, 33) and math.isnan(first.param4)
        assert (first.param7, second.param7) == pytest.approx((594.5 + 10, 594.5 + 20))


def test_a_px4_without_a_position_does_not_take_off(peer, quick):
    with flown(peer, px4=True, silent=frozenset({"COMMAND_LONG"})) as (vehicle, stub):
        with pytest.raises(TimeoutError, match="no GLOBAL_POSITION_INT within .*: the altitude above"):
            vehicle.takeoff(10)
        assert [m.command for m in stub.messages] == [512]


def test_commands_by_number_and_name(peer):
    with flown(peer, progress=True) as (vehicle, stub):
        assert vehicle.command("DO_SET_SERVO", 9, 1500).result == 0
        assert vehicle.command("MAV_CMD_DO_SET_SERVO", 9, 1600).command == 183
        assert vehicle.command(mavloom.enums.MAV_CMD.MAV_CMD_DO_SET_RELAY).name == "COMMAND_ACK"
        assert [(m.command, m.param2) for m in stub.messages] == [(183, 1500), (183, 1600), (181, 0)]
        with pytest.raises(mavloom.UsageError, match="unknown command 'DANCE'"):
            vehicle.command("DANCE")
        with pytest.raises(mavloom.UsageError, match="at most 7 parameters, not 8"):
            vehicle.command(183, *range(8))


def test_a_lost_command_is_repeated(peer, quick):
    with flown(peer, drop=frozenset({"COMMAND_LONG"})) as (vehicle, stub):
        vehicle.command("DO_SET_SERVO", 1, 1000)
        assert [m.confirmation for m in stub.messages] == [0, 1]


def test_a_command_in_progress_is_not_repeated(peer, quick):
    with flown(peer) as (vehicle, stub):
        stub.on_command_long = lambda message: stub.send(stub.ack(message, 5))
        with pytest.raises(TimeoutError, match="MAV_CMD_PREFLIGHT_CALIBRATION was in progress, then silence for"):
            vehicle.command("PREFLIGHT_CALIBRATION", 1)
        assert [m.confirmation for m in stub.messages] == [0]


def test_a_refused_command_is_an_error_with_the_reason(peer):
    with flown(peer, refuse={400: 4}) as (vehicle, _):
        with pytest.raises(mavloom.CommandError, match="MAV_CMD_COMPONENT_ARM_DISARM: MAV_RESULT_FAILED") as caught:
            vehicle.arm()
        assert caught.value.result == 4


def text(peer, text, severity=2, number=0, part=0):
    return peer.MAVLink_statustext_message(severity, text.encode(), number, part)


def test_a_refusal_has_the_texts_that_came_around_it(peer):
    """ArduPilot and PX4 queue their texts: they come after the answer, too."""
    def refuse(message):
        stub.send(text(peer, "PreArm: Compass not calibrated"), text(peer, "Mission: 1 Takeoff", severity=6),
                  stub.ack(message, 4), text(peer, "Preflight Fail: the first fifty characters of a text", 3, 7, 0),
                  text(peer, ", and the rest", 3, 7, 1), text(peer, "Arming denied\t", 4),
                  text(peer, "Arming denied\t", 4))
    with flown(peer) as (vehicle, stub):
        stub.send(text(peer, "an earlier text"))
        vehicle.link.recv_match(type="STATUSTEXT", timeout=30)
        stub.on_command_long = refuse
        with pytest.raises(mavloom.CommandError) as caught:
            vehicle.arm()
        expected = ("PreArm: Compass not calibrated",
                    "Preflight Fail: the first fifty characters of a te, and the rest", "Arming denied")
        assert caught.value.texts == expected
        assert str(caught.value).endswith(f"MAV_CMD_COMPONENT_ARM_DISARM: MAV_RESULT_FAILED: {'; '.join(expected)}")
        with pytest.raises(mavloom.CommandError, match="Arming denied"):
            asyncio.run(vehicle.link.vehicle_async(1).arm())


def test_a_later_part_of_an_unnumbered_text_is_a_text(peer):
    """Number 0: the text has one part (common.xml, STATUSTEXT). It was an IndexError."""
    def refuse(message):
        stub.send(stub.ack(message, 4), text(peer, "Arming denied", 4, 0, 1))
    with flown(peer) as (vehicle, stub):
        stub.on_command_long = refuse
        with pytest.raises(mavloom.CommandError) as caught:
            vehicle.arm()
    assert caught.value.texts == ("Arming denied",)


def test_a_refusal_without_a_text(peer):
    with flown(peer, refuse={400: 4}) as (vehicle, _), pytest.raises(mavloom.CommandError) as caught:
        vehicle.arm()
    assert caught.value.texts == () and str(caught.value).endswith("MAV_RESULT_FAILED")


# ---- silence

def test_a_refused_connection_is_the_reason_that_there_is_no_vehicle():
    """A link retries for ever: each call that waits for a vehicle states why there is none."""
    with mavloom.connect(f"tcpout://127.0.0.1:{free_port(socket.SOCK_STREAM)}") as link:
        with pytest.warns(RuntimeWarning, match="no vehicle for 0.2 s: cannot connect to .*: Connection ref") as all:
            assert link.wait_heartbeat(timeout=0.2) is None
            assert link.wait_heartbeat(timeout=0.2) is None
        assert len(all) == 1 and all[0].filename == __file__
        for call in (lambda: link.vehicle(timeout=0.05), lambda: link.wait_vehicle(timeout=0.05),
                     lambda: link.vehicle(1).command("DO_SET_SERVO", timeout=0.02),
                     lambda: asyncio.run(link.vehicle_async(1).command("DO_SET_SERVO", timeout=0.02))):
            with pytest.raises(TimeoutError, match="cannot connect to 127.0.0.1:.*: Connection refused"):
                call()
        assert "Connection refused" in link.stats.hints[0]


def test_a_wait_without_a_time_out_states_why_it_lasts(peer, monkeypatch):
    monkeypatch.setattr(_silence, "PATIENCE_S", 0.1)
    with mavloom.connect("udpin://127.0.0.1:0") as link:
        vehicle = Vehicle(peer, link.port)
        timer = threading.Timer(0.5, lambda: vehicle.send(vehicle.heartbeat(autopilot=3)))
        timer.start()
        with pytest.warns(RuntimeWarning, match=f"nothing heard; does the far side send to port {link.port} and"):
            assert link.wait_heartbeat().autopilot == 3
        timer.join()


def test_what_is_heard_instead_of_a_vehicle(peer):
    with mavloom.connect("udpin://127.0.0.1:0") as link:
        for system in range(240, 246):
            station = Vehicle(peer, link.port, system, 190)
            station.send(station.heartbeat(6, 8))
        until(lambda: link.stats.frames_in == 6)
        with pytest.raises(TimeoutError, match="heard only 240/190, 241/190, .*244/190, 1 more .system/component"):
            link.wait_vehicle(timeout=0.05)
    with mavloom.connect("udpin://127.0.0.1:0") as link:
        Vehicle(peer, link.port).socket.send(b"no MAVLink")
        until(lambda: link.stats.stray_bytes)
        with pytest.raises(TimeoutError, match=r"received bytes are not MAVLink \(10 bytes, .*is it the right port"):
            link.wait_vehicle(timeout=0.05)
    with mavloom.connect(f"udpout://127.0.0.1:{free_port()}") as link:
        with pytest.raises(TimeoutError, match="nothing was sent there either, so the far side may not know"):
            link.vehicle(timeout=0.05)
        link.send("HEARTBEAT", type=6)
        until(lambda: link.stats.refused)
        with pytest.raises(TimeoutError, match="the frames sent were refused: no program listens there"):
            link.vehicle(timeout=0.05)


def test_frames_without_the_signature_are_named_as_such(peer, tmp_path):
    """They were called bytes that are not MAVLink."""
    key = tmp_path / "key"
    key.write_text("11" * 32)
    key.chmod(0o600)
    with mavloom.connect(f"udpin://127.0.0.1:0?verify={key}") as link:
        vehicle = Vehicle(peer, link.port)
        vehicle.send(vehicle.heartbeat(autopilot=3))
        until(lambda: link.stats.bad_signature)
        with pytest.raises(TimeoutError, match="1 frame arrived without the signature that verify= requires"):
            link.vehicle(timeout=0.05)


def test_answers_from_another_port_are_named_as_such(peer):
    """The error stated that nothing arrived."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as called:
        called.bind(("127.0.0.1", 0))
        called.settimeout(30)
        with mavloom.connect(f"udpout://127.0.0.1:{called.getsockname()[1]}") as link:
            link.send("HEARTBEAT", type=6)
            vehicle = Vehicle(peer, called.recvfrom(280)[1][1])
            vehicle.send(vehicle.heartbeat(autopilot=3))
            until(lambda: link.stats.wrong_peer)
            with pytest.raises(TimeoutError, match="1 datagram came from an address other than 127.0.0.1:"):
                link.vehicle(timeout=0.05)


def test_a_vehicle_that_fell_silent(peer):
    with flown(peer, beat_s=3) as (vehicle, _):
        assert vehicle.link.wait_heartbeat(timeout=30)
        with pytest.raises(TimeoutError, match="its last heartbeat arrived [0-9] s ago"):
            vehicle.link.wait_vehicle(timeout=0.1)


def test_silence_is_a_timeout(peer, quick):
    with flown(peer, silent=frozenset({"COMMAND_LONG"})) as (vehicle, stub):
        with pytest.raises(TimeoutError, match="no answer to MAV_CMD_DO_SET_SERVO after 4 tries"):
            vehicle.command("DO_SET_SERVO", timeout=0.05)
        assert len(stub.messages) == 4


def test_a_command_is_repeated_as_often_as_the_script_requests(peer):
    with flown(peer, silent=frozenset({"COMMAND_LONG"})) as (vehicle, stub):
        with pytest.raises(TimeoutError, match="no answer to MAV_CMD_DO_SET_SERVO after 7 tries"):
            vehicle.command("DO_SET_SERVO", 9, timeout=0.02, tries=7)
        assert [m.confirmation for m in stub.messages] == list(range(7))
        with pytest.raises(TimeoutError, match="after 1 tries"):
            asyncio.run(vehicle.link.vehicle_async(1).command("DO_SET_SERVO", 9, timeout=0.02, tries=1))
        assert len(stub.messages) == 8
        for wrong in ({"timeout": 0}, {"timeout": math.nan}, {"timeout": "1"}, {"tries": 0}, {"tries": 257},
                      {"tries": 1.5}):
            with pytest.raises(mavloom.UsageError, match=next(iter(wrong))):
                vehicle.command("DO_SET_SERVO", **wrong)
        assert len(stub.messages) == 8


def test_names_that_no_parameter_can_have(peer, quick):
    with flown(peer) as (vehicle, stub):
        for name in ("X" * 17, "", "H\u00f6he", 5, None):
            assert name not in vehicle.params
        assert stub.messages == []


def test_a_component_of_the_first_vehicle(peer):
    with flown(peer) as (first, _):
        link = first.link
        assert (link.vehicle().component, link.vehicle(1).component) == (1, 1)
        for vehicle in (link.vehicle(component=5), link.vehicle(None, 5), link.vehicle(1, 5)):
            assert (vehicle.system, vehicle.component) == (1, 5)
        with pytest.raises(mavloom.UsageError, match="component: 300 is out of range"):
            link.vehicle(component=300)


# ---- parameters

@both_autopilots
def test_parameters_are_a_mapping(px4, peer):
    expected = {name: value for name, (value, _) in (PX4_PARAMS if px4 else ARDUPILOT_PARAMS).items()}
    with flown(peer, px4=px4) as (vehicle, stub):
        assert vehicle.params.fetch() == expected == dict(vehicle.params)
        assert list(vehicle.params) == sorted(expected) and len(vehicle.params) == len(expected)
        name = "COM_RC_IN_MODE" if px4 else "RTL_ALT"
        assert vehicle.params[name] == expected[name] and isinstance(vehicle.params[name], int)
        vehicle.params[name] = -7
        assert stub.params[name][0] == -7 and vehicle.params[name] == -7
        assert "NO_SUCH" not in vehicle.params and vehicle.params.get("NO_SUCH", 3) == 3


def test_a_float_parameter_has_the_digits_that_were_set(peer):
    with flown(peer, px4=True) as (vehicle, _):
        name = next(name for name, (value, kind) in PX4_PARAMS.items() if kind == 9)
        for value in (0.15, 1e-7, 16777217.5, 3.4028234663852886e38, -0.1):
            vehicle.params[name] = value
            assert struct.unpack("<f", struct.pack("<f", vehicle.params[name])) == \
                struct.unpack("<f", struct.pack("<f", value))
        vehicle.params[name] = 0.15
        assert vehicle.params[name] == 0.15


def test_px4_integers_are_sent_as_their_bytes(peer):
    """-4200000 has the bits of a signalling NaN, 0xffbfe9c0: a conversion to double would change it."""
    with flown(peer, px4=True) as (vehicle, stub):
        for value in (-4200000, -1, 0, 2**31 - 1, -(2**31)):
            vehicle.params["COM_RC_IN_MODE"] = value
            assert stub.params["COM_RC_IN_MODE"][0] == value == vehicle.params["COM_RC_IN_MODE"]
        with pytest.raises(mavloom.UsageError, match="does not fit its type"):
            vehicle.params["COM_RC_IN_MODE"] = 2**31
        with pytest.raises(mavloom.UsageError, match=r"is an integer, not 0\.5"):
            vehicle.params["COM_RC_IN_MODE"] = 0.5


def test_one_parameter_is_requested_alone(peer):
    with flown(peer) as (vehicle, stub):
        assert vehicle.params["RTL_ALT"] == 1500 and vehicle.params["RTL_ALT"] == 1500
        assert [m.get_type() for m in stub.messages] == ["PARAM_REQUEST_READ"]
        assert vehicle.params.type_of("RTL_ALT") == 6


def test_missing_values_are_requested_one_by_one(peer, quick):
    with flown(peer, lose_values=frozenset({1, 3})) as (vehicle, stub):
        assert len(vehicle.params.fetch()) == 5
        assert [m.param_index for m in stub.messages if m.get_type() == "PARAM_REQUEST_READ"] == [1, 3]


def test_an_absent_parameter(peer, quick):
    with flown(peer, px4=True) as (vehicle, _):
        with pytest.raises(KeyError) as caught:
            vehicle.params["NO_SUCH"]
        assert isinstance(caught.value.__cause__, mavloom.ParameterError) and caught.value.__cause__.result == 1
    with flown(peer) as (vehicle, _), pytest.raises(TimeoutError, match="no answer about parameter NO_SUCH"):
        vehicle.params["NO_SUCH"]  # an ArduPilot does not report it


def test_values_that_are_no_parameters(peer):
    with flown(peer) as (vehicle, _):
        for name, value in (("", 1), ("x" * 17, 1), ("ä", 1), (5, 1), ("RTL_ALT", "high"), ("RTL_ALT", True)):
            with pytest.raises(mavloom.UsageError):
                vehicle.params[name] = value


def test_a_parameter_that_is_not_taken(peer, quick):
    with flown(peer) as (vehicle, stub):
        stub.on_param_set = lambda message: stub.send(stub.value(message.param_id))
        with pytest.raises(mavloom.ParameterError, match="is 1500, not 1600: the vehicle did not take it"):
            vehicle.params["RTL_ALT"] = 1600


def test_a_late_answer_to_an_earlier_request_is_no_refusal(peer):
    with flown(peer) as (vehicle, stub):
        def late_then_set(message):
            stub.send(stub.value(message.param_id))
            Autopilot.on_param_set(stub, message)
        stub.on_param_set = late_then_set
        vehicle.params["RTL_ALT"] = 1600
        assert vehicle.params["RTL_ALT"] == 1600


def test_integers_are_exact(peer):
    with flown(peer, px4=True) as (vehicle, stub):
        vehicle.params["SYS_AUTOSTART"] = 4000000
        stub.on_param_set = lambda message: stub.send(stub.value(message.param_id))
        with pytest.raises(mavloom.ParameterError, match="is 4000000, not 4000001: the vehicle did not take it"):
            vehicle.params["SYS_AUTOSTART"] = 4000001
    with flown(peer) as (vehicle, stub):
        vehicle.params["RTL_ALT"] = 2**24
        with pytest.raises(mavloom.UsageError, match="takes values as float, which cannot hold 16777217"):
            vehicle.params["RTL_ALT"] = 2**24 + 1
        for value in (math.inf, math.nan):
            with pytest.raises(mavloom.UsageError, match="RTL_ALT is an integer, not"):
                vehicle.params["RTL_ALT"] = value
        assert stub.params["RTL_ALT"][0] == 2**24


def test_an_integer_that_is_reported_as_nan(peer):
    """As by a vehicle that sends the bytes of -1, but whose autopilot sends numbers."""
    with flown(peer) as (vehicle, stub):
        stub.params["RTL_ALT"] = (math.nan, 6)
        assert math.isnan(vehicle.params["RTL_ALT"]) and math.isnan(vehicle.params.fetch()["RTL_ALT"])


def test_a_value_that_is_set_during_a_fetch_is_the_newer_one(peer):
    def send_list(message):
        names = sorted(stub.params)
        stub.send(*(stub.value(name) for name in names[:-1]),
                  peer.MAVLink_param_value_message(b"ARMING_CHECK", 7.0, 6, 5, 65535), stub.value(names[-1]))
    with flown(peer) as (vehicle, stub):
        stub.on_param_request_list = send_list
        assert vehicle.params.fetch()["ARMING_CHECK"] == 7


def test_values_that_repeat_do_not_prolong_a_fetch(peer, quick):
    silent = frozenset({"PARAM_REQUEST_LIST", "PARAM_REQUEST_READ"})
    with flown(peer, silent=silent) as (vehicle, stub), again_and_again(lambda: stub.send(stub.value("RTL_ALT")), 0.02):
        with pytest.raises(TimeoutError, match="4 of 5 parameters did not arrive"):
            vehicle.params.fetch()


def test_all_values_can_be_forgotten(peer):
    with flown(peer) as (vehicle, stub):
        vehicle.params.fetch()
        vehicle.params.clear()
        assert vehicle.params["RTL_ALT"] == 1500
        assert [m.get_type() for m in stub.messages] == ["PARAM_REQUEST_LIST", "PARAM_REQUEST_READ"]


# ---- missions

PLACES = [(47.3977, 8.5456, 20), (47.3980, 8.5460, 25.5), (-33.8, 151.2, 30)]


@pytest.mark.parametrize("request_int", [False, True])
def test_missions_up_and_down(request_int, peer):
    items = [mavloom.MissionItem.at(*place, param1=float(i)) for i, place in enumerate(PLACES)]
    with flown(peer, px4=True, request_int=request_int) as (vehicle, stub):
        vehicle.mission.upload(items)
        assert [(m.seq, m.x, m.y, m.z, m.frame, m.param1) for m in stub.mission] == [
            (i, round(lat * 1e7), round(lon * 1e7), alt, 6, i) for i, (lat, lon, alt) in enumerate(PLACES)]
        assert vehicle.mission.download() == items
        assert [(round(i.lat, 7), round(i.lon, 7), i.z) for i in vehicle.mission.download()] == PLACES
        vehicle.mission.clear()
        assert vehicle.mission.download() == [] == stub.mission
        vehicle.mission.upload([])


def test_the_home_of_an_ardupilot_is_no_item_of_its_mission(peer):
    """Its item 0 is home, whatever is sent; jumps follow their targets."""
    items = [*(mavloom.MissionItem.at(*place) for place in PLACES), mavloom.MissionItem(177, param1=1, param2=3)]
    with flown(peer) as (vehicle, stub):
        vehicle.mission.upload(items)
        assert [(m.seq, m.command, m.z, m.param1) for m in stub.mission] == [
            (0, 16, 0, 0), (1, 16, 20, 0), (2, 16, 25.5, 0), (3, 16, 30, 0), (4, 177, 0, 2)]
        assert vehicle.mission.download() == items and items[3].param1 == 1
        vehicle.mission.upload([items[0], mavloom.MissionItem("MAV_CMD_DO_JUMP", param1=0)])
        assert [(m.seq, m.command, m.param1) for m in stub.mission] == [(0, 16, 0), (1, 16, 0), (2, 177, 1)]
        vehicle.mission.upload([])
        assert stub.mission == [] == vehicle.mission.download()
        vehicle.mission.upload(items[:2], 1)
        assert [m.z for m in stub.mission] == [20, 25.5] and vehicle.mission.download(1) == items[:2]


def test_items_as_mappings_and_messages(peer):
    dialect = mavloom.Dialect()
    items = [{"command": "NAV_TAKEOFF", "z": 10.0},
             dialect.message("MISSION_ITEM_INT", command=16, x=1, y=2, z=3, frame=6),
             dialect.message("MISSION_ITEM", command=16, x=47.5, y=8.25, z=3, frame=3),
             mavutil.mavlink.MAVLink_mission_item_int_message(1, 1, 0, 6, 16, 0, 1, 0, 0, 0, 0, 4, 5, 6)]
    with flown(peer, px4=True) as (vehicle, stub):
        vehicle.mission.upload(items)
        assert [(m.command, m.x, m.y, m.z) for m in stub.mission] == [(22, 0, 0, 10), (16, 1, 2, 3),
                                                                      (16, 475000000, 82500000, 3), (16, 4, 5, 6)]


def test_an_item_that_cannot_be_sent_sends_nothing(peer):
    with flown(peer, px4=True) as (vehicle, stub):
        for item, text in (({"colour": 1}, "has no 'colour'"), ({"x": 2**40}, "item 0 of the mission: .*x"),
                           (5, "is a MissionItem"), (mavloom.Dialect().message("HEARTBEAT"), "not HEARTBEAT")):
            with pytest.raises(mavloom.UsageError, match=text):
                vehicle.mission.upload([item])
        assert stub.messages == []


def test_places_and_altitudes_that_are_none(peer):
    nan, item = math.nan, mavloom.MissionItem
    assert item.at(1, 2, nan, command="NAV_LAND").command == 21  # PX4 takes NaN for "as it is"
    message = mavloom.Dialect().message("MISSION_ITEM", x=nan, y=8.25)
    with flown(peer, px4=True) as (vehicle, stub):
        for call, text in ((lambda: item.at(nan, 2, 3), "^lat: nan is not a coordinate"),
                           (lambda: item.at(1, math.inf, 3), "^lon: inf is not a coordinate"),
                           (lambda: item.at(147.5, 8, 3), "^lat: 147.5 is out of range, -90 to 90 degrees"),
                           (lambda: item.at("a", 2, 3), "^lat: a number, not 'a'"),
                           (lambda: item.at(1, 2, None), "^alt: a number, not None"),
                           (lambda: item.at(1, 2, 3, command="DANCE"), "^unknown command 'DANCE'"),
                           (lambda: vehicle.mission.upload([message]), "^x: nan is not a coordinate"),
                           (lambda: vehicle.takeoff("x"), "^altitude: a number, not 'x'"),
                           (lambda: vehicle.takeoff(nan), "^altitude: nan is not an altitude"),
                           (lambda: vehicle.link.vehicle(True), "^system: True is out of range, 1 to 255"),
                           (lambda: vehicle.link.vehicle(1, "x"), "^component: 'x' is out of range, 1 to 255"),
                           (lambda: vehicle.link.packet_loss("x"), "^system: 'x' is out of range, 0 to 255")):
            with pytest.raises(mavloom.UsageError, match=text):
                call()
        assert stub.messages == []


def test_lost_messages_of_a_mission_are_repeated(peer, quick):
    items = [mavloom.MissionItem.at(*place) for place in PLACES]
    lost = frozenset({"MISSION_COUNT", "MISSION_REQUEST_LIST", "MISSION_REQUEST_INT", "MISSION_CLEAR_ALL"})
    with flown(peer, px4=True, drop=lost) as (vehicle, stub):
        vehicle.mission.upload(items)
        assert vehicle.mission.download() == items
        vehicle.mission.clear()
        assert stub.mission == []


def test_a_lost_acknowledgement_is_requested_again(peer, quick):
    """By the last item once more, which a PX4 then acknowledges."""
    with flown(peer, px4=True) as (vehicle, stub):
        def acknowledge(message, result=0):
            if [m.get_type() for m in stub.messages].count("MISSION_ITEM_INT") == 4:
                Autopilot.mission_ack(stub, message)
        stub.mission_ack = acknowledge
        vehicle.mission.upload([mavloom.MissionItem.at(*place) for place in PLACES])
        assert [m.seq for m in stub.messages[1:]] == [0, 1, 2, 2] and len(stub.mission) == 3


def test_an_acknowledgement_of_something_earlier_does_not_end_an_upload(peer):
    with flown(peer, px4=True) as (vehicle, stub):
        def acknowledge_first(message):
            stub.mission_ack(message)
            Autopilot.on_mission_item_int(stub, message)
        stub.on_mission_item_int = acknowledge_first
        vehicle.mission.upload([mavloom.MissionItem.at(*place) for place in PLACES])
        assert [m.seq for m in stub.messages[1:]] == [0, 1, 2]


def test_an_upload_ends_whose_items_are_lost(peer, quick):
    def request_first(message):
        stub.send(peer.MAVLink_mission_request_message(message.get_srcSystem(), message.get_srcComponent(), 0, 0))
    with flown(peer, px4=True) as (vehicle, stub):
        stub.on_mission_item_int = request_first
        with pytest.raises(TimeoutError, match="no answer during the upload"):
            vehicle.mission.upload([mavloom.MissionItem.at(*place) for place in PLACES])


def test_a_fence_needs_mavlink_2(peer):
    """MISSION_CLEAR_ALL of MAVLink 1 has no type, so it would delete the mission in place of the fence."""
    with (mavloom.connect("udpin://127.0.0.1:0", version=1) as link,
          Autopilot(peer, Settings(px4=True), connect_to=("127.0.0.1", link.port), v1=True) as stub):
        vehicle = link.vehicle(timeout=30)
        for call in (vehicle.mission.clear, vehicle.mission.download, lambda kind: vehicle.mission.upload([], kind)):
            with pytest.raises(mavloom.UsageError, match="fences and rally points need MAVLink 2"):
                call(1)
        assert stub.messages == []
        vehicle.mission.upload([mavloom.MissionItem.at(*PLACES[0])])
        assert len(stub.mission) == 1


def test_a_refused_mission_is_an_error_with_the_reason(peer):
    with flown(peer, px4=True, refuse_mission=4) as (vehicle, _):
        with pytest.raises(mavloom.MissionError, match="upload of the mission: MAV_MISSION_NO_SPACE") as caught:
            vehicle.mission.upload([mavloom.MissionItem()])
        assert caught.value.result == 4


def test_silence_during_a_mission_is_a_timeout(peer, quick):
    with flown(peer, px4=True, silent=frozenset({"MISSION_COUNT", "MISSION_REQUEST_LIST"})) as (vehicle, _):
        with pytest.raises(TimeoutError, match="no answer during the upload"):
            vehicle.mission.upload([mavloom.MissionItem()])
        with pytest.raises(TimeoutError, match="no answer to MISSION_REQUEST_LIST after 5 tries"):
            vehicle.mission.download()


# ---- threads and asyncio

def test_threads_share_a_vehicle(peer):
    with flown(peer) as (vehicle, stub):
        failures = []

        def work(channel):
            try:
                for _ in range(10):
                    vehicle.command("DO_SET_SERVO", channel, 1500)
                    assert vehicle.params["RTL_ALT"] == 1500
            except Exception as error:
                failures.append(error)
        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert failures == []


async def exchange(vehicle, stub, name):
    """Reads and writes parameters and a mission."""
    params = await vehicle.params.fetch()
    assert params == {key: value for key, (value, _) in stub.params.items()}
    await vehicle.params.set(name, 42)
    assert await vehicle.params.get(name) == 42
    await vehicle.mission.upload([mavloom.MissionItem.at(*place) for place in PLACES])
    assert len(await vehicle.mission.download()) == 3
    await vehicle.mission.clear()


@both_autopilots
def test_the_services_with_asyncio(px4, peer, quick):
    async def fly(link, stub):
        vehicle = link.vehicle_async(1)
        ticks = 0

        async def tick():
            nonlocal ticks
            while True:
                ticks += 1
                await asyncio.sleep(0.001)
        ticker = asyncio.create_task(tick())
        await vehicle.set_mode("LOITER")
        await vehicle.arm()
        assert vehicle.armed and vehicle.mode == ("Hold" if px4 else "LOITER")
        await vehicle.takeoff(5)
        await vehicle.land()
        await vehicle.disarm()
        await exchange(vehicle, stub, "SYS_AUTOSTART" if px4 else "RTL_ALT")
        stub.settings.refuse[183] = 2
        with pytest.raises(mavloom.CommandError, match="MAV_RESULT_DENIED"):
            await vehicle.command("DO_SET_SERVO")
        stub.settings.silent = frozenset({"COMMAND_LONG"})
        with pytest.raises(TimeoutError):
            await vehicle.return_to_launch()
        ticker.cancel()
        return ticks

    with (mavloom.connect("udpin://127.0.0.1:0") as link,
          Autopilot(peer, Settings(px4=px4), connect_to=("127.0.0.1", link.port)) as stub):
        assert asyncio.run(asyncio.wait_for(fly(link, stub), 60)) > 10


def test_a_cancelled_task_leaves_the_vehicle_usable(peer):
    async def cancel(vehicle):
        task = asyncio.create_task(vehicle.command("DO_SET_SERVO"))
        await asyncio.sleep(0.05)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task

    with flown(peer, silent=frozenset({"COMMAND_LONG"})) as (vehicle, stub):
        asyncio.run(cancel(vehicle.link.vehicle_async(1)))
        stub.settings.silent = frozenset()
        assert vehicle.command("DO_SET_SERVO").result == 0


def test_a_cancelled_transfer_lets_the_next_one_begin(peer):
    items = [mavloom.MissionItem.at(*place) for place in PLACES]

    async def cancel(vehicle, stub):
        first = asyncio.create_task(vehicle.mission.upload(items))
        while not stub.messages:
            await asyncio.sleep(0.01)
        second, third = (asyncio.create_task(vehicle.mission.upload(items[:count])) for count in (2, 1))
        await asyncio.sleep(0.05)
        second.cancel()
        first.cancel()
        stub.settings.silent = frozenset()
        await third
        assert first.cancelled() and second.cancelled()

    with flown(peer, px4=True, silent=frozenset({"MISSION_COUNT"})) as (vehicle, stub):
        asyncio.run(cancel(vehicle.link.vehicle_async(1), stub))
        assert len(stub.mission) == 1


def test_a_call_does_not_wait_for_a_call_without_answers(peer, quick):
    """Here the first call cannot continue before the second one returns."""
    async def block(vehicle, stub):
        first = asyncio.create_task(vehicle.link.vehicle_async(1).mission.upload([mavloom.MissionItem()]))
        while not stub.messages:
            await asyncio.sleep(0.01)
        with pytest.raises(TimeoutError, match="transfer of a mission: another call that does the same has had no"):
            vehicle.mission.download()
        with pytest.raises(TimeoutError, match="no answer during the upload"):
            await first

    with flown(peer, px4=True, silent=frozenset({"MISSION_COUNT"})) as (vehicle, stub):
        asyncio.run(block(vehicle, stub))
        stub.settings.silent = frozenset()
        assert vehicle.mission.download() == []
