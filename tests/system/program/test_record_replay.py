# SPDX-License-Identifier: MIT
"""mavloom record and replay: what is recorded is what came; what is replayed is what was recorded, at its pace."""
import contextlib
import fcntl
import json
import os
import pty
import re
import select
import shutil
import signal
import socket
import struct
import subprocess
import termios
import time

import pytest

import frames
import harness
from disks import SmallDisk

pytestmark = pytest.mark.short


def port_of(process):
    return int(process.wait_output(r"listening on port (\d+)", stream="err")[1])


def receive(sock, count):
    got = []
    while len(got) < count:
        got += frames.split_frames(sock.recv(65536))
    return got


def test_records_every_frame_with_its_bytes(spawn, tmp_path):
    log = tmp_path / "x.tlog"
    process = spawn("record", "udpin://127.0.0.1:0", "-o", log)
    address = ("127.0.0.1", port_of(process))
    sender, sent = harness.udp_socket(), list(frames.heartbeats(200))
    begin = time.time()
    for frame in sent:
        sender.sendto(frame, address)
    done = process.stop()

    assert done.status == 130 and "200 frames" in done.stderr
    records = frames.read_tlog(log)
    assert [frame for _, frame in records] == sent
    assert all(begin - 1 < time_us / 1e6 < time.time() + 1 for time_us, _ in records)


def test_pymavlink_reads_what_we_record(run, tmp_path):
    from pymavlink import mavutil
    log = tmp_path / "x.tlog"
    assert run("record", frames.FLIGHT, "-o", log, "--only", "ATTITUDE").status == 0

    reader = mavutil.mavlink_connection(str(log), dialect="common")
    rolls = []
    while message := reader.recv_match(type="ATTITUDE"):
        rolls.append(message.roll)
    assert len(rolls) == 5312


def test_an_existing_file_is_renamed(run, tmp_path):
    log = tmp_path / "x.tlog"
    for count in (3, 2, 1):
        assert run("record", frames.FLIGHT, "-o", log, "--count", count).status == 0

    assert len(frames.read_tlog(log)) == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["x.tlog", "x.tlog.1", "x.tlog.2"]


LOSSES = ["kernel_drop", "buffer_full", "lapped", "bad_records", "other_kinds", "copies", "echo", "crc_error",
          "junk_bytes", "damaged_places", "unknown_flags", "bad_signature", "wrong_peer", "bad_source",
          "stray_bytes", "peers_refused", "http_refused", "wrong_origin", "bad_handshake", "bad_message"]


def sums(done):
    """The one line of --json on stdout."""
    assert len(done.lines) == 1, done
    return json.loads(done.stdout)["stats"]


def test_the_sums_of_record_as_json(run, tmp_path):
    log = frames.write_tlog(tmp_path / "in.tlog", list(enumerate(frames.heartbeats(5))))
    stats = sums(run("record", log, "-o", tmp_path / "x.tlog", "--json", "-q"))

    assert list(stats) == ["destinations", "totals"]
    assert stats["destinations"] == [{"endpoint": str(tmp_path / "x.tlog"), "frames": 5, "bytes": 5 * 29,
                                      "not_written": 0, "files": 1}]
    assert list(stats["totals"]) == ["frames", "bytes", *LOSSES]
    assert (stats["totals"]["frames"], stats["totals"]["bytes"], stats["totals"]["crc_error"]) == (5, 5 * 21, 0)


def test_the_sums_of_replay_as_json(run, tmp_path):
    log = frames.write_tlog(tmp_path / "in.tlog", list(enumerate(frames.heartbeats(5))))
    log.write_bytes(b"damage" + log.read_bytes())
    station = harness.udp_socket()
    address = f"udpout://127.0.0.1:{station.getsockname()[1]}"
    done = run("replay", log, "--to", address, "--to", f"tlog://{tmp_path}/copy.tlog", "--json")

    stats = sums(done)
    assert done.status == 0 and "5 frames" in done.stderr
    assert stats["destinations"] == [
        {"endpoint": address, "frames": 5, "bytes": 5 * 21, "dropped": 0, "refused": 0, "not_sent": 0,
         "nobody_there": 0, "queued_bytes": 0},
        {"endpoint": f"tlog://{tmp_path}/copy.tlog".removeprefix("tlog://"), "frames": 5, "bytes": 5 * 29,
         "not_written": 0, "files": 1}]
    assert list(stats["totals"]) == ["frames", "bytes", *LOSSES]
    assert (stats["totals"]["frames"], stats["totals"]["junk_bytes"], stats["totals"]["damaged_places"]) == (5, 6, 1)


