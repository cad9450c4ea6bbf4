# SPDX-License-Identifier: MIT
"""Behaviours 83 to 90 of docs/guide/sim-behaviour.md, and what the vehicle does about clients that misbehave."""
import contextlib
import json
import os
import signal
import socket
import statistics
import struct
import threading
import time

import pytest

import ftp as protocol
import frames
import harness
from flights import arm, ready_vehicle, take_off
from ftp import FtpClient
from simulators import ALTITUDE, HOLD, Simulator, item, plain
from stations import Station, mavlink

ACCEPTED = 0
KEY = bytes(range(1, 33))


def ticks():
    return int((time.time() - 1420070400) * 1e5)


def sign_with(station, key=KEY, link=3):
    station._coder.signing.secret_key = key
    station._coder.signing.link_id = link
    station._coder.signing.timestamp = ticks()
    station._coder.signing.sign_outgoing = True


def checks_signatures(station, key=KEY):
    """From now on, frames without a valid signature count as damaged."""
    station._parser.signing.secret_key = key
    station._parser.signing.allow_unsigned_callback = None
    station._parser.signing.sign_outgoing = False


def test_b83_signing(sim):
    simulator = sim()
    station = simulator.station().ready()
    setup = mavlink.MAVLink_setup_signing_message(1, 1, list(KEY), ticks())
    arm(station)
    station.send(setup)
    assert station.command(512, 148) == ACCEPTED  # armed: unsigned commands are still good
    assert station.command(400, 0) == ACCEPTED
    mark = station.mark()
    station.send(setup)
    station.until(lambda: station.mark() > mark + 50, what="telemetry")
    station.until(lambda: bytes(station.log[-1][1].get_msgbuf())[2] & 1, what="a signed frame")

    checks_signatures(station)
    damaged, mark = station.damaged, station.mark()
    sign_with(station)
    assert station.command(512, 148) == ACCEPTED
    station.until(lambda: station.mark() > mark + 100, what="signed telemetry")
    assert station.damaged == damaged
    assert all(m.get_signed() for m in station.since(mark))

    replayed = command_frame(station, 400, 1)
    station.write(replayed)
    station.armed_is(True)
    assert station.command(400, 0) == ACCEPTED
    mark = station.mark()
    station.write(replayed)  # an old time stamp
    station._coder.signing.sign_outgoing = False
    station.write(command_frame(station, 400, 1))  # no signature
    station._coder.signing.sign_outgoing = True
    assert station.command(512, 148) == ACCEPTED
    assert [m.command for m in station.since(mark, "COMMAND_ACK")] == [512]
    assert not station.is_armed


def command_frame(station, command, *params):
    values = list(params) + [0] * (7 - len(params))
    with station._sending:
        frame = bytes(mavlink.MAVLink_command_long_message(1, 1, command, 0, *values).pack(station._coder))
        station._coder.seq = (station._coder.seq + 1) % 256
    return frame


def test_b84_the_last_of_two_modes_wins(sim):
    simulator = sim()
    first, second = simulator.station().ready(), simulator.station((254, 191))
    for _ in range(10):
        marks = first.mark(), second.mark()
        first.send(mavlink.MAVLink_command_long_message(1, 1, 176, 0, 1, 2, 0, 0, 0, 0, 0))
        second.send(mavlink.MAVLink_command_long_message(1, 1, 176, 0, 1, 4, 3, 0, 0, 0, 0))
        assert [s.expect("COMMAND_ACK", since=m).result for s, m in zip((first, second), marks)] == [ACCEPTED] * 2
    modes = [station.expect("HEARTBEAT").custom_mode for station in (first, second)]
    assert modes[0] == modes[1] and modes[0] in (ALTITUDE, HOLD)

    assert first.command(176, 1, 2) == ACCEPTED  # the last of the two, now beyond doubt
    mark = first.mark()
    assert second.command(176, 1, 4, 3) == ACCEPTED
    assert first.expect("HEARTBEAT", since=mark).custom_mode == HOLD


