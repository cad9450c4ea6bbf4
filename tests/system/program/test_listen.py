# SPDX-License-Identifier: MIT
"""mavloom listen: every message that the kernel delivered, in all forms, from all kinds of source."""
import contextlib
import csv
import json
import os
import pathlib
import pty
import random
import re
import resource
import select
import signal
import socket
import time
import tty

import pytest

import frames
import harness

pytestmark = pytest.mark.short


def port_of(process):
    return int(process.wait_output(r"listening on port (\d+)", stream="err")[1])


def json_lines(text):
    return [json.loads(line) for line in text.splitlines()]


def test_what_a_link_lost_is_summed_once_however_often_it_came_back(spawn):
    """Five bytes of noise on each of two connections of one tcpout link are ten in the totals."""
    port = harness.free_port(socket.SOCK_STREAM)
    with socket.create_server(("127.0.0.1", port)) as server:
        server.settimeout(harness.DEFAULT_TIMEOUT_S)
        process = spawn("listen", f"tcpout://127.0.0.1:{port}", "--json", "--stats")
        for turn in range(2):
            connection, _ = server.accept()
            with connection:
                connection.sendall(b"noise" + next(frames.heartbeats(1, sequence=turn)))
                harness.wait_for(lambda: len(process.stdout.splitlines()) > turn, what="the heartbeat")

    totals = json_lines(process.stop().stdout)[-1]["stats"]["totals"]
    assert (totals["frames"], totals["junk_bytes"]) == (2, 10)


def test_the_totals_count_web_pages_that_were_turned_away(spawn):
    process = spawn("listen", "tcpin://127.0.0.1:0", "--json", "--stats")
    with socket.create_connection(("127.0.0.1", port_of(process)), harness.DEFAULT_TIMEOUT_S) as page:
        page.sendall(b"POST / HTTP/1.1\r\n")
        assert page.recv(1) == b""

    assert json_lines(process.stop().stdout)[-1]["stats"]["totals"]["http_refused"] == 1


def test_prints_every_message_of_a_recording(run):
    done = run("listen", frames.FLIGHT)

    assert done.status == 0
    assert len(done.lines) == 40087  # the recording's README
    assert done.stderr == ""


def test_json_has_the_pinned_keys(run):
    first = json_lines(run("listen", frames.FLIGHT, "--json", "--count", "1").stdout)[0]

    assert list(first) == ["time_us", "link", "sys", "comp", "seq", "id", "name", "v", "signed", "fields"]
    time_us, frame = frames.read_tlog(frames.FLIGHT)[0]
    assert (first["time_us"], first["seq"], first["sys"], first["comp"]) == (time_us, frame[4], frame[5], frame[6])


def test_json_of_the_whole_flight_agrees_with_pymavlink(run):
    ours = json_lines(run("listen", frames.FLIGHT, "--json").stdout)
    records = frames.read_tlog(frames.FLIGHT)

    assert len(ours) == len(records)
    parser = frames.mavlink.MAVLink(None)
    compared = 0
    for line, (time_us, frame) in zip(ours, records):
        assert line["time_us"] == time_us
        message_id = int.from_bytes(frame[7:10], "little")
        assert line["id"] == message_id
        if line["name"] != "ATTITUDE":
            continue
        theirs = parser.decode(bytearray(frame))
        for name in ("roll", "pitch", "yaw", "rollspeed"):
            assert line["fields"][name] == pytest.approx(getattr(theirs, name), rel=1e-7)
        compared += 1
    assert compared == 5312  # the recording's table


def test_udp_loses_nothing_and_distinguishes_the_peers(spawn):
    process = spawn("listen", "udpin://127.0.0.1:0", "--json", "--count", "600")
    address = ("127.0.0.1", port_of(process))
    peers = [harness.udp_socket() for _ in range(3)]
    for batch in zip(*(frames.heartbeats(200, system=10 + i) for i in range(3))):
        for peer, frame in zip(peers, batch):
            peer.sendto(frame, address)

    lines = json_lines(process.wait().stdout)

    assert len(lines) == 600
    for i, peer in enumerate(peers):
        own = [line for line in lines if line["sys"] == 10 + i]
        assert [line["fields"]["custom_mode"] for line in own] == list(range(200))
        assert {line["link"] for line in own} == {own[0]["link"]} and str(peer.getsockname()[1]) in own[0]["link"]