@pytest.mark.parametrize("command",
                         [["record", "{log}", "-o", "{tmp}/x.tlog"], ["replay", "{log}", "--to", "tlog://{tmp}/x.tlog"],
                                     ["relay", "{log}", "--to", "tlog://{tmp}/x.tlog"]])
def test_sums_that_cannot_be_written_are_an_error(program, tmp_path, command):
    log = frames.write_tlog(tmp_path / "in.tlog", list(enumerate(frames.heartbeats(5))))
    with open("/dev/full", "wb") as full:
        done = harness.subprocess.run([program, *[word.format(log=log, tmp=tmp_path) for word in command], "--json"],
                                      stdout=full, stderr=harness.subprocess.PIPE, text=True, timeout=60)
    assert done.returncode == 1 and "No space left" in done.stderr


def test_segments_of_a_second(run, tmp_path):
    """Two frames 1.1 s apart, with segments of 1 s, become two files."""
    log = frames.write_tlog(tmp_path / "in.tlog", [(1_700_000_000_000_000 + 1_100_000 * i, frame)
                                                   for i, frame in enumerate(frames.heartbeats(2))])
    out = tmp_path / "out"
    out.mkdir()
    for output in (f"{out}/x.tlog?rotate_every=1s", f"tlog://{out}/x.tlog?rotate_every=1s"):
        done = run("record", log, "-o", output)
        assert done.status == 0 and "2 frames, 58 bytes written in 2 files" in done.stderr, done

    assert sorted(path.name for path in out.iterdir()) == [
        "x-20231114T221320.000Z.tlog", "x-20231114T221320.000Z_2.tlog", "x-20231114T221321.100Z.tlog",
        "x-20231114T221321.100Z_2.tlog"]
    assert all(len(frames.read_tlog(path)) == 1 for path in out.iterdir())


def test_live_frames_rotate_by_their_receive_time(spawn, wait_for, tmp_path):
    process = spawn("record", "udpin://127.0.0.1:0", "-o", f"{tmp_path}/x.tlog?rotate_every=1")
    address, sender = ("127.0.0.1", port_of(process)), harness.udp_socket()
    sequence = 0

    def two_files():
        nonlocal sequence
        sender.sendto(next(frames.heartbeats(1, sequence=sequence % 256)), address)
        sequence += 1
        return len(list(tmp_path.glob("x-*.tlog"))) >= 2
    wait_for(two_files)
    assert process.stop().status == 130

    times = [[time_us for time_us, _ in frames.read_tlog(path)] for path in sorted(tmp_path.iterdir())]
    assert sum(map(len, times)) == sequence
    assert times[1][0] - times[0][0] >= 1_000_000 > times[0][-1] - times[0][0]


def test_segments_by_size_hold_every_frame(run, tmp_path):
    done = run("relay", frames.FLIGHT, "--to", f"tlog://{tmp_path}/x.tlog?rotate_bytes=100k")
    assert done.status == 0, done

    files = sorted(tmp_path.iterdir(), key=lambda path: frames.read_tlog(path)[0][0])
    assert len(files) > 10 and all(path.stat().st_size <= 100 * 1024 for path in files)
    assert b"".join(path.read_bytes() for path in files) == frames.FLIGHT.read_bytes()


@pytest.mark.parametrize("output, status, said", [
    ("{tmp}/missing/x.tlog?rotate_every=1h", 1, "cannot create files in"), ("/dev/null", 0, "bytes written"),
    ("tlog:///dev/null?rotate_every=1h", 2, "cannot be rotated"), ("{tmp}/x.tlog?rotate_every=1ms", 2, "rotate_every"),
    ("{tmp}/x.tlog?speed=2", 2, "speed"), ("udpout://127.0.0.1:9", 2, "record writes a .tlog file"),
])
def test_outputs_of_record(run, tmp_path, output, status, said):
    done = run("record", frames.FLIGHT, "--count", "3", "-o", output.format(tmp=tmp_path))

    assert done.status == status and said in done.stderr, done


