# SPDX-License-Identifier: MIT
"""tools/changed_sources.py: which files clang-tidy looks at when a change is small."""
import shutil
import subprocess
import sys

import pytest

from harness import ROOT

TREE = {
    "include/mavloom/base/a.hpp": "", "include/mavloom/wire/b.hpp": '#include "mavloom/base/a.hpp"\n',
    "src/wire/private.hpp": '#include "mavloom/wire/b.hpp"\n', "src/base/a.cpp": '#include "mavloom/base/a.hpp"\n',
    "src/wire/b.cpp": '#include "wire/private.hpp"\n', "src/net/c.cpp": "#include <vector>\n",
    "apps/mavloom/own.hpp": "", "apps/mavloom/main.cpp": '#  include "own.hpp"\n', "docs/page.md": "",
    "CMakeLists.txt": "",
}


@pytest.fixture
def tree(tmp_path):
    for name, text in TREE.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    (tmp_path / "tools").mkdir()
    shutil.copy(ROOT / "tools" / "changed_sources.py", tmp_path / "tools")
    for command in (["init", "-q"], ["add", "."], ["-c", "user.name=x", "-c", "user.email=x@x", "commit", "-qm", "x"]):
        subprocess.run(["git", *command], cwd=tmp_path, check=True)
    return tmp_path


def changed(tree, base="HEAD"):
    done = subprocess.run([sys.executable, tree / "tools" / "changed_sources.py", base], cwd=tree, capture_output=True,
                          text=True)
    return done.returncode, done.stdout.split()


@pytest.mark.parametrize("edited, wanted", [
    ("include/mavloom/base/a.hpp",
     ["include/mavloom/base/a.hpp", "include/mavloom/wire/b.hpp", "src/base/a.cpp", "src/wire/b.cpp"]),
    ("src/wire/private.hpp", ["src/wire/b.cpp"]),
    ("src/net/c.cpp", ["src/net/c.cpp"]), ("apps/mavloom/own.hpp", ["apps/mavloom/main.cpp"]), ("docs/page.md", []),
    ("src/net/new.cpp", ["src/net/new.cpp"]),
])
def test_what_differs_and_what_includes_it(tree, edited, wanted):
    with (tree / edited).open("a") as file:
        file.write("// edited\n")
    assert changed(tree) == (0, wanted)


@pytest.mark.parametrize("edited, of_all", [
    (".clang-tidy", True), ("cmake/MavloomModule.cmake", True), ("dialects/common.xml", True),
    ("CMakeLists.txt", False), ("cmake/MavloomPackage.cmake", False), ("bench/CMakeLists.txt", False),
])
def test_a_change_of_how_all_is_compiled_is_one_of_everything(tree, edited, of_all):
    (tree / edited).parent.mkdir(exist_ok=True)
    (tree / edited).write_text("# edited\n")
    assert changed(tree) == (3 if of_all else 0, [])


def test_an_unknown_commit_is_an_error(tree):
    status, printed = changed(tree, "0123456789abcdef0123456789abcdef01234567")
    assert status not in (0, 3) and printed == []
