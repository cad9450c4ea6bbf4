# SPDX-License-Identifier: MIT
"""mavloom check --convert: mavlink-router's configuration becomes ours, which check takes and the router runs."""
import re

import pytest

import frames

pytestmark = pytest.mark.short


def converted(run, tmp_path, text):
    (tmp_path / "main.conf").write_text(text)
    done = run("check", "--convert", "main.conf", cwd=tmp_path)
    assert done.status == 0, done
    (tmp_path / "router.toml").write_text(done.stdout)
    checked = run("check", "router.toml", cwd=tmp_path)
    assert checked.status == 0, checked
    return done


def test_what_comes_out_routes(run, spawn, tmp_path, udp_port, tcp_port, udp_socket):
    ground, listening = udp_socket(), udp_port()
    done = converted(run, tmp_path, f"""\
# a companion computer
[General]
TcpServerPort = {tcp_port()}
ReportStats = true

[UdpEndpoint vehicle]
Mode = Server
Address = 127.0.0.1
Port = {listening}

[UdpEndpoint ground]
Mode = Normal
Address = 127.0.0.1
Port = {ground.getsockname()[1]}
BlockMsgIdOut = 253
""")
    assert re.fullmatch(r"main\.conf:4: \[General\] ReportStats: .*\n", done.stderr), done

    router = spawn("route", "--config", tmp_path / "router.toml", "--name", f"convert-{listening}")
    router.wait_output("ground: up")
    vehicle = udp_socket()
    beat, text = next(frames.heartbeats(1)), frames.statustext(b"not for the ground", sequence=1)
    attitude = frames.attitude(sequence=2)
    for frame in (beat, text, attitude):
        vehicle.sendto(frame, ("127.0.0.1", listening))

    received = b""
    while attitude not in received:
        received += ground.recv(65536)
    assert frames.split_frames(received) == [beat, attitude]


def test_a_file_that_is_malformed_names_its_line(run, tmp_path):
    (tmp_path / "main.conf").write_text("[General]\nTcpServerPort 5760\n")
    done = run("check", "--convert", "main.conf", cwd=tmp_path)

    assert (done.status, done.stdout) == (3, "")
    assert done.stderr.startswith("mavloom: main.conf:2: "), done


def test_a_file_that_is_not_there_is_bad_input(run, tmp_path):
    done = run("check", "--convert", tmp_path / "main.conf")

    assert done.status == 3, done


def test_our_own_file_is_not_mavlink_routers(run, tmp_path):
    (tmp_path / "router.toml").write_text('[[endpoint]]\nurl = "udpin://127.0.0.1:14550"\n')
    done = run("check", "--convert", "router.toml", cwd=tmp_path)

    assert done.status == 3, done