def test_several_frames_in_one_datagram(spawn):
    process = spawn("listen", "udpin://127.0.0.1:0", "--json", "--count", "50")
    harness.udp_socket().sendto(b"".join(frames.heartbeats(50)), ("127.0.0.1", port_of(process)))

    assert [line["seq"] for line in json_lines(process.wait().stdout)] == list(range(50))


def test_tcp_in_takes_a_stream_cut_anywhere(spawn):
    process = spawn("listen", "tcpin://127.0.0.1:0", "--json", "--count", "30")
    stream = b"".join(frames.heartbeats(30))
    with socket.create_connection(("127.0.0.1", port_of(process))) as client:
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for at in range(0, len(stream), 7):
            client.sendall(stream[at:at + 7])
        done = process.wait()

    assert [line["seq"] for line in json_lines(done.stdout)] == list(range(30))


def test_tcp_out_connects_once_somebody_listens(spawn, tcp_port):
    port = tcp_port()
    process = spawn("listen", f"tcpout://127.0.0.1:{port}", "--json", "--count", "5")
    with socket.create_server(("127.0.0.1", port)) as server:
        connection, _ = server.accept()
        with connection:
            connection.sendall(b"".join(frames.heartbeats(5)))
            assert len(json_lines(process.wait().stdout)) == 5


def test_only_and_from(run, tmp_path):
    records = [(i, frame) for i, frame in enumerate([frames.attitude(system=1), frames.attitude(system=2),
                                                     *frames.heartbeats(1, system=2)])]
    log = frames.write_tlog(tmp_path / "x.tlog", records)

    assert len(run("listen", log, "--only", "ATTITUDE").lines) == 2
    assert len(run("listen", log, "--only", "30,HEARTBEAT", "--from", "2/1").lines) == 2
    assert len(run("listen", log, "--from", "2/7").lines) == 0


def test_csv(run):
    done = run("listen", frames.FLIGHT, "--csv", "ATTITUDE")
    rows = list(csv.DictReader(done.lines))

    assert len(rows) == 5312
    assert list(rows[0])[:6] == ["time_us", "link", "sys", "comp", "seq", "time_boot_ms"]
    assert float(rows[0]["roll"]) == pytest.approx(0.0025562597)


def test_csv_by_id(run):
    assert (run("listen", frames.FLIGHT, "--csv", "30").stdout
            == run("listen", frames.FLIGHT, "--csv", "ATTITUDE").stdout)
    unknown = run("listen", frames.FLIGHT, "--csv", "77777")
    assert unknown.status == 2 and "message 77777 has no definition" in unknown.stderr


def test_stats_as_json_agree_with_the_recordings_table(run):
    stats = json_lines(run("listen", frames.FLIGHT, "--json", "--stats").stdout)[-1]["stats"]

    vehicle = next(source for source in stats["sources"] if source["sys"] == 1)
    assert (vehicle["frames"], vehicle["lost"]) == (39974, 0)
    counts = {row["name"]: row["count"] for row in vehicle["messages"]}
    assert (counts["ATTITUDE"], counts["GPS_RAW_INT"], counts["EVENT"],
            counts["GNSS_INTEGRITY"]) == (5312, 531, 17, 106)
    rates = {row["name"]: row["rate_hz"] for row in vehicle["messages"]}
    assert rates["ATTITUDE"] == pytest.approx(49.06, abs=0.02)
    gaps = {row["name"]: row["gap_max_ms"] for row in vehicle["messages"]}
    assert gaps["ATTITUDE"] == pytest.approx(70.85, abs=0.01)
    rows = {row["name"]: row for row in vehicle["messages"]}  # tests/unit/observe/latest_table_test.cpp
    assert rows["ATTITUDE"]["share"] == pytest.approx(0.115799, abs=1e-6)
    assert rows["ATTITUDE"]["jitter_ms"] == pytest.approx(0.124, abs=0.001)
    assert (rows["ATTITUDE"]["instance"], rows["BATTERY_STATUS"]["instance"]) == (None, 0)
    assert stats["totals"]["frames"] == 40087


def test_stats_table_for_people(run):
    done = run("listen", frames.FLIGHT, "--stats", "--only", "HEARTBEAT")

    assert "39974 frames, 0 lost (0.00 %)" in done.stdout
    assert any(line.split()[:2] == ["HEARTBEAT", "106"] for line in done.lines)


