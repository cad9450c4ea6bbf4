# SPDX-License-Identifier: MIT
"""The router as a service: its notifications to a service manager (a socket of ours stands in for systemd's), and the
installed unit."""
import os
import re
import shutil
import signal
import socket
import subprocess

import pytest

import harness

pytestmark = pytest.mark.short

UNIT = harness.ROOT / "packaging" / "systemd" / "mavloom-router.service"
SYSUSERS = harness.ROOT / "packaging" / "systemd" / "mavloom.sysusers"


class Manager:
    def __init__(self, address):
        self.sock = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.sock.bind("\0" + address[1:] if address[0] == "@" else address)
        self.sock.settimeout(harness.DEFAULT_TIMEOUT_S)

    def next(self, leave_out="WATCHDOG=1"):
        while (message := self.sock.recv(4096).decode()) == leave_out:
            pass
        return message


@pytest.fixture(params=["path", "abstract"])
def manager_address(request, tmp_path):
    return str(tmp_path / "notify") if request.param == "path" else f"@mavloom-test-{os.getpid()}-{harness.free_port()}"


@pytest.fixture
def manager(manager_address):
    made = Manager(manager_address)
    yield made
    made.sock.close()


@pytest.fixture
def router(spawn, tmp_path, udp_port, manager, manager_address):
    def start(**env):
        port = udp_port()
        config = tmp_path / "router.toml"
        config.write_text(f'[[endpoint]]\nurl = "udpin://127.0.0.1:{port}"\n')
        return spawn("route", "--config", config, "--name", f"service-{port}",
                     env={"NOTIFY_SOCKET": manager_address, **env})
    return start


def test_reports_its_start_its_reload_and_its_end(router, manager):
    running = router()
    assert manager.next() == "READY=1"

    running.send(signal.SIGHUP)
    assert re.fullmatch(r"RELOADING=1\nMONOTONIC_USEC=\d+", manager.next())
    assert manager.next() == "READY=1"
    assert running.alive

    assert running.stop(signal.SIGTERM).status == 143
    assert manager.next() == "STOPPING=1"


def test_feeds_the_watchdog_from_its_loop(router, manager):
    running = router(WATCHDOG_USEC="100000")
    assert manager.next() == "READY=1"
    for _ in range(3):
        assert manager.next(leave_out=None) == "WATCHDOG=1"

    running.send(signal.SIGSTOP)  # the loop hangs
    os.waitpid(running.pid, os.WUNTRACED)
    manager.sock.setblocking(False)
    with pytest.raises(BlockingIOError):
        while True:
            manager.next(leave_out=None)
    manager.sock.settimeout(0.5)
    with pytest.raises(TimeoutError):
        manager.next(leave_out=None)

    running.send(signal.SIGCONT)
    manager.sock.settimeout(harness.DEFAULT_TIMEOUT_S)
    assert manager.next(leave_out=None) == "WATCHDOG=1"


def test_a_watchdog_for_another_process_is_not_fed(router, manager):
    running = router(WATCHDOG_USEC="20000", WATCHDOG_PID="1")
    assert manager.next(leave_out=None) == "READY=1"

    running.send(signal.SIGTERM)
    assert manager.next(leave_out=None) == "STOPPING=1"


@pytest.mark.parametrize("address", ["/nowhere/notify", "@", "notify", "/" + "x" * 200])
def test_a_manager_that_is_not_there_is_none(run, address):
    done = run("route", "tcpin://127.0.0.1:%d" % harness.free_port(socket.SOCK_STREAM), "--for", "50ms", "--name",
               f"none-{os.getpid()}", env={"NOTIFY_SOCKET": address, "WATCHDOG_USEC": "10000"})

    assert done.status == 0, done


# ---- the unit --------------------------------------------------------------------------------------------------------

@pytest.fixture
def analyze(program, tmp_path):
    """systemd-analyze VERB OPTIONS on the unit, with the program under test in it."""
    if not shutil.which("systemd-analyze"):
        pytest.skip("systemd-analyze is not installed")
    unit = tmp_path / UNIT.name
    unit.write_text(UNIT.read_text().replace("/usr/bin/mavloom", str(program)))

    def call(*options):
        return subprocess.run(["systemd-analyze", *options, str(unit)], capture_output=True, text=True, timeout=60)
    return call


def test_the_unit_has_no_fault(analyze):
    done = analyze("verify", "--man=no")

    assert (done.returncode, done.stdout + done.stderr) == (0, "")


def test_the_unit_is_hardened(analyze):
    # of 100; a unit without protection has 96
    done = analyze("security", "--offline=true", "--threshold=20", "--no-pager")
    if "nrecognized option" in done.stderr or "nknown option" in done.stderr:
        pytest.skip("this systemd-analyze is older than 250")

    assert done.returncode == 0, done.stdout + done.stderr


def test_the_command_of_the_unit_is_one(run, tmp_path):
    command = re.search(r"^ExecStart=/usr/bin/mavloom (.*)$", UNIT.read_text(), re.MULTILINE)[1].split()
    config = tmp_path / "router.toml"
    config.write_text(f'[[endpoint]]\nurl = "tcpin://127.0.0.1:{harness.free_port(socket.SOCK_STREAM)}"\n')
    assert command[-1] == "/etc/mavloom/router.toml"
    done = run(*command[:-1], config, "--for", "50ms", "--name", f"unit-{os.getpid()}")

    assert done.status == 0, done


def test_the_user_of_the_unit_is_made(tmp_path):
    assert "User=mavloom\n" in UNIT.read_text()
    if not shutil.which("systemd-sysusers"):
        pytest.skip("systemd-sysusers is not installed")
    (tmp_path / "etc").mkdir()
    done = subprocess.run(["systemd-sysusers", f"--root={tmp_path}", str(SYSUSERS)], capture_output=True, text=True,
                          timeout=60)

    assert done.returncode == 0, done.stderr
    assert re.search(r"^mavloom:", (tmp_path / "etc" / "passwd").read_text(), re.MULTILINE)


def test_the_package_allows_the_receive_buffer_that_endpoints_request():
    """docs/guide/endpoints.md: rcvbuf is 32 MiB by default."""
    settings = (SYSUSERS.parent / "mavloom.sysctl").read_text()
    setting, = re.findall(r"^net\.core\.rmem_max = (\d+)$", settings, re.MULTILINE)

    assert int(setting) == 32 << 20
