# SPDX-License-Identifier: MIT
"""The state of each system in connections of mavloom.mavutil, against pymavlink's after the same messages."""
import time

import pytest

import mavloom
from mavloom import mavutil
from tlogs import packer, write

PX4, ARDUPILOT, NONE = 12, 3, 8  # MAV_AUTOPILOT
QUADROTOR, STATION, COMPANION, GIMBAL, CAMERA = 2, 6, 18, 26, 30  # MAV_TYPE
PX4_LOITER = 50593792


class Sent(list):
    """Stands in for the file that a MAVLink object writes to."""

    def write(self, frame):
        self.append(bytes(frame))


class Crew:
    """Packs the messages of several components, each with its own sequence numbers."""

    def __init__(self, peer):
        self.peer, self.packers = peer, {}

    def frame(self, source, name, *values):
        self.packers.setdefault(source, packer(self.peer, *source))
        return self.packers[source].pack(getattr(self.peer, f"MAVLink_{name}_message")(*values))

    def heartbeat(self, source, kind, autopilot, base=81, custom=0):
        return self.frame(source, "heartbeat", kind, autopilot, base, custom, 4, 3)


def both_read(path, frames, their_mavutil):
    """The connections of both sides, after they have read the frames."""
    logs = []
    for module in (their_mavutil, mavutil):
        log = module.mavlogfile(str(write(path, frames)))
        while log.recv_msg() is not None:
            pass
        logs.append(log)
    return logs


def state_of(log):
    return (log.target_system, log.flightmode, log.mav_type, log.base_mode, log.motors_armed(), log.mode_mapping(),
            {system: (state.mav_autopilot, state.mav_type, state.flightmode, state.base_mode, state.armed,
                      sorted(state.messages)) for system, state in log.sysid_state.items()})


def sent_by(log, call, peer):
    log.mav.file = sent = Sent()
    call(log)
    return [message.to_dict() for message in peer.MAVLink(None).parse_buffer(b"".join(sent))]


def high_latency(kind, autopilot, custom=4, custom0=0):
    """The values of a HIGH_LATENCY2."""
    return ("high_latency2", 0, kind, autopilot, custom, *[0] * 20, custom0, 0, 0)


OTHERS = {"companion": ((1, 191), COMPANION), "camera": ((1, 100), CAMERA), "gimbal": ((1, 154), GIMBAL),
          "station": ((1, 190), STATION)}


@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("autopilot, custom", [(PX4, PX4_LOITER), (ARDUPILOT, 4)])
def test_other_components_do_not_change_the_modes_of_their_vehicle(autopilot, custom, other, peer, their_mavutil,
                                                                  tmp_path):
    crew = Crew(peer)
    frames = [crew.heartbeat((1, 1), QUADROTOR, autopilot, 209, custom),
              crew.heartbeat(OTHERS[other][0], OTHERS[other][1], NONE, 0, 0)]
    theirs, ours = both_read(tmp_path / "x.tlog", frames, their_mavutil)
    assert state_of(ours) == state_of(theirs)
    # After the heartbeat of the other component, pymavlink raises struct.error for a PX4.
    alone, _ = both_read(tmp_path / "y.tlog", frames[:1], their_mavutil)
    orders = (lambda log: log.set_mode("RTL"), lambda log: log.set_mode(*numbers))
    numbers = (29, 4, 5) if autopilot == PX4 else (4,)
    for order in orders:
        assert sent_by(ours, order, peer) == sent_by(alone, order, peer) != []


@pytest.mark.parametrize("autopilot, custom", [(PX4, PX4_LOITER), (ARDUPILOT, 4)])
def test_modes_that_a_script_adds_to_the_tables_count(autopilot, custom, peer, tmp_path, monkeypatch, their_mavutil):
    monkeypatch.setitem(mavutil.px4_map, "PARK", (29, 4, 6))
    monkeypatch.setitem(mavutil.AP_MAV_TYPE_MODE_MAP, QUADROTOR, {77: "PARK", 78: "RTL"})
    frames = [Crew(peer).heartbeat((1, 1), QUADROTOR, autopilot, 209, custom)]
    _, log = both_read(tmp_path / "x.tlog", frames, their_mavutil)
    numbers = (29, 4, 6) if autopilot == PX4 else (77,)
    park = sent_by(log, lambda log: log.set_mode("PARK"), peer)
    assert park == sent_by(log, lambda log: log.set_mode(*numbers), peer) != []
    if autopilot == ARDUPILOT:
        changed = sent_by(log, lambda log: log.set_mode("RTL"), peer)
        assert changed == sent_by(log, lambda log: log.set_mode(78), peer)


SUMMARIES = {
    "copter": [high_latency(QUADROTOR, ARDUPILOT)], "plane": [high_latency(1, ARDUPILOT, 10)],
    "unknown mode": [high_latency(QUADROTOR, ARDUPILOT, 99)], "armed": [high_latency(QUADROTOR, ARDUPILOT, 5, -64)],
    "px4": [high_latency(QUADROTOR, PX4, 0x304)], "px4, position": [high_latency(QUADROTOR, PX4, 3)],
    "home-made": [high_latency(QUADROTOR, NONE)],
    "before a heartbeat": [high_latency(QUADROTOR, ARDUPILOT), ("heartbeat", QUADROTOR, ARDUPILOT, 217, 5, 4, 3)],
    "after a heartbeat": [("heartbeat", QUADROTOR, ARDUPILOT, 217, 5, 4, 3), high_latency(QUADROTOR, ARDUPILOT)]}