def test_stats_only_prints_the_table_alone(run):
    done = run("listen", frames.FLIGHT, "--stats-only")
    table = run("listen", frames.FLIGHT, "--stats").lines[40087:]  # the recording's README
    assert done.status == 0 and done.lines == table and len(table) < 60

    only = run("listen", frames.FLIGHT, "--stats-only", "--csv", "ATTITUDE")
    assert [line.split()[0] for line in only.lines if " Hz " not in line and "frames" not in line and line] \
        == ["ATTITUDE"]
    assert only.stderr == ""

    one = json_lines(run("listen", frames.FLIGHT, "--stats-only", "--json").stdout)
    assert one == json_lines(run("listen", frames.FLIGHT, "--stats", "--json").stdout)[-1:]


def test_junk_on_a_stream_is_counted_although_its_run_has_not_ended(spawn):
    """Issue 30: only whole blocks of 4,096 bytes were counted."""
    port = harness.free_port(socket.SOCK_STREAM)
    with socket.create_server(("127.0.0.1", port)) as server:
        process = spawn("listen", f"tcpout://127.0.0.1:{port}", "--stats", "--json")
        connection, _ = server.accept()
        with connection:
            connection.sendall(next(frames.heartbeats(1)) + b"login: ")
            process.wait_output('"HEARTBEAT"')  # the junk arrived with it
            totals = json_lines(process.stop().stdout)[-1]["stats"]["totals"]

    assert (totals["frames"], totals["junk_bytes"]) == (1, 7)


def test_loss_duplicates_and_reordering_are_distinguished(run, tmp_path):
    all_frames = list(frames.heartbeats(100))
    order = [f for i, f in enumerate(all_frames) if i not in (10, 11, 50)]  # three lost
    order.insert(20, order[19])  # one twice
    order[30], order[31] = order[31], order[30]  # two swapped
    log = frames.write_tlog(tmp_path / "x.tlog", list(enumerate(order)))

    source = json_lines(run("listen", log, "--json", "--stats").stdout)[-1]["stats"]["sources"][0]

    assert (source["lost"], source["duplicate"], source["late"], source["resync"]) == (3, 1, 1, 0)


def test_unknown_id_prints_its_payload(run, tmp_path):
    from pymavlink.generator.mavcrc import x25crc
    frame = bytes([0xFD, 3, 0, 0, 9, 5, 6]) + (9_999_999).to_bytes(3, "little") + b"\x01\x02\x03"
    checksum = x25crc(frame[1:] + b"\x4d").crc
    log = frames.write_tlog(tmp_path / "x.tlog",
                            [(1, next(frames.heartbeats(1))), (2, frame + checksum.to_bytes(2, "little"))])

    line = json_lines(run("listen", log, "--json").stdout)[1]

    assert line == {"time_us": 2, "link": line["link"], "sys": 5, "comp": 6, "seq": 9, "id": 9_999_999, "name": None,
                    "v": 2, "signed": False, "payload_hex": "010203"}


