# SPDX-License-Identifier: MIT
"""The shared libraries that a program loads, and the Debian packages that they belong to."""
import os
import pathlib
import re
import subprocess


def libraries_of(elf: os.PathLike[str] | str) -> list[pathlib.Path]:
    """As the loader finds them on this machine, the loader itself included."""
    listed = subprocess.run(["ldd", elf], check=True, capture_output=True, text=True).stdout
    if missing := re.findall(r"(\S+) => not found", listed):
        raise FileNotFoundError(f"{elf} needs {', '.join(missing)}")
    return [pathlib.Path(path) for path in re.findall(r"(?:^\t|=> )(/\S+)", listed, re.MULTILINE)]


def package_of(library: pathlib.Path) -> str:
    """/lib may be a link to /usr/lib; dpkg knows a file by one of the two names."""
    names = [library, library.resolve(), pathlib.Path(str(library.resolve()).removeprefix("/usr"))]
    found = subprocess.run(["dpkg-query", "--search", *map(str, names)], capture_output=True, text=True).stdout
    return re.split(r"[:,]", found)[0]


def licence_of(package: str) -> pathlib.Path:
    return pathlib.Path("/usr/share/doc") / package / "copyright"
