# SPDX-License-Identifier: MIT
"""mavloom relay: decoded and re-encoded, byte for byte the same unless asked otherwise; both directions;
pymavlink reads what comes out."""
import itertools
import json
import signal
import socket

import pytest

import frames
import harness
from frames import mavlink
from recorded_px4 import PARAMETERS, RecordedPx4, Station

pytestmark = pytest.mark.short


class Path:
    """vehicle -> relay -> station, over UDP."""

    def __init__(self, spawn, *options):
        self.station = harness.udp_socket()
        self.vehicle = harness.udp_socket()
        self.relay = spawn("relay", "udpin://127.0.0.1:0", "--to",
                           f"udpout://127.0.0.1:{self.station.getsockname()[1]}", *options)
        self.port = int(self.relay.wait_output(r"listening on port (\d+)", stream="err")[1])

    def send(self, *sent):
        for frame in sent:
            self.vehicle.sendto(frame, ("127.0.0.1", self.port))

    def receive(self, count):
        got = []
        while len(got) < count:
            datagram, self.relay_address = self.station.recvfrom(65536)
            got += frames.split_frames(datagram)
        return got

    def through(self, *sent, count=None):
        self.send(*sent)
        return self.receive(len(sent) if count is None else count)


def decode(frame):
    return frames.mavlink.MAVLink(None).decode(bytearray(frame))


def test_a_whole_flight_is_byte_identical_over_tcp(spawn, tcp_port):
    port = tcp_port()
    with socket.create_server(("127.0.0.1", port)) as server:
        process = spawn("relay", frames.FLIGHT, "--to", f"tcpout://127.0.0.1:{port}")
        connection, _ = server.accept()
        got = b""
        while chunk := connection.recv(1 << 16):
            got += chunk
    done = process.wait()

    assert done.status == 0
    assert got == b"".join(frame for _, frame in frames.read_tlog(frames.FLIGHT))
    assert "40087 frames in, 40087 decoded and re-encoded, 0 passed untouched" in done.stderr


def test_to_a_file_with_the_recorded_times(run, tmp_path):
    out = tmp_path / "out.tlog"
    done = run("relay", frames.FLIGHT, "--to", f"tlog://{out}")

    assert done.status == 0
    assert out.read_bytes() == frames.FLIGHT.read_bytes()


def test_a_full_disk_ends_it(run):
    done = run("relay", frames.FLIGHT, "--to", "tlog:///dev/full")

    assert done.status == 1
    assert "No space left" in done.stderr


def test_a_recording_does_not_overrun_its_own_queue(spawn, tcp_port):
    port = tcp_port()
    with socket.create_server(("127.0.0.1", port)) as server:
        process = spawn("relay", frames.FLIGHT, "--to", f"tcpout://127.0.0.1:{port}?queue_bytes=16k")
        connection, _ = server.accept()
        got = b""
        while chunk := connection.recv(1 << 16):
            got += chunk

    assert process.wait().status == 0
    assert len(frames.split_frames(got)) == 40087


def test_a_far_side_that_goes_is_a_loss_with_status_4(spawn, tcp_port):
    port = tcp_port()
    with socket.create_server(("127.0.0.1", port)) as server:
        process = spawn("relay", frames.FLIGHT, "--to", f"tcpout://127.0.0.1:{port}?queue_age=200ms", "--for", "20s")
        connection, _ = server.accept()
        connection.recv(1 << 16)
        connection.close()
    done = process.wait()

    assert done.status == 4, done.stderr
    reasons = ("there was no peer", "dropped", "still queued at the end, not sent")  # by how far the relay was
    assert any(reason in done.stderr for reason in reasons), done.stderr


def test_live_frames_are_byte_identical(spawn):
    path = Path(spawn)
    sent = [frame for _, frame in frames.read_tlog(frames.FLIGHT)[:200]]

    assert path.through(*sent) == sent
    done = path.relay.stop()
    assert done.status == 130 and "200 frames in" in done.stderr