def test_b85_a_network_that_reorders_and_repeats(sim, rng):
    simulator = sim()
    simulator.fault("duplicate:0.2,delay:10ms~5ms,reorder:0.2/20ms", rng)
    station = simulator.station()
    plan = [item(seq, 16, 10 * seq) for seq in range(20)]
    assert station.upload(plan).type == ACCEPTED
    assert [plain(one)[2:] for one in station.download()] == [plain(one)[2:] for one in plan]
    assert len(station.parameters()) > 100
    assert station.command(176, 1, 2) == ACCEPTED
    station.mode_is(ALTITUDE)


SERVICES = {
    "parameters": lambda s: s.send_to_vehicle("param_request_list"),
    "upload": lambda s: s.send_to_vehicle("mission_count", 100, 0),
    "download": lambda s: s.send_to_vehicle("mission_request_list", 0),
    "burst": lambda s: burst_of_log(s),
    "log": lambda s: [s.send_to_vehicle("log_request_list", 0, 0xFFFF),
                      s.send_to_vehicle("log_request_data", 0, 0, 0xFFFFFFFF)],
    "log stream": lambda s: s.send(mavlink.MAVLink_command_long_message(1, 1, 2510, 0, 0, 0, 0, 0, 0, 0, 0)),
    "calibration": lambda s: s.send(mavlink.MAVLink_command_long_message(1, 1, 241, 0, 1, 0, 0, 0, 0, 0, 0)),
}


def burst_of_log(station):
    client = FtpClient(station)
    path = "/etc/extras/component_general.json.xz"
    client.send(protocol.OPEN, path.encode())
    client.send(protocol.BURST, size=239)


def test_b86_a_client_that_vanishes_disturbs_nobody(sim):
    """Its port is closed in the middle of each service: the kernel answers with ICMP."""
    simulator = sim()
    witness = simulator.station().ready()
    plan = [item(seq, 16, 10 * seq) for seq in range(100)]
    assert witness.upload(plan).type == ACCEPTED
    mark = witness.mark()
    for number, start in enumerate(SERVICES.values()):
        client = simulator.station((100 + number, 190))
        start(client)
        client.close()
    witness.until(lambda: len(witness.times("HEARTBEAT", mark)) > 3, what="heartbeats")

    assert len(witness.parameters()) > 100
    assert len(witness.download()) == 100
    assert witness.lost == 0 and gaps_of(witness, "ATTITUDE", mark) < 2
    assert simulator.process.alive


def gaps_of(station, name, mark):
    """The longest silence of a message, in seconds."""
    times = station.times(name, mark)
    assert len(times) > 10
    return max(b - a for a, b in zip(times, times[1:]))


@pytest.mark.parametrize("clients, vehicles", [(1000, 1), (1, 250)])
def test_b87_heartbeats_keep_time_under_load(sim, clients, vehicles):
    simulator = sim("--profile", "lite", "--vehicles", str(vehicles),
                    listen=("udpin://127.0.0.1:0?max_peers=1000",))
    witness = simulator.station().ready()
    with contextlib.ExitStack() as opened:
        beat = mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3).pack(mavlink.MAVLink(None, 255, 190))
        crowd = []
        for _ in range(clients - 1):
            sock = opened.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            sock.connect(("127.0.0.1", simulator.port))
            sock.send(beat)
            sock.setblocking(False)
            crowd.append(sock)
        mark = witness.mark()
        witness.until(lambda: keeps_time(witness.times("HEARTBEAT", mark)), what="heartbeats in time")
        assert witness.command(512, 148) == ACCEPTED
        silent = [sock for sock in crowd if not hears(sock)]

    assert len(silent) < 10  # what the kernel had no room for
    assert witness.lost == 0


def keeps_time(times):
    """Whether the last five intervals are of a second. Others may be late, by a busy machine."""
    last = times[-6:]
    late = [abs(b - a - 1) for a, b in zip(last, last[1:])]
    return len(late) == 5 and statistics.median(late) < 0.1


