# SPDX-License-Identifier: MIT
"""The routers of `bench route`: how each is installed and started.

Other routers run as separate programs; none of their code is linked or copied."""
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
MAVROUTER_VERSION = "0.1.6"
NOT_AT_HAND = "mavlink-router, mavp2p and mavlink-server are in no package registry: not measured"


class Missing(Exception):
    """A peer is not available on this machine; the text states why."""


class Peer:
    """A router. command() returns the argv of a process that reads UDP datagrams at in_port and forwards them to
    each of out_ports."""
    note = ""
    counts_beside = False  # whether CPU includes the programs beside

    def __init__(self, name):
        self.name = name

    def command(self, in_port, out_ports, folder):
        raise NotImplementedError

    def beside(self):
        """Programs that run while it does."""
        return []


class BareLoop(Peer):
    def __init__(self, name, program, mode):
        super().__init__(name)
        self.program, self.mode = program, mode

    def command(self, in_port, out_ports, folder):
        return [self.program, in_port, self.mode, *out_ports]


class Mavloom(Peer):
    """`mavloom route` with its defaults."""

    def __init__(self, program, name="mavloom"):
        super().__init__(name)
        self.program = program

    def route(self, *arguments):
        """Gives the router its own name, if the program supports names, to avoid a clash with another router."""
        help_text = subprocess.run([str(self.program), "route", "--help"], capture_output=True, text=True).stdout
        return [self.program, "route", *(("--name", f"bench-{os.getpid()}") if "--name" in help_text else ()),
                *arguments]

    def command(self, in_port, out_ports, folder):
        return self.route(f"udpin://127.0.0.1:{in_port}", *(f"udpout://127.0.0.1:{port}" for port in out_ports))


class MavloomWithRing(Mavloom):
    """`mavloom route --ring`, with `readers` that follow the ring beside it."""

    def __init__(self, program, name, readers=0):
        super().__init__(program, name)
        self.ring, self.readers = f"bench-{os.getpid()}", readers

    def command(self, in_port, out_ports, folder):
        return [*super().command(in_port, out_ports, folder), "--ring", self.ring]

    def beside(self):
        return [[self.program, "shm", "read", self.ring, "--data"]] * self.readers


class MavloomConfigured(Mavloom):
    """`mavloom route` with a configuration file, in which every peer of one udpin endpoint is a link.

    `router` and `endpoint` are lines of TOML."""

    def __init__(self, program, name, router, endpoint):
        super().__init__(program, name)
        self.router, self.endpoint = router, endpoint

    def command(self, in_port, out_ports, folder):
        lines = ["[router]", *self.router, "[[endpoint]]", f'url = "udpin://127.0.0.1:{in_port}"', *self.endpoint]
        file = pathlib.Path(folder, "mavloom.toml")
        file.write_text("\n".join(lines) + "\n")
        return self.route("--config", file)


class Mavrouter(Peer):
    """mavrouter, with the configuration of its own stress test (bus_capacity) and our endpoints."""
    note = "keeps one frame of a datagram"

    def __init__(self, program):
        super().__init__("mavrouter")
        self.program = program

    def command(self, in_port, out_ports, folder):
        lines = ["[general]", "bus_capacity = 20000"]
        for mode, ports in (("server", [in_port]), ("client", out_ports)):
            for port in ports:
                lines += ["[[endpoint]]", 'type = "udp"', f'address = "127.0.0.1:{port}"', f'mode = "{mode}"']
        file = pathlib.Path(folder, "mavrouter.toml")
        file.write_text("\n".join(lines) + "\n")
        return [self.program, "--config", file]


class Mavproxy(Peer):
    """MAVProxy with as little as possible: no modules, no logs, no console."""
    note = "without modules"

    def __init__(self, python):
        super().__init__("MAVProxy")
        self.python = python

    def command(self, in_port, out_ports, folder):
        return [self.python, self.python.with_name("mavproxy.py"), "--daemon", "--non-interactive", "--no-state",
                "--default-modules=", "--force-connected", "--nowait", f"--master=udpin:127.0.0.1:{in_port}",
                *(f"--out=udpout:127.0.0.1:{port}" for port in out_ports)]


def run_quietly(command, what):
    """Runs an installer. Shows its output only if it fails."""
    print(f"bench route: {what}", file=sys.stderr, flush=True)
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        raise Missing(f"{what} failed: {done.stdout.strip().splitlines()[-1:]}")


def mavrouter(folder):
    program = folder / "mavrouter" / "bin" / "mavrouter"
    if not program.is_file():
        cargo = shutil.which("cargo")
        if not cargo:
            raise Missing("no cargo to build it with (Debian: cargo-web)")
        run_quietly([cargo, "install", "mavrouter", "--version", MAVROUTER_VERSION, "--locked", "--root",
                     folder / "mavrouter"],
                    "cargo install mavrouter, which takes some minutes")
    return Mavrouter(program)


def mavproxy(folder):
    python = folder / "mavproxy" / "bin" / "python"
    if not python.with_name("mavproxy.py").is_file():
        run_quietly([sys.executable, "-m", "venv", folder / "mavproxy"], f"Python environment {folder / 'mavproxy'}")
        run_quietly([python, "-m", "pip", "install", "--quiet", "--no-input", "--no-deps", "-r",
                     ROOT / "packaging" / "python-bench.txt"],
                    "pip install MAVProxy")
    return Mavproxy(python)


def at_hand(program, tools, folder, without=()):
    """Returns (the available peers in the order of the table, why the others are missing)."""
    peers = [BareLoop("bare loop", tools / "route_bare_loop", "single"),
             BareLoop("bare loop, gathering", tools / "route_bare_loop", "gather"), Mavloom(program)]
    missing = [NOT_AT_HAND]
    for name, find in (("mavrouter", mavrouter), ("MAVProxy", mavproxy)):
        if name.lower() in without:
            continue
        try:
            peers.append(find(folder))
        except Missing as why:
            missing.append(f"{name} is left out: {why}")
    return peers, missing
