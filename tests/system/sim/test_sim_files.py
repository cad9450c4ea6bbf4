# SPDX-License-Identifier: MIT
"""Behaviours 56 to 63 of docs/guide/sim-behaviour.md: files, logs and metadata; logs/ has what is in a log. pymavlink's
own mavftp module is one client, MAVSDK another."""
import json

import pytest

import ftp as protocol
import mavsdks
import mavutils
from flights import results_in_time
from ftp import FtpClient
from simulators import metadata_file
from stations import crc32


def largest_file(station):
    """(path, size) of the largest file that the vehicle offers."""
    client, folders, files = FtpClient(station), ["/"], []
    while folders:
        folder = folders.pop()
        for entry in client.list(folder):
            path = f"{folder.rstrip('/')}/{entry[1:].split(chr(9))[0]}"
            if entry[0] == "D":
                folders.append(path)
            elif entry[0] == "F":
                files.append((int(entry.split("\t")[1]), path))
    size, path = max(files)
    return path, size


def test_b56_folders_can_be_listed(px4):
    client = FtpClient(px4)
    entries = client.list("/")
    past = client.ask(protocol.LIST, b"/", offset=len(entries))
    with mavutils.connected(px4.vehicle_port) as connection:
        listed = mavutils.list_folder(connection, "/")

    assert len(entries) > 0 and all(entry[0] in "FDS" for entry in entries)
    assert (past.opcode, past.error) == (protocol.NAK, protocol.EOF)
    assert {name for name, _ in listed} >= {entry[1:].split("\t")[0] for entry in entries if entry[0] != "S"}


@pytest.mark.parametrize("loss", [0, 0.05])
def test_b57_a_burst_download_is_complete(sim, rng, loss):
    simulator = sim()
    with simulator.station() as station:
        path, size = largest_file(station)
        expected = FtpClient(station).crc(path)
    simulator.fault(f"loss:{loss}", rng)
    with mavutils.connected(simulator.port) as connection:
        content = mavutils.download(connection, path)

    assert len(content) == size > 10_000
    assert crc32(content) == expected


def test_b58_a_client_chooses_its_session_numbers(px4):
    path, size = largest_file(px4)
    for session in (0, 1, 7, 255):
        client = FtpClient(px4, session)
        reply = client.ask(protocol.OPEN, path.encode())
        assert (reply.error, reply.session) == (0, session)
        assert len(client.ask(protocol.READ, size=239).data) == min(size, 239)
        assert client.ask(protocol.TERMINATE).error == 0
    with mavutils.connected(px4.vehicle_port) as connection:  # counts its sessions itself
        assert len(mavutils.download(connection, path)) == len(mavutils.download(connection, path)) == size


def test_b59_a_missing_file_is_refused_at_once(px4):
    client = FtpClient(px4)
    messages = results_in_time(px4, lambda: client.send(protocol.OPEN, b"@PARAM/nothing.pck"), "FILE_TRANSFER_PROTOCOL",
                               0.1)
    payload = bytes(next(m for m in messages if m.get_type() == "FILE_TRANSFER_PROTOCOL").payload)

    assert payload[3] == protocol.NAK and payload[12] == protocol.NOT_FOUND


def test_b60_a_path_cannot_leave_the_tree(px4):
    client = FtpClient(px4)
    for path in ("/../etc/passwd", "/etc/../../secret", "../..", "/log/../../b"):
        for opcode in (protocol.OPEN, protocol.CREATE, protocol.REMOVE, protocol.LIST, protocol.MAKE_DIR):
            reply = client.ask(opcode, path.encode())

            assert reply.opcode == protocol.NAK, (path, opcode)
            assert reply.error in (protocol.PROTECTED, protocol.NOT_FOUND), (path, opcode, reply)


def test_b61_two_clients_download_at_once(shared):
    simulator = shared()
    with simulator.station() as first, simulator.station((254, 191)) as second:
        path, size = largest_file(first)
        clients = FtpClient(first), FtpClient(second, 3)
        sessions = [client.ask(protocol.OPEN, path.encode()).session for client in clients]
        contents = [b"", b""]
        while any(len(content) < min(size, 20_000) for content in contents):
            for number, client in enumerate(clients):
                reply = client.ask(protocol.READ, offset=len(contents[number]), size=239, session=sessions[number])
                contents[number] += reply.data

    assert contents[0] == contents[1]
    assert first.lost == second.lost == 0


def test_b62_logs_can_be_listed_and_downloaded(sim):
    without, having = sim(vehicle={"logs": 0}), sim()
    for simulator in (without, having):
        simulator.station().close()
    none, two = mavsdks.run(without.port, "logs"), mavsdks.run(having.port, "logs")

    assert none["result"] == "NO_LOGFILES"
    assert two["result"] == "SUCCESS" and len(two["entries"]) == 2
    assert two["sizes"] == [size for _, size in two["entries"]] * 2 and min(two["sizes"]) > 1000
    assert two["same"]


def test_b63_metadata_leads_to_all_parameters(px4):
    client = FtpClient(px4)
    place = px4.ask_for(397, "COMPONENT_METADATA")
    content = metadata_file(client, place.uri)
    general = json.loads(content)
    names = set()
    for entry in general["metadataTypes"]:
        described = metadata_file(client, entry["uri"])
        assert entry["fileCrc"] == client.crc(entry["uri"].removeprefix("mftp:/")), entry  # as it is transferred
        if entry["type"] == 1:
            names = {one["name"] for one in json.loads(described)["parameters"]}

    assert place.file_crc == crc32(content)
    assert set(px4.parameters()) <= names


def test_mavsdk_moves_files(sim):
    simulator = sim()
    with simulator.station() as station:
        path, size = largest_file(station)
    answer = mavsdks.run(simulator.port, "files", "", path)

    assert answer["root"][0] == "SUCCESS"
    assert answer["burst True"] == answer["burst False"] == "SUCCESS" and answer["size"] == size
    assert answer["identical"] == ["SUCCESS", True]
    assert [answer[name] for name in ("mkdir", "upload", "rename", "remove", "rmdir")] == ["SUCCESS"] * 5
    assert answer["again"] == ["SUCCESS", True]
    assert answer["missing"] == "FILE_DOES_NOT_EXIST"