def hears(sock):
    with contextlib.suppress(OSError):
        return bool(sock.recv(2048))
    return False


def test_b88_the_end_leaves_no_partial_frames(sim, udp_socket):
    simulator = sim("--profile", "px4-onboard", "--speed", "20", listen=("tcpin://127.0.0.1:0",))
    sock = socket.create_connection(("127.0.0.1", simulator.port), timeout=harness.DEFAULT_TIMEOUT_S)
    data = b""
    while len(data) < 200_000:
        data += sock.recv(65536)
    simulator.process.send(signal.SIGTERM)
    while chunk := sock.recv(65536):
        data += chunk
    sock.close()
    done = simulator.process.wait()
    parts = frames.split_frames(data)

    assert done.status == 143
    assert sum(map(len, parts)) == len(data) and len(parts[-1]) == frames.frame_length(parts[-1], 0)


def test_a_web_page_arms_no_simulated_vehicle(sim):
    simulator = sim(listen=("tcpin://127.0.0.1:0", "udpin://127.0.0.1:0"))
    simulator.station(port=simulator.listening_port(1)).ready()
    order = mavlink.MAVLink_command_long_message(1, 1, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0)
    request = b"POST / HTTP/1.1\r\nOrigin: https://evil.example\r\n\r\n" + order.pack(mavlink.MAVLink(None, 255, 190))
    with socket.create_connection(("127.0.0.1", simulator.port), timeout=harness.DEFAULT_TIMEOUT_S) as page:
        page.sendall(request)
        with contextlib.suppress(ConnectionResetError):
            while page.recv(65536):
                pass
    simulator.process.wait_output("is an HTTP or TLS client")
    assert not simulator.state()["armed"]
    rows = [json.loads(line) for line in simulator.ctl("stats").splitlines()]
    assert sum(row.get("http_refused", 0) for row in rows) == 1
    with socket.create_connection(("127.0.0.1", simulator.port), timeout=harness.DEFAULT_TIMEOUT_S) as client:
        client.sendall(order.pack(mavlink.MAVLink(None, 255, 190)))
        harness.wait_for(lambda: simulator.state()["armed"], what="the same order, without the page")


def telemetry_of(program, *options):
    """{(message, time): payload} of a short flight."""
    with Station.listening(beats=False) as station:
        simulator = Simulator(program, "--to", station.url, "--seed", "77", "--for", "3s", *options, listen=())
        station.expect("HEARTBEAT", since=0)
        assert simulator.process.wait().status == 0
        simulator.end()
        found = {}
        for message in station.since(0):
            if hasattr(message, "time_boot_ms") and message.get_type() != "SYSTEM_TIME":
                found[message.get_type(), message.time_boot_ms] = bytes(message.get_payload())
    return found


def test_b89_the_same_seed_gives_the_same_telemetry(program):
    first, second = (telemetry_of(program, "--speed", "3") for _ in range(2))
    common = set(first) & set(second)

    assert len(common) > 0.8 * len(first) > 100
    assert [key for key in common if first[key] != second[key]] == []


def test_b90_speed_changes_the_flight_and_no_time_outs(sim):
    speeds = (0.5, 20)
    stations = [sim("--speed", speed).station() for speed in speeds]
    for station in stations:
        station.expect("ATTITUDE", since=0)
        station.send_to_vehicle("mission_count", 5, 0)
    for station, speed in zip(stations, speeds):
        end = station.expect("MISSION_ACK", since=0, timeout=20)
        asked = station.times("MISSION_REQUEST_INT")
        timed = [(when, m.time_boot_ms / 1000) for when, m in station.log if m.get_type() == "ATTITUDE"]
        (t0, boot0), (t1, boot1) = timed[0], timed[-1]

        assert end.type == mavlink.MAV_MISSION_OPERATION_CANCELLED
        assert 4 < asked[-1] - asked[0] < 9  # 5 s of real time; 10 s by the slow clock
        assert 0.2 < statistics.median(b - a for a, b in zip(asked, asked[1:])) < 0.45
        assert abs((boot1 - boot0) / (t1 - t0) / speed - 1) < 0.1
        assert not [text for text in station.texts() if "lost" in text]  # of our heartbeats, one a second


