# SPDX-License-Identifier: MIT
"""Peers of the simulator for PX4 that are no PX4, or the wrong one."""
import contextlib
import re
import socket
import urllib.request

import harness
from frames import mavlink

SHORT = {"arm_at": 0.5, "height": 2.0, "hold": 0.2}


def station_heartbeat():
    station = mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID
    return mavlink.MAVLink_heartbeat_message(*station, 0, 0, 0, 3).pack(mavlink.MAVLink(None, 255, 190))


def read_to_the_end(link):
    while link.recv(65536):
        pass


def test_a_ground_station_is_disconnected_and_the_port_stays_open(hil, stand_in):
    simulator = hil("--speed", "max")
    with socket.create_connection(("127.0.0.1", simulator.hil_port)) as link:
        link.sendall(station_heartbeat())
        read_to_the_end(link)
    simulator.process.wait_output("its HEARTBEAT is not that of PX4")
    assert stand_in(simulator.hil_port, **SHORT).said("report")["time_errors"] == 0


def test_a_silent_peer_gives_its_place_to_an_autopilot(hil, stand_in):
    simulator = hil("--speed", "max")
    with socket.create_connection(("127.0.0.1", simulator.hil_port)) as link:
        link.sendall(b"hello\n")
        simulator.process.wait_output("has sent 6 bytes that are no MAVLink")
        pilot = stand_in(simulator.hil_port, **SHORT)
        read_to_the_end(link)
        assert pilot.said("report")["time_errors"] == 0


def test_two_autopilots_of_one_system_id_are_named_and_have_metrics_of_their_own(hil):
    metrics = harness.free_port(socket.SOCK_STREAM)
    simulator = hil("--vehicles", "2", "--metrics", f"127.0.0.1:{metrics}")
    ports = simulator.hil_port, simulator.hil_port + 1
    with contextlib.ExitStack() as stack:
        for port in ports:
            link = stack.enter_context(socket.create_connection(("127.0.0.1", port)))
            link.sendall(mavlink.MAVLink_heartbeat_message(0, 12, 0, 0, 0, 3).pack(mavlink.MAVLink(None, 1, 1)))
        simulator.process.wait_output("both have system id 1")
        text = urllib.request.urlopen(f"http://127.0.0.1:{metrics}/metrics").read().decode()
    samples = re.findall(r"^(mavloom_hil_steps_total\{.*\}) \d+$", text, re.MULTILINE)
    assert samples == [f'mavloom_hil_steps_total{{port="tcpin://127.0.0.1:{port}",system="1"}}' for port in ports]
