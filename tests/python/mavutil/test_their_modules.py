# SPDX-License-Identifier: MIT
"""`from mavloom import mavftp` and `mavparm`: pymavlink's own modules."""
import subprocess
import sys

import pytest


@pytest.mark.parametrize("name", ["mavftp", "mavparm"])
def test_a_module_of_pymavlink_is_imported_as_it_is(name, child_environment):
    code = (f"from mavloom import {name}\nimport mavloom.{name} as again\nimport pymavlink.{name} as theirs\n"
            f"print({name} is theirs, again is theirs)")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=child_environment)
    assert (done.stdout, done.stderr) == ("True True\n", "")


@pytest.mark.parametrize("name", ["mavftp", "mavparm"])
def test_without_pymavlink_the_error_states_what_to_install(name, child_environment):
    code = f"import sys\nsys.modules['pymavlink'] = None\nfrom mavloom import {name}"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=child_environment)
    assert done.stderr.splitlines()[-1].startswith(
        f"ImportError: mavloom.{name} is the module of pymavlink, which is not installed or too old (")
    assert done.stderr.splitlines()[-1].endswith("): pip install --upgrade pymavlink")
