# SPDX-License-Identifier: MIT
"""changed_sources.py BASE: prints the .cpp files of the library, the program and the Python package, and the public
headers, that have changed since the commit BASE, or that include a changed header, directly or indirectly.

The exit status is 3 if something changed that every file depends on (clang-tidy's rules, warnings, dialects). All
files must be checked then."""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
TOPS = ("include", "src", "apps", "python/src")
# Other files of the build do not change what clang-tidy finds in a source.
OF_ALL = re.compile(r"^(\.clang-tidy|cmake/Mavloom(Module|Dialect|DefaultDialect)\.cmake)$|"
                    r"^dialects/|^tools/dialectgen/")
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)


def changed_since(base: str) -> list[str]:
    """Returns the files that differ from `base`, including uncommitted and untracked ones."""
    differing = subprocess.run(["git", "diff", "--name-only", base], cwd=ROOT, check=True, capture_output=True,
                               text=True).stdout.split()
    untracked = subprocess.run(["git", "ls-files", "--others", "--exclude-standard"], cwd=ROOT, check=True,
                               capture_output=True, text=True).stdout.split()
    return differing + untracked


def included_by() -> dict[str, set[str]]:
    """Returns {how a file is included: the files that include it}."""
    users: dict[str, set[str]] = {}
    for top in TOPS:
        for path in (ROOT / top).rglob("*.[ch]pp"):
            for name in INCLUDE.findall(path.read_text()):
                users.setdefault(name, set()).add(str(path.relative_to(ROOT)))
    return users


def spelling_of(path: str) -> str:
    """Returns the path as an #include spells it: below include/, src/ or python/src/, or in the file's own folder."""
    top = next(top for top in TOPS if path.startswith(top + "/"))
    return path[len(top) + 1:] if top != "apps" else pathlib.PurePath(path).name


def main() -> int:
    changed = changed_since(sys.argv[1])
    if any(OF_ALL.search(path) for path in changed):
        return 3
    users, found = included_by(), set()
    waiting = [path for path in changed if path.startswith(tuple(top + "/" for top in TOPS))]
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting += users.get(spelling_of(path), ())
    print("\n".join(sorted(path for path in found
                           if path.startswith("include/") or path.endswith(".cpp") if (ROOT / path).exists())))
    return 0


if __name__ == "__main__":
    sys.exit(main())
