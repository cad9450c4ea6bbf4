# SPDX-License-Identifier: MIT
"""Every command reports a wrong command line: no word is ignored silently, and no control character reaches the
terminal."""
import json
import os
import pathlib
import re
import signal

import pytest

import frames
import harness

pytestmark = pytest.mark.short

IN = "udpin://127.0.0.1:0"
OUT = "udpout://127.0.0.1:9"
ESCAPE = "a\x1b[31m\x7f\u009b"


@pytest.mark.parametrize("arguments", [
    [f"z{ESCAPE}"], ["listen", f"--z{ESCAPE}"], ["listen", f"{ESCAPE}.tlog"], ["listen", IN, "--only", ESCAPE],
    ["listen", IN, "--from", ESCAPE], ["listen", IN, "--csv", ESCAPE], ["listen", IN, "--count", ESCAPE],
    ["listen", IN, "--dialect", ESCAPE], ["replay", ESCAPE, "--to", OUT], ["record", IN, "-o", f"/nowhere/{ESCAPE}"],
    ["relay", IN, "--to", OUT, "--set", f"{ESCAPE}.x=1"], ["relay", IN, "--to", OUT, "--sign", ESCAPE],
    ["relay", IN, "--to", OUT, "--remap-system", ESCAPE], ["route", OUT, "--explain", ESCAPE],
    ["route", "--config", ESCAPE], ["route", OUT, "--name", ESCAPE], ["route", OUT, "--metrics", ESCAPE],
    ["check", ESCAPE], ["check", "--convert", ESCAPE], ["dialect", "check", ESCAPE], ["dialect", "show", ESCAPE],
    ["bench", "parse", ESCAPE], ["ctl", ESCAPE, "links"], ["stat", ESCAPE], ["shm", "stat", ESCAPE],
    ["shm", "read", ESCAPE], ["shm", "remove", ESCAPE], ["key", "new", f"/nowhere/{ESCAPE}"],
    [f"--{ESCAPE}", "listen"],
])
def test_control_characters_do_not_reach_the_terminal(run, arguments):
    done = run(*arguments)
    assert done.status in (1, 2, 3) and "a?[31m" in done.stderr, done
    assert re.search("[\x00-\x09\x0b-\x1f\x7f-\x9f]", done.stderr + done.stdout) is None, done


def test_control_characters_of_a_converted_file_do_not_reach_the_terminal(run, tmp_path):
    path = tmp_path / ESCAPE
    path.write_text(f"[General]\nLog = {ESCAPE}\n[Uart{ESCAPE}]\nDevice = {ESCAPE}\n")
    done = run("check", "--convert", path)
    assert "a?[31m" in done.stderr and re.search("[\x00-\x09\x0b-\x1f\x7f-\x9f]",
                                                 done.stderr + done.stdout) is None, done


@pytest.mark.parametrize("arguments, option", [
    (["listen", IN, "--for", ""], "--for"), (["listen", IN, "--count", ""], "--count"),
    (["listen", IN, "--csv", ""], "--csv"), (["listen", IN, "--only", ""], "--only"),
    (["listen", IN, "--from", ""], "--from"), (["record", IN, "-o", ""], "--output"),
    (["route", IN, "--for", ""], "--for"), (["route", IN, "--name", ""], "--name"),
    (["route", IN, "--metrics", ""], "--metrics"), (["route", IN, "--config", ""], "--config"),
    (["relay", IN, "--to", OUT, "--for", ""], "--for"), (["relay", IN, "--to", ""], "--to"),
    (["replay", "x.tlog", "--to", OUT, "--start", ""], "--start"),
    (["replay", "x.tlog", "--to", OUT, "--speed", ""], "--speed"),
])
def test_an_empty_value_is_wrong_use(run, arguments, option):
    done = run(*arguments)
    assert done.status == 2 and f"{option}: the value is empty" in done.stderr, done


@pytest.mark.parametrize("arguments",
                         [["--dialect", "x.xml", "listen", IN], ["--json", "listen", IN], ["-q", "route", IN]])
def test_an_option_before_the_command_is_explained(run, arguments):
    done = run(*arguments)
    command = next(word for word in arguments if word in ("listen", "route"))
    assert done.status == 2
    assert (f"'{arguments[0]}' comes before the command; options go after it: mavloom {command} ... "
            f"{arguments[0]}") in done.stderr


