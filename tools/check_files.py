#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""check_files.py [FILE...]: finds files that do not belong in the repository, among the files given or all that git
does not ignore: object files, archives and executables, and files of more than 1 MB outside tests/data.

Prints `FILE: what it is`. Status: 0 nothing found, 1 something found.
"""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
LARGEST_BYTES = 1_000_000
DATA = ROOT / "tests/data"

# How the content of such files begins.
KINDS = {
    b"\x7fELF": "an ELF file (program, library or object file)",
    b"MZ": "a Windows program or library",
    b"\xcf\xfa\xed\xfe": "a Mach-O file (program, library or object file)",
    b"!<arch>\n": "a static library or Debian package",
    b"!<thin>\n": "a static library",
    b"PK\x03\x04": "a ZIP archive or a Python wheel",
    b"\x1f\x8b": "a gzip archive",
    b"BZh": "a bzip2 archive",
    b"\xfd7zXZ\x00": "an xz archive",
    b"\x28\xb5\x2f\xfd": "a zstd archive",
    b"7z\xbc\xaf\x27\x1c": "a 7z archive",
}
TAR_MAGIC_AT = 257


def kind_of(head: bytes) -> str | None:
    if head[TAR_MAGIC_AT:TAR_MAGIC_AT + 5] == b"ustar":
        return "a tar archive"
    return next((kind for magic, kind in KINDS.items() if head.startswith(magic)), None)


def fault_of(path: pathlib.Path) -> str | None:
    with path.open("rb") as file:
        kind = kind_of(file.read(512))
    if kind:
        return kind
    if path.stat().st_size > LARGEST_BYTES and not path.is_relative_to(DATA):
        return f"larger than {LARGEST_BYTES} bytes; only tests/data may have such files"
    return None


def known_files() -> list[pathlib.Path]:
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT,
                            check=True, capture_output=True, text=True).stdout
    return [ROOT / name for name in listed.split("\0") if name]


def main() -> int:
    files = [pathlib.Path(name).absolute() for name in sys.argv[1:]] or known_files()
    found = {file: fault for file in files if file.is_file() and not file.is_symlink() and (fault := fault_of(file))}
    for file, fault in found.items():
        print(f"{file.relative_to(ROOT) if file.is_relative_to(ROOT) else file}: {fault}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
