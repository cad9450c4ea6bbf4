# SPDX-License-Identifier: MIT
"""tidy.py units|headers|sources BUILD: checks the whole tree, for `./run tidy`. BUILD has compile_commands.json, and no
unity files.
tidy.py files BUILD [FILE...]: checks these sources and public headers.

units: clang-tidy over many sources at a time, which share the cost of headers. With `files`: over a few, each alone.
headers, sources: the compiler's warnings, over each public header or each source by itself. This finds files that do
       not include what they use.

The exit status is 1 if there is a finding."""
import concurrent.futures
import functools
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
TOPS = ("src", "apps", "tools", "python/src")
FILES_A_UNIT = 70
FEW_FILES = 16
CLANG_TIDY = ("clang-tidy-16", "--quiet", "--warnings-as-errors=*")
INCLUDE = re.compile(r'^#include "(.+)"', re.MULTILINE)


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


def options_of(entry: dict[str, str]) -> list[str]:
    """The compiler and its options. `-isystem FOLDER` is one string."""
    words = shlex.split(entry["command"].replace("-isystem ", "-isystem"))
    return words[:words.index("-o")]


def groups_of(entries: list[dict[str, str]]) -> list[list[dict[str, str]]]:
    """Groups of up to FILES_A_UNIT sources from one folder of TOPS, or generated, or that include ncurses: its headers
    define macros such as `columns`."""
    groups: dict[str, list[dict[str, str]]] = {}
    for entry in entries:
        name = next((top for top in TOPS if entry["file"].startswith(f"{ROOT / top}/")), "generated")
        if "#include <ncurses.h>" in pathlib.Path(entry["file"]).read_text():
            name = "ncurses"
        groups.setdefault(name, []).append(entry)
    return [group[at:at + FILES_A_UNIT] for group in groups.values() for at in range(0, len(group), FILES_A_UNIT)]


def unite(group: list[dict[str, str]], path: pathlib.Path) -> dict[str, str]:
    """Writes a source that includes those of the group, and returns its command, with the options of all of them. In
    this source, -Wshadow also finds variables that have the name of a constant of another file."""
    path.write_text("".join(f'#include "{entry["file"]}"\n' for entry in group))
    options = dict.fromkeys(option for entry in group for option in options_of(entry))
    command = shlex.join([*options, "-c", str(path)])
    return {"directory": group[0]["directory"], "file": str(path), "command": command}


def check_units(build: pathlib.Path) -> bool:
    return check_groups(build, groups_of(compile_commands(build)))


def check_groups(build: pathlib.Path, groups: list[list[dict[str, str]]]) -> bool:
    """The analyzer follows functions of included sources only if the file is called UnifiedSource
    (AnalysisManager::isInCodeFile of Clang)."""
    database = build / "units"
    database.mkdir(exist_ok=True)
    groups = sorted(groups, key=len, reverse=True)
    entries = [unite(group, database / f"UnifiedSource{number}.cpp") for number, group in enumerate(groups)]
    (database / "compile_commands.json").write_text(json.dumps(entries))
    return all_passed([[*tidy_of_units(), "-p", str(database), entry["file"]] for entry in entries], build)


def check_files(build: pathlib.Path, *files: str) -> bool:
    wanted = {ROOT / file for file in files}
    headers = {name: path for name, path in public_headers(build).items() if path in wanted}
    # The groups of a check of everything. In other groups, names of two files might clash.
    groups = [[entry for entry in group if pathlib.Path(entry["file"]) in wanted]
              for group in groups_of(compile_commands(build))]
    sources = [entry["file"] for group in groups for entry in group]
    print(f"{len(sources)} sources, {len(headers)} public headers", flush=True)
    if len(sources) > FEW_FILES:
        clean = check_groups(build, [group for group in groups if group])
    else:
        clean = all_passed([[*CLANG_TIDY, "-p", str(build), source] for source in sources], build)
    return check_alone(build, headers) and clean


def tidy_of_units() -> list[str]:
    if os.environ.get("MAVLOOM_FULL"):
        config, changes = re.subn(r"max-nodes=\d+", "max-nodes=225000", (ROOT / ".clang-tidy").read_text())
        assert changes == 1
        return [*CLANG_TIDY, "--checks=clang-diagnostic-*", f"--config={config}"]
    # The second is a tenth of the time, most of it in headers of libraries.
    return [*CLANG_TIDY, "--checks=clang-diagnostic-*,-performance-unnecessary-value-param"]


def compiler(entry: dict[str, str]) -> list[str]:
    return [*options_of(entry), "-fsyntax-only", "-Werror"]


def public_headers(build: pathlib.Path) -> dict[str, pathlib.Path]:
    """By the name in #include: all headers of the library, and a few of messages, which all come from one template."""
    headers = {}
    for top in ROOT / "include", build / "generated/include":
        found = sorted(top.glob("mavloom/**/*.hpp")) or sys.exit(f"{top}: there are no headers to check")
        headers |= {str(path.relative_to(top)): path for number, path in enumerate(found)
                    if "msg" not in path.relative_to(top).parts or number % 40 == 0}
    return headers


def includes_of(headers: dict[str, pathlib.Path]) -> dict[str, set[str]]:
    """The names of the headers that each includes, directly or not."""
    direct = {name: set(INCLUDE.findall(path.read_text())) & headers.keys() for name, path in headers.items()}

    @functools.cache
    def reached(name: str) -> set[str]:
        return direct[name].union(*map(reached, direct[name]))
    return {name: reached(name) for name in headers}


def chains_of(headers: dict[str, pathlib.Path]) -> list[list[str]]:
    """The headers in chains. A header includes all headers before it in its chain, so it sees what it sees alone."""
    includes, chains = includes_of(headers), []
    for name in sorted(headers, key=lambda name: len(includes[name])):
        fitting = [chain for chain in chains if chain[-1] in includes[name]]
        if fitting:
            max(fitting, key=lambda chain: len(includes[chain[-1]])).append(name)
        else:
            chains.append([name])
    return chains


def check_headers(build: pathlib.Path) -> bool:
    return check_alone(build, public_headers(build))


def check_alone(build: pathlib.Path, headers: dict[str, pathlib.Path]) -> bool:
    """A source of the last header's module has the options."""
    module_in = re.compile(r"/mavloom_([a-z]+)(_cold|_core)?\.dir/")
    options = {found[1]: compiler(entry) for entry in compile_commands(build)
               if (found := module_in.search(entry["command"]))}
    commands = []
    for chain in chains_of(headers):
        module = chain[-1].split("/")[1].replace("msg", "message")
        included = [word for name in chain for word in ("-include", str(headers[name]))]
        commands.append([*options[module], *included, "-x", "c++", "/dev/null"])
    return all_passed(commands, build)


def check_sources(build: pathlib.Path) -> bool:
    return all_passed([[*compiler(entry), entry["file"]] for entry in compile_commands(build)], build)


def main() -> int:
    checks = {"units": check_units, "files": check_files, "headers": check_headers, "sources": check_sources}
    check, build, *files = sys.argv[1:] if len(sys.argv) > 2 else ("", "")
    if check not in checks or (files and check != "files"):
        print(__doc__, file=sys.stderr)
        return 2
    return 0 if checks[check](pathlib.Path(build).resolve(), *files) else 1


if __name__ == "__main__":
    sys.exit(main())