def test_a_killed_recorder_leaves_whole_records(spawn, tmp_path, wait_for):
    log = tmp_path / "x.tlog"
    process = spawn("record", "udpin://127.0.0.1:0", "-o", log)
    address = ("127.0.0.1", port_of(process))
    sender = harness.udp_socket()
    for frame in frames.heartbeats(100):
        sender.sendto(frame, address)
    wait_for(lambda: log.exists() and log.stat().st_size == 100 * 29, what="the records to be written")
    process.send(signal.SIGKILL)

    assert len(frames.read_tlog(log)) == 100


def test_a_full_disk_is_an_error(run):
    done = run("record", frames.FLIGHT, "-o", "/dev/full")

    assert done.status == 1
    assert "No space left" in done.stderr


def test_a_recording_waits_for_room_on_a_full_disk(spawn, udp_socket, tmp_path, wait_for):
    """Nothing is lost: what the disk has no room for waits in the receiver's buffer."""
    disk = SmallDisk(tmp_path)
    with contextlib.closing(disk):
        log = tmp_path / "x.tlog"
        process = spawn("record", "udpin://127.0.0.1:0", "-o", log, "--json")
        address = ("127.0.0.1", int(process.wait_output(r"listening on port (\d+)", stream="err")[1]))
        sender, sent = udp_socket(), []

        def send_more():
            for _ in range(50):
                sent.append(next(frames.heartbeats(1, sequence=len(sent) % 256)) if len(sent) % 2
                            else frames.attitude(len(sent), sequence=len(sent) % 256))
                sender.sendto(sent[-1], address)
            return "trying again" in process.stderr
        wait_for(send_more, what="the disk to be full")
        for _ in range(20):
            send_more()
        disk.free(process.pid)
        process.wait_output("records are written again", stream="err")
        done = process.stop()
        recorded = json.loads(done.stdout)["stats"]["destinations"][0]

        assert done.status == 130 and (recorded["frames"], recorded["not_written"]) == (len(sent), 0)
        assert [frame for _, frame in frames.read_tlog(log)] == sent
        assert done.stderr.count("trying again") == 1


@pytest.mark.parametrize("command", ["record udpin://127.0.0.1:0 -o", "relay udpin://127.0.0.1:0 --to"])
@pytest.mark.parametrize("how", ["deleted", "replaced", "rotated"])
def test_a_file_that_goes_is_reported_and_a_new_one_begins(spawn, udp_socket, tmp_path, wait_for, command, how):
    options = "?rotate_every=1h" if how == "rotated" else ""
    process = spawn(*command.split(), f"tlog://{tmp_path / 'x.tlog'}{options}")
    address = ("127.0.0.1", int(process.wait_output(r"listening on port (\d+)", stream="err")[1]))
    sender = udp_socket()

    def recorded(frame):
        sender.sendto(frame, address)
        return lambda: any(frame in path.read_bytes() for path in tmp_path.glob("x*.tlog"))
    wait_for(recorded(frames.attitude(1)), what="the first frame")
    first, = tmp_path.glob("x*.tlog")
    first.unlink()
    if how == "replaced":
        first.write_bytes(b"")
    process.wait_output(f"{first} was removed or replaced; a new file begins", stream="err")
    wait_for(recorded(frames.attitude(2)), what="the second frame in a new file")
    assert (tmp_path / "x_2.tlog").exists() == (how == "replaced")
    assert process.stop().status == 130


