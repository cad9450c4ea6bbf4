# SPDX-License-Identifier: MIT
"""Machines of their own: network namespaces. Needs root and iproute2; elsewhere the tests are skipped with that
reason."""
import ctypes
import os
import shutil
import socket
import subprocess
import threading

import harness
import pytest

CLONE_NEWNET = 0x40000000


def ip(*args):
    subprocess.run(["ip", *map(str, args)], check=True, capture_output=True, text=True)


class Machine:
    """One namespace: `command` runs in it, `socket` makes sockets in it."""

    def __init__(self, number):
        self.name = f"mavloom-{os.getpid()}-{number}"
        self.interface = f"cable{number}"
        self.host, self.host6 = f"10.77.0.{number}", f"fd77::{number}"
        ip("netns", "add", self.name)

    def command(self, *args):
        return ["ip", "netns", "exec", self.name, *args]

    def configure(self):
        ip("-n", self.name, "link", "set", "lo", "up")
        ip("-n", self.name, "addr", "add", f"{self.host}/24", "brd", "+", "dev", self.interface)
        ip("-n", self.name, "addr", "add", f"{self.host6}/64", "nodad", "dev", self.interface)
        ip("-n", self.name, "link", "set", self.interface, "up")
        ip("-n", self.name, "route", "add", "default", "dev", self.interface)

    def socket(self, family=socket.AF_INET, timeout=60, kind=socket.SOCK_DGRAM, protocol=0):
        """A socket of this machine: a socket stays in the namespace of the thread that made it."""
        made = []

        def make():
            with open(f"/run/netns/{self.name}") as namespace:
                if ctypes.CDLL(None, use_errno=True).setns(namespace.fileno(), CLONE_NEWNET) != 0:
                    raise OSError(ctypes.get_errno(), "setns")
            made.append(socket.socket(family, kind, protocol))
        thread = threading.Thread(target=make)
        thread.start()
        thread.join()
        made[0].settimeout(timeout)
        return made[0]

    def remove(self):
        subprocess.run(["ip", "netns", "del", self.name], capture_output=True)


def two_machines():
    """A generator for a fixture: two machines whose interfaces are joined by a cable."""
    if os.geteuid() != 0 or not shutil.which("ip"):
        pytest.skip("network namespaces need root and iproute2")
    machines = []
    try:
        try:
            machines = [Machine(1), Machine(2)]
            ip("link", "add", "cable1", "netns", machines[0].name, "type", "veth", "peer", "name", "cable2", "netns",
               machines[1].name)
        except subprocess.CalledProcessError as error:
            pytest.skip(f"no network namespaces here: {error.stderr.strip()}")
        for machine in machines:
            machine.configure()
        yield machines
    finally:
        for machine in machines:
            machine.remove()


def alone(folder, *command):
    """Runs a command to its end as on a machine without other programs: without rings, and with all ports free. The
    control sockets are in `folder`. Returns what subprocess.run() does."""
    if os.geteuid() != 0 or not shutil.which("unshare") or not shutil.which("ip"):
        pytest.skip("a machine of its own needs root, unshare and iproute2")
    script = 'mount -t tmpfs tmpfs /dev/shm && ip link set lo up && exec "$@"'
    done = subprocess.run(["unshare", "--mount", "--net", "sh", "-c", script, "sh", *command],
                          capture_output=True, text=True, timeout=2 * harness.DEFAULT_TIMEOUT_S,
                          env=harness.environment({"MAVLOOM_RUN": str(folder)}))
    if done.stderr.startswith(("unshare: ", "mount: ")):
        pytest.skip(done.stderr.strip())
    return done
