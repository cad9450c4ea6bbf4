# SPDX-License-Identifier: MIT
"""mavloom record and replay: what is recorded is what came; what is replayed is what was recorded, at its pace."""
import os
import signal
import socket
import time

import pytest

import frames
import harness

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


def test_a_file_at_its_limit_keeps_whole_records(program, tmp_path):
    log = tmp_path / "x.tlog"
    limited = f"ulimit -f 100; exec '{program}' record '{frames.FLIGHT}' -o '{log}'"  # 100 KiB
    done = harness.subprocess.run(["bash", "-c", limited], capture_output=True, text=True, timeout=60)

    assert done.returncode == 1, done.stderr
    assert "too large" in done.stderr.lower()
    assert [frame for _, frame in frames.read_tlog(log)] == [frame for _, frame in frames.read_tlog(frames.FLIGHT)][:len(frames.read_tlog(log))]


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
    log = frames.write_tlog(tmp_path / "x.tlog", [(1_000_000 + 20_000 * i, frame) for i, frame in enumerate(sent)])  # 0.98 s
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


def test_replay_starts_later(spawn, tmp_path):
    log = frames.write_tlog(tmp_path / "x.tlog", [(10_000_000 * (i + 1), frame) for i, frame in enumerate(frames.heartbeats(5))])
    station = harness.udp_socket()
    process = spawn("replay", log, "--start", "25s", "--speed", "max", "--to", f"udpout://127.0.0.1:{station.getsockname()[1]}")

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


@pytest.mark.parametrize("arguments, said", [
    (["udpin://127.0.0.1:0", "--to", "udpout://127.0.0.1:9"], ".tlog"), (["x.tlog"], "--to"),
    (["{log}", "--to", "udpout://0.0.0.0:9"], "0.0.0.0"), (["{log}", "--to", "udpout://127.0.0.1:9", "--speed", "fast"], "--speed"),
    (["{log}", "--to", "udpout://127.0.0.1:9", "--speed", "0"], "speed"),
])
def test_wrong_use(run, arguments, said):
    done = run("replay", *[argument.format(log=frames.FLIGHT) for argument in arguments])

    assert done.status == 2
    assert said in done.stderr