@pytest.mark.parametrize("options", ["", "?rotate_every=1h"])
def test_record_waits_for_the_folder_of_its_file(spawn, udp_socket, tmp_path, wait_for, options):
    folder = tmp_path / "folder"
    folder.mkdir()

    def recorded():
        return [frame for path in folder.glob("*.tlog") for _, frame in frames.read_tlog(path)]
    process = spawn("record", "udpin://127.0.0.1:0", "-o", f"tlog://{folder}/x.tlog{options}")
    address = ("127.0.0.1", int(process.wait_output(r"listening on port (\d+)", stream="err")[1]))
    sender = udp_socket()
    sender.sendto(frames.attitude(0), address)
    wait_for(recorded, what="the first frame")
    shutil.rmtree(folder)

    def send_more():
        sender.sendto(frames.attitude(1), address)
        return "No such file or directory; trying again" in process.stderr
    wait_for(send_more, what="the missing folder to be noticed")
    sender.sendto(frames.attitude(2), address)
    folder.mkdir()
    process.wait_output("records are written again", stream="err")
    # The frames before may have gone to the deleted file.
    wait_for(lambda: recorded()[-1:] == [frames.attitude(2)], what="the last frame")

    assert process.stop().status == 130


def test_a_recording_on_a_disk_that_stays_full_ends_when_it_is_asked_to(spawn, tmp_path):
    disk = SmallDisk(tmp_path)
    with contextlib.closing(disk):
        process = spawn("record", frames.FLIGHT, "-o", tmp_path / "x.tlog", "--json")
        process.wait_output("No space left on device; trying again", stream="err")
        done = process.stop()
        recorded = json.loads(done.stdout)["stats"]["destinations"][0]
        written = frames.read_tlog(tmp_path / "x.tlog")

        assert done.status == 1 and recorded["not_written"] > 0
        assert recorded["frames"] == len(written) and written == frames.read_tlog(frames.FLIGHT)[:len(written)]


@pytest.mark.parametrize("command",
                         ["record '{flight}' -o", "relay '{flight}' --to", "replay '{flight}' --speed max --to"])
def test_a_file_at_its_limit_keeps_whole_records_and_counts_no_others(program, tmp_path, command):
    log = tmp_path / "x.tlog"
    limited = f"ulimit -f 100; exec '{program}' {command.format(flight=frames.FLIGHT)} '{log}' --json"  # 100 KiB
    done = harness.subprocess.run(["bash", "-c", limited], capture_output=True, text=True, timeout=60)

    assert done.returncode == 1, done.stderr
    assert "too large" in done.stderr.lower()
    written = frames.read_tlog(log)
    assert written == frames.read_tlog(frames.FLIGHT)[:len(written)]
    recorded = json.loads(done.stdout)["stats"]["destinations"][0]
    assert (recorded["frames"], recorded["bytes"]) == (len(written), log.stat().st_size)
    assert recorded["not_written"] > 0
    assert f"{recorded['not_written']} frames not written" in done.stderr


@pytest.mark.parametrize("command", [["record", frames.FLIGHT, "-o", "tlog:///dev/full"],
                                     ["replay", frames.FLIGHT, "--to", "tlog:///dev/full", "--speed", "max"]],
                         ids=lambda c: c[0])
def test_every_frame_that_was_read_has_its_place_in_the_sums(run, command):
    done = run(*command, "--json", "-q")
    sums = json.loads(done.stdout)["stats"]
    destination = sums["destinations"][0]

    assert done.status == 1 and destination["not_written"] > 0
    assert sums["totals"]["frames"] == destination["frames"] + destination["not_written"]


@pytest.mark.parametrize("destination", ["x.tlog", "./x.tlog", "tlog://x.tlog"])
def test_a_recording_is_not_replayed_onto_itself(run, tmp_path, destination):
    (tmp_path / "x.tlog").write_bytes(frames.FLIGHT.read_bytes())
    done = run("replay", "x.tlog", "--to", destination, "--speed", "max", cwd=tmp_path)

    assert done.status == 2 and "the recording itself" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["x.tlog"]
    assert (tmp_path / "x.tlog").read_bytes() == frames.FLIGHT.read_bytes()


def test_a_recording_that_rotates_is_not_the_one_it_is_named_after(run, tmp_path):
    (tmp_path / "x.tlog").write_bytes(frames.FLIGHT.read_bytes())
    done = run("replay", "x.tlog", "--to", "x.tlog?rotate_bytes=100M", "--speed", "max", cwd=tmp_path)

    assert done.status == 0, done
    assert (tmp_path / "x.tlog").read_bytes() == frames.FLIGHT.read_bytes()