def test_what_cannot_be_decoded_passes_untouched(spawn):
    path = Path(spawn)
    padded = bytearray(next(frames.heartbeats(1)))
    unknown = bytes([0xFD, 1, 0, 0, 0, 1, 1]) + (9_999_999).to_bytes(3, "little") + b"\x07"
    from pymavlink.generator.mavcrc import x25crc
    unknown += x25crc(unknown[1:] + b"\x11").crc.to_bytes(2, "little")
    mav = frames.sender()
    mav.signing.secret_key, mav.signing.link_id, mav.signing.timestamp = bytes(32), 1, 10
    mav.signing.sign_outgoing = True
    signed = frames.mavlink.MAVLink_attitude_message(1, 2, 3, 4, 5, 6, 7).pack(mav)
    sent = [bytes(padded), unknown, bytes(signed)]

    assert path.through(*sent) == sent


def test_answers_go_back(spawn):
    path = Path(spawn)
    path.through(next(frames.heartbeats(1)))
    answer = frames.mavlink.MAVLink_command_long_message(1, 1, 400, 0, 1, 0, 0, 0, 0, 0,
                                                         0).pack(frames.sender(255, 190))
    path.station.sendto(answer, path.relay_address)

    assert path.vehicle.recv(65536) == answer


def test_several_sources_and_destinations(spawn):
    stations = [harness.udp_socket() for _ in range(2)]
    to = itertools.chain.from_iterable(("--to", f"udpout://127.0.0.1:{s.getsockname()[1]}") for s in stations)
    process = spawn("relay", "udpin://127.0.0.1:0?name=a", "udpin://127.0.0.1:0?name=b", *to)
    ports = [int(process.wait_output(rf"{name}: listening on port (\d+)", stream="err")[1]) for name in "ab"]
    vehicle = harness.udp_socket()
    sent = [next(frames.heartbeats(1, system=system)) for system in (1, 2)]
    for port, frame in zip(ports, sent):
        vehicle.sendto(frame, ("127.0.0.1", port))

    for station in stations:
        got = []
        while len(got) < 2:
            got += frames.split_frames(station.recv(65536))
        assert sorted(got) == sorted(sent)


def test_set_a_field(spawn):
    path = Path(spawn, "--set", "ATTITUDE.roll=0.5", "--set", "HEARTBEAT.system_status=MAV_STATE_CRITICAL")
    attitude, heartbeat = map(decode, path.through(frames.attitude(), next(frames.heartbeats(1))))

    assert (attitude.roll, attitude.pitch) == (0.5, pytest.approx(-0.2))
    assert heartbeat.system_status == frames.mavlink.MAV_STATE_CRITICAL


def test_set_one_element_of_an_array(spawn):
    sent = frames.mavlink.MAVLink_actuator_control_target_message(7, 3, [1, 2, 3, 4, 5, 6, 7, 8]).pack(frames.sender())
    path = Path(spawn, "--set", "ACTUATOR_CONTROL_TARGET.controls[3]=0.5", "--set",
                "ACTUATOR_CONTROL_TARGET.controls[7]=0")

    assert decode(path.through(sent)[0]).controls == [1, 2, 3, 0.5, 5, 6, 7, 0]


def test_the_sums_as_json(run, tmp_path):
    log = frames.write_tlog(tmp_path / "in.tlog", list(enumerate([*frames.heartbeats(5), frames.attitude()])))
    done = run("relay", log, "--to", f"tlog://{tmp_path}/x.tlog", "--only", "HEARTBEAT", "--json", "-q")

    assert (done.status, done.stderr, len(done.lines)) == (0, "", 1), done
    stats = json.loads(done.stdout)["stats"]
    assert list(stats) == ["destinations", "edit", "totals"]
    assert stats["destinations"] == [{"endpoint": f"{tmp_path}/x.tlog", "frames": 5, "bytes": 5 * 29, "not_written": 0,
                                      "files": 1}]
    assert stats["edit"] == {"frames": 6, "reencoded": 5, "rewrapped": 0, "passed_untouched": 0, "filtered": 1,
                             "rate_limited": 0, "not_v1": 0, "not_signed": 0, "signature_removed": 0, "backward": 0,
                             "unheard_answers": 0}
    assert set(stats["totals"].values()) == {0} and "kernel_drop" in stats["totals"]