@pytest.mark.parametrize("messages", SUMMARIES.values(), ids=list(SUMMARIES))
def test_a_vehicle_on_a_slow_link_is_known_by_its_high_latency2(messages, peer, their_mavutil, tmp_path):
    crew = Crew(peer)
    frames = [crew.frame((7, 1), *message) for message in messages]
    theirs, ours = both_read(tmp_path / "x.tlog", frames, their_mavutil)
    assert state_of(ours) == state_of(theirs)
    assert ours.target_system == 7


@pytest.mark.parametrize("messages", SUMMARIES.values(), ids=list(SUMMARIES))
def test_the_mode_in_a_message(messages, peer, their_mavutil):
    for name, *values in messages:
        message = getattr(peer, f"MAVLink_{name}_message")(*values)
        assert mavutil.mode_string_v10(message) == their_mavutil.mode_string_v10(message)


def test_high_latency2_of_a_gimbal_changes_nothing(peer, tmp_path):
    """In pymavlink the vehicle becomes a gimbal."""
    crew, path = Crew(peer), tmp_path / "x.tlog"
    log = mavutil.mavlogfile(str(write(path, [crew.heartbeat((1, 1), QUADROTOR, ARDUPILOT, 209, 4),
                                              crew.frame((1, 154), *high_latency(GIMBAL, NONE, 0))])))
    while log.recv_msg() is not None:
        pass
    assert (log.mav_type, log.flightmode, bool(log.motors_armed())) == (QUADROTOR, "GUIDED", True)


@pytest.mark.parametrize("radio", [(51, 68), (51, 67)])
def test_the_messages_of_a_radio_are_those_of_all_systems(radio, peer, their_mavutil, tmp_path):
    crew = Crew(peer)
    status = crew.frame(radio, "radio_status", 1, 2, 3, 4, 5, 6, 7)
    beats = [crew.heartbeat((system, 1), QUADROTOR, ARDUPILOT) for system in (1, 2)]
    for frames in ([*beats, status], [status, *beats]):
        theirs, ours = both_read(tmp_path / "x.tlog", frames, their_mavutil)
        assert state_of(ours) == state_of(theirs)
        assert ("RADIO_STATUS" in ours.messages) == (radio == (51, 68) and frames[-1] == status)


# ---- signing

KEY = bytes(range(32))
AGES_S = (0, 5, 15, 70, 3600, 365 * 86400)


def signed_heartbeats(peer, now):
    """One heartbeat of each age, each from a component of its own."""
    frames = []
    for component, age in enumerate(AGES_S, 1):
        sender = packer(peer, 1, component)
        sender.mav.signing.secret_key, sender.mav.signing.sign_outgoing = KEY, True
        sender.mav.signing.timestamp = now - age * 100_000
        frames.append(sender.pack(peer.MAVLink_heartbeat_message(QUADROTOR, ARDUPILOT, 0, 0, 4, 3)))
    return frames


def test_old_signatures_are_refused(peer, their_mavutil, tmp_path):
    """Nobody can replay what was recorded before the program began."""
    now = int((time.time() - 1420070400) * 100_000)
    path, found = str(write(tmp_path / "x.tlog", signed_heartbeats(peer, now))), []
    for module in (their_mavutil, mavutil):
        log = module.mavlogfile(path)
        log.setup_signing(KEY)
        assert now <= log.mav.signing.timestamp < now + 86400 * 100_000
        found.append([(message.get_type(), message.get_type() != "BAD_DATA" and message.get_signed())
                      for message in iter(log.recv_msg, None)])
    assert found[0] == found[1]
    assert [name for name, _ in found[1]] == ["HEARTBEAT"] * 3 + ["BAD_DATA"] * 3


# ---- parameters

@pytest.mark.parametrize("name", ["5", "-1", " 5 ", "+5", "1_0", b"5", 5, 5.0, True, "5.0", "1e3", "0x10", "",
                                  "RTL_ALT", b"RTL_ALT"])
def test_one_parameter_is_requested_by_name_or_index(name, peer, their_mavutil, tmp_path):
    theirs, ours = both_read(tmp_path / "x.tlog", [Crew(peer).heartbeat((1, 1), QUADROTOR, ARDUPILOT)], their_mavutil)
    sent = [sent_by(log, lambda log: log.param_fetch_one(name), peer) for log in (theirs, ours)]
    assert sent[0] == sent[1] and len(sent[1]) == 1


@pytest.mark.parametrize("call", [lambda log: log.param_fetch_one("A\udc80"), lambda log: log.param_fetch_one(None),
                                  lambda log: log.param_set_send("A\udc80", 1), lambda log: log.param_set_send(5, 1),
                                  lambda log: log.setup_logfile("x\ud800"),
                                  lambda log: log.setup_logfile_raw("\ud800")])
def test_names_that_are_no_text_are_refused(call, flight):
    with pytest.raises(mavloom.UsageError):
        call(mavutil.mavlink_connection(str(flight)))