def test_a_start_behind_the_end_is_reported(run, tmp_path):
    done = run("replay", frames.FLIGHT, "--to", tmp_path / "x.tlog", "--speed", "max", "--start", "10h")
    other = run("replay", frames.FLIGHT, "--to", tmp_path / "y.tlog", "--speed", "max", "--start", "1s", "--only",
                "GPS2_RAW")

    assert done.status == 0 and "the recording ends before --start 10h" in done.stderr
    assert other.status == 0 and "the recording ends before" not in other.stderr


def test_frames_with_an_unknown_flag_are_left_out_and_named(run, tmp_path):
    records = frames.read_tlog(frames.FLIGHT)[:20]
    flagged = bytearray(records[7][1])
    flagged[2] |= 0x02  # in incompat_flags; no such flag is defined
    mavlink = frames.mavlink
    checksum = mavlink.x25crc(flagged[1:-2])
    checksum.accumulate(bytes([mavlink.mavlink_map[int.from_bytes(flagged[7:10], "little")].crc_extra]))
    flagged[-2:] = checksum.crc.to_bytes(2, "little")
    records[7] = (records[7][0], bytes(flagged))

    done = run("replay", frames.write_tlog(tmp_path / "in.tlog", records), "--to", tmp_path / "out.tlog", "--speed",
               "max")

    assert "in.tlog: 1 frame not sent: an unknown incompatibility flag" in done.stderr
    assert frames.read_tlog(tmp_path / "out.tlog") == records[:7] + records[8:]


def test_an_unwritable_place_is_an_error(run, tmp_path):
    done = run("record", frames.FLIGHT, "-o", tmp_path / "missing" / "x.tlog")

    assert done.status == 1
    assert "missing" in done.stderr


def test_replay_as_fast_as_possible_over_tcp_is_complete(spawn, tcp_port):
    port = tcp_port()
    with socket.create_server(("127.0.0.1", port)) as server:
        process = spawn("replay", frames.FLIGHT, "--to", f"tcpout://127.0.0.1:{port}", "--speed", "max")
        connection, _ = server.accept()
        got = b""
        while chunk := connection.recv(1 << 16):
            got += chunk

    assert process.wait().status == 0
    assert got == b"".join(frame for _, frame in frames.read_tlog(frames.FLIGHT))


def test_replay_keeps_the_recorded_pace(spawn, tmp_path):
    sent = list(frames.heartbeats(50))
    # 0.98 s
    log = frames.write_tlog(tmp_path / "x.tlog", [(1_000_000 + 20_000 * i, frame) for i, frame in enumerate(sent)])
    station = harness.udp_socket()
    begin = time.monotonic()
    process = spawn("replay", log, "--to", f"udpout://127.0.0.1:{station.getsockname()[1]}")

    assert receive(station, 50) == sent
    took = time.monotonic() - begin
    assert process.wait().status == 0
    assert took >= 0.98  # never early; how late depends on the machine


@pytest.mark.parametrize("speed, shortest", [("2", 0.49), ("0.5", 1.96)])
def test_replay_speed(spawn, tmp_path, speed, shortest):
    log = frames.write_tlog(tmp_path / "x.tlog", [(20_000 * i, frame) for i, frame in enumerate(frames.heartbeats(50))])
    station = harness.udp_socket()
    begin = time.monotonic()
    process = spawn("replay", log, "--speed", speed, "--to", f"udpout://127.0.0.1:{station.getsockname()[1]}")

    receive(station, 50)
    assert time.monotonic() - begin >= shortest
    assert process.wait().status == 0


@pytest.mark.parametrize("file, speed, slow", [("{log}?speed=max", "1", True), ("{log}?speed=1", "max", False),
                                               ("{log}?speed=max", None, False), ("{log}", None, True)])