def test_the_sums_of_a_link_as_json(run, udp_socket):
    station = udp_socket()
    address = f"udpout://127.0.0.1:{station.getsockname()[1]}"
    done = run("relay", f"tlog://{frames.FLIGHT}?speed=max", "--to", address, "--only", "GPS_RAW_INT", "--json")

    sums = json.loads(done.stdout)["stats"]["destinations"][0]
    assert list(sums) == ["endpoint", "frames", "bytes", "dropped", "refused", "not_sent", "nobody_there",
                          "queued_bytes"]
    assert (sums["endpoint"], sums["frames"], sums["dropped"], sums["queued_bytes"]) == (address, 531, 0, 0)


@pytest.mark.parametrize("options", [["--only", "PLAY_TUNE"], ["--as-v1", "--only", "COMPONENT_METADATA"]],
                         ids=" ".join)
def test_nothing_to_send_is_no_loss(run, udp_socket, options):
    done = run("relay", frames.FLIGHT, "--to", f"udpout://127.0.0.1:{udp_socket().getsockname()[1]}", *options)
    assert done.status == 0 and "0 frames, 0 bytes sent" in done.stderr, done


def test_frames_that_cannot_leave_are_counted(run, tmp_path):
    log = frames.write_tlog(tmp_path / "in.tlog", list(enumerate(frames.heartbeats(5))))
    # from the loopback address nothing goes to another host
    done = run("relay", log, "--to", "udpout://192.0.2.1:9?bind=127.0.0.1:0", "--json")

    sums = json.loads(done.stdout)["stats"]["destinations"][0]
    assert done.status == 4 and (sums["frames"], sums["not_sent"], sums["refused"]) == (0, 5, 0), done
    assert "5 frames not sent: the system refused them" in done.stderr


def test_the_guide_names_every_key_of_the_sums(run, tmp_path, udp_socket):
    guide = (harness.ROOT / "docs" / "guide" / "relay.md").read_text()
    done = run("relay", frames.FLIGHT, "--json", "--to", f"tlog://{tmp_path}/x.tlog", "--to",
               f"udpout://127.0.0.1:{udp_socket().getsockname()[1]}")
    stats = json.loads(done.stdout)["stats"]

    keys = {*stats, *stats["edit"], *(key for destination in stats["destinations"] for key in destination)}
    assert [key for key in sorted(keys) if f"`{key}`" not in guide and f'"{key}"' not in guide] == []


def test_remap_a_system_in_both_directions(spawn):
    path = Path(spawn, "--remap-system", "1=42")
    assert decode(path.through(frames.attitude())[0]).get_srcSystem() == 42
    command = frames.mavlink.MAVLink_command_long_message(42, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0)
    path.station.sendto(command.pack(frames.sender(255, 190)), path.relay_address)

    back = decode(path.vehicle.recv(65536))
    assert (back.target_system, back.get_srcSystem()) == (1, 255)


def test_only_and_resequence_show_no_loss(spawn):
    path = Path(spawn, "--only", "ATTITUDE", "--resequence")
    mixed = [frame for i, beat in enumerate(frames.heartbeats(20))
             for frame in (beat, frames.attitude(sequence=7 * i % 256))]
    got = path.through(*mixed, count=20)

    assert [decode(frame).get_type() for frame in got] == ["ATTITUDE"] * 20
    assert [frame[4] for frame in got] == list(range(got[0][4], got[0][4] + 20))


def test_max_rate_by_recorded_time(spawn, tmp_path, tcp_port):
    # 50 Hz for 10 s
    log = frames.write_tlog(tmp_path / "x.tlog", [(20_000 * i, frames.attitude(sequence=i % 256)) for i in range(500)])
    port = tcp_port()
    with socket.create_server(("127.0.0.1", port)) as server:
        process = spawn("relay", log, "--to", f"tcpout://127.0.0.1:{port}", "--max-rate", "ATTITUDE:10")
        connection, _ = server.accept()
        got = b""
        while chunk := connection.recv(1 << 16):
            got += chunk

    assert process.wait().status == 0
    assert 98 <= len(frames.split_frames(got)) <= 102


