#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""make_image_root.py FOLDER MAVLOOM.deb: makes FOLDER/root, all files of a container image with the program mavloom and
nothing else (packaging/docker/Dockerfile), from the Debian package.

These are the program, the shared libraries that it loads on this machine, the terminal descriptions that `mavloom top`
needs, and the licences of all. The root also works with chroot.
"""
import argparse
import pathlib
import shutil
import subprocess
import tempfile

from shared_libraries import libraries_of, licence_of, package_of

OF_THE_PACKAGE = ("usr/bin/mavloom", "usr/share/doc/mavloom/copyright", "usr/share/doc/mavloom/licences.txt")
TERMINAL_FOLDERS = ("/etc/terminfo", "/lib/terminfo", "/usr/share/terminfo")
TERMINALS = ("linux", "screen-256color", "tmux-256color", "vt100", "xterm", "xterm-256color")


def copy(source: pathlib.Path, root: pathlib.Path, name: pathlib.Path | None = None) -> None:
    """`source`, or what it links to, by the same path, or by `name`, below `root`."""
    target = root / (name or source).relative_to("/")
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(source, target)


def copy_package(package: pathlib.Path, root: pathlib.Path) -> None:
    with tempfile.TemporaryDirectory() as unpacked:
        subprocess.run(["dpkg-deb", "--extract", package, unpacked], check=True)
        for file in OF_THE_PACKAGE:
            copy(pathlib.Path(unpacked, file), root, pathlib.Path("/", file))


def copy_libraries(root: pathlib.Path) -> None:
    packages = set()
    for library in libraries_of(root / "usr/bin/mavloom"):
        copy(library, root)
        packages.add(package_of(library))
    for package in packages:
        copy(licence_of(package), root)


def copy_terminals(root: pathlib.Path) -> None:
    for name in TERMINALS:
        found = (pathlib.Path(folder, name[0], name) for folder in TERMINAL_FOLDERS)
        if source := next((path for path in found if path.exists()), None):
            copy(source, root, pathlib.Path("/usr/share/terminfo", name[0], name))


def main() -> None:
    parser = argparse.ArgumentParser(description="makes the files of a container image")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("package", type=pathlib.Path)
    given = parser.parse_args()
    root = given.folder / "root"
    shutil.rmtree(root, ignore_errors=True)
    copy_package(given.package, root)
    copy_libraries(root)
    copy_terminals(root)
    (given.folder / "empty").mkdir(exist_ok=True)  # /run/mavloom and /var/lib/mavloom, which belong to the user


if __name__ == "__main__":
    main()