@pytest.mark.parametrize("arguments, said", [
    (["play", "x.tlog"], "unknown command 'play', did you mean 'replay'?"),
    (["listen", "00000012.BIN"], "ArduPilot's own log (DataFlash)"),
    (["replay", "x.tlog", OUT, "--speed", "2"],
     f"'{OUT}' is not expected here; to send to {OUT}, type mavloom replay x.tlog --to {OUT} --speed 2"),
    (["relay", "x.tlog", OUT],
     f"--to is required; to send to {OUT}, type mavloom relay x.tlog --to {OUT}"),
    (["relay", IN], "--to is required\n"),
    (["relay", "x.tlog", OUT, "--to"], "--to: 1 required ENDPOINT missing\n"),
    (["ctl", "takeoff", "10"], "the name of the simulator comes before it: mavloom ctl sim takeoff 10"),
    (["ctl", "links"], "the name of the router or simulator comes before it: mavloom ctl router links"),
    (["ctl", "sim"], "the action is missing: mavloom ctl sim ACTION, which is one of links, routes, "),
    (["ctl", "sim", "takeof", "10"], "there is no action 'takeof', did you mean 'takeoff'?"),
    (["ctl", "sim", "explode"], "there is no action 'explode'; there are links, routes, "),
    (["sim", "--vehicle", "copter"], "--vehicle: 'copter' is none of quad, plane, rover, did you mean 'quad'?"),
    (["listen", "udp:14550"], "type udpin://0.0.0.0:14550 to listen, udpout://HOST:14550 to send"),
    (["relay", IN, "--to", OUT, "--from", "1/x"], "--from: '1/x' is not SYS or SYS/COMP"),
])
def test_wrong_words_get_the_words_to_type(run, arguments, said):
    done = run(*arguments)
    assert done.status == 2 and said in done.stderr, done


def test_help_fits_into_a_terminal(run):
    whole = run("--help").stdout
    assert "mavloom help COMMAND" in whole
    for command in re.findall(r"^  ([a-z]+) {2}", whole.split("Subcommands:")[1], re.MULTILINE):
        lines = run("help", command, env={"COLUMNS": "90"}).stdout.splitlines()
        described = [line for line in lines if line.startswith(" " * 30)]
        assert max(map(len, described), default=0) <= 90 and max(map(len, lines)) <= 120, (command, lines)


def test_the_help_lists_every_scheme(run):
    listed = re.findall(r"^  (\w+)://", run("--help").stdout, re.MULTILINE)
    assert listed == ["udpin", "udpout", "udpbcast", "udpmcast", "tcpin", "tcpout", "wsin", "wsout", "serial", "shm",
                      "tlog"]


def test_help_is_a_command_too(run):
    assert run("help").stdout == run("--help").stdout != ""
    assert run("help", "relay").stdout == run("relay", "--help").stdout != ""


@pytest.mark.parametrize("command, has", [("route", True), ("relay", True), ("listen", False), ("check", False)])
def test_only_commands_that_log_more_list_verbose(run, command, has):
    assert ("--verbose" in run(command, "--help").stdout) == has
    assert run("check", "-v", "/dev/null").status == 0


def test_options_of_the_program_itself(run):
    assert run("--help", "listen").status == 0
    assert run("--version").status == 0
    assert run("--hepl").status == 2


def test_sign_link_id_states_what_it_needs_and_its_range(run):
    alone = run("relay", IN, "--to", OUT, "--sign-link-id", "3")
    assert alone.status == 2 and "--sign-link-id requires --sign" in alone.stderr
    far = run("relay", IN, "--to", OUT, "--sign", "x", "--sign-link-id", "300")
    assert far.status == 2 and re.search(r"--sign-link-id: .*300.*0.*255", far.stderr), far
    assert "0 to 255" in run("relay", "--help").stdout


@pytest.mark.parametrize("command, takes", [("ctl", False), ("stat", False), ("key", False), ("listen", True),
                                            ("check", True), ("dialect", True)])
def test_only_commands_that_read_messages_take_a_dialect(run, command, takes):
    assert ("--dialect" in run(command, "--help").stdout) == takes