def test_the_speed_on_the_command_line_is_the_one(run, tmp_path, file, speed, slow):
    step_us = 20_000 if slow else 50_000_000  # an hour at the recorded pace would show on any machine
    log = frames.write_tlog(tmp_path / "x.tlog",
                            [(step_us * i, frame) for i, frame in enumerate(frames.heartbeats(72))])
    begin = time.monotonic()
    done = run("replay", file.format(log=log), "--to", f"tlog://{tmp_path}/out.tlog",
               *(["--speed", speed] if speed else []))
    assert done.status == 0 and (not slow or time.monotonic() - begin >= 1.42)


@pytest.mark.parametrize("command", ["replay", "relay"])
def test_that_nobody_listened_is_reported(run, tmp_path, udp_port, command):
    log = frames.write_tlog(tmp_path / "in.tlog", list(enumerate(frames.heartbeats(3))))
    address = f"udpout://127.0.0.1:{udp_port()}?mtu=0"
    done = run(command, log, "--to", address, "--json")

    sent = sums(done)["destinations"][0]
    assert done.status == 4 and (sent["frames"], sent["refused"]) == (0, 3), done
    assert "3 frames refused: no program listens there, or the host cannot be reached" in done.stderr


@pytest.mark.parametrize("command", [["replay", "--no-wait"], ["replay"], ["relay"]], ids=" ".join)
def test_what_is_sent_to_nobody_is_status_4(run, tmp_path, tcp_port, command):
    """Nobody connects: without --no-wait a recording waits for somebody until the end."""
    log = frames.write_tlog(tmp_path / "in.tlog", list(enumerate(frames.heartbeats(3))))
    done = run(command[0], log, "--to", f"tcpin://127.0.0.1:{tcp_port()}", "--for", "300ms", *command[1:])

    assert done.status == 4, done


def test_a_relay_of_something_live_to_nobody_is_status_4(spawn, udp_socket, udp_port):
    relay = spawn("relay", "udpin://127.0.0.1:0", "--to", f"udpout://127.0.0.1:{udp_port()}", "--for", "2s")
    vehicle, port = udp_socket(), int(relay.wait_output(r"listening on port (\d+)", stream="err")[1])
    vehicle.sendto(next(frames.heartbeats(1)), ("127.0.0.1", port))

    assert relay.wait().status == 4


@pytest.mark.parametrize("source, to", [("udpin://0.0.0.0:{}", "udpout://127.0.0.1:{}"),
                                        ("udpin://127.0.0.1:{}", "udpout://localhost:{}"),
                                        ("udpin://[::]:{}", "udpout://[::1]:{}"),
                                        ("tcpin://127.0.0.1:{}", "tcpout://127.0.0.1:{}"),
                                        ("udpin://0.0.0.0:{}", "udpbcast://127.255.255.255:{}"),
                                        ("udpin://0.0.0.0:{}", "udpout://127.0.0.2:{}"),
                                        ("udpin://0.0.0.0:{}", f"udpout://{socket.gethostname()}:{{}}")])
def test_a_relay_onto_its_own_port_is_refused(run, udp_port, source, to):
    port = udp_port()
    done = run("relay", source.format(port), "--to", to.format(port), "--for", "1s")

    assert done.status == 2 and "every frame would loop forever" in done.stderr, done
    assert run("relay", source.format(port), "--to", "udpout://127.0.0.1:1", "--for", "100ms").status == 0


@pytest.mark.parametrize("source, to", [("udpin://0.0.0.0:{}", "udpout://[::1]:{}"),
                                        ("udpin://127.0.0.1:{}", "udpout://127.0.0.2:{}"),
                                        ("udpin://127.0.0.2:{}", "udpout://localhost:{}")])
def test_the_same_port_of_another_address_is_no_loop(run, udp_port, source, to):
    port = udp_port()
    assert run("relay", source.format(port), "--to", to.format(port), "--for", "100ms").status == 0


def test_replay_starts_later(spawn, tmp_path):
    log = frames.write_tlog(tmp_path / "x.tlog",
                            [(10_000_000 * (i + 1), frame) for i, frame in enumerate(frames.heartbeats(5))])
    station = harness.udp_socket()
    process = spawn("replay", log, "--start", "25s", "--speed", "max", "--to",
                    f"udpout://127.0.0.1:{station.getsockname()[1]}")

    assert [frame[4] for frame in receive(station, 2)] == [3, 4]
    assert "2 frames" in process.wait().stderr


