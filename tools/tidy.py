# SPDX-License-Identifier: MIT
"""tidy.py units|headers|sources BUILD: checks the whole tree, for `./run tidy`. BUILD has compile_commands.json.

units: clang-tidy over the files of a unity build, which share the cost of headers.
headers, sources: the compiler's warnings, over each public header or each source by itself. This finds files that do
       not include what they use. `sources` needs a build without unity files.

The exit status is 1 if there is a finding."""
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]


def passed(command: list[str], folder: pathlib.Path) -> bool:
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        print(shlex.join(command), done.stdout, sep="\n", flush=True)
    return not done.returncode


def all_passed(commands: list[list[str]], folder: pathlib.Path) -> bool:
    """Runs the commands, as many at once as there are processors."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return all(list(pool.map(passed, commands, [folder] * len(commands))))


def compile_commands(build: pathlib.Path) -> list[dict[str, str]]:
    found = [entry for entry in json.loads((build / "compile_commands.json").read_text())
             if "/nanobind" not in entry["file"]]
    return found or sys.exit(f"{build}: there are no sources to check")


def unified(entry: dict[str, str]) -> dict[str, str]:
    """Copies a unity file, and returns the command for the copy. The analyzer follows functions of included sources
    only if the file has such a name (AnalysisManager::isInCodeFile of Clang)."""
    source = entry["file"]
    copy = re.sub(r"/unity_(\d+)_cxx\.cxx$", r"/UnifiedSource\1.cpp", source)
    if copy != source:
        pathlib.Path(copy).write_bytes(pathlib.Path(source).read_bytes())
    return {**entry, "file": copy, "command": entry["command"].replace(source, copy)}


def check_units(build: pathlib.Path) -> bool:
    entries = [unified(entry) for entry in compile_commands(build)]
    database = build / "units"
    database.mkdir(exist_ok=True)
    (database / "compile_commands.json").write_text(json.dumps(entries))
    checks = "clang-diagnostic-*"
    if not os.environ.get("MAVLOOM_FULL"):
        checks += ",-performance-unnecessary-value-param"  # a tenth of the time, most of it in headers of libraries
    check = ["clang-tidy-16", "-p", str(database), "--quiet", "--warnings-as-errors=*", f"--checks={checks}"]
    return all_passed([[*check, entry["file"]] for entry in entries], build)


def compiler(entry: dict[str, str]) -> list[str]:
    words = shlex.split(entry["command"])
    return [*words[:words.index("-o")], "-fsyntax-only", "-Werror"]


def check_headers(build: pathlib.Path) -> bool:
    """A source of the header's module has the options. Generated headers of messages all come from one template."""
    module_in = re.compile(r"/mavloom_([a-z]+)(_cold|_core)?\.dir/")
    options = {found[1]: compiler(entry) for entry in compile_commands(build)
               if (found := module_in.search(entry["command"]))}
    commands = []
    for top in ROOT / "include/mavloom", build / "generated/include/mavloom":
        headers = sorted(top.rglob("*.hpp")) or sys.exit(f"{top}: there are no headers to check")
        for number, header in enumerate(headers):
            folder = header.relative_to(top).parts[0]
            if folder == "msg" and number % 40:
                continue
            module = "message" if folder == "msg" else folder
            commands.append([*options[module], "-include", str(header), "-x", "c++", "/dev/null"])
    return all_passed(commands, build)


def check_sources(build: pathlib.Path) -> bool:
    return all_passed([[*compiler(entry), entry["file"]] for entry in compile_commands(build)], build)


def main() -> int:
    checks = {"units": check_units, "headers": check_headers, "sources": check_sources}
    if len(sys.argv) != 3 or sys.argv[1] not in checks:
        print(__doc__, file=sys.stderr)
        return 2
    return 0 if checks[sys.argv[1]](pathlib.Path(sys.argv[2]).resolve()) else 1


if __name__ == "__main__":
    sys.exit(main())