# ---- misbehaving clients

def fuzzed(rng, station, count):
    """Frames of the services with random targets, lengths, numbers and texts, some of them damaged."""
    names = ["command_long", "command_int", "param_request_list", "param_request_read", "param_set", "mission_count",
             "mission_item_int", "mission_request_int", "mission_request_list", "mission_set_current",
             "mission_clear_all", "mission_ack", "mission_write_partial_list", "file_transfer_protocol",
             "log_request_list", "log_request_data", "log_erase", "log_request_end", "timesync", "ping",
             "manual_control", "rc_channels_override", "set_position_target_local_ned", "set_attitude_target",
             "set_position_target_global_int", "request_data_stream", "set_mode", "serial_control", "request_event",
             "gimbal_manager_set_attitude", "logging_ack", "set_gps_global_origin", "play_tune_v2"]
    classes = [getattr(mavlink, f"MAVLink_{name}_message") for name in names]
    for _ in range(count):
        kind = rng.choice(classes)
        payload = bytearray(rng.choice([bytes(255), rng.randbytes(255), b"\xff" * 255, b"\x7f" * 255]))
        size = struct.calcsize(kind.unpacker.format)
        payload = payload[:size].ljust(size, b"\0")
        for offset in range(rng.randrange(3)):
            payload[rng.randrange(size)] = rng.choice((0, 1, 1, 190, 255))
        if rng.random() < 0.8:
            address(kind, payload)
        frame = bytearray(frame_of(kind, bytes(payload), rng))
        if rng.random() < 0.1:
            frame[rng.randrange(len(frame))] ^= 1 << rng.randrange(8)
        station.write(bytes(frame[:rng.randrange(1, len(frame))] if rng.random() < 0.05 else frame))


FORBIDDEN = {246, 185}  # a reboot or a termination would end the telemetry for good


def address(kind, payload):
    """Puts this vehicle's ids into the target fields."""
    message = kind.unpacker.unpack(bytes(payload))
    names = list(kind.ordered_fieldnames)
    values = list(message)
    if len(values) != len(names):
        return  # arrays; their targets are left to chance
    for name in ("target_system", "target_component", "target"):
        if name in names:
            values[names.index(name)] = 1
    if "command" in names and values[names.index("command")] % 65536 in FORBIDDEN:
        values[names.index("command")] = 400
    payload[:] = kind.unpacker.pack(*values)


def frame_of(kind, payload, rng):
    """A valid MAVLink 2 frame of a payload, its zeros cut off or not."""
    from pymavlink.generator.mavcrc import x25crc
    if rng.random() < 0.5:
        payload = payload.rstrip(b"\0") or b"\0"
    header = struct.pack("<BBBBBBBHB", 0xFD, len(payload), 0, 0, rng.randrange(256), rng.choice((255, 254, 1, 7)),
                         rng.choice((190, 1, 7)), kind.id & 0xFFFF, kind.id >> 16)
    crc = x25crc(header[1:] + payload)
    crc.accumulate(bytes([kind.crc_extra]))
    return header + payload + struct.pack("<H", crc.crc)


@pytest.mark.parametrize("count", [20_000, pytest.param(1_000_000, marks=pytest.mark.long)])
@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_fuzzed_requests_leave_the_telemetry_alone(sim, rng, count, autopilot):
    simulator = sim("--autopilot", autopilot, "--gimbal")
    witness, attacker = simulator.station().ready(), simulator.station((254, 190), keeps=("HEARTBEAT",))
    mark = witness.mark()
    memory = resident_kib(simulator)
    fuzzed(rng, attacker, count)
    attacker.close()
    assert witness.command(512, 148) == ACCEPTED
    witness.until(lambda: len(witness.times("GLOBAL_POSITION_INT", mark)) > 20, what="telemetry")

    assert simulator.process.alive
    assert gaps_of(witness, "GLOBAL_POSITION_INT", mark) < 2
    assert witness.lost == 0
    assert resident_kib(simulator) - memory < 4096


