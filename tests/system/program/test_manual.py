# SPDX-License-Identifier: MIT
"""The manual pages, read by mandoc, and completion in real bash, zsh and fish."""
import os
import pathlib
import pty
import re
import select
import shutil
import subprocess
import time

import harness
import pytest


def need(tool):
    if not shutil.which(tool):
        pytest.skip(f"{tool} is missing: ./run test installs it")


@pytest.fixture
def commands(run):
    """The names of all commands, as the help lists them."""
    table = run("--help").stdout.split("Subcommands:\n")[1].split("\n\n")[0]
    return re.findall(r"^  (\w+)", table, re.MULTILINE)


def test_mandoc_finds_no_fault_in_any_page(run, commands, tmp_path):
    need("mandoc")
    pages = {name: run("manual", "mdoc", *([name] if name else [])) for name in ["", *commands]}
    for name, page in pages.items():
        (tmp_path / f"mavloom{name and '-' + name}.1").write_text(page.stdout)
    done = subprocess.run(["mandoc", "-Tlint", "-Wwarning", *sorted(tmp_path.iterdir())], capture_output=True,
                          text=True)
    faults = [line for line in done.stdout.splitlines() if not line.endswith("new sentence, new line")]
    assert len(pages) > 15 and not faults, "\n".join(faults[:20])


def test_a_page_has_every_option_of_the_help(run, commands):
    need("mandoc")
    for name in commands:
        page = subprocess.run(["mandoc", "-Tascii"], input=run("manual", "mdoc", name).stdout, capture_output=True,
                              text=True, check=True).stdout
        shown = re.sub(".\b", "", page)  # bold and underlined letters are written twice
        for option in re.findall(r"^  (?:-\w,)?(--[\w-]+)", run(name, "--help").stdout, re.MULTILINE):
            assert option in shown, f"{name} {option}"


def test_the_guide_has_the_reference_of_this_program(run):
    assert (harness.ROOT / "docs/guide/commands.md").read_text() == run("manual", "markdown").stdout, (
        "type: mavloom manual markdown > docs/guide/commands.md")


def words(run, *typed):
    lines = run("completion", "words", "--", *typed).lines
    return [line.split("\t")[0] for line in lines]


def test_what_may_stand_next(run):
    assert words(run, "re") == ["relay", "record", "replay"]
    assert words(run, "dialect", "sh") == ["show"]
    assert words(run, "listen", "--st") == ["--stats", "--stats-only"]
    assert words(run, "listen", "--only", "ATTITUDE,HEART") == ["ATTITUDE,HEARTBEAT"]
    assert words(run, "listen", "--only=HEARTB") == ["--only=HEARTBEAT"]
    assert words(run, "relay", "--set", "ATTITUDE.pitch") == ["ATTITUDE.pitch=", "ATTITUDE.pitchspeed="]
    assert words(run, "ctl", "any", "ta") == ["takeoff"]
    assert words(run, "ctl", "any", "wait", "a") == ["armed", "alt"]
    assert words(run, "ctl", "any", "remove", "") == [], "it does not run"
    assert words(run, "route", "udpi") == ["udpin://", ":files"]
    assert words(run, "record", "-o", "") == [":files"]
    assert words(run, "manual", "m") == ["mdoc", "markdown"]
    assert words(run, "demo", "--ports", "f") == ["free"]
    assert words(run, "nothing", "at", "all") == []
    assert words(run, "--v") == ["--version"]
    assert words(run, "doctor", "--v") == [], "doctor has no such option"
    assert words(run, "shm", "stat", "--h") == ["--help"]


def test_running_programs_and_rings_are_offered(run, spawn, udp_port):
    name = f"complete-{os.getpid()}"
    links = f"udpin://127.0.0.1:{udp_port()}", "udpout://127.0.0.1:9?name=tablet"
    spawn("route", *links, "--name", name, "--ring", name)
    harness.wait_for(lambda: words(run, "ctl", name) == [name], what="the router's counter page")
    harness.wait_for(lambda: words(run, "shm", "stat", name[:-1]) == [name], what="its ring")
    assert f"shm://{name}" in words(run, "listen", "shm://comp")
    assert words(run, "ctl", name, "remove", "ta") == ["tablet"]


def test_a_killed_program_is_not_offered(run, spawn):
    name = f"killed-{os.getpid()}"
    page = pathlib.Path(f"/dev/shm/mavloom.{name}.stat")
    router = spawn("route", "udpout://127.0.0.1:9", "--name", name)
    try:
        harness.wait_for(lambda: words(run, "ctl", name) == [name], what="the router's counter page")
        router.kill()
        assert page.exists()
        assert words(run, "ctl", name) == []
    finally:
        router.kill()
        page.unlink(missing_ok=True)


@pytest.fixture
def shell_environment(program):
    return {**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}", "TERM": "dumb", "LC_ALL": "C.UTF-8"}


def test_bash_completes(shell_environment):
    need("bash")
    script = """eval "$(mavloom completion bash)"
    for word in ro 'route --explai' 'listen udpou'; do
      COMP_WORDS=(mavloom $word); COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
      COMP_LINE="mavloom $word"; COMP_POINT=${#COMP_LINE}
      compopt() { :; }
      _mavloom; echo "${COMPREPLY[*]}"
    done"""
    done = subprocess.run(["bash", "--norc", "-c", script], env=shell_environment, capture_output=True, text=True)
    assert done.stdout.splitlines() == ["route", "--explain", "udpout://"], done.stderr


def test_fish_completes(shell_environment, tmp_path):
    need("fish")
    script = "mavloom completion fish | source; complete -C 'mavloom ro'; complete -C 'mavloom route --explai'"
    done = subprocess.run(["fish", "-c", script], env={**shell_environment, "HOME": str(tmp_path)}, capture_output=True,
                          text=True)
    assert [line.split("\t")[0] for line in done.stdout.splitlines()] == ["route", "--explain"], done.stderr


class Terminal:
    """A program on a pseudo-terminal."""

    def __init__(self, command, env):
        self.pid, self.descriptor = pty.fork()
        if self.pid == 0:
            os.execvpe(command[0], command, env)
        self.shown = ""

    def type(self, text):
        os.write(self.descriptor, text.encode())

    def wait_for(self, text):
        deadline = time.monotonic() + harness.DEFAULT_TIMEOUT_S
        while text not in self.shown:
            left = deadline - time.monotonic()
            assert left > 0 and select.select([self.descriptor], [], [], left)[0], f"no {text!r} in {self.shown!r}"
            self.shown += os.read(self.descriptor, 4096).decode(errors="replace").replace("\a", "")

    def close(self):
        os.kill(self.pid, 9)
        os.waitpid(self.pid, 0)
        os.close(self.descriptor)


def test_zsh_completes(shell_environment, tmp_path):
    need("zsh")
    shell = Terminal(["zsh", "-f", "-i"], {**shell_environment, "HOME": str(tmp_path)})
    try:
        shell.type("PS1='ready> '; autoload -Uz compinit; compinit -u -D\n")
        shell.type("source <(mavloom completion zsh); echo lo''aded\n")
        shell.wait_for("loaded")
        shell.type("mavloom rou\t")
        shell.wait_for("route")
        shell.type(" --expl\t")
        shell.wait_for("--explain")
    finally:
        shell.close()
