# SPDX-License-Identifier: MIT
"""How the program and the Python module are protected from errors in memory: read from the ELF files of a release
build."""
import re
import subprocess

import harness
import pytest

BUILD = harness.program_path().parent.parent
ENDBR64 = b"\xf3\x0f\x1e\xfa"


def is_release():
    cache = BUILD / "CMakeCache.txt"
    return not cache.exists() or "CMAKE_BUILD_TYPE:STRING=Release" in cache.read_text()


pytestmark = pytest.mark.skipif(not is_release(), reason="only release builds are hardened")


def readelf(file, *options):
    return subprocess.run(["readelf", "--wide", *options, file], capture_output=True, text=True, check=True).stdout


@pytest.fixture(params=["program", "module"])
def elf(request):
    if request.param == "program":
        return harness.program_path()
    found = list((BUILD / "python" / "mavloom").glob("_core*.so"))
    if not found:
        pytest.skip("the Python module is not built")
    return found[0]


def test_addresses_are_random_and_the_stack_holds_no_code(elf):
    header, segments = readelf(elf, "--file-header"), readelf(elf, "--segments")

    assert re.search(r"Type:\s+DYN", header)
    assert re.search(r"GNU_STACK .* RW +0x", segments)


def test_the_loaders_tables_are_read_only(elf):
    dynamic = readelf(elf, "--dynamic")

    assert "GNU_RELRO" in readelf(elf, "--segments")
    assert re.search(r"\(FLAGS_1\).*\bNOW\b", dynamic)


def test_calls_check_their_stack_and_their_buffers(elf):
    symbols = readelf(elf, "--dyn-syms")

    assert "__stack_chk_fail" in symbols
    assert re.search(r"__(mem|str|v?sn?printf|read|recv|pread|fread)\w*_chk", symbols)


def test_indirect_calls_arrive_at_a_mark(elf):
    """Debian 12's crt1.o has no note about it, so the linker leaves out the program's; the code shows it."""
    if "X86-64" not in readelf(elf, "--file-header"):
        pytest.skip("x86-64 only")
    functions = re.findall(r"^ *\d+: ([0-9a-f]+) +\d+ FUNC +\w+ +DEFAULT +\d+ (main|PyInit_\w+)$",
                           readelf(elf, "--symbols"), re.MULTILINE)
    text = re.search(r" \.text +PROGBITS +([0-9a-f]+) ([0-9a-f]+)", readelf(elf, "--sections"))
    address, offset = (int(number, 16) for number in text.groups())
    assert functions
    with open(elf, "rb") as file:
        for at, name in functions:
            file.seek(int(at, 16) - address + offset)
            assert file.read(4) == ENDBR64, name
