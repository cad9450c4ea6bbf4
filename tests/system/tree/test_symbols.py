# SPDX-License-Identifier: MIT
"""Library modules never print, exit or abort: what they need from outside holds none of the functions that do."""
import pathlib
import re
import subprocess

import pytest

import harness

FORBIDDEN = re.compile(
    r"_*(v?f?printf(_chk)?|puts|fputs|putchar|putc|perror|psignal|stdout|stderr|syslog"
    r"|exit|_exit|_Exit|quick_exit|abort)"
    r"|std::(cout|cerr|clog|exit|_Exit|quick_exit|abort)"
    r"|fmt::v\d+::(v?print(ln)?)\(.*"
    r"|spdlog::.*")
# Their last bits depend on the C library and the processor. src/flight/physics/math.hpp replaces them.
INEXACT = re.compile(r"(a?(sin|cos|tan)h?|sincos|atan2|exp(2|10|m1)?|log(2|10|1p)?|pow|hypot|cbrt|erfc?)[fl]?")


def forbidden_symbols(binary: pathlib.Path, forbidden=FORBIDDEN) -> set:
    listing = subprocess.run(["nm", "--undefined-only", "--demangle", "--format=just-symbols", binary],
                             capture_output=True, text=True, check=True)
    symbols = {line.split("@")[0].strip() for line in listing.stdout.splitlines()}
    return {symbol for symbol in symbols if forbidden.fullmatch(symbol)}


def libraries() -> list:
    return sorted((harness.program_path().parent.parent).glob("libmavloom_*.a"))


def test_libraries_are_found():
    assert {"libmavloom_base.a", "libmavloom_wire.a"} <= {path.name for path in libraries()}


@pytest.mark.parametrize("library", libraries(), ids=lambda path: path.stem)
def test_library_neither_prints_nor_exits(library):
    assert forbidden_symbols(library) == set()


@pytest.mark.parametrize("name", ["flight", "sim", "hil"])
def test_flights_do_not_depend_on_the_processor(name):
    library = harness.program_path().parent.parent / f"libmavloom_{name}.a"
    assert forbidden_symbols(library, INEXACT) == set()


@pytest.mark.parametrize("code, symbol", [
    ("#include <cstdio>\nvoid f(int i) { std::printf(\"%d\", i); }", "printf"),
    ("#include <cstdlib>\nvoid f() { std::exit(1); }", "exit"),
    ("#include <cstdlib>\nvoid f() { std::abort(); }", "abort"),
    ("#include <iostream>\nvoid f(int i) { std::cerr << i; }", "std::cerr"),
    ("#include <fmt/format.h>\nvoid f(int i) { fmt::print(\"{}\", i); }", "fmt::v9::vprint"),
])
def test_forbidden_symbol_is_found(tmp_path, code, symbol):
    source, built = tmp_path / "x.cpp", tmp_path / "x.o"
    source.write_text(code + "\n")
    subprocess.run(["c++", "-std=c++20", "-O1", "-c", source, "-o", built], check=True)

    assert any(found.startswith(symbol) for found in forbidden_symbols(built))


def test_inexact_function_is_found(tmp_path):
    source, built = tmp_path / "x.cpp", tmp_path / "x.o"
    source.write_text("#include <cmath>\ndouble f(double x) { return std::sin(x) + std::sqrt(std::round(x)); }\n")
    subprocess.run(["c++", "-std=c++20", "-O1", "-c", source, "-o", built], check=True)
    assert forbidden_symbols(built, INEXACT) == {"sin"}
