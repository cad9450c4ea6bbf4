# SPDX-License-Identifier: MIT
"""Runs a Python program on both sides: as it is, with pymavlink, and with the import changed, with Mavloom.

pymavlink decodes with a module that its own generator made from our definitions, in place of its dialects.
"""
import pathlib
import subprocess
import sys

from pymavlink_vectors import plain_environment

IMPORT = "from pymavlink import mavutil"
SIDES = ("pymavlink", "mavloom")
TIMEOUT_S = 120
# Runs when Python starts, because its folder is on PYTHONPATH.
PEER = """
import importlib.util, sys
spec = importlib.util.spec_from_file_location("peer", {path!r})
peer = importlib.util.module_from_spec(spec)
spec.loader.exec_module(peer)
import pymavlink.dialects.v10 as v10, pymavlink.dialects.v20 as v20
for package, module in (("v10", v10), ("v20", v20)):
    for name in ("all", "ardupilotmega"):
        sys.modules[f"pymavlink.dialects.{{package}}.{{name}}"] = peer
        setattr(module, name, peer)
"""


def lay_out(folder, programs, peer):
    """Copies the programs into a folder for each side. Returns {side: folder}."""
    folders = {side: folder / side for side in SIDES}
    for side, place in folders.items():
        place.mkdir()
        (place / "sitecustomize.py").write_text(PEER.format(path=peer.__file__) if side == "pymavlink" else "")
        for program in programs:
            text = pathlib.Path(program).read_text()
            assert text.count(IMPORT) == 1, f"{program}: one line must change"
            if side == "mavloom":
                text = text.replace(IMPORT, "from mavloom import mavutil")
            (place / pathlib.Path(program).name).write_text(text)
    return folders


def run(folder, program, *words, environment, status=0):
    """Returns what the program printed."""
    path = f"{folder}:{environment['PYTHONPATH']}"
    if folder.name == "pymavlink":
        environment = plain_environment(environment)
    done = subprocess.run([sys.executable, folder / f"{program}.py", *map(str, words)],
                          env={**environment, "PYTHONPATH": path, "TZ": "UTC", "PYTHONHASHSEED": "0"},
                          capture_output=True, text=True, timeout=TIMEOUT_S)
    assert done.returncode == status, (folder.name, program, done.stdout[-2000:], done.stderr[-4000:])
    return done.stdout
