# SPDX-License-Identifier: MIT
"""Terminals of a chosen size, by tmux: what the program shows to people."""
import contextlib
import os
import re
import shutil
import subprocess

import harness
import pytest


class Tmux:
    """A terminal of a size of its own, with one program in it."""

    def __init__(self, folder, *command, columns=80, lines=24, env=()):
        self.socket = str(folder / "tmux")
        settings = " ".join(f"{key}={value}" for key, value in env)
        self.call("-f", "/dev/null", "new-session", "-d", "-x", str(columns), "-y", str(lines),
                  f"env {settings} {' '.join(map(str, command))}; echo ended with $?; "
                  "stty -a | grep -o -- '-*icanon'; cat")

    def call(self, *arguments):
        return subprocess.run(["tmux", "-S", self.socket, *arguments], capture_output=True, text=True, check=True,
                              env={**os.environ, "LC_ALL": "C.UTF-8"}).stdout

    def type(self, *keys):
        self.call("send-keys", *keys)

    def shown(self):
        """The lines on the screen. A line that the terminal wrapped is one line."""
        return self.call("capture-pane", "-p", "-J")

    def wait_for(self, pattern):
        try:
            return harness.wait_for(lambda: re.search(pattern, self.shown(), re.MULTILINE), what=pattern)
        except AssertionError as error:
            raise AssertionError(f"{error}\n{self.shown()}") from None

    def close(self):
        subprocess.run(["tmux", "-S", self.socket, "kill-server"], capture_output=True, check=False)


@contextlib.contextmanager
def opened(folder, program, command):
    """Gives a function that runs `command` of the program, with arguments, in a terminal of its own."""
    if not shutil.which("tmux"):
        pytest.skip("tmux is missing: ./run test installs it")
    terminals = []

    def start(*arguments, **options):
        place = folder / f"terminal{len(terminals)}"
        place.mkdir()
        terminals.append(Tmux(place, program, command, *arguments, **options))
        return terminals[-1]
    try:
        yield start
    finally:
        for terminal in terminals:
            terminal.close()