@pytest.mark.parametrize("number, status", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_ends_cleanly_with_the_table(spawn, number, status):
    process = spawn("listen", "udpin://127.0.0.1:0", "--stats")
    harness.udp_socket().sendto(frames.attitude(), ("127.0.0.1", port_of(process)))
    process.wait_output("ATTITUDE", stream="out")

    done = process.stop(number)

    assert done.status == status
    assert "1 frame, 0 lost" in done.stdout


def test_a_signal_that_the_caller_ignores_stays_ignored(spawn, tmp_path):
    """As under nohup; `bench` handles no signals of its own."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    process = spawn("bench", "parse", pipe, preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))

    def opened():
        with contextlib.suppress(OSError):  # until the program reads
            return os.open(pipe, os.O_WRONLY | os.O_NONBLOCK)
    writing = harness.wait_for(opened, what="the program to open the pipe")
    process.send(signal.SIGHUP)
    os.set_blocking(writing, True)
    with open(writing, "wb") as stream:
        stream.write(pathlib.Path(frames.FLIGHT).read_bytes())
    assert process.wait().status == 0


def test_what_arrived_before_the_signal_is_printed(spawn):
    process = spawn("listen", "udpin://127.0.0.1:0", "--json")
    address = ("127.0.0.1", port_of(process))
    sender = harness.udp_socket()
    for frame in frames.heartbeats(200):
        sender.sendto(frame, address)

    done = process.stop()

    assert (done.status, len(done.lines)) == (130, 200), done.stderr


def test_for_bounds_the_time(run):
    begin = time.monotonic()
    done = run("listen", "udpin://127.0.0.1:0", "--for", "300ms")

    assert done.status == 0
    assert time.monotonic() - begin >= 0.3


def test_a_reader_that_leaves_is_no_error(spawn):
    process = spawn("listen", frames.FLIGHT, stdout=harness.subprocess.PIPE)
    process.process.stdout.read(1000)
    process.process.stdout.close()

    done = process.wait()

    assert (done.status, done.stderr) == (0, "")


def test_full_disk_is_an_error(program):
    with open("/dev/full", "w") as full:
        done = harness.subprocess.run([program, "listen", frames.FLIGHT], stdout=full, stderr=harness.subprocess.PIPE,
                                      text=True, timeout=60)

    assert done.returncode == 1
    assert "standard output" in done.stderr and "No space left" in done.stderr


def test_a_file_and_a_terminal_get_what_a_pipe_gets(run, spawn, program, tmp_path):
    """Each is written to in its own way: whole, as much as fits, and page by page."""
    piped = run("listen", frames.FLIGHT, "--json", text=False).stdout
    with open(tmp_path / "out.json", "wb") as file:
        harness.subprocess.run([program, "listen", frames.FLIGHT, "--json"], stdout=file,
                               timeout=harness.DEFAULT_TIMEOUT_S, check=True)
    ours, terminal = pty.openpty()
    tty.setraw(terminal)
    process = spawn("listen", frames.FLIGHT, "--json", stdout=terminal)
    os.close(terminal)
    shown = bytearray()
    while len(shown) < len(piped):
        shown += os.read(ours, 1 << 16)
    process.wait()
    os.close(ours)

    assert (tmp_path / "out.json").read_bytes() == piped
    same = len(os.path.commonprefix([bytes(shown), piped]))
    assert shown[same:same + 200] == piped[same:same + 200]


def test_a_stalled_pipe_loses_nothing_below_the_buffer_bound(spawn):
    read_end, write_end = os.pipe()
    process = spawn("listen", "udpin://127.0.0.1:0", "--json", "--buffer", "8M", stdout=write_end)
    os.close(write_end)
    address = ("127.0.0.1", port_of(process))
    sender = harness.udp_socket()
    count = 20_000  # 20,000 x 40 bytes in the buffer; the pipe holds 64 KiB
    for i, frame in enumerate(frames.heartbeats(count)):
        sender.sendto(frame, address)
        if i % 100 == 0:
            time.sleep(0.005)  # a pace that the kernel's buffer takes, not a verdict
    sender.sendto(frames.attitude(sequence=count % 256), address)
    text = b""
    while b"ATTITUDE" not in text[-1000:] or not text.endswith(b"\n"):
        assert select.select([read_end], [], [], harness.DEFAULT_TIMEOUT_S)[0], "the rest was lost"
        text += os.read(read_end, 1 << 16)
    process.send(signal.SIGINT)
    os.close(read_end)

    lines = json_lines(text.decode())
    assert [line["fields"]["custom_mode"] for line in lines[:-1]] == list(range(count))
    assert process.wait().status == 130


def test_beyond_the_bound_the_loss_has_a_name(spawn):
    read_end, write_end = os.pipe()
    process = spawn("listen", "udpin://127.0.0.1:0", "--json", "--buffer", "64k", stdout=write_end)
    os.close(write_end)
    address = ("127.0.0.1", port_of(process))
    sender = harness.udp_socket()
    for frame in frames.heartbeats(20_000):
        sender.sendto(frame, address)
    process.send(signal.SIGINT)
    text = b""
    while chunk := os.read(read_end, 1 << 16):
        text += chunk
    done = process.wait()
    os.close(read_end)

    dropped = sum(int(line.split()[2]) for line in done.stderr.splitlines() if "buffer_full:" in line
                  or "kernel_drop:" in line)
    assert done.status == 130
    assert len(text.splitlines()) + dropped == 20_000


@pytest.mark.parametrize("junk", [random.Random(4).randbytes(60_000), b"\xfd" * 60_000, b"\xfe" * 60_000,
                                  bytes(60_000)], ids=["random", "fd", "fe", "zeros"])
def test_garbage_is_counted_and_harms_nobody(spawn, junk):
    process = spawn("listen", "udpin://127.0.0.1:0", "--json", "--stats", "--count", "2")
    address = ("127.0.0.1", port_of(process))
    good, bad = harness.udp_socket(), harness.udp_socket()
    good.sendto(frames.attitude(sequence=0), address)
    for _ in range(20):
        bad.sendto(junk, address)
    good.sendto(frames.attitude(sequence=1), address)

    lines = json_lines(process.wait().stdout)

    assert [line["name"] for line in lines[:2]] == ["ATTITUDE"] * 2
    assert lines[-1]["stats"]["totals"]["stray_bytes"] == 20 * 60_000


@pytest.mark.skipif("san" in harness.program_path().parent.parent.name,
                    reason="a sanitizer keeps freed memory: the resident size says nothing there")
def test_memory_stays_flat_under_peers_and_garbage_from_many_ports(spawn):
    process = spawn("listen", "udpin://127.0.0.1:0", "--json")
    address = ("127.0.0.1", port_of(process))
    steady = harness.udp_socket()

    def resident_kib():
        return int(next(line for line in open(f"/proc/{process.pid}/status") if line.startswith("VmRSS")).split()[1])

    def round_of_strangers(number):
        for _ in range(400):  # more than max_peers
            stranger = harness.udp_socket()
            stranger.sendto(os.urandom(1000), address)
            stranger.sendto(frames.attitude(system=9), address)
        steady.sendto(frames.statustext(f"round {number}".encode()), address)
        process.wait_output(f"round {number}", stream="out")
        return resident_kib()
    first = round_of_strangers(0)
    later = [round_of_strangers(number) for number in range(1, 4)]

    assert process.stop().status == 130
    assert later[-1] - first < 4096


@pytest.mark.parametrize("form", [[], ["--json"]], ids=["text", "json"])
def test_ctrl_c_ends_it_although_nobody_ever_reads(spawn, form):
    read_end, write_end = os.pipe()
    process = spawn("listen", frames.FLIGHT, "udpin://127.0.0.1:0", "--stats", *form, stdout=write_end)
    os.close(write_end)
    harness.wait_for(lambda: len(select.select([read_end], [], [], 0)[0]) == 1, what="the pipe to fill")
    done = process.stop(timeout=20)
    shown = b""
    while chunk := os.read(read_end, 1 << 16):
        shown += chunk
    os.close(read_end)
    unprinted = int(re.search(r"(\d+) messages received but not printed", done.stderr)[1])
    if form:
        totals = json.loads(next(line for line in done.stderr.splitlines() if line.startswith("{")))["stats"]["totals"]
        assert totals["unprinted"] == unprinted > 0
        heard = totals["frames"]
    else:
        heard = int(re.search(r"total heard: (\d+) frames", done.stderr)[1])

    assert done.status == 130 and "ATTITUDE" in done.stderr
    assert shown.endswith(b"\n") and shown.count(b"\n") + unprinted == heard


@pytest.mark.parametrize("end, status", [(["--for", "6s"], 0), ([], 130)], ids=["for", "interrupt"])
def test_the_end_waits_for_a_reader_that_takes_what_is_left(spawn, end, status):
    read_end, write_end = os.pipe()
    process = spawn("listen", "udpin://127.0.0.1:0", "--json", "--stats", *end, stdout=write_end)
    os.close(write_end)
    tasks = f"/proc/{process.pid}/task"
    address, sender = ("127.0.0.1", port_of(process)), harness.udp_socket()
    sender.sendto(frames.attitude(), address)
    harness.wait_for(lambda: len(select.select([read_end], [], [], 0)[0]) == 1, what="the first message")
    threads = len(os.listdir(tasks))
    for frame in frames.heartbeats(5_000):
        sender.sendto(frame, address)
    if end:  # nothing is read before
        harness.wait_for(lambda: len(os.listdir(tasks)) < threads, what="the end of receiving")
    else:
        process.send(signal.SIGINT)
    text = b""
    while chunk := os.read(read_end, 4096):
        text += chunk
        time.sleep(0.01)  # 400 kB/s: slower than it is written
    os.close(read_end)
    done = process.wait()
    assert done.status == status, done.stderr
    lines = json_lines(text.decode())
    totals = lines[-1]["stats"]["totals"]

    assert len(lines) - 1 == totals["frames"] == 5_001 - totals["kernel_drop"] and totals["unprinted"] == 0


def test_a_recording_of_nothing_but_damage_leaves_room_for_the_rest(spawn):
    process = spawn("listen", "tlog:///dev/zero", "udpin://127.0.0.1:0", "--json")
    address, sender = ("127.0.0.1", port_of(process)), harness.udp_socket()
    sender.sendto(frames.attitude(), address)
    process.wait_output("ATTITUDE", stream="out")

    assert process.stop().status == 130


def test_the_end_comes_although_a_recording_is_nothing_but_damage(run):
    assert run("listen", "tlog:///dev/zero", "--for", "200ms").status == 0


@pytest.mark.parametrize("arguments, status, said", [
    (["--only", "ATITUDE"], 2, "did you mean 'ATTITUDE'"),
    (["--csv", "ATTITUD"], 2, "did you mean 'ATTITUDE'"),
    (["--from", "1/x"], 2, "as in 1/1"),
    (["--for", "soon"], 2, "--for"),
    (["--buffer", "much"], 2, "--buffer"),
    (["--nonsense"], 2, "--help"),
    (["--jsn"], 2, "did you mean '--json'"),
    (["--count", "-1"], 2, "--count"),
    (["--count", "99999999999999999999"], 2, "--count"),
    (["--buffer", "1"], 2, "64k"),
])
def test_wrong_use_states_what_to_type(run, arguments, status, said):
    done = run("listen", frames.FLIGHT, *arguments)

    assert done.status == status
    assert said in done.stderr and done.stdout == ""


@pytest.mark.parametrize("source, said", [
    ("127.0.0.1:14550", "udp"), ("udp://:14540", "udpin://"), ("udpin://127.0.0.1:70000", "65535"),
    ("udpin://127.0.0.1", "port"), ("udpin://127.0.0.1:0?idel=2", "did you mean 'idle'"),
])
def test_wrong_endpoints_say_the_spelling_to_type(run, source, said):
    done = run("listen", source)

    assert done.status == 2
    assert said in done.stderr


@pytest.mark.parametrize("command",
                         ["listen {log} --count 3", "relay {log} --to udpout://127.0.0.1:9", "listen missing.tlog"])
def test_a_stderr_that_takes_nothing_harms_nobody(program, command):
    arguments = command.format(log=frames.FLIGHT).split()
    with open("/dev/full", "w") as full:
        full_disk = harness.subprocess.run([program, *arguments], stderr=full, stdout=harness.subprocess.DEVNULL,
                                           timeout=60)
    closed = harness.subprocess.run(["bash", "-c", 'exec "$0" "$@" 2>&- >/dev/null', program, *arguments], timeout=60)

    assert full_disk.returncode in (0, 3, 4) and closed.returncode == full_disk.returncode


@pytest.mark.parametrize("command", ["listen {log} --json", "dialect list",
                                     "replay {log} --speed max --to tlog:///dev/null --json"])
def test_a_closed_stdout_is_an_error(program, command):
    arguments = command.format(log=frames.FLIGHT).split()
    done = harness.subprocess.run(["bash", "-c", 'exec "$0" "$@" >&-', program, *arguments], capture_output=True,
                                  text=True, timeout=60)

    assert done.returncode == 1 and "cannot write" in done.stderr


def test_unsigned_frames_of_strangers_are_bad_signatures(run, spawn, tmp_path, udp_socket):
    key = tmp_path / "x.key"
    assert run("key", "new", key).status == 0
    process = spawn("listen", f"udpin://127.0.0.1:0?verify={key}", "--json", "--stats", "--count", "1")
    port, sender = port_of(process), udp_socket()
    for frame in frames.heartbeats(3):
        sender.sendto(frame, ("127.0.0.1", port))
    relayed = run("relay", frames.FLIGHT, "--only", "ATTITUDE", "--sign", key, "--to", f"udpout://127.0.0.1:{port}")
    assert "bytes sent" in relayed.stderr, relayed
    totals = json_lines(process.wait().stdout)[-1]["stats"]["totals"]

    assert (totals["bad_signature"], totals["stray_bytes"]) == (3, 3 * 21)


def test_a_file_that_is_no_recording(run):
    done = run("listen", f"tlog://{harness.ROOT / 'docs/pictures/top.png'}")

    assert done.status == 3
    assert "holds no record" in done.stderr


def test_no_source_is_wrong_use(run):
    assert run("listen").status == 2


def test_a_port_in_use_is_an_error_at_once(run):
    with harness.udp_socket() as taken:
        done = run("listen", f"udpin://127.0.0.1:{taken.getsockname()[1]}")

    assert done.status == 1
    assert re.search(r"in use by \S+ \(process \d+\); end that program, or choose another port$", done.stderr.strip())


def test_a_missing_recording(run):
    done = run("listen", "nowhere.tlog")

    assert done.status == 3
    assert "nowhere.tlog" in done.stderr


def test_a_damaged_recording_continues_behind_the_damage(run, tmp_path):
    data = bytearray(frames.FLIGHT.read_bytes()[:100_000])
    data[50_000:50_200] = os.urandom(200)
    log = tmp_path / "damaged.tlog"
    log.write_bytes(data)
    whole = tmp_path / "whole.tlog"
    whole.write_bytes(frames.FLIGHT.read_bytes()[:100_000])

    damaged, intact = run("listen", log, "--json"), run("listen", whole, "--json")

    assert damaged.status == 0
    assert len(intact.lines) - 8 <= len(damaged.lines) < len(intact.lines)
    assert "damaged" in damaged.stderr


def test_help_teaches(run):
    done = run("listen", "--help")

    assert done.status == 0 and done.stderr == ""
    for word in ("--json", "--csv", "--only", "--from", "--count", "--for", "--buffer", "--stats", "Examples"):
        assert word in done.stdout


@pytest.mark.long
def test_two_gigabytes_of_zeros(program, tmp_path):
    log = tmp_path / "zeros.tlog"
    with open(log, "wb") as out:
        out.truncate(2 << 30)
    done = harness.subprocess.run([program, "listen", log], capture_output=True, text=True, timeout=600)

    assert done.returncode == 3
    assert str(2 << 30) in done.stderr and "holds no record" in done.stderr
    assert resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss < 256 * 1024


def test_damage_does_not_change_the_order_of_recordings(run, tmp_path):
    records = frames.read_tlog(frames.FLIGHT)[:2000]
    first, second = records[::2], records[1::2]
    whole = frames.write_tlog(tmp_path / "a.tlog", first).read_bytes()
    middle = len(frames.write_tlog(tmp_path / "half.tlog", first[:500]).read_bytes())
    (tmp_path / "a.tlog").write_bytes(whole[:middle] + b"\x00\xfd" * 500_000 + whole[middle:])
    frames.write_tlog(tmp_path / "b.tlog", second)

    times = [line["time_us"]
             for line in json_lines(run("listen", tmp_path / "a.tlog", tmp_path / "b.tlog", "--json").stdout)]

    assert times == [time_us for time_us, _ in records]


def test_several_recordings_are_merged_by_time_at_full_speed(run, tmp_path):
    """Each keeps its own order, also where its clock was set back."""
    def recording(name, system, times):
        return frames.write_tlog(tmp_path / name,
                                 [(1_700_000_000_000_000 + t, next(frames.heartbeats(1, system=system, sequence=i)))
                                  for i, t in enumerate(times)])
    logs = [recording("a.tlog", 1, [0, 30, 60, 61]), recording("b.tlog", 2, [10, 20, 70]),
            recording("c.tlog", 3, [40, 15, 65])]

    heard = [(line["sys"], line["time_us"] - 1_700_000_000_000_000)
             for line in json_lines(run("listen", *logs, "--json").stdout)]

    assert heard == [(1, 0), (2, 10), (2, 20), (1, 30), (3, 40), (3, 15), (1, 60), (1, 61), (3, 65), (2, 70)]


@pytest.mark.parametrize("name", ["FLIGHT.TLOG", "x.tlog.1", "Flight.Tlog.12"])
def test_a_recording_is_known_by_its_name(run, tmp_path, name):
    log = frames.write_tlog(tmp_path / name, list(enumerate(frames.heartbeats(3))))

    assert len(json_lines(run("listen", log, "--json").stdout)) == 3
    done = run("replay", log, "--to", f"tlog://{tmp_path}/out.tlog", "--speed", "max")
    assert done.status == 0 and (tmp_path / "out.tlog").read_bytes() == log.read_bytes()


def test_one_message_as_rows_takes_no_other_names(run):
    done = run("listen", frames.FLIGHT, "--csv", "ATTITUDE", "--only", "HEARTBEAT")

    assert done.status == 2 and "--csv ATTITUDE prints that one message; omit --only" in done.stderr
