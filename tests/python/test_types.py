# SPDX-License-Identifier: MIT
"""The package as type checkers see it (row 25 of docs/guide/python.md): mypy --strict and pyright take the package and
every example of the guides, with the oldest Python that is supported; mypy also with this one. They also find what that
Python's grammar and library do not have."""
import json
import os
import pathlib
import shutil
import subprocess
import sys

import pytest

from guides import PAGES, script_of
from places import PACKAGE

pytestmark = pytest.mark.timeout(600)

OLDEST = "3.10"
NEWEST = "{}.{}".format(*sys.version_info)
WRONG = "from mavloom import messages\ndef f(m: messages.ATTITUDE) -> int:\n    return m.roll\n"
WRONG_CALLS = """from mavloom import Link, mavutil
def f(link: Link, conn: mavutil.mavfile) -> None:
    link.mav.heartbeet_send(6)
    conn.mav.heartbeet_send(6)
"""
NO_EXAMPLES = ("wrong.py", "wrong_calls.py", "newer.py")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The package, the examples of the guides and as_typed.py, one that is wrong and one that needs a newer Python."""
    folder = tmp_path_factory.mktemp("types")
    shutil.copytree(PACKAGE / "mavloom", folder / "mavloom", ignore=shutil.ignore_patterns("*.so", "__pycache__"))
    for page in PAGES:
        (folder / f"{page.stem.replace('-', '_')}.py").write_text(script_of(page))
    shutil.copy(pathlib.Path(__file__).parent / "as_typed.py", folder)
    (folder / "wrong.py").write_text(WRONG)
    (folder / "wrong_calls.py").write_text(WRONG_CALLS)
    (folder / "newer.py").write_text("from datetime import UTC\nprint(UTC)\n")  # 3.11
    return folder


def examples_in(folder):
    return sorted(path.name for path in folder.glob("*.py") if path.name not in NO_EXAMPLES)


@pytest.fixture(scope="module", params=[OLDEST, NEWEST])
def mypy(request, folder):
    (folder / "mypy.ini").write_text(
        "[mypy]\nstrict = True\n[mypy-pandas.*,pyarrow.*]\nignore_missing_imports = True\n")

    def call(*words):
        command = [sys.executable, "-m", "mypy", "--config-file", "mypy.ini", "--python-version", request.param,
                   "--cache-dir", f"cache-{request.param}"]
        return subprocess.run([*command, *words], cwd=folder, env={**os.environ, "MYPYPATH": ""}, capture_output=True,
                              text=True)
    return call


def test_row_25_mypy_strict_takes_every_example(mypy, folder):
    done = mypy(*examples_in(folder))
    assert done.returncode == 0, done.stdout + done.stderr


def test_row_25_mypy_strict_takes_the_package(mypy):
    done = mypy("-p", "mavloom")
    assert done.returncode == 0, done.stdout + done.stderr


def test_row_25_mypy_knows_the_types_of_fields(mypy):
    assert 'Incompatible return value type (got "float", expected "int")' in mypy("wrong.py").stdout


def test_row_25_mypy_knows_the_names_of_messages(mypy):
    found = mypy("wrong_calls.py").stdout
    assert '"Sender" has no attribute "heartbeet_send"' in found
    assert '"MAVLink" has no attribute "heartbeet_send"' in found


def pyright(folder, version, *include):
    """Returns its findings, as file:line: text. Packages without types are unknown, not guessed at."""
    settings = {"include": include, "pythonVersion": version, "useLibraryCodeForTypes": False,
                "reportMissingModuleSource": False}
    (folder / "pyrightconfig.json").write_text(json.dumps(settings))
    done = subprocess.run([sys.executable, "-m", "pyright", "--outputjson", "--pythonpath", sys.executable], cwd=folder,
                          capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stdout + done.stderr
    found = json.loads(done.stdout)
    assert found["summary"]["filesAnalyzed"] >= len(include)
    return [f"{one['file']}:{one['range']['start']['line'] + 1}: {one['message']}"
            for one in found["generalDiagnostics"]]


def test_row_25_pyright_takes_the_package_and_every_example(folder):
    files = (folder / "mavloom").rglob("*.py*")
    package = [str(path.relative_to(folder)) for path in files]
    assert pyright(folder, OLDEST, *package, *examples_in(folder)) == []


def test_row_25_pyright_knows_the_types_of_fields(folder):
    (found,) = pyright(folder, OLDEST, "wrong.py")
    assert 'wrong.py:3: Type "float" is not assignable to return type "int"' in found


def test_pyright_finds_what_the_oldest_python_does_not_have(folder):
    (found,) = pyright(folder, OLDEST, "newer.py")
    assert '"UTC" is unknown import symbol' in found


def test_checkers_know_fields_and_messages(tmp_path, child_environment):
    """Each line that ends with a comment has an error, and no other line has one."""
    code = """import mavloom
from mavloom import messages
link = mavloom.connect("udpin://127.0.0.1:0")
found = link.recv_match(type=messages.ATTITUDE)
assert found is not None
roll: float = found.roll
text: str = found.roll  # error
link.send("HEARTBEAT", type=6)
link.send("HEARTBEAT", typo=3)  # error
link.send("ATTITUDE", type=3)  # error
newest = link.latest(messages.GPS_RAW_INT)
number: str = newest.lat if newest else ""  # error
link.target = 3  # error
"""
    (tmp_path / "code.py").write_text(code)
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache", "code.py"],
                          cwd=tmp_path, env={**child_environment, "MYPYPATH": str(PACKAGE)}, capture_output=True,
                          text=True)
    wrong = {number for number, line in enumerate(code.splitlines(), 1) if line.endswith("# error")}
    assert {int(line.split(":")[1]) for line in done.stdout.splitlines() if ": error:" in line} == wrong, done.stdout