def test_as_v1_and_back(spawn):
    path = Path(spawn, "--as-v1")
    v1 = path.through(frames.attitude())[0]
    assert v1[0] == 0xFE and decode(v1).roll == pytest.approx(0.1)

    path = Path(spawn, "--as-v2")
    v2 = path.through(v1)[0]
    assert v2 == frames.attitude()


def test_signed_output_is_accepted_by_pymavlink(spawn, tmp_path):
    key = tmp_path / "key"
    key.write_text("00" * 31 + "07")
    key.chmod(0o600)
    path = Path(spawn, "--sign", key, "--sign-link-id", "3")
    got = path.through(frames.attitude(), next(frames.heartbeats(1)))

    receiver = frames.mavlink.MAVLink(None)
    receiver.signing.secret_key = bytes(31) + b"\x07"
    for frame in got:
        assert receiver.decode(bytearray(frame)).get_signed()
        assert frame[-13] == 3


def test_a_dead_destination_harms_nobody(spawn, udp_port):
    station, vehicle = harness.udp_socket(), harness.udp_socket()
    process = spawn("relay", "udpin://127.0.0.1:0", "--to", f"udpout://127.0.0.1:{udp_port()}",
                    "--to", f"udpout://127.0.0.1:{station.getsockname()[1]}")
    port = int(process.wait_output(r"listening on port (\d+)", stream="err")[1])
    sent = list(frames.heartbeats(200))
    for frame in sent:
        vehicle.sendto(frame, ("127.0.0.1", port))
    got = []
    while len(got) < 200:
        got += frames.split_frames(station.recv(65536))

    assert got == sent


def test_a_stalled_client_gets_whole_frames_only_and_the_other_all(spawn):
    process = spawn("relay", "udpin://127.0.0.1:0", "--to", "tcpin://127.0.0.1:0?queue_bytes=100000")
    udp = int(process.wait_output(r"udpin.*listening on port (\d+)", stream="err")[1])
    tcp = int(process.wait_output(r"tcpin.*on port (\d+)", stream="err")[1])
    stalled = socket.socket()
    stalled.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    stalled.connect(("127.0.0.1", tcp))
    good = socket.create_connection(("127.0.0.1", tcp), timeout=harness.DEFAULT_TIMEOUT_S)
    vehicle = harness.udp_socket()
    sent, got = [], b""
    for frame in itertools.islice(itertools.chain.from_iterable(frames.heartbeats(1000) for _ in range(100)), 60_000):
        vehicle.sendto(frame, ("127.0.0.1", udp))
        sent.append(frame)
        if len(sent) % 100 == 0:
            while len(got) < sum(map(len, sent)):
                got += good.recv(1 << 16)
    assert got == b"".join(sent)

    process.send(signal.SIGINT)
    rest = b""
    stalled.settimeout(harness.DEFAULT_TIMEOUT_S)
    while chunk := stalled.recv(1 << 16):
        rest += chunk
    process.wait()
    whole = frames.split_frames(rest)
    assert 0 < len(whole) < 60_000
    for frame in whole[:-1]:
        assert decode(frame).get_type() == "HEARTBEAT"


@pytest.mark.parametrize("options, said", [
    (["--set", "ATTITUDE.rol=1"], "did you mean 'roll'"), (["--set", "ATITUDE.roll=1"], "did you mean 'ATTITUDE'"),
    (["--set", "ATTITUDE.roll"], "ATTITUDE.roll"), (["--set", "HEARTBEAT.type=300"], "255"),
    (["--set", "HEARTBEAT.type=MAV_TYPE_QUADROTR"], "MAV_TYPE_QUADROTOR"), (["--remap-system", "1"], "--remap-system"),
    (["--remap-system", "1=300"], "255"), (["--only", "NOPE"], "NOPE"), (["--max-rate", "ATTITUDE"], "--max-rate"),
    (["--as-v1", "--as-v2"], "--as-v"),
])
def test_wrong_use(run, options, said):
    done = run("relay", frames.FLIGHT, "--to", "udpout://127.0.0.1:9", *options)

    assert done.status == 2
    assert said in done.stderr


