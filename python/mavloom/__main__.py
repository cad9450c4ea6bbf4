# SPDX-License-Identifier: MIT
"""`python -m mavloom ARGUMENT...` runs the program mavloom. A wheel has it inside the package; the Debian package
python3-mavloom has not, and uses the one in PATH."""
import os
import shutil
import sys


def run(otherwise: str | None = None) -> None:
    """Runs the program of this package, else the one at the path `otherwise`."""
    packaged = os.path.join(os.path.dirname(__file__), "bin", "mavloom")
    program = packaged if os.path.isfile(packaged) else otherwise
    if program is None:
        sys.exit("mavloom: there is no program mavloom; install the Debian package mavloom, or the wheel anew: "
                 "pip install --force-reinstall mavloom")
    os.execv(program, ["mavloom", *sys.argv[1:]])


if __name__ == "__main__":
    run(shutil.which("mavloom"))