@pytest.mark.parametrize("arguments", [["route", "--config", "/tmp"], ["check", "/tmp"], ["check", "--convert", "/tmp"],
                                       ["listen", IN, "--dialect", "/tmp"], ["replay", "/tmp", "--to", OUT],
                                       ["bench", "parse", "/tmp"]])
def test_a_folder_is_no_input_file(run, arguments):
    done = run(*arguments)
    assert done.status == 3, done


def test_an_include_that_is_missing_states_where_it_is_looked_for(run, tmp_path):
    path = tmp_path / "mine.xml"
    path.write_text("<mavlink>\n<include>commn.xml</include>\n</mavlink>")
    done = run("dialect", "check", path)
    assert done.status == 3
    assert (f"{path}:2: cannot include {tmp_path}/commn.xml: no such file; expected a file beside the including "
            "one, or the name of a public one, such as common.xml") in done.stderr
    path.write_text("<mavlink>\n<include>common.xml</include>\n</mavlink>")
    assert run("dialect", "check", path).status == 0


def test_one_is_singular(run, tmp_path):
    log = frames.write_tlog(tmp_path / "in.tlog", [(0, next(frames.heartbeats(1)))])
    with open(log, "ab") as damaged:
        damaged.write(b"x")
    replayed = run("replay", log, "--to", f"tlog://{tmp_path}/out.tlog")
    assert "out.tlog: 1 frame, 29 bytes written" in replayed.stderr
    assert "in.tlog: 1 damaged place, 1 byte lost" in replayed.stderr
    listened = run("listen", log, "--stats")
    assert ": 1 frame, 0 lost" in listened.stdout and "total heard: 1 frame, 21 bytes" in listened.stdout
    assert "junk_bytes: 1 byte outside" in listened.stdout and "damaged_places: 1 damaged place in" in listened.stdout
    relayed = run("relay", log, "--to", f"tlog://{tmp_path}/out.tlog", "--only", "ATTITUDE")
    assert "1 frame in, " in relayed.stderr and "filtered: 1 frame that --only leaves out" in relayed.stderr
    assert re.search(r"\(1 frame, 21 bytes, median of 1 turn\)", run("bench", "parse", log, "--turns", "1").stdout)
    for text in (replayed.stderr, listened.stdout, relayed.stderr):
        assert re.search(r"\b1 (frame|byte|place|message|datagram)s\b", text) is None, text


@pytest.mark.parametrize("command", [["listen", "{log}"], ["replay", "{log}", "--to", "tlog://{tmp}/out.tlog"],
                                     ["record", "{log}", "-o", "{tmp}/out.tlog"],
                                     ["relay", "{log}", "--to", "tlog://{tmp}/out.tlog"]])
def test_an_empty_recording_is_reported(run, tmp_path, command):
    log = tmp_path / "empty.tlog"
    log.touch()
    done = run(*[word.format(log=log, tmp=tmp_path) for word in command])
    assert done.status == 0 and f"{log} holds no frames" in done.stderr, done
    quiet = run(*[word.format(log=log, tmp=tmp_path) for word in command], "-q")
    assert (quiet.status, quiet.stderr) == (0, "")


@pytest.mark.parametrize("command", [["replay", "{log}", "--to", "tlog://{out}"], ["record", "{log}", "-o", "{out}"],
                                     ["relay", "{log}", "--to", "tlog://{out}"],
                                     ["replay", "{good}", "--to", "tlog://{out}", "--to", "udpin://192.0.2.1:9"],
                                     ["relay", "{good}", "--to", "tlog://{out}", "--to", "udp://nowhere"]])
@pytest.mark.parametrize("content", [None, b"no recording at all, but text" * 50])
def test_a_destination_is_left_alone_when_the_input_is_wrong(run, tmp_path, command, content):
    log, out = tmp_path / "in.tlog", tmp_path / "out.tlog"
    good = frames.write_tlog(tmp_path / "good.tlog", list(enumerate(frames.heartbeats(3))))
    if content is not None:
        log.write_bytes(content)
    out.write_text("mine")
    done = run(*[word.format(log=log, out=out, good=good) for word in command], timeout=20)

    assert done.status in (1, 2, 3), done
    assert out.read_text() == "mine" and not (tmp_path / "out.tlog.1").exists()