def test_replay_waits_for_a_client(spawn, tmp_path):
    log = frames.write_tlog(tmp_path / "x.tlog", list(enumerate(frames.heartbeats(5))))
    process = spawn("replay", log, "--to", "tcpin://127.0.0.1:0")
    port = int(process.wait_output(r"on port (\d+)", stream="err")[1])
    with socket.create_connection(("127.0.0.1", port)) as client:
        got = b""
        while chunk := client.recv(4096):
            got += chunk

    assert frames.split_frames(got) == list(frames.heartbeats(5))
    assert process.wait().status == 0


def test_replay_of_a_pipe_is_refused_or_read(run, tmp_path):
    fifo = tmp_path / "x.tlog"
    os.mkfifo(fifo)
    writer = harness.subprocess.Popen(["bash", "-c", f"head -c 29000 '{frames.FLIGHT}' > '{fifo}'"])
    done = run("listen", fifo)
    writer.wait()

    assert done.status == 0
    assert len(done.lines) > 400


@pytest.mark.parametrize("command", [["listen", "{fifo}"], ["record", "{fifo}", "-o", "{tmp}/x.tlog"],
                                     ["relay", "{fifo}", "--to", "udpout://127.0.0.1:9"],
                                     ["replay", "{fifo}", "--to", "udpout://127.0.0.1:9"],
                                     ["record", "{log}", "-o", "{fifo}"], ["replay", "{log}", "--to", "tlog://{fifo}"],
                                     ["relay", "{log}", "--to", "tlog://{fifo}"]])
def test_interrupt_ends_the_wait_for_the_other_end_of_a_fifo(spawn, wait_for, tmp_path, command):
    fifo = tmp_path / "pipe.tlog"
    os.mkfifo(fifo)
    process = spawn(*[word.format(fifo=fifo, log=frames.FLIGHT, tmp=tmp_path) for word in command])

    def catches_interrupts():
        caught = re.search(r"^SigCgt:\s*(\w+)$", open(f"/proc/{process.pid}/status").read(), re.MULTILINE)
        return int(caught[1], 16) >> (signal.SIGINT - 1) & 1
    wait_for(catches_interrupts)
    # It waits in open() or in its loop, not on the way there: asleep.
    wait_for(lambda: open(f"/proc/{process.pid}/stat").read().split()[2] == "S")

    assert process.stop().status == 130


def test_a_fifo_beside_a_live_source(spawn, tmp_path):
    fifo = tmp_path / "pipe.tlog"
    os.mkfifo(fifo)
    process = spawn("listen", "udpin://127.0.0.1:0", fifo)
    address = ("127.0.0.1", port_of(process))
    harness.udp_socket().sendto(next(frames.heartbeats(1)), address)
    process.wait_output("HEARTBEAT", stream="out")
    with open(fifo, "wb") as writer:
        writer.write(bytes(8) + frames.attitude())
        writer.flush()
        process.wait_output("ATTITUDE", stream="out")

    assert process.stop().status == 130


def test_a_pipe_has_no_start_to_count_from(run, tmp_path):
    fifo = tmp_path / "pipe.tlog"
    os.mkfifo(fifo)
    done = run("replay", fifo, "--start", "1s", "--to", "udpout://127.0.0.1:9")

    assert done.status == 2 and "is a pipe" in done.stderr


@pytest.mark.parametrize("arguments, said", [
    (["udpin://127.0.0.1:0", "--to", "udpout://127.0.0.1:9"], ".tlog"), (["x.tlog"], "--to"),
    (["{log}", "--to", "udpout://0.0.0.0:9"], "0.0.0.0"),
    (["{log}", "--to", "udpout://127.0.0.1:9", "--speed", "fast"], "--speed"),
    (["{log}", "--to", "udpout://127.0.0.1:9", "--speed", "0"], "speed"),
])
def test_wrong_use(run, arguments, said):
    done = run("replay", *[argument.format(log=frames.FLIGHT) for argument in arguments])

    assert done.status == 2
    assert said in done.stderr