@pytest.mark.parametrize("content, mode, said",
                         [("00" * 32, 0o644, "chmod 600"), ("00" * 31, 0o600, "64 hexadecimal digits"),
                          (None, 0, "cannot open key file")])
@pytest.mark.parametrize("command", [
    ["relay", "{log}", "--to", "udpout://127.0.0.1:9", "--sign", "{key}"],
    ["relay", "{log}", "--to", "udpout://127.0.0.1:9?sign={key}"],
    ["replay", "{log}", "--to", "udpout://127.0.0.1:9?verify={key}"], ["listen", "udpin://127.0.0.1:0?verify={key}"],
    ["record", "udpin://127.0.0.1:0?sign={key}", "-o", "{key}.tlog"],
])
def test_a_bad_key_file_is_status_3(run, tmp_path, command, content, mode, said):
    key = tmp_path / "key"
    if content is not None:
        key.write_text(content)
        key.chmod(mode)
    done = run(*[word.format(key=key, log=frames.FLIGHT) for word in command])

    assert done.status == 3
    assert said in done.stderr


def test_an_own_dialect_is_decoded_and_edited(spawn, run, tmp_path):
    xml = tmp_path / "mine.xml"
    xml.write_text('<?xml version="1.0"?><mavlink><messages><message id="42000" name="MY_STATE">'
                   '<field type="uint16_t" name="count">n</field><field type="float[3]" name="v">v</field></message>'
                   '</messages></mavlink>')
    shown = run("dialect", "show", "MY_STATE", "--dialect", xml, "--json")
    crc_extra = json.loads(shown.stdout)["crc_extra"]
    body = bytes([0xFD, 14, 0, 0, 0, 1, 1]) + (42000).to_bytes(3, "little") + bytes(12) + b"\x05\x00"
    from pymavlink.generator.mavcrc import x25crc
    frame = body + x25crc(body[1:] + bytes([crc_extra])).crc.to_bytes(2, "little")
    path = Path(spawn, "--dialect", xml, "--set", "MY_STATE.count=9")

    got = path.through(frame)[0]
    assert got[10:23] == bytes(12) + b"\x09"


def test_help_teaches(run):
    done = run("relay", "--help")

    assert done.status == 0
    for word in ("--to", "--set", "--remap-system", "--only", "--max-rate", "--as-v1", "--sign", "--resequence",
                 "Examples"):
        assert word in done.stdout


def test_a_rate_for_all_leaves_protocols_whole(spawn, udp_port):
    """`--max-rate '*:10'` thins telemetry: a ground station behind it gets every parameter, uploads a mission and
    arms."""
    station = Station(f"udpin:127.0.0.1:{udp_port()}")
    relay = spawn("relay", "udpin://127.0.0.1:0", "--to",
                  f"udpout://127.0.0.1:{station.connection.port.getsockname()[1]}", "--max-rate", "*:10", "--json")
    port = int(relay.wait_output(r"listening on port (\d+)", stream="err")[1])
    with RecordedPx4(port) as vehicle:
        station.wait_vehicle()
        parameters = station.fetch_parameters()
        mission, result = station.upload_mission(), station.arm()
    station.close()
    edit = json.loads(relay.stop().stdout)["stats"]["edit"]

    assert len(parameters) == PARAMETERS + 1 and parameters[65535] == "_HASH_CHECK"
    assert mission == (0, 6) and result == 0
    assert vehicle.unanswered == []
    assert edit["rate_limited"] > 0


def test_a_rate_for_a_command_is_limited_with_a_warning(spawn):
    path = Path(spawn, "--max-rate", "COMMAND_ACK:1")
    acks = [mavlink.MAVLink_command_ack_message(400, result, 0, 0, 255, 190).pack(frames.sender())
            for result in range(3)]
    beat = next(frames.heartbeats(1))

    assert path.through(*acks, beat, count=2) == [acks[0], beat]
    assert ("--max-rate COMMAND_ACK:1 drops COMMAND_ACK frames over that rate: "
            "commands and their answers may get lost") in path.relay.stderr