@pytest.mark.parametrize("arguments", [["listen", IN], ["record", IN, "-o", "/dev/null"], ["relay", IN, "--to", OUT],
                                       ["relay", "tcpin://127.0.0.1:0", "--to", OUT]])
def test_listening_is_reported(spawn, arguments):
    process = spawn(*arguments)
    scheme = arguments[1].split(":")[0]
    process.wait_output(rf"^mavloom: [\d: -]{{19}} {scheme}://127\.0\.0\.1:[1-9]\d*: listening\b(?! on)", stream="err")


def test_a_smaller_receive_buffer_gets_a_hint(spawn):
    allowed = int(open("/proc/sys/net/core/rmem_max").read())
    process = spawn("listen", "udpin://127.0.0.1:0?rcvbuf=1G")
    granted = int(process.wait_output(r"listening \(receive buffer (\d+) bytes\)", stream="err")[1])
    done = process.stop()
    assert ("sysctl net.core.rmem_max=1073741824" in done.stderr) == (granted < 1 << 30), (allowed, done)
    enough = spawn("listen", "udpin://127.0.0.1:0?rcvbuf=64k")
    enough.wait_output("listening on", stream="err")
    assert "rmem_max" not in enough.stop().stderr


def test_an_option_of_a_subcommand_has_a_nearest_spelling(run):
    done = run("bench", "parse", frames.FLIGHT, "--tunrs", "3")

    assert done.status == 2 and "'--tunrs' is not expected here" in done.stderr and "--turns" in done.stderr
    assert "did you mean '--version'" in run("--versoin").stderr
    assert "--dialect" in run("dialect", "show", "ATTITUDE", "--dialet", "x.xml").stderr


def test_bench_shm_hands_every_record_to_every_reader(run):
    done = run("bench", "shm", "--readers", "3", "--records", "20000", "--bytes", "40", "--turns", "2", "--json")
    assert done.status == 0, done
    assert {**json.loads(done.stdout), "per_second": 0} == {"bench": "shm", "per_second": 0, "unit": "records",
                                                            "readers": 3, "bytes": 40, "records": 20000,
                                                            "turns": 2}


def takes_signals(process):
    caught = re.search(r"^SigCgt:\s*(\w+)$", pathlib.Path(f"/proc/{process.pid}/status").read_text(), re.MULTILINE)[1]
    return int(caught, 16) >> (signal.SIGINT - 1) & 1


@pytest.mark.parametrize("number, status", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
@pytest.mark.parametrize("words", [["parse", frames.FLIGHT, "--turns", "10000"],
                                   ["shm", "--records", "1000000", "--turns", "10000"]], ids=["parse", "shm"])
def test_a_signal_ends_a_benchmark_that_leaves_no_ring(spawn, words, number, status):
    bench = spawn("bench", *words)
    ring = pathlib.Path(f"/dev/shm/mavloom.bench-{bench.pid}")
    harness.wait_for(lambda: takes_signals(bench), what="its handlers")
    if words[0] == "shm":
        harness.wait_for(ring.exists, what="the ring")

    assert bench.stop(number).status == status
    assert not ring.exists()


@pytest.mark.parametrize("words", [["route", "--config"], ["check"], ["bench", "parse"]], ids=" ".join)
def test_a_signal_while_the_program_starts_is_taken(spawn, tmp_path, words):
    slow = tmp_path / "slow"
    os.mkfifo(slow)
    process = spawn(*words, slow)
    with open(slow, "wb"):  # waits until the program reads it

        assert process.stop().status == 130


@pytest.mark.parametrize("chunk, done", [("64k", 0), ("1", 0), ("0", 2), ("2G", 2), ("much", 2)])
def test_a_chunk_is_a_size(run, chunk, done):
    bench = run("bench", "parse", frames.FLIGHT, "--turns", "1", "--chunk", chunk)

    assert bench.status == done and ("--chunk" in bench.stderr) == (done != 0), bench


def test_benchmarks_take_the_options_of_every_command(run):
    done = run("bench", "parse", frames.FLIGHT, "--turns", "1", "-q", "--dialect", "/nowhere.xml")

    assert done.status == 3 and "/nowhere.xml" in done.stderr