# ---- progress --------------------------------------------------------------------------------------------------------

def read_terminal(master):
    """All that was written to the terminal, until its other end is closed."""
    seen = b""
    with contextlib.suppress(OSError):
        while chunk := os.read(master, 4096):
            seen += chunk
    os.close(master)
    return seen.decode()


def on_terminal(program, *arguments, until=lambda seen: False, seconds=harness.DEFAULT_TIMEOUT_S):
    """Returns the text on stderr, a terminal of 100 columns. A signal ends the command when `until` holds for the text,
    or after some seconds."""
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 100, 0, 0))
    process = subprocess.Popen([program, *map(str, arguments)], stderr=slave, stdout=subprocess.DEVNULL,
                               env=harness.environment())
    os.close(slave)
    seen, end = "", time.monotonic() + seconds
    while not until(seen) and process.poll() is None and (left := end - time.monotonic()) > 0:
        if select.select([master], [], [], min(left, 0.1))[0]:
            with contextlib.suppress(OSError):  # the end of the program
                seen += os.read(master, 4096).decode()
    process.send_signal(signal.SIGINT)
    seen += read_terminal(master)
    process.wait(harness.DEFAULT_TIMEOUT_S)
    return seen


# The end is known: per cent, and the time left once a thousandth is done.
LINE = r"\[#*\.*\] +\d+ %  \d+ frames?  [\d.]+ k?B  00:0\d  \d+ frames/s  \d\d:\d\d left"


@pytest.mark.parametrize("command", ["replay", "relay", "record"])
def test_progress_is_shown_on_a_terminal_and_leaves_no_trace(program, udp_port, tmp_path, command):
    end = ("-o", tmp_path / "out.tlog") if command == "record" else ("--to", f"udpout://127.0.0.1:{udp_port()}")
    more = ("--no-wait",) if command == "replay" else ()
    seen = on_terminal(program, command, f"{frames.FLIGHT}?speed=1", *end, *more,
                       until=lambda seen: re.search(rf"\r{LINE} *\r", seen))
    lines = [line.strip() for line in re.findall(r"\r(\[[^\r\n]*)", seen)]
    assert lines and any(re.fullmatch(LINE, line) for line in lines), seen
    assert not any(re.search(r"[1-9]\d* frames?  0 B", line) for line in lines), seen
    assert re.search(r"\r +\r(?!\[)", seen), "the last line is erased"
    assert run_quiet(program, command, *end, *more) == ""


def run_quiet(program, command, *more):
    return on_terminal(program, command, f"{frames.FLIGHT}?speed=1", "-q", *more, seconds=0.8)


@pytest.mark.parametrize("command, limit, shown", [
    ("record", (), None), ("record", ("--for", "9s"), r"\[#*\.*\] +\d+ %.*0[0-9]:\d\d left"),
    ("record", ("--count", "900"), r"\[#*\.*\] +\d+ %"), ("relay", (), None),
    ("relay", ("--for", "9s"), r"\[#*\.*\] +\d+ %.*0[0-9]:\d\d left")])
def test_a_live_command_knows_its_end_by_its_limit(program, spawn, udp_port, tmp_path, command, limit, shown):
    port = udp_port()
    to = "-o" if command == "record" else "--to"
    spawn("sim", "--to", f"udpout://127.0.0.1:{port}", "--name", f"progress-{port}")
    counts = r"\d+ frames  [\d.]+ k?B  00:0\d  \d+ frames/s"
    seen = on_terminal(program, command, f"udpin://127.0.0.1:{port}", to, tmp_path / "live.tlog", *limit,
                       until=lambda seen: re.search(counts, seen) and (shown is None or re.search(shown, seen)))
    assert re.search(counts, seen), seen
    assert bool(re.search(r"\d %", seen)) == bool(shown) and (shown is None or re.search(shown, seen)), seen


def test_nothing_is_shown_off_a_terminal(run, spawn, udp_port):
    replay = spawn("replay", frames.FLIGHT, "--to", f"udpout://127.0.0.1:{udp_port()}", "--no-wait", "--for", "1s")
    assert "\r" not in replay.wait().stderr