def resident_kib(simulator):
    with open(f"/proc/{simulator.process.pid}/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1024


def test_two_clients_upload_at_once(sim):
    """One of them, or both one after the other: the plan is never a mixture."""
    simulator = sim()
    stations = simulator.station(), simulator.station((254, 191))
    plans = [[item(seq, 16, 10 * seq, height=height) for seq in range(60)] for height in (10, 20)]
    acks = [None, None]

    def upload(number):
        acks[number] = stations[number].upload(plans[number]).type
    threads = [threading.Thread(target=upload, args=(number,)) for number in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    heights = {m.z for m in stations[0].download()}

    assert sorted(acks) in ([ACCEPTED, ACCEPTED], [ACCEPTED, mavlink.MAV_MISSION_ERROR])
    assert heights in ({10.0}, {20.0})
    assert heights == {m.z for m in stations[1].download()}
    assert acks[0 if heights == {10.0} else 1] == ACCEPTED
    assert stations[1].upload(plans[1]).type == ACCEPTED


@pytest.mark.parametrize("loss", [0.1, 0.2])
def test_services_on_a_lossy_link(sim, rng, loss):
    simulator = sim()
    simulator.fault(f"loss:{loss},delay:5ms", rng)
    station = simulator.station()
    assert len(station.parameters()) > 100
    plan = [item(seq, 16, 10 * seq) for seq in range(10)]
    assert station.upload(plan).type == ACCEPTED
    assert len(station.download()) == 10


def test_limits_answer_with_the_errors_of_the_protocols(sim):
    station = sim().station().ready()
    mark = station.mark()
    station.send_to_vehicle("mission_count", 60_000, 0)
    assert station.expect("MISSION_ACK", since=mark).type == mavlink.MAV_MISSION_NO_SPACE
    client = FtpClient(station)
    open_sessions = [FtpClient(station, number).ask(protocol.OPEN, b"/etc/extras/component_general.json.xz").error
                     for number in range(20)]
    assert set(open_sessions) <= {0, protocol.NO_SESSIONS} and protocol.NO_SESSIONS in open_sessions
    assert client.ask(protocol.RESET).error == 0
    assert client.ask(protocol.OPEN, b"/etc/extras/component_general.json.xz").error == 0


def test_it_still_flies_after_bad_values(sim, rng):
    """NaN and infinity in every parameter of every command that flies."""
    station = ready_vehicle(sim, speed=5)
    take_off(station)
    for command in (16, 17, 20, 21, 22, 34, 84, 115, 178, 179, 186, 192, 193, 195, 197, 201, 224, 300, 511, 512):
        for value in (float("nan"), float("inf"), -float("inf"), 3e38):
            station.send(mavlink.MAVLink_command_long_message(1, 1, command, 0, *[value] * 7))
            station.send(mavlink.MAVLink_command_int_message(1, 1, 3, command, 0, 0, *[value] * 4, 2**31 - 1, -2**31,
                                                             value))
    for value in (float("nan"), float("inf"), 3e38):
        for mask in (0, 0x9C7, 0x9F8, 0xFFF):
            station.send(mavlink.MAVLink_set_position_target_local_ned_message(0, 1, 1, 1, mask, *[value] * 11))
            station.send(mavlink.MAVLink_set_attitude_target_message(0, 1, 1, mask & 0xFF, [value] * 4, *[value] * 4))
    assert station.command(410) == ACCEPTED  # all others before it are carried out
    mark = station.mark()
    assert station.command(176, 1, 4, 5) == ACCEPTED
    station.armed_is(False, since=mark)
    end = station.expect("LOCAL_POSITION_NED")
    assert all(abs(value) < 1e5 for value in (end.x, end.y, end.z, end.vx))
