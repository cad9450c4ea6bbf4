# SPDX-License-Identifier: MIT
"""Sizes and file modes as `python -m mavloom.hear` takes them: the forms of docs/guide/endpoints.md and shm.md."""
import argparse

import pytest

from mavloom._values import mode, size

SIZES = {"0": 0, "5000": 5000, "12B": 12, "64k": 65_536, "64K": 65_536, "64KiB": 65_536, "64kB": 64_000,
         "8m": 8_388_608, "8M": 8_388_608, "8MiB": 8_388_608, "8MB": 8_000_000,
         "1g": 1_073_741_824, "1G": 1_073_741_824, "1GiB": 1_073_741_824, "1GB": 1_000_000_000}
NO_SIZES = ["", "M", "8X", "8mb", "8 M", " 8M", "-8M", "+8M", "1.5M", "8M\n", "0x10", "1_000", "８M"]
MODES = {"600": 0o600, "0600": 0o600, "0o600": 0o600, "640": 0o640, "0640": 0o640, "777": 0o777, "0000": 0}
NO_MODES = ["", "9", "0", "60", "06400", "1600", "00o600", "0o6000", "0x600", "-600", "+600",
            " 600", "600 ", "6_00", "608", "rw-r-----"]


@pytest.mark.parametrize("text, value", SIZES.items())
def test_a_size_has_these_units(text, value):
    assert size(text) == value


@pytest.mark.parametrize("text, value", MODES.items())
def test_a_mode_has_three_octal_digits(text, value):
    assert mode(text) == value


@pytest.mark.parametrize("parse, text", [(size, text) for text in NO_SIZES] + [(mode, text) for text in NO_MODES])
def test_other_forms_are_refused(parse, text):
    with pytest.raises(argparse.ArgumentTypeError, match="for example"):
        parse(text)
