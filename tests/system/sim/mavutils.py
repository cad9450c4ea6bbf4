# SPDX-License-Identifier: MIT
"""pymavlink's own connection (mavutil), as scripts use it, with the dialect of all messages."""
import contextlib
import os
import sys
import tempfile
import time

import harness
from stations import mavlink

import pymavlink.dialects.v20  # noqa: E402
from pymavlink import mavftp, mavutil  # noqa: E402

DIALECT = "of_all_messages"
sys.modules[f"pymavlink.dialects.v20.{DIALECT}"] = mavlink
setattr(pymavlink.dialects.v20, DIALECT, mavlink)


@contextlib.contextmanager
def connected(port, system=255, component=190, kind="udpout"):
    """A connection that knows its vehicle, as after wait_heartbeat()."""
    usual = mavutil.current_dialect
    connection = mavutil.mavlink_connection(f"{kind}:127.0.0.1:{port}", source_system=system,
                                            source_component=component, dialect=DIALECT)
    if kind != "tcp":
        harness.enlarge_receive_buffer(connection.port)
    try:
        deadline = time.monotonic() + harness.DEFAULT_TIMEOUT_S
        while not connection.target_system:
            assert time.monotonic() < deadline, "no heartbeat"
            beat(connection)
            connection.recv_match(type="HEARTBEAT", blocking=True, timeout=0.5)
        yield connection
    finally:
        connection.close()
        mavutil.set_dialect(usual)


def beat(connection):
    connection.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0)


def receive(connection, name, where=lambda m: True, timeout=harness.DEFAULT_TIMEOUT_S):
    """The next message of this name, with a heartbeat each second meanwhile."""
    deadline, due = time.monotonic() + timeout, 0
    while time.monotonic() < deadline:
        if time.monotonic() >= due:
            beat(connection)
            due = time.monotonic() + 1
        message = connection.recv_match(type=name, blocking=True, timeout=0.2)
        if message is not None and where(message):
            return message
    raise AssertionError(f"no {name} within {timeout} s")


def files_of(connection):
    return mavftp.MAVFTP(connection, connection.target_system, 1)


def list_folder(connection, path):
    """[(name, is a folder)] as pymavlink's mavftp reads it."""
    client = files_of(connection)
    result = client.cmd_list([path])
    assert result.error_code == mavftp.FtpError.Success, result.error_code
    return [(entry.name, entry.is_dir) for entry in client.list_result]


def download(connection, path):
    """The file's content, by the bursts of pymavlink's mavftp."""
    client = files_of(connection)
    with tempfile.TemporaryDirectory() as folder:
        local = os.path.join(folder, "file")
        client.cmd_get([path, local])
        result = client.process_ftp_reply("OpenFileRO", timeout=100)
        assert result.error_code == mavftp.FtpError.Success, result.error_code
        with open(local, "rb") as file:
            return file.read()
