# SPDX-License-Identifier: MIT
"""The library compiles for 32-bit Arm, which has no integers of 128 bits. tools/armhf.sh makes no object files."""
import os
import shutil

import pytest
from test_package import BUILD, ROOT, call

pytestmark = [pytest.mark.timeout(3600),
              pytest.mark.skipif("MAVLOOM_FULL" not in os.environ, reason="only .ci/run --full"),
              pytest.mark.skipif(not shutil.which("arm-linux-gnueabihf-g++"),
                                 reason="packaging/armhf.list is not installed")]


def test_the_library_compiles_for_armhf():
    call(ROOT / "tools" / "armhf.sh", BUILD)
