# SPDX-License-Identifier: MIT
"""How the program of the package is found."""
import os
import shutil
import subprocess
import sys

import pytest

from places import ROOT


@pytest.fixture
def installed(tmp_path):
    """A package without the program, and the script of a wheel in PATH."""
    (tmp_path / "mavloom").mkdir()
    (tmp_path / "mavloom" / "__init__.py").touch()
    shutil.copy(ROOT / "python/mavloom/__main__.py", tmp_path / "mavloom")
    script = tmp_path / "bin" / "mavloom"
    script.parent.mkdir()
    script.write_text((ROOT / "python/scripts/mavloom").read_text().replace("#!python", f"#!{sys.executable}", 1))
    script.chmod(0o755)
    return tmp_path


def run_in(folder, *command):
    environment = {**os.environ, "PYTHONPATH": str(folder), "PATH": str(folder / "bin")}
    return subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True, timeout=30)


@pytest.mark.parametrize("command", [["bin/mavloom"], [sys.executable, "-m", "mavloom"]])
def test_without_the_program_the_error_names_the_next_step(installed, command):
    done = run_in(installed, *command, "--version")

    assert done.returncode == 1 and "pip install --force-reinstall mavloom" in done.stderr, done


@pytest.mark.parametrize("command", [["bin/mavloom"], [sys.executable, "-m", "mavloom"]])
def test_the_program_of_the_package_gets_the_arguments(installed, command):
    program = installed / "mavloom" / "bin" / "mavloom"
    program.parent.mkdir()
    program.write_text('#!/bin/sh\necho "$@"\n')
    program.chmod(0o755)

    assert run_in(installed, *command, "listen", "a b").stdout == "listen a b\n"


def test_importing_it_runs_nothing(installed):
    done = run_in(installed, sys.executable, "-c", "import mavloom.__main__")

    assert (done.returncode, done.stderr) == (0, "")
